// SPDX-License-Identifier: BSD-3-Clause
// The motion of a run between its states.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/integrators/integrator.hpp"
#include "core/system/state.hpp"

namespace unfurl {

struct Model;

// Whether the velocities at both ends tell how far a step leads, by the trapezoidal rule: half a radian of a
// swing.
bool is_short_step(const State& a, const State& b);

// For states that no step of the method led to, at round-off of the motion: steps between them that miss as
// little of it as any here.
SolverOptions closest_steps(SolverOptions options);

// Hermite's cubic through the coordinates and rates of two states of one model: a guess, not a solution.
State on_cubic(const State& a, const State& b, double t);

// The state at a time t between two neighbouring states of a run is that of a step of the run's own method
// from the earlier one to t: as accurate as the states themselves and on the constraints like them, whatever
// the method, its order and the length of its steps, and never across an event, which has a state of its own.
// No interpolant does that: a step of high order may turn a rod by two radians. Threads may share one.
// `options`: those of the method that the states come from.
class DenseOutput {
 public:
  explicit DenseOutput(const SolverOptions& options) : options_(options) {}

  // a.t <= t <= b.t, both states of `model`. Where no step to t can be solved (next to a singular pose), the
  // cubic through both states, projected on the constraints. `step`: of the one that ended in b.
  State between(const std::shared_ptr<const Model>& model, const State& a, const State& b, double t,
                const StepReport& step = {});
  const SolverOptions& options() const { return options_; }

 private:
  struct Engine {
    std::shared_ptr<const Model> model;
    std::unique_ptr<Integrator> integrator;
  };
  Engine borrow(const std::shared_ptr<const Model>& model, State start, double h);  // for steps like this one
  void give_back(Engine engine);

  SolverOptions options_;
  std::mutex mutex_;
  std::vector<Engine> idle_;
};

}  // namespace unfurl
