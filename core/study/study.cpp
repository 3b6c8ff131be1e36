// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/study/row_columns.hpp"
#include "core/study/team.hpp"

namespace unfurl {
namespace {

// A run's row and back, so that a journal and a fresh run say the same.
struct Point {
  const Setting& setting;
  MeasuredRun run = {};
};

template <auto member>
constexpr RowColumn<Point> number(const char* name) {
  return number_column < Point, [](auto& point) -> auto& {
    return point.run;
  }
  , member > (name);
}

// Of the setting, which is known by its name.
constexpr RowColumn<Point> known(const char* name, std::string (*get)(const Point&), bool number = false) {
  return {name, get, [](Point&, const std::string&) {}, number};
}

constexpr std::array study_rows{
    known("setting", [](const Point& p) { return p.setting.name; }),
    number<&MeasuredRun::steps>("steps"),
    known("method", [](const Point& p) { return p.setting.options.method; }),
    known(
        "stages", [](const Point& p) { return std::to_string(p.setting.options.stages); }, true),
    known("nodes", [](const Point& p) { return p.setting.options.nodes; }),
    known("constraints_at", [](const Point& p) { return p.setting.options.constraints_at; }),
    RowColumn<Point>{"outcome", [](const Point& p) { return p.run.outcome; },
                     [](Point& p, const std::string& cell) { p.run.outcome = cell; }, false},
    number<&MeasuredRun::step>("step_s"),
    number<&MeasuredRun::position_error>("position_error_m"),
    number<&MeasuredRun::constraint_max>("constraint_max_m"),
    number<&MeasuredRun::constraint_relative_max>("constraint_relative_max"),
    number<&MeasuredRun::constraint_velocity_max>("constraint_velocity_max_m_s"),
    number<&MeasuredRun::energy_error>("energy_error_max_J"),
    number<&MeasuredRun::newton_iterations>("newton_iterations"),
    number<&MeasuredRun::factorisations>("factorisations"),
    number<&MeasuredRun::linear_solves>("linear_solves"),
    number<&MeasuredRun::cpu_median>("cpu_median_s"),
    number<&MeasuredRun::cpu_min>("cpu_min_s"),
    number<&MeasuredRun::cpu_max>("cpu_max_s"),
    number<&MeasuredRun::repeats>("repeats"),
};
constexpr std::span<const RowColumn<Point>> point_columns(study_rows);

std::vector<std::string> row_of(const Setting& setting, const MeasuredRun& run) {
  return cells_of(point_columns, Point{setting, run});
}

MeasuredRun run_of(const Setting& setting, const std::vector<std::string>& row) {
  Point point{setting};
  read_cells(point_columns, row, point);
  return point.run;
}

bool gains(const MeasuredRun& now, const MeasuredRun& before) {
  return !now.ok() || !before.ok() || now.position_error < 0.8 * before.position_error;
}

// Errors below this are not the methods' own: the reference's, those of rounded coordinates, and the largest
// that any method is left with where smaller steps gain nothing.
double floor_of(const Study& study) {
  double floor = std::max(10 * study.reference_uncertainty, 1e-14 * study.size);
  for (const StudyCurve& curve : study.curves)
    for (std::size_t i = 1; i < curve.runs.size(); ++i) {
      const MeasuredRun& run = curve.runs[i];
      if (!gains(run, curve.runs[i - 1]) && run.position_error < 1e-9 * study.size)
        floor = std::max(floor, 2 * run.position_error);
    }
  return floor;
}

// Where error ~ step^p: answers that are right to a hundredth of the structure and above the floor; the five
// smallest such steps.
ObservedOrder order_of(const StudyCurve& curve, double floor, double size) {
  std::vector<double> step, error;
  for (const MeasuredRun& r : curve.runs) {
    if (!r.ok() || r.position_error > 1e-2 * size) continue;
    if (r.position_error < floor) break;
    step.push_back(r.step);
    error.push_back(r.position_error);
  }
  const auto skip = static_cast<std::ptrdiff_t>(step.size() > 5 ? step.size() - 5 : 0);
  return fit_order({step.begin() + skip, step.end()}, {error.begin() + skip, error.end()});
}

// Two steps in a row that gain nothing: smaller ones would only cost more.
bool exhausted(const std::vector<MeasuredRun>& runs, double size) {
  const std::size_t n = runs.size();
  return n >= 3 && !gains(runs[n - 1], runs[n - 2]) && !gains(runs[n - 2], runs[n - 3]) &&
         runs[n - 1].position_error < 1e-9 * size;
}

}  // namespace

std::vector<std::string> study_columns() {
  return column_names(point_columns);
}

std::vector<std::size_t> study_number_columns() {
  return number_columns(point_columns);
}

bool is_study_point(const std::vector<std::string>& row) {
  const Setting any;
  return is_possible(run_of(any, row));
}

bool asks_for(const StudyPlan& plan, const std::vector<std::string>& row) {
  const auto has = [](const auto& all, const std::string& cell, const auto& text) {
    return std::ranges::any_of(all, [&](const auto& one) { return text(one) == cell; });
  };
  return has(plan.settings, row[0], [](const Setting& setting) { return setting.name; }) &&
         has(plan.ladder.steps, row[1], [](long steps) { return std::to_string(steps); });
}

Study run_study(const StudyPlan& plan, Journal& journal, const StudyHooks& hooks) {
  Study study;
  study.end = plan.end;
  study.before = plan.before;
  study.size = structure_size(*plan.model);
  for (const Setting& setting : plan.settings) study.curves.push_back({setting, {}, {}});
  try {
    std::optional<Reference> reference;
    const auto solve = [&] {
      if (!reference)
        reference = solve_reference(plan.model, plan.end, static_cast<int>(plan.ladder.grid), hooks);
      study.reference = reference->how;
      study.reference_uncertainty = reference->uncertainty;
      study.reference_confirmed = reference->confirmed;
      study.size = reference->size;
    };
    // A worker of a team may find all its work done.
    if (!hooks.team || !(study.size > 0)) solve();
    double done = 0;
    double all = 0;
    for (const long steps : plan.ladder.steps)
      all += static_cast<double>(steps * static_cast<long>(plan.settings.size()));
    for (StudyCurve& curve : study.curves) {
      for (const long steps : plan.ladder.steps) {
        hooks.tell(done / all);
        done += static_cast<double>(steps);
        if (exhausted(curve.runs, study.size)) continue;
        const auto known = [&] {
          const auto* row = journal.find({curve.setting.name, std::to_string(steps)});
          if (row) curve.runs.push_back(run_of(curve.setting, *row));
          return row != nullptr;
        };
        if (known()) continue;
        if (hooks.stopped()) throw Cancelled();
        const auto look_again = [&] { journal.take_in(hooks.team->journals_of_others()); };
        if (hooks.team && !hooks.team->takes(curve.setting.name, look_again)) {
          study.complete = false;  // another's; the rest of its ladder too
          break;
        }
        if (known()) continue;
        solve();
        curve.runs.push_back(
            measure_run(plan.model, curve.setting.options, steps, *reference, plan.timing, hooks));
        journal.append(row_of(curve.setting, curve.runs.back()));
      }
    }
    hooks.tell(1);
  } catch (const Cancelled&) {
    study.complete = false;
  }
  const double floor = floor_of(study);
  for (StudyCurve& curve : study.curves) curve.order = order_of(curve, floor, study.size);
  return study;
}

std::string reference_words(const Study& study) {
  const std::string size = short_number(study.reference_uncertainty, 2) + " m";
  return study.reference_confirmed ? "dvm and extrapolation agree to " + size
                                   : "it agrees with itself to " + size;
}

Table points_table(const Study& study) {
  Table table{study_columns(), {}};
  for (const StudyCurve& curve : study.curves)
    for (const MeasuredRun& run : curve.runs) table.rows.push_back(row_of(curve.setting, run));
  return table;
}

Table orders_table(const Study& study) {
  Table table{{"setting", "claimed order", "observed order", "95 % interval", "from points", "best error (m)",
               "its step (s)", "its CPU (s)", "constraint error (m)", "energy error (J)"},
              {}};
  for (const StudyCurve& curve : study.curves) {
    const MeasuredRun* best = nullptr;
    for (const MeasuredRun& r : curve.runs)
      if (r.ok() && (!best || r.position_error < best->position_error)) best = &r;
    const ObservedOrder& o = curve.order;
    std::vector<std::string> row{curve.setting.name, std::to_string(curve.setting.claimed_order)};
    if (std::isfinite(o.order))
      row.insert(row.end(), {short_number(o.order), short_number(o.low) + " to " + short_number(o.high)});
    else
      row.insert(row.end(), {"too few points", ""});
    row.push_back(std::to_string(o.points));
    if (best) {
      const bool below = best->position_error < study.reference_uncertainty;  // by how much is not known
      row.push_back(below ? "below " + short_number(study.reference_uncertainty)
                          : short_number(best->position_error));
      for (const double x : {best->step, best->cpu_median, best->constraint_max, best->energy_error})
        row.push_back(short_number(x));
    }
    row.resize(table.columns.size());
    table.rows.push_back(std::move(row));
  }
  return table;
}

Cheapest cheapest(const Study& study, double error) {
  Cheapest best;
  for (const StudyCurve& curve : study.curves)
    for (const MeasuredRun& run : curve.runs)
      if (run.ok() && run.position_error <= error && (!best.run || run.cpu_median < best.run->cpu_median))
        best = {&curve, &run};
  return best;
}

std::string cheapest_sentence(const Study& study) {
  std::string found, missed;
  // Of a structure of some metres; a share of what is far from that.
  const bool usual = study.size > 0.03 && study.size < 300;
  const double unit = usual || !(study.size > 0) ? 1.0 : std::pow(10.0, std::round(std::log10(study.size)));
  for (const double share : {1e-3, 1e-6, 1e-9}) {
    const double error = share * unit;
    const Cheapest best = cheapest(study, error);
    if (best.run)
      found += (found.empty() ? "The cheapest setting for " : ", for ") + short_number(error, 1) + " m" +
               (found.empty() ? " is " : " ") + best.curve->setting.name + " with a step of " +
               short_number(best.run->step) + " s (" + short_number(1e3 * best.run->cpu_median) + " ms)";
    else
      missed += (missed.empty() ? "" : ", ") + short_number(error, 1) + " m";
  }
  if (missed.empty()) return found + ".";
  return (found.empty() ? "No" : found + "; no") + " setting was found that keeps " + missed + ".";
}

}  // namespace unfurl
