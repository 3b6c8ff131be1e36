// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/stress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/simulate/one_sided.hpp"
#include "core/study/parallel_for.hpp"
#include "core/study/reference_motion.hpp"
#include "core/study/row_columns.hpp"
#include "core/study/team.hpp"

namespace unfurl {
namespace {

// A scene at one value of an extreme, with its reference.
struct Site {
  const Extreme* extreme = nullptr;
  double value = 0;
  std::shared_ptr<const Model> model = nullptr;
  std::optional<Reference> reference = std::nullopt;
  std::string trouble = {};  // why there is none
};

constexpr double probing_seconds = 3.0;

// When the structure is deployed, looked for up to `end`; NaN where it is not, or not by a run to be trusted.
double deployment_by(const Site& site, SolverOptions options, double end, const StudyHooks& hooks) {
  options.end_time = end;
  options.step = end / 4000;
  const double begin = thread_cpu_seconds();
  SimulationHooks bounded;
  bounded.cancelled = [&] { return hooks.stopped() || thread_cpu_seconds() - begin > probing_seconds; };
  const Simulation run = simulate(site.model, options, bounded);
  if (hooks.stopped()) throw Cancelled();
  return mistrust(run, diagnose_books(run)).empty() ? deployment_time(run) : nan;
}

// How long the motion is, and whether it ends right before the deployed pose.
struct Duration {
  double end = 0;  // [s]
  bool deploys = false;
};

// To 99 % of the deployment where there is one, however late (a motion that is driven: within the scene's
// time); else to the scene's end, which moves with the square root of the forces. Two methods of different
// principle must agree on a deployment: one alone may find it in the noise of its start. Throws
// ReferenceError.
Duration duration(const Site& site, SolverOptions options, const StudyHooks& hooks) {
  double end = options.end_time;
  if (site.extreme->name == "force") end /= std::sqrt(site.value);
  if (site.model->structure.deployment.empty()) return {end};
  options.nodes = "lobatto";
  options.constraints_at = "nodes";
  const bool driven = !site.model->system.drives().empty();
  for (const double factor : {driven ? 1.0 : 2.0, 20.0, 400.0, 8000.0, 160000.0}) {
    std::vector<double> by_dvm, by_rk4;
    for (const auto& [method, stages] : {std::pair{"dvm", 4}, {"rk4_projected", 3}, {"dvm", 3}, {"rk4", 3}}) {
      options.method = method;
      options.stages = stages;
      const double t = deployment_by(site, options, factor * end, hooks);
      if (std::isnan(t)) continue;
      const bool dvm = options.method == "dvm";
      for (const double other : dvm ? by_rk4 : by_dvm)
        if (std::abs(t - other) <= 1e-3 * t) return {0.99 * std::min(t, other), true};
      (dvm ? by_dvm : by_rk4).push_back(t);
    }
    const auto when = [](const std::vector<double>& times) {
      return times.empty() ? "never" : "at " + short_number(times[0]) + " s";
    };
    if (!by_dvm.empty() || !by_rk4.empty())
      throw ReferenceError("no two methods agree on when it deploys: dvm " + when(by_dvm) +
                           ", rk4 and its kin " + when(by_rk4));
    if (driven) return {end};
  }
  throw ReferenceError("it does not deploy");
}

// The part of the motion before anything one-sided acts, of which the reference knows nothing. Throws
// ReferenceError.
double plain_part(const Site& site, SolverOptions options, double end, const StudyHooks& hooks) {
  options.end_time = end;
  options.step = end / 4000;
  if (OneSided(site.model->structure, options).empty()) return end;
  const double begin = thread_cpu_seconds();
  SimulationHooks bounded;
  bounded.cancelled = [&] { return hooks.stopped() || thread_cpu_seconds() - begin > probing_seconds; };
  const Simulation run = simulate(site.model, options, bounded);
  if (hooks.stopped()) throw Cancelled();
  require_plain_start(run);
  const double plain = judged_span(run).end;
  if (plain < end || run.status == RunStatus::completed) return plain;
  throw ReferenceError("no run tells when stops, cables, friction or motors act in it");
}

// The share of the deployment that the reference must show: a motion that has not begun tells nothing.
constexpr double deployed_share = 0.5;

void prepare(Site& site, int intervals, const StudyHooks& hooks) {
  try {
    SolverOptions options;
    site.model = site.extreme->build(site.value, options);
    Duration motion = duration(site, options, hooks);
    if (const double plain = plain_part(site, options, motion.end, hooks); plain < motion.end)
      motion = {plain};
    Reference reference = solve_reference(site.model, motion.end, intervals, hooks, 1e-6);
    const Deployment& deployment = site.model->structure.deployment;
    if (motion.deploys && !(deployment.fraction(reference.q.back()) >= deployed_share))
      throw ReferenceError("the reference has not deployed at " + short_number(motion.end) + " s");
    site.reference = std::move(reference);
  } catch (const ReferenceError& error) {
    site.trouble = error.what();
  } catch (const SceneError& error) {
    site.trouble = error.what();
  }
}

Verdict judge(const MeasuredRun& run, double size, const StressLimits& limits) {
  if (run.outcome == "solver failed") return Verdict::solver_failed;
  if (run.outcome == "too slow") return Verdict::too_slow;
  if (!(run.constraint_relative_max <= limits.constraint)) return Verdict::constraint_lost;
  if (!(run.energy_error <= limits.energy * run.energy_turned_over + run.energy_round_off))
    return Verdict::energy_growth;
  if (!(run.position_error <= limits.branch * size)) return Verdict::wrong_branch;
  return run.position_error <= limits.right * size ? Verdict::right : Verdict::inaccurate;
}

template <auto member>
constexpr RowColumn<StressCell> run_number(const char* name) {
  return number_column < StressCell, [](auto& cell) -> auto& {
    return cell.run;
  }
  , member > (name);
}

template <auto member>
constexpr RowColumn<StressCell> cell_number(const char* name) {
  return number_column < StressCell, [](auto& cell) -> auto& {
    return cell;
  }
  , member > (name);
}

template <std::string StressCell::*member>
constexpr RowColumn<StressCell> cell_word(const char* name) {
  return {name, [](const StressCell& c) { return c.*member; },
          [](StressCell& c, const std::string& cell) { c.*member = cell; }, false};
}

void read_verdict(StressCell& c, const std::string& cell) {
  for (const Verdict v : verdicts())
    if (to_string(v) == cell) c.verdict = v;
}

constexpr std::array stress_rows{
    cell_word<&StressCell::extreme>("extreme"),
    cell_number<&StressCell::value>("value"),
    cell_word<&StressCell::setting>("setting"),
    cell_number<&StressCell::steps>("steps"),
    RowColumn<StressCell>{"verdict", [](const StressCell& c) { return std::string(to_string(c.verdict)); },
                          read_verdict, false},
    run_number<&MeasuredRun::step>("step_s"),
    run_number<&MeasuredRun::position_error>("position_error_m"),
    run_number<&MeasuredRun::constraint_relative_max>("constraint_relative_max"),
    run_number<&MeasuredRun::energy_error>("energy_error_max_J"),
    run_number<&MeasuredRun::kinetic_energy_max>("kinetic_energy_max_J"),
    run_number<&MeasuredRun::cpu_median>("cpu_s"),
    RowColumn<StressCell>{"message", [](const StressCell& c) { return c.run.message; },
                          [](StressCell& c, const std::string& cell) { c.run.message = cell; }, false},
};
constexpr std::span<const RowColumn<StressCell>> cell_columns(stress_rows);

StressCell cell_of(const std::vector<std::string>& row) {
  StressCell cell;
  read_cells(cell_columns, row, cell);
  return cell;
}

std::vector<std::string> key_of(const Site& site, const Setting& setting, long steps) {
  return {site.extreme->name, exact_number(site.value), setting.name, std::to_string(steps)};
}

// All cells of a site that the journal lacks; false where another worker of the team is at them.
bool fill(const StressPlan& plan, Site& site, Journal& journal, std::mutex& mutex, const StudyHooks& hooks) {
  const TimingOptions once{.repeats = 1, .patience = 0, .limit = plan.limits.seconds};
  const auto known = [&](const std::vector<std::string>& key) {
    const std::lock_guard lock(mutex);
    return journal.find(key) != nullptr;
  };
  const std::string piece = site.extreme->name + "-" + exact_number(site.value);
  for (const Setting& setting : plan.settings)
    for (const long steps : plan.steps) {
      const auto key = key_of(site, setting, steps);
      if (known(key)) continue;
      const auto look_again = [&] {
        const std::lock_guard lock(mutex);
        journal.take_in(hooks.team->journals_of_others());
      };
      if (hooks.team && hooks.team->finished(piece)) return true;
      if (hooks.team && !hooks.team->takes(piece, look_again)) return false;
      if (known(key)) continue;
      if (!site.model) prepare(site, static_cast<int>(plan.steps.front()), hooks);
      if (!site.reference) {
        if (hooks.team) hooks.team->finish(piece);  // no row tells the others so
        return true;
      }
      if (hooks.stopped()) throw Cancelled();
      StressCell cell{key[0], site.value, setting.name, steps, {}, {}};
      cell.run = measure_run(site.model, setting.options, steps, *site.reference, once, hooks);
      cell.verdict = judge(cell.run, site.reference->size, plan.limits);
      const std::lock_guard lock(mutex);
      journal.append(cells_of(cell_columns, cell));
    }
  return true;
}

}  // namespace

std::vector<std::string> stress_columns() {
  return column_names(cell_columns);
}

std::vector<std::size_t> stress_number_columns() {
  return number_columns(cell_columns);
}

bool is_stress_cell(const std::vector<std::string>& row) {
  const std::vector<std::string> names = stress_columns();
  const auto verdict = static_cast<std::size_t>(std::ranges::find(names, "verdict") - names.begin());
  if (std::ranges::none_of(verdicts(), [&](Verdict v) { return to_string(v) == row[verdict]; })) return false;
  const StressCell cell = cell_of(row);
  for (const double time : {cell.run.step, cell.run.cpu_median})
    if (!(std::isfinite(time) && time >= 0)) return false;
  for (const double error : {cell.run.position_error, cell.run.constraint_relative_max, cell.run.energy_error,
                             cell.run.kinetic_energy_max})
    if (error < 0 || (cell.verdict == Verdict::right && !std::isfinite(error))) return false;
  return true;
}

Stress run_stress(const StressPlan& plan, Journal& journal, const StudyHooks& hooks) {
  std::vector<Site> sites;
  for (const Extreme& extreme : plan.extremes)
    for (const double value : extreme.values) sites.push_back({&extreme, value});
  Stress stress;
  std::mutex mutex;
  std::size_t done = 0;
  try {
    parallel_for(sites.size(), hooks.threads, [&](std::size_t i) {
      const bool filled = fill(plan, sites[i], journal, mutex, hooks);
      const std::lock_guard lock(mutex);
      stress.complete = stress.complete && filled;
      hooks.tell(static_cast<double>(++done) / static_cast<double>(sites.size() + 2));
    });
    if (!hooks.team) stress.long_runs = long_runs(plan, hooks);
  } catch (const Cancelled&) {
    stress.complete = false;
  }
  for (const Site& site : sites) {
    if (!site.trouble.empty())
      stress.notes.push_back(site.extreme->name + " = " + short_number(site.value) + ": " + site.trouble);
    for (const Setting& setting : plan.settings)
      for (const long steps : plan.steps)
        if (const auto* row = journal.find(key_of(site, setting, steps)))
          stress.cells.push_back(cell_of(*row));
  }
  return stress;
}

Table cells_table(const Stress& stress) {
  Table table{stress_columns(), {}};
  for (const StressCell& cell : stress.cells) table.rows.push_back(cells_of(cell_columns, cell));
  return table;
}

Table summary_table(const StressPlan& plan, const Stress& stress) {
  Table table{{"setting", "cells"}, {}};
  for (const Verdict v : verdicts()) table.columns.emplace_back(to_string(v));
  for (const Setting& setting : plan.settings) {
    std::vector<long> count(verdicts().size());
    long all = 0;
    for (const StressCell& cell : stress.cells)
      if (cell.setting == setting.name) {
        ++all;
        const auto at = std::find(verdicts().begin(), verdicts().end(), cell.verdict) - verdicts().begin();
        ++count[static_cast<std::size_t>(at)];
      }
    std::vector<std::string> row{setting.name, std::to_string(all)};
    for (const long n : count) row.push_back(std::to_string(n));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace unfurl
