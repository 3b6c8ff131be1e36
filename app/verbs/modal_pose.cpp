// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/modal_pose.hpp"

#include <algorithm>

#include "app/output/interrupt.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/solve_for.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

// Stops and friction may hold at the start: which of them do is what a run finds there.
bool may_be_held(const Structure& structure) {
  return !structure.stops.empty() ||
         std::ranges::any_of(structure.forces, [](const Force& force) { return force.kind == "friction"; });
}

ModalPose at_start(const Scene& scene, const Arguments& arguments) {
  warn_of_idle_sets(arguments, {"solver.model", "solver.tolerance"}, "the pose at the start is no motion's");
  auto model = model_of(scene, arguments);
  if (may_be_held(model->structure)) {
    SolverOptions first = scene.solver;
    first.end_time = std::min(first.end_time, first.step);
    const auto run = std::make_shared<const Simulation>(simulate(model, first));
    const std::size_t i = run->trajectory.state_before(run->trajectory.start_time());
    return {{run, &run->trajectory.model(i)}, {run, &run->trajectory.model()}, run->trajectory.state(i)};
  }
  State state = initial_state(model->structure, model->system).state;
  return {model, model, std::move(state)};
}

double time_of_pose(const std::string& at, const Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  if (at == "end") return trajectory.end_time();
  if (at == "deployed") {
    for (const Event& event : run.events)
      if (event.name == "deployed") return event.t;
    if (run.status == RunStatus::failed)
      throw NotFound("--at deployed: the run fails before the deployed pose");
    throw UsageError("--at deployed: the run does not reach the deployed pose");
  }
  double t = number_of(at);
  // The end as it is told, in six digits.
  if (t > trajectory.end_time() && short_number(t, 6) == short_number(trajectory.end_time(), 6))
    t = trajectory.end_time();
  if (run.status == RunStatus::failed && t > trajectory.end_time())
    throw NotFound("--at " + at + ": the run is good up to " + short_number(trajectory.end_time(), 6) +
                   " s only");
  if (!(t >= trajectory.start_time() && t <= trajectory.end_time()))
    throw UsageError("--at takes start, end, deployed or a time from " +
                     short_number(trajectory.start_time(), 6) + " to " +
                     short_number(trajectory.end_time(), 6) + " s; got " + in_quotes(at));
  return t;
}

ModalPose in_motion(const Scene& scene, const Arguments& arguments) {
  const auto run = std::make_shared<Simulation>(simulate_scene(scene, model_of(scene, arguments), arguments));
  throw_if_interrupted();
  const Diagnostics diagnostics = judge_run(*run);
  throw_if_interrupted();
  warn_of_run(*run, diagnostics);
  const Trajectory& trajectory = run->trajectory;
  const double t = time_of_pose(arguments.at, *run);
  const std::size_t i = trajectory.state_before(t);
  return {{run, &trajectory.model(i)},
          {run, &trajectory.model()},
          trajectory.time(i) == t ? trajectory.state(i) : trajectory.state_at(t),
          exit_code_of(*run, diagnostics)};
}

}  // namespace

ModalPose modal_pose(const Scene& scene, const Arguments& arguments) {
  const bool start = arguments.at.empty() || arguments.at == "start";
  return start ? at_start(scene, arguments) : in_motion(scene, arguments);
}

Vibration vibration_of(const ModalPose& pose) {
  const Index solved = pose.model->system.solved_coordinates();
  if (solved > max_vibration_coordinates)
    throw UsageError("modes are for " + std::to_string(max_vibration_coordinates) +
                     " solved coordinates at most; the structure has " + std::to_string(solved));
  return vibration(*pose.model, pose.state);
}

std::string name_of(const VibrationMode& mode) {
  if (mode.growth > 0) return mode.frequency > 0 ? "flutter" : "unstable";
  if (!mode.mechanism) return "elastic";
  return mode.frequency > 0 ? "mechanism, pulled back" : "mechanism, free";
}

Table modes_table(const Vibration& vibration) {
  Table table{{"mode", "frequency_Hz", "growth_rate_1_s", "mechanism"}, {}};
  for (std::size_t k = 0; k < vibration.modes.size(); ++k) {
    const VibrationMode& mode = vibration.modes[k];
    table.rows.push_back({std::to_string(k + 1), exact_number(mode.frequency), exact_number(mode.growth),
                          mode.mechanism ? "1" : "0"});
  }
  return table;
}

}  // namespace unfurl
