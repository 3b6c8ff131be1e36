// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/reproduce_figures.hpp"

#include <algorithm>
#include <array>

#include "core/diagnostics/diagnostics.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

constexpr std::array scheme_colors{1, 6, 5, 0};
constexpr std::array dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted};
constexpr std::array markers{Marker::square, Marker::triangle, Marker::diamond, Marker::circle};

Panel error_panel(std::string title, std::string x, std::string y) {
  Panel p;
  p.title = std::move(title);
  p.x.label = std::move(x);
  p.y.label = std::move(y);
  p.y.log = true;
  return p;
}

Curve curve(const Reproduction& r, std::size_t scheme, bool labelled) {
  Curve c;
  if (labelled) c.label = r.schemes[scheme].name;
  c.color = scheme_colors[scheme];
  c.dash = dashes[scheme];
  return c;
}

}  // namespace

Figure reproduced_poses_figure(const Reproduction& r) {
  Figure f = poses_figure(*r.motion, diagnose(*r.motion));
  f.name = "figure_2_poses";
  f.title = "Deployment of the six-unit ring (Figure 2 of the paper)";
  return f;
}

Figure reproduced_constraint_figure(const Reproduction& r) {
  Figure f;
  f.name = "figures_3_4_constraint_error";
  f.title = "Constraint error over time (Figures 3 and 4 of the paper)";
  f.columns = 2;
  f.width_mm = 180;
  f.height_mm = 90;
  f.caption =
      "Largest error of all constraints. The variational method stays at the round-off of a length of 3 m; "
      "Runge-Kutta imposes the second derivative of the constraints only and drifts off. Exact zeros are "
      "drawn at the bottom edge.";
  for (std::size_t step = paper_step; step <= paper_step + 1; ++step) {
    Panel p = error_panel("h = " + plot::format_number(reproduced_steps[step], 3) + " s", "time (s)",
                          "constraint error (m)");
    p.y.min = 1e-17;
    p.y.max = 1e-5;
    p.y.zeros_at_floor = true;
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      Curve c = curve(r, s, step == paper_step);
      c.x = r.schemes[s].runs[step].t;
      c.y = r.schemes[s].runs[step].constraint_error;
      p.curves.push_back(std::move(c));
    }
    f.panels.push_back(std::move(p));
  }
  return f;
}

Figure reproduced_trajectory_figure(const Reproduction& r) {
  Figure f;
  f.name = "trajectory_error";
  f.title = "What the constraint error does not show: the error of the trajectory";
  f.columns = 2;
  f.width_mm = 180;
  f.height_mm = 100;
  f.caption =
      "Largest distance of a node from the reference, for the same runs. With multipliers at the ends of a "
      "step only, the scheme as printed is second order; with constraints at every node it is of order "
      "2 s \u2212 2.";
  Panel time = error_panel("over time, h = 0.01 s", "time (s)", "position error (m)");
  time.y.min = 1e-15;
  time.y.max = 1e-2;
  Panel order = error_panel("against the step", "step (s)", "largest position error (m)");
  order.x.log = true;
  order.x.min = 0.8 * reproduced_steps.back();
  order.x.max = 1.25 * reproduced_steps.front();
  for (std::size_t s = 0; s < r.schemes.size(); ++s) {
    Curve c = curve(r, s, true);
    c.x = r.schemes[s].runs[paper_step].comparison_t;
    c.y = r.schemes[s].runs[paper_step].position_error;
    time.curves.push_back(std::move(c));
    Curve o = curve(r, s, false);
    o.marker = markers[s];
    for (const ReproducedRun& run : r.schemes[s].runs) {
      o.x.push_back(run.measured.step);
      o.y.push_back(run.measured.position_error);
    }
    order.curves.push_back(std::move(o));
  }
  f.panels = {std::move(time), std::move(order)};
  return f;
}

}  // namespace unfurl
