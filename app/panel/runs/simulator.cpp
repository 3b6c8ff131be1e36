// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/simulator.hpp"

#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/tolerance.hpp"

namespace unfurl {

namespace {

// Counts the states that are looked at: what they are looked at for is asked before each.
std::function<bool()> counted(const Simulator::Task& task, std::size_t states, const char* doing) {
  return [&task, states, doing, done = std::size_t{0}]() mutable {
    if (++done % 64 == 0)
      task.progress(std::min(1.0, static_cast<double>(done) / static_cast<double>(states)), doing);
    return task.stale();
  };
}

LiveRun live_run(const SceneDocument& document, const Simulator::Task& task) {
  Scene scene = read_document(document);
  SimulationHooks hooks;
  hooks.progress = [&](double fraction) { task.progress(fraction, "simulating"); };
  hooks.cancelled = [&] { return task.stale(); };
  Simulation simulation = simulate_as_asked(build_model(scene), scene.solver, hooks);
  const std::size_t states = simulation.trajectory.size();
  record_singular_poses(simulation, counted(task, states, "looking for singular poses"));
  Diagnostics diagnostics = judge(simulation, counted(task, states, "energies and forces"));
  std::vector<std::string> warnings = simulation.warnings;
  if (!task.stale())
    for (auto& warning : accuracy_warnings(simulation, diagnostics)) warnings.push_back(std::move(warning));
  MotionKey motion = motion_of(scene);
  return {task.id(),
          document,
          std::move(scene),
          std::move(motion),
          std::move(simulation),
          std::move(diagnostics),
          std::move(warnings)};
}

SimulationOutcome outcome_of(const SceneDocument& document, const Simulator::Task& task) {
  SimulationOutcome outcome{task.id(), nullptr, {}, ""};
  try {
    outcome.run = std::make_shared<const LiveRun>(live_run(document, task));
  } catch (const SceneError& error) {
    outcome.problems = error.problems();
  } catch (const std::bad_alloc&) {
    outcome.message = "out of memory";
  } catch (const std::exception& error) {
    outcome.message = error.what();
  }
  return outcome;
}

}  // namespace

Simulator::Simulator(std::function<void()> wake) : Worker(outcome_of, std::move(wake)) {}

}  // namespace unfurl
