// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "core/diagnostics/peaks.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/style.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

// One curve for every column that ends so; the name before it is the drive's, which keeps its colour and
// dashes from panel to panel.
void add_curves(const Diagnostics& d, std::string_view ending, std::map<std::string, int>& colors,
                Panel& panel) {
  for (const Series& column : d.columns) {
    if (!column.name.ends_with(ending)) continue;
    const std::string drive = column.name.substr(0, column.name.size() - ending.size());
    const int color = colors.try_emplace(drive, static_cast<int>(colors.size())).first->second;
    panel.curves.push_back(over_time(d, column.values, drive, color));
    panel.curves.back().dash = color < palette_size ? Dash::solid : Dash::long_dashed;
  }
}

}  // namespace

Figure drives_figure(const Simulation& run, const Diagnostics& d) {
  Figure f;
  f.name = "drives";
  f.title = "What the drives give";
  f.caption =
      "Torque or force of every motor, winch and prescribed motion along what it moves, and its power.";
  std::map<std::string, int> colors;
  for (const auto& [ending, label] :
       {std::pair{".torque_N_m", "torque (N m)"}, std::pair{".force_N", "force (N)"},
        std::pair{".power_W", "power (W)"}}) {
    Panel panel = time_panel(run, label);
    add_curves(d, ending, colors, panel);
    if (!panel.curves.empty()) f.panels.push_back(std::move(panel));
  }
  f.rows = static_cast<int>(f.panels.size());
  f.height_mm = 55.0 * static_cast<double>(f.panels.size()) + 30.0;
  for (std::size_t i = 1; i < f.panels.size(); ++i) share_time_axis(f.panels[i - 1], f.panels[i]);
  for (const Series& column : d.columns)
    if (column.name.ends_with(".power_W"))
      f.caption += " " + column.name.substr(0, column.name.size() - 8) + ": at most " +
                   plot::format_number(peak_of_column(run, d, column.name), 4) + " W.";
  f.caption += events_sentence(run) + " " + method_sentence(run);
  return f;
}

}  // namespace unfurl
