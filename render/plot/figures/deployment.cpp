// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/types.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

// Of a structure that is deployed by a measure of its own.
Figure fraction_figure(const Simulation& run, const Diagnostics& diagnostics) {
  Figure f;
  f.name = "deployment";
  f.title = "Deployment";
  f.height_mm = 85;
  f.caption = "Deployed fraction." + events_sentence(run) + " " + method_sentence(run);
  Panel p = time_panel(run, "deployed fraction");
  p.curves.push_back(over_time(diagnostics, diagnostics.at("deployed_fraction").values, "", 0));
  f.panels.push_back(std::move(p));
  return f;
}

}  // namespace

Figure deployment_figure(const Simulation& run, const Diagnostics& diagnostics) {
  if (!diagnostics.find("fold_angle_rad")) return fraction_figure(run, diagnostics);
  std::vector<double> degrees = diagnostics.at("fold_angle_rad").values;
  for (double& a : degrees) a /= radians_per_degree;
  const std::vector<double>& fraction = diagnostics.at("deployed_fraction").values;

  Figure f;
  f.name = "deployment";
  f.title = "Deployment";
  f.height_mm = 85;
  f.caption = "Fold angle (solid, left axis) and deployed fraction (dashed, right axis).";
  if (!degrees.empty())
    f.caption += " The fold angle starts at " + plot::format_number(degrees.front(), 6) + "\u00B0.";
  f.caption += events_sentence(run) + " " + method_sentence(run);

  Panel p = time_panel(run, "fold angle (\u00B0)");
  p.y.degrees = true;
  p.y2.label = "deployed fraction";
  p.curves.push_back(over_time(diagnostics, std::move(degrees), "", 0));
  p.curves.push_back(over_time(diagnostics, fraction, "", 1));
  p.curves.back().right_axis = true;
  p.curves.back().dash = Dash::dashed;
  f.panels.push_back(std::move(p));
  return f;
}

}  // namespace unfurl
