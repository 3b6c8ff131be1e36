// SPDX-License-Identifier: BSD-3-Clause
// The only input of everything downstream: diagnostics, figures, frames, exports.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integrators/solver_options.hpp"
#include "core/simulate/dense_output.hpp"
#include "core/structure/structure.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// A structure with its equations; immutable, shared by everything that looks at a run.
struct Model {
  Structure structure;
  System system;
};

// Append-only states and reports with dense output.
class Trajectory {
 public:
  // `options`: those of the method that its states come from.
  explicit Trajectory(std::shared_ptr<const Model> model, const SolverOptions& options = {});

  void append(State state, StepReport report);
  void append(Trajectory&& next);  // its states, with the models that they belong to
  void pop_back();
  // States appended from now on belong to another model of the same nodes and rods: one that is locked, say.
  void change_model(std::shared_ptr<const Model> model);

  // A copy of the states [first, last) in the order they are in, beside the same first model; without what
  // add_stretch() adds.
  Trajectory part(std::size_t first, std::size_t last, const SolverOptions& options) const;

  const Model& model() const { return *models_.front().model; }  // that of the start
  const Model& model(std::size_t i) const;                       // that state i belongs to
  const Model& last_model() const { return *models_.back().model; }
  const SolverOptions& options() const { return dense_->options(); }
  const Structure& structure() const { return model().structure; }
  std::size_t size() const { return states_.size(); }
  bool empty() const { return states_.empty(); }
  const State& state(std::size_t i) const { return states_[i]; }
  const StepReport& report(std::size_t i) const { return reports_[i]; }  // of the step that ended in state i
  double time(std::size_t i) const { return states_[i].t; }
  double start_time() const { return states_.front().t; }
  double end_time() const { return states_.back().t; }

  // Solved node coordinates and velocities [3 n] at state i.
  VectorXd node_positions(std::size_t i) const;
  VectorXd node_velocities(std::size_t i) const;
  // The whole structure's [3 N] at state i, or at any time inside: from a step of the method to that time, as
  // accurate as the states (dense_output.hpp). At an impulse, what comes after it.
  VectorXd positions(std::size_t i) const;
  VectorXd velocities(std::size_t i) const;
  VectorXd positions_at(double t) const;
  VectorXd velocities_at(double t) const;
  // The same in the coordinates of the model of state_before(t).
  // What rods give in a quasi-static model is added to the positions of the whole that are shown, not to the
  // states: displacements of the solved nodes at state i [3 n] (stretched.hpp).
  void add_stretch(std::size_t i, VectorXd displacement);
  const VectorXd* stretch(std::size_t i) const { return i < stretch_.size() ? &stretch_[i] : nullptr; }
  State state_at(double t) const;
  std::size_t state_before(double t) const;  // the last state at or before t; the first one before the start

 private:
  struct Part {
    std::size_t first;  // state
    std::shared_ptr<const Model> model;
  };
  const Part& part_of(std::size_t i) const;
  VectorXd stretch_at(double t) const;
  std::vector<Part> models_;
  std::vector<State> states_;
  std::vector<StepReport> reports_;
  std::vector<VectorXd> stretch_;  // empty: nothing is added
  std::shared_ptr<DenseOutput> dense_;
};

}  // namespace unfurl
