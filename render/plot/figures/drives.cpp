// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

// One curve for every column that ends so; the name before it is the drive's.
void add_curves(const Diagnostics& d, std::string_view ending, Panel& panel) {
  int color = 0;
  for (const Series& column : d.columns)
    if (column.name.ends_with(ending))
      panel.curves.push_back(
          over_time(d, column.values, column.name.substr(0, column.name.size() - ending.size()), color++));
}

}  // namespace

Figure drives_figure(const Simulation& run, const Diagnostics& d) {
  Figure f;
  f.name = "drives";
  f.title = "What the drives give";
  f.caption =
      "Torque or force of every motor, winch and prescribed motion along what it moves, and its power.";
  for (const auto& [ending, label] :
       {std::pair{".torque_N_m", "torque (N m)"}, std::pair{".force_N", "force (N)"},
        std::pair{".power_W", "power (W)"}}) {
    Panel panel = time_panel(run, label);
    add_curves(d, ending, panel);
    if (!panel.curves.empty()) f.panels.push_back(std::move(panel));
  }
  f.rows = static_cast<int>(f.panels.size());
  f.height_mm = 55.0 * static_cast<double>(f.panels.size()) + 30.0;
  for (std::size_t i = 1; i < f.panels.size(); ++i) share_time_axis(f.panels[i - 1], f.panels[i]);
  for (const Series& column : d.columns)
    if (column.name.ends_with(".power_W"))
      f.caption += " " + column.name.substr(0, column.name.size() - 8) + ": at most " +
                   plot::format_number(largest_magnitude(column.values), 4) + " W.";
  f.caption += events_sentence(run) + " " + method_sentence(run);
  return f;
}

}  // namespace unfurl
