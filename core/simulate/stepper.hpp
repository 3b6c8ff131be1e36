// SPDX-License-Identifier: BSD-3-Clause
// A run step by step: what `simulate` drives from the start to the end.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "core/simulate/simulation.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// Advances a model with the method, steps and limits of its options, and sees to all that happens on the way:
// the edges of time, end stops, cables, the deployed pose, latches. A step that such an event divides is
// solved in parts, each a step of the method that ends at the event.
class Stepper {
 public:
  // From the model's start. Throws std::invalid_argument on an unknown method.
  Stepper(std::shared_ptr<const Model> model, const SolverOptions& options);
  // From a state of the model at any time before options.end_time; the grid of steps begins there.
  Stepper(std::shared_ptr<const Model> model, const SolverOptions& options, State start);
  ~Stepper();

  // To the next time of the grid (an edge of time is one). False where the run has ended, at the end time, at
  // the deployed pose or by a failure; run().status and run().message say which.
  bool step();
  // To this time, at most the end time; the step before it is shortened, the grid stays as it is. False where
  // the run ended before; once `cancelled` says so it stays where it is, and can go on from there.
  bool advance_to(double t, const std::function<bool()>& cancelled = {});

  double time() const { return state().t; }
  const State& state() const { return run_.trajectory.state(run_.trajectory.size() - 1); }
  // That the state belongs to: it changes with what is held or pulls.
  const Model& model() const { return run_.trajectory.last_model(); }
  const Simulation& run() const { return run_; }  // all so far
  Simulation take() { return std::move(run_); }   // the same, for good: the stepper is of no use after it
  // A force [N] on a solved node from now on, in place of the one that was set before, beside what the scene
  // has: what a controller does between steps. What holds and gives way to it has given way at once. Its work
  // is among that of the loads. The method begins anew, as after any jump of a load; a force that stays the
  // same costs nothing.
  void set_force(int node, const Vec3& force);
  // The fastest swing on springs that adaptive steps have followed, by its share of the energy [1/s]; below
  // zero where one began within a step that did not.
  double swing() const;
  void stop();  // ends the run as stopped by the user

  // Hands over all of the run but its last states, which go on being known here: what was handed over is
  // `window`, whose states [first, last) no window before had; those around them are in the windows before
  // and after, too. At least 2 `around` states stay, of the present model only, so that what a long run keeps
  // does not grow. The method begins anew behind it: a run that is handed over at the same states goes the
  // same way to the bit whether it was archived there or not.
  struct Window {
    Simulation run;
    std::size_t first, last;
  };
  Window take_window(std::size_t around);
  // Those that no window had, of run().
  std::size_t first_new() const;
  // Right behind take_window(): all that the rest of the run depends on; for the constructor below.
  void archive(Archive& archive);
  // Goes on where a stepper of the same model and options was archived. Throws ArchiveError.
  Stepper(std::shared_ptr<const Model> model, const SolverOptions& options, Archive& archived);

  // Called with every state that is appended to the run, in order, the report of its step beside it.
  void on_step(std::function<void(const State&, const StepReport&)> callback);

 private:
  class Loop;
  Simulation run_;
  std::unique_ptr<Loop> loop_;
};

}  // namespace unfurl
