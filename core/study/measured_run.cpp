// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/measured_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/math/largest.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// One run that is given up after `limit` seconds of CPU time: how busy the machine is shall not matter.
Simulation run_once(const std::shared_ptr<const Model>& model, const SolverOptions& options, double limit,
                    const StudyHooks& hooks, bool& too_slow) {
  const double begin = thread_cpu_seconds();
  too_slow = false;
  SimulationHooks own;
  own.cancelled = [&] {
    too_slow = thread_cpu_seconds() - begin > limit;
    return too_slow || hooks.stopped();
  };
  Simulation run = simulate(model, options, own);
  if (run.status == RunStatus::stopped && !too_slow) throw Cancelled();
  return run;
}

void count_work(const Simulation& run, MeasuredRun& out) {
  out.newton_iterations = run.newton_iterations;
  out.factorisations = run.factorisations;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    out.linear_solves += run.trajectory.report(i).right_hand_sides;
}

std::string outcome_of(const Simulation& run, bool too_slow, double error) {
  if (too_slow) return "too slow";
  if (run.status == RunStatus::failed) return "solver failed";
  if (!std::isfinite(error)) return "other motion";  // it reached the deployed pose before the reference
  return "ok";
}

constexpr std::array outcomes{"ok", "too slow", "solver failed", "other motion", "not trusted"};

}  // namespace

bool is_possible(const MeasuredRun& run) {
  if (std::ranges::find(outcomes, run.outcome) == outcomes.end()) return false;
  for (const long count : {run.newton_iterations, run.factorisations, run.linear_solves})
    if (count < 0) return false;
  for (const double time : {run.step, run.cpu_min, run.cpu_median, run.cpu_max})
    if (!(std::isfinite(time) && time >= 0)) return false;
  for (const double error : {run.position_error, run.constraint_max, run.constraint_relative_max,
                             run.constraint_velocity_max, run.energy_error})
    if (error < 0 || (run.ok() && !std::isfinite(error))) return false;
  return run.steps >= 1 && run.repeats >= 1 && run.cpu_min <= run.cpu_median && run.cpu_median <= run.cpu_max;
}

void measure_invariants(const Simulation& run, MeasuredRun& out) {
  const Diagnostics books = diagnose_books(run);
  const auto most = [&](std::string_view column) { return largest_magnitude(books.at(column).values); };
  out.constraint_max = most("constraint_max_m");
  out.constraint_relative_max = most("constraint_relative_max");
  out.constraint_velocity_max = most("constraint_velocity_max_m_s");
  out.energy_error = most("energy_balance_J");
  out.kinetic_energy_max = most("kinetic_energy_J");
  out.energy_turned_over = energy_turned_over(books);
  out.energy_round_off = energy_round_off(run).back();
  if (const std::string why = mistrust(run, books); out.ok() && !why.empty()) {
    out.outcome = "not trusted";
    out.message = why;
  }
}

double position_error(const Trajectory& trajectory, const Reference& reference) {
  const Index in_space = space_coordinates(trajectory.structure());
  double largest = 0;
  std::size_t i = 0;
  const double near = 1e-9 * reference.t.back();
  for (std::size_t k = 0; k < reference.t.size(); ++k) {
    while (i < trajectory.size() && trajectory.time(i) < reference.t[k] - near) ++i;
    if (i == trajectory.size() || trajectory.time(i) > reference.t[k] + near) return nan;
    largest = larger(
        largest, node_distance(trajectory.node_positions(i).head(in_space), reference.q[k].head(in_space)));
  }
  return largest;
}

MeasuredRun measure_run(const std::shared_ptr<const Model>& model, SolverOptions options, long steps,
                        const Reference& reference, const TimingOptions& timing, const StudyHooks& hooks) {
  options.end_time = reference.t.back();
  options.step = options.end_time / static_cast<double>(steps);
  MeasuredRun out;
  out.steps = steps;
  out.step = options.step;
  std::vector<double> times;
  double spent = 0;
  while (static_cast<int>(times.size()) < timing.repeats) {
    bool too_slow = false;
    const Simulation run = run_once(model, options, timing.limit, hooks, too_slow);
    if (times.empty()) {
      out.position_error = position_error(run.trajectory, reference);
      out.outcome = outcome_of(run, too_slow, out.position_error);
      out.message = run.message;
      measure_invariants(run, out);
      count_work(run, out);
    }
    times.push_back(run.cpu_s);
    spent += run.cpu_s;
    const double enough = times.size() < 3 ? 3 * timing.patience : timing.patience;
    if (!out.ok() || spent > enough) break;
  }
  std::sort(times.begin(), times.end());
  out.cpu_min = times.front();
  out.cpu_max = times.back();
  out.cpu_median = times[times.size() / 2];
  out.repeats = static_cast<int>(times.size());
  return out;
}

double deployment_time(const Simulation& run) {
  for (const Event& event : run.events)
    if (event.name == "deployed") return event.t;
  return nan;
}

}  // namespace unfurl
