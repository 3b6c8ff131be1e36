// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/diagnostics/peaks.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/same_curves.hpp"
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

// " motor: between −2 W and 5.5 W.": what a drive brakes has a minus.
std::string power_sentence(const Simulation& run, const Diagnostics& d, const std::string& drive) {
  const std::string column = drive + ".power_W";
  const double least = smallest_of_column(run, d, column), most = largest_of_column(run, d, column);
  const double noise = 1e-9 * std::max(std::abs(least), std::abs(most));
  const auto text = [noise](double x) {
    return plot::format_number(std::abs(x) > noise ? x : 0.0, 4) + " W";
  };
  if (text(least) == text(most)) return " " + drive + ": " + text(most) + ".";
  return " " + drive + ": between " + text(least) + " and " + text(most) + ".";
}

}  // namespace

Figure drives_figure(const Simulation& run, const Diagnostics& d) {
  Figure f;
  f.name = "drives";
  f.title = "What the drives give";
  f.caption =
      "Torque or force of every motor, winch and prescribed motion along what it moves, and the power it "
      "gives.";
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
      f.caption += power_sentence(run, d, column.name.substr(0, column.name.size() - 8));
  f.caption += plot::same_curves_sentence(f) + events_sentence(run) + " " + method_sentence(run);
  return f;
}

}  // namespace unfurl
