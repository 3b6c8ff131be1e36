// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/simulation.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "core/integrators/integrator.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/parts.hpp"
#include "core/simulate/stepper.hpp"
#include "core/simulate/stretched.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/blocked_motion.hpp"

namespace unfurl {
namespace {

// At most about 20 times a second, and at the end.
class Progress {
 public:
  Progress(const SimulationHooks& hooks, double end) : hooks_(hooks), end_(end) {}
  void at(double t) { report(t / end_); }
  void report(double fraction) {
    if (!hooks_.progress) return;
    const auto now = std::chrono::steady_clock::now();
    if (fraction < 1.0 && now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    hooks_.progress(fraction);
  }

 private:
  const SimulationHooks& hooks_;
  double end_;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string_view to_string(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::deployed:
      return "deployed";
    case RunStatus::stopped:
      return "stopped";
    case RunStatus::failed:
      return "failed";
  }
  return "failed";
}

namespace {

// Methods that hold the constraints fail in such a pose, and say why.
std::string drift_warning(const Model& model, const SolverOptions& options) {
  const Method* method = find_method(options.method);
  if (!method || method->claims(options).holds_positions) return "";
  const std::string rods = held_at_second_order(model.system, node_positions(model.structure));
  if (rods.empty()) return "";
  return rods +
         " hold each other in this pose, and what looks free there is not (as rods in line are not): " +
         options.method +
         " lets it move as the constraints drift, and its rod forces mean nothing; draw them a little slack, "
         "or let rods give (structure.rod_model)";
}

std::vector<std::string> warnings_of_start(const Model& model, const InitialState& start,
                                           const SolverOptions& options, double swing) {
  std::vector<std::string> warnings = model.structure.notes;
  std::vector<std::string> said{velocity_warning(start, model.structure),
                                elastic_step_warning(model, start.state, options, swing),
                                wave_step_warning(model.structure, options), drift_warning(model, options)};
  if (model.structure.kind == "custom")
    said.push_back(misfit_warning(model.system, node_positions(model.structure)));
  for (std::string& warning : said)
    if (!warning.empty()) warnings.push_back(std::move(warning));
  return warnings;
}

}  // namespace

SolvedAs solved_as(const Simulation& run) {
  SolvedAs out = run.solved_as;
  const Structure& structure = run.trajectory.structure();
  const bool sector = structure.node_copies.size() > structure.nodes.size();
  if (out.name.empty()) out.name = sector ? "sector" : "full";
  if (out.why.empty())
    out.why = sector ? "structure.model = \"sector\"" : "solver.model = \"" + run.options.model + "\"";
  return out;
}

Parts parts_for(const Model& model) {
  const double numbers =
      static_cast<double>(2 * model.system.solved_coordinates() + model.system.constraints()) +
      2.0 * static_cast<double>(model.structure.rods.size()) + 60;
  Parts parts;
  parts.states = static_cast<std::size_t>(std::clamp(2e6 / (8 * numbers), 128.0, 4096.0));
  parts.around = parts.states / 64 + 6;
  return parts;
}

std::vector<std::string> start_warnings(const Model& model, const SolverOptions& options, double swing) {
  return warnings_of_start(model, initial_state(model.structure, model.system), options, swing);
}

Simulation simulate(std::shared_ptr<const Model> model, const SolverOptions& options,
                    const SimulationHooks& hooks) {
  std::size_t first_new = 0;
  return simulate_in_parts(std::move(model), options, hooks, {}, first_new);
}

Simulation simulate_in_parts(std::shared_ptr<const Model> model, const SolverOptions& options,
                             const SimulationHooks& hooks, const Parts& parts, std::size_t& first_new) {
  if (!find_method(options.method)) throw std::invalid_argument("no method is called " + options.method);
  const InitialState start = initial_state(model->structure, model->system);
  const bool stretches = model->structure.quasi_static;
  double begin = thread_cpu_seconds();
  Progress progress(hooks, options.end_time);
  Stepper stepper =
      parts.archived ? Stepper(model, options, *parts.archived) : Stepper(model, options, start.state);
  while (stepper.time() < options.end_time) {
    progress.at(stepper.time());
    if (hooks.cancelled && hooks.cancelled()) stepper.stop();
    if (!stepper.step()) break;
    if (parts.look) parts.look(stepper.run());
    if (!parts.take || stepper.run().trajectory.size() - stepper.first_new() < parts.states + parts.around)
      continue;
    Stepper::Window window = stepper.take_window(parts.around);
    if (stretches) add_stretch(window.run.trajectory);
    const double pause = thread_cpu_seconds();
    window.run.cpu_s = pause - begin;
    parts.take(std::move(window), stepper);
    begin += thread_cpu_seconds() - pause;
  }
  first_new = stepper.first_new();
  const double swing = stepper.swing();
  Simulation run = stepper.take();
  if (run.status == RunStatus::completed || run.status == RunStatus::deployed) progress.report(1.0);
  run.cpu_s = thread_cpu_seconds() - begin;
  const std::vector<std::string> warnings = warnings_of_start(*model, start, options, swing);
  run.warnings.insert(run.warnings.begin(), warnings.begin(), warnings.end());
  if (stretches) add_stretch(run.trajectory);
  return run;
}

}  // namespace unfurl
