// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/simulator.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/structures/family.hpp"
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

LiveRun live_run(const SceneDocument& document, Scene scene, const Simulator::Task& task, bool coarse) {
  SimulationHooks hooks;
  hooks.progress = [&](double fraction) {
    task.progress(fraction, coarse ? "simulating coarsely" : "simulating");
  };
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
          std::move(warnings),
          coarse};
}

// What shows a large ring at once: one of its equal sectors, solved with longer steps. None where the family
// has no such model, or is quick enough as it is.
std::optional<Scene> coarse_scene(const SceneDocument& document, const Scene& scene) {
  constexpr std::size_t large = 300;  // nodes
  const Family* family = find_family(scene.kind);
  if (!family || !scene.structure.has("model") || scene.structure.text("model") != "full")
    return std::nullopt;
  SceneDocument coarse = document;
  coarse.edits["structure.model"] = std::string("sector");
  coarse.edits["solver.step"] = 4 * scene.solver.step;
  coarse.edits["solver.tolerance"] = 0.0;
  try {
    Scene sector = read_document(coarse);
    if (build_structure(sector).node_copies.size() < large) return std::nullopt;
    return sector;
  } catch (const SceneError&) {  // what acts on single nodes has no place in a sector
    return std::nullopt;
  }
}

std::shared_ptr<const LiveRun> run_of_document(const SceneDocument& document, const Simulator::Task& task) {
  Scene scene = read_document(document);
  if (auto coarse = coarse_scene(document, scene)) try {
      task.publish({task.id(),
                    std::make_shared<const LiveRun>(live_run(document, std::move(*coarse), task, true)),
                    {},
                    ""});
    } catch (const Error&) {  // the whole will say what is wrong
    }
  return std::make_shared<const LiveRun>(live_run(document, std::move(scene), task, false));
}

SimulationOutcome outcome_of(const SceneDocument& document, const Simulator::Task& task) {
  SimulationOutcome outcome{task.id(), nullptr, {}, ""};
  try {
    outcome.run = run_of_document(document, task);
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

std::string warning_sentence(const LiveRun& run) {
  const std::size_t count = run.warnings.size();
  if (count == 0) return "";
  return (count == 1 ? "1 warning: " : std::to_string(count) + " warnings: ") + run.warnings.front();
}

std::string state_sentence(const LiveRun& run) {
  const Simulation& simulation = run.simulation;
  if (run.coarse) return "coarse: one sector with longer steps; the whole is being simulated";
  if (simulation.status == RunStatus::failed) return "the solver failed: " + simulation.message;
  char facts[160];
  std::snprintf(facts, sizeof facts, " at %.4g s, %ld steps, %.3g s of CPU time",
                simulation.trajectory.end_time(), simulation.steps, simulation.cpu_s);
  const SolvedAs solved = solved_as(simulation);
  return std::string(to_string(simulation.status)) + facts + "\nmodel " + solved.name + ": " + solved.why;
}

Simulator::Simulator(std::function<void()> wake) : Worker(outcome_of, std::move(wake)) {}

}  // namespace unfurl
