// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "core/diagnostics/accuracy.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

Figure constraint_error_figure(const Simulation& run, const Diagnostics& diagnostics) {
  constexpr double round_off = std::numeric_limits<double>::epsilon();
  const std::vector<double>& position = diagnostics.at("constraint_relative_max").values;
  const std::vector<double>& velocity = diagnostics.at("constraint_velocity_max_m_s").values;

  const double aim = solved_as(run).name == "path" ? 0.0 : constraint_tolerance(run);
  const std::string end =
      aim > 0 ? " Newton iterations end where the constraints are met to " + plot::format_number(aim, 2) + "."
              : "";

  std::vector<double> both = position;
  both.insert(both.end(), velocity.begin(), velocity.end());

  Figure f;
  f.name = "constraint_error";
  f.title = "Constraint error";
  f.rows = 2;
  f.height_mm = 105;
  f.caption =
      "Largest error of all constraints, of positions relative to rod length and of velocities. Worst: " +
      plot::format_number(largest_magnitude(position), 2) + " (" +
      plot::format_number(largest_magnitude(position) / round_off, 2) + " units of round-off) and " +
      plot::format_number(largest_magnitude(velocity), 2) + " m/s." + end + zeros_sentence(both) + " " +
      method_sentence(run);

  Panel top = time_panel(run, "position error (relative)");
  top.y.log = top.y.zeros_at_floor = true;
  top.lines.push_back({round_off, true, "round-off, 2\u207B\u2075\u00B2", 1});
  if (aim > 0) top.lines.push_back({aim, true, "Newton iterations end", 2});
  top.curves.push_back(over_time(diagnostics, position, "", 0));
  Panel bottom = time_panel(run, "velocity error (m/s)");
  bottom.y.log = bottom.y.zeros_at_floor = true;
  bottom.curves.push_back(over_time(diagnostics, velocity, "", 0));
  share_time_axis(top, bottom);
  f.panels = {std::move(top), std::move(bottom)};
  return f;
}

}  // namespace unfurl
