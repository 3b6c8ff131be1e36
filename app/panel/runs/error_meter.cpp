// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/error_meter.hpp"

#include <algorithm>
#include <utility>

#include "core/study/tolerance.hpp"

namespace unfurl {

namespace {

// A person waits, and the machine has other things to do: not much more CPU time for a reference than so many
// times the run's own, within limits [s].
constexpr double effort_of_run = 40, least_effort = 4, most_effort = 20;
// CPU time of a run that is timed once more, and more than once [s].
constexpr double longest_timed = 5, longest_repeated = 0.1;
constexpr std::size_t most_known = 32, most_waiting = 64;
constexpr double most_known_bytes = 128e6, most_waiting_bytes = 128e6;

double memory_of(const LiveRun& run) {
  const auto states = static_cast<double>(run.simulation.trajectory.size());
  const Structure& structure = run.simulation.trajectory.structure();
  const auto numbers = static_cast<double>(6 * structure.nodes.size() + 2 * structure.rods.size());
  return states * (8 * numbers + 512);
}

// CPU time of a run up to where errors are judged, as in studies: locating the deployed pose behind that may
// cost several times as much. A first run finds cold memory and is short enough for any other work of the
// machine to disturb it: the median of three tells more. 0: it was not to be had.
double timed(const LiveRun& run, double end, const std::function<bool()>& cancelled) {
  SolverOptions options = run.simulation.options;
  options.end_time = std::min(end, options.end_time);
  options.tolerance = 0;  // its choice is made
  options.model = solved_as(run.simulation).name;
  SimulationHooks hooks;
  hooks.cancelled = cancelled;
  const std::shared_ptr<const Model> model(std::shared_ptr<void>(), &run.simulation.trajectory.model());
  std::vector<double> times;
  if (run.simulation.cpu_s > longest_timed) return 0;
  do {
    const Simulation again = simulate_as_asked(model, options, hooks);
    if (again.status == RunStatus::stopped) break;
    times.push_back(again.cpu_s);
  } while (times.size() < 3 && times.front() < longest_repeated);
  std::sort(times.begin(), times.end());
  return times.empty() ? 0 : times[times.size() / 2];
}

}  // namespace

ErrorMeter::ErrorMeter(std::function<void()> wake)
    : worker_([this](const Runs& runs, const Meter::Task& task) { return errors_of(runs, task); },
              std::move(wake)) {}

void ErrorMeter::measure(std::shared_ptr<const LiveRun> run) {
  const bool same = same_motion(wanted_, run->motion);
  wanted_ = run->motion;
  waiting_.push_back(std::move(run));
  double bytes = 0;
  std::size_t keep = 0;  // of the latest
  for (auto it = waiting_.rbegin(); it != waiting_.rend() && keep < most_waiting; ++it, ++keep)
    if (bytes += memory_of(**it); bytes > most_waiting_bytes && keep > 0) break;
  waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(keep));
  if (!same || !worker_.busy()) begin();
}

bool ErrorMeter::has_work() const {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [&](const auto& run) { return same_motion(run->motion, wanted_); });
}

void ErrorMeter::begin() {
  Runs runs;
  std::copy_if(waiting_.begin(), waiting_.end(), std::back_inserter(runs),
               [&](const auto& run) { return same_motion(run->motion, wanted_); });
  if (!runs.empty()) worker_.submit(std::move(runs));
}

std::vector<RunError> ErrorMeter::take() {
  std::vector<RunError> errors = worker_.take().value_or(std::vector<RunError>());
  for (const RunError& error : errors)
    std::erase_if(waiting_, [&](const auto& run) { return run->id == error.run; });
  if (!errors.empty()) begin();
  return errors;
}

std::optional<ErrorMeter::Known> ErrorMeter::find(const MotionKey& motion) {
  const std::lock_guard lock(mutex_);
  const auto it = std::find_if(known_.begin(), known_.end(),
                               [&](const Known& known) { return same_motion(known.motion, motion); });
  if (it == known_.end()) return std::nullopt;
  known_.splice(known_.begin(), known_, it);
  return known_.front();
}

void ErrorMeter::remember(Known known) {
  const std::lock_guard lock(mutex_);
  known_.push_front(std::move(known));
  double bytes = 0;
  std::size_t keep = 0;
  for (const Known& each : known_) {
    if (each.reference) bytes += static_cast<double>(each.reference->bytes());
    if (keep > 0 && (bytes > most_known_bytes || keep == most_known)) break;
    ++keep;
  }
  known_.resize(keep);
}

ErrorMeter::Known ErrorMeter::solve(const std::shared_ptr<const LiveRun>& run, const Meter::Task& task) {
  Known known{run->motion, nullptr, {}};
  ++begun_;
  try {
    StudyHooks hooks;
    hooks.cancelled = [&task] { return task.stopped(); };
    const double effort = std::clamp(effort_of_run * run->simulation.cpu_s, least_effort, most_effort);
    const std::shared_ptr<const Model> model(run, &run->simulation.trajectory.model());
    known.reference = std::make_shared<const ReferenceMotion>(
        solve_reference_motion(model, run->simulation, effort, hooks));
    ++solved_;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::bad_alloc&) {
    known.why = "out of memory";
  } catch (const std::exception& error) {
    known.why = error.what();
  }
  return known;
}

std::vector<RunError> ErrorMeter::errors_of(const Runs& runs, const Meter::Task& task) {
  std::vector<RunError> errors;
  if (task.stopped()) return errors;
  std::optional<Known> known = find(runs.front()->motion);
  try {
    // The latest run may have the steps that fit its motion best: the user looks at it.
    if (!known) remember(*(known = solve(runs.back(), task)));
  } catch (const Cancelled&) {
    return errors;
  }
  for (const auto& run : runs) {
    RunError out{.run = run->id, .why = known->why};
    if (known->reference) {
      out.end = known->reference->end();
      out.cpu_s = timed(*run, out.end, [&task] { return task.stopped(); });
      out.error = position_error(run->simulation, *known->reference);
      out.uncertainty = known->reference->uncertainty();
    }
    errors.push_back(std::move(out));
  }
  return errors;
}

}  // namespace unfurl
