// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/study_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "render/plot/limits.hpp"
#include "render/plot/same_curves.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

using plot::format_number;

// Colours, dashes and markers by the setting's place, so that a setting looks the same in every panel; no two
// of sixteen have both dash and marker in common.
Curve looks_of(std::size_t i) {
  constexpr std::array markers{Marker::circle, Marker::square, Marker::triangle, Marker::diamond};
  constexpr std::array dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted};
  Curve c;
  c.color = static_cast<int>(i % (palette_size - 1));
  c.marker = markers[i % markers.size()];
  c.dash = dashes[i / markers.size() % dashes.size()];
  return c;
}

// A position error as far as it is known: no smaller than the uncertainty of what it is measured by.
double known_error(const Study& study, const MeasuredRun& run) {
  return std::max(run.position_error, study.reference_uncertainty);
}

// A member or function of the run over another; NaN where the run has no answer.
template <class X>
Curve curve_of(const Study& study, std::size_t i, X x, double MeasuredRun::*y) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Curve c = looks_of(i);
  for (const MeasuredRun& run : study.curves[i].runs) {
    c.x.push_back(static_cast<double>(std::invoke(x, run)));
    c.y.push_back(!run.ok() ? nan : y == &MeasuredRun::position_error ? known_error(study, run) : run.*y);
  }
  return c;
}

Panel log_panel(std::string x, std::string y) {
  Panel p;
  p.x.label = std::move(x);
  p.y.label = std::move(y);
  p.x.log = p.y.log = p.y.zeros_at_floor = true;
  return p;
}

// The key to all panels, in one of its own.
Panel key_panel(const Study& study) {
  Panel p;
  p.bare = true;
  for (std::size_t i = 0; i < study.curves.size(); ++i) {
    p.curves.push_back(looks_of(i));
    p.curves.back().label = study.curves[i].setting.name;
  }
  return p;
}

// From the fastest to the slowest of the repeated runs, as a thin line.
void add_spread(const Study& study, const StudyCurve& from, int color, Panel& panel) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Curve c;
  c.color = color;
  c.width = 0.6f;
  for (const MeasuredRun& run : from.runs) {
    if (!run.ok()) continue;
    c.x.insert(c.x.end(), {run.cpu_min, run.cpu_max, nan});
    const double error = known_error(study, run);
    c.y.insert(c.y.end(), {error, error, nan});
  }
  panel.curves.push_back(std::move(c));
}

// What curves that run along the reference's uncertainty mean.
std::string below_sentence(const Study& study) {
  long below = 0;
  for (const StudyCurve& curve : study.curves)
    below += std::count_if(curve.runs.begin(), curve.runs.end(), [&](const MeasuredRun& run) {
      return run.ok() && run.position_error < study.reference_uncertainty;
    });
  if (below == 0) return {};
  return " Errors below it (" + std::to_string(below) + (below == 1 ? " point" : " points") +
         ") are drawn at it.";
}

void add_floor(const Study& study, Panel& panel) {
  if (study.reference_uncertainty > 0)
    panel.lines.push_back({study.reference_uncertainty, true, "uncertainty of the reference", 7});
}

std::string span_sentence(const Study& study) {
  return "Motion from 0 to " + format_number(study.end, 4) + " s" +
         (study.before.empty() ? "" : ", just before " + study.before) + ". Reference: " + study.reference +
         "; " + reference_words(study) + "." + below_sentence(study);
}

std::string drawn_sentences(const Figure& f) {
  const bool zeros = std::ranges::any_of(f.panels, plot::has_floored_zeros);
  return (zeros ? " Exact zeros are drawn at the bottom edge." : "") + plot::same_curves_sentence(f);
}

}  // namespace

Figure work_precision_figure(const Study& study, const std::string& scene) {
  Figure f;
  const bool once = std::ranges::all_of(study.curves, [](const StudyCurve& curve) {
    return std::ranges::all_of(curve.runs, [](const MeasuredRun& run) { return run.repeats <= 1; });
  });
  f.name = "work_precision";
  f.title = "Speed against accuracy: " + scene;
  f.columns = 3;
  f.width_mm = 215;
  f.height_mm = 95;
  f.caption = std::string("Largest error of a node's position against CPU time ") +
              (once ? "(of one run each) "
                    : "(median of repeated runs; a thin line from the fastest to the slowest) ") +
              "and against the number of linear solves. " + span_sentence(study);
  Panel time = log_panel("CPU time (s)", "position error (m)");
  Panel solves = log_panel("linear solves", "position error (m)");
  for (std::size_t i = 0; i < study.curves.size(); ++i) {
    time.curves.push_back(curve_of(study, i, &MeasuredRun::cpu_median, &MeasuredRun::position_error));
    add_spread(study, study.curves[i], time.curves.back().color, time);
    solves.curves.push_back(curve_of(study, i, &MeasuredRun::linear_solves, &MeasuredRun::position_error));
  }
  add_floor(study, time);
  f.panels = {std::move(time), std::move(solves), key_panel(study)};
  f.caption += drawn_sentences(f);
  return f;
}

Figure convergence_figure(const Study& study, const std::string& scene) {
  Figure f;
  f.name = "convergence";
  f.title = "Errors against the step: " + scene;
  f.rows = f.columns = 2;
  f.width_mm = 180;
  f.height_mm = 160;
  f.caption =
      "Position error against the reference, and what a run shows without one: the error of the "
      "constraints relative to rod length, and of the energy balance. " +
      span_sentence(study);
  Panel position = log_panel("step (s)", "position error (m)");
  Panel constraint = log_panel("step (s)", "constraint error (relative)");
  Panel energy = log_panel("step (s)", "energy error (J)");
  for (std::size_t i = 0; i < study.curves.size(); ++i) {
    position.curves.push_back(curve_of(study, i, &MeasuredRun::step, &MeasuredRun::position_error));
    constraint.curves.push_back(
        curve_of(study, i, &MeasuredRun::step, &MeasuredRun::constraint_relative_max));
    energy.curves.push_back(curve_of(study, i, &MeasuredRun::step, &MeasuredRun::energy_error));
  }
  add_floor(study, position);
  constraint.lines.push_back({std::numeric_limits<double>::epsilon(), true, "round-off", 7});
  f.panels = {std::move(position), std::move(constraint), std::move(energy), key_panel(study)};
  f.caption += drawn_sentences(f);
  return f;
}

}  // namespace unfurl
