// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/stepper.hpp"

#include <stdexcept>
#include <utility>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/run_words.hpp"
#include "core/simulate/stepper_loop.hpp"

namespace unfurl {

// A longer step, as far as time has no edge, where this one begins or ends too close to a singular pose.
// The grid goes on after that.
void Stepper::Loop::step_over(Probe& to, double& h) {
  for (const double length : {1.41, 1.73, 1.19, 2.24, 1.09, 2.77, 1.57, 3.37}) {
    if (now().t + length * h > grid_.next_edge(now().t)) continue;
    Probe longer{.at = length * h, .state = now()};
    integrator_->restart();
    longer.report = take_step(*integrator_, longer.state, length * h);
    if (!longer.report.ok()) continue;
    part_end_ += (length - 1) * h;
    to = std::move(longer), h *= length;
    return;
  }
}

Stepper::Stepper(std::shared_ptr<const Model> model, const SolverOptions& options)
    : Stepper(model, options, initial_state(model->structure, model->system).state) {}

Stepper::Stepper(std::shared_ptr<const Model> model, const SolverOptions& options, State start)
    : run_{.trajectory = Trajectory(model, options), .options = options} {
  if (!find_method(options.method)) throw std::invalid_argument("no method is called " + options.method);
  run_.trajectory.append(std::move(start), StepReport{});
  loop_ = std::make_unique<Loop>(run_, std::move(model), time());
  loop_->begin_run();
}

Stepper::Stepper(std::shared_ptr<const Model> model, const SolverOptions& options, Archive& archived)
    : run_{.trajectory = Trajectory(model, options), .options = options} {
  double start = 0;
  archived(start);
  loop_ = std::make_unique<Loop>(run_, std::move(model), start);
  loop_->archive(archived);
}

Stepper::~Stepper() = default;

bool Stepper::step() {
  return loop_->step();
}
bool Stepper::advance_to(double t) {
  return loop_->advance_to(t);
}
void Stepper::set_force(int node, const Vec3& force) {
  loop_->set_force(node, force);
}
Stepper::Window Stepper::take_window(std::size_t around) {
  return loop_->take_window(around);
}
std::size_t Stepper::first_new() const {
  return loop_->first_new();
}
void Stepper::archive(Archive& archive) {
  double start = loop_->start();
  archive(start);
  loop_->archive(archive);
}
void Stepper::stop() {
  loop_->end();
  run_.status = RunStatus::stopped;
  run_.message = "stopped by the user at t = " + seconds(time());
}
void Stepper::on_step(std::function<void(const State&, const StepReport&)> callback) {
  loop_->on_step = std::move(callback);
}

}  // namespace unfurl
