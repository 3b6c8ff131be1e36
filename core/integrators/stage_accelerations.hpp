// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/integrators/index1.hpp"
#include "core/integrators/projection.hpp"

namespace unfurl {

// Accelerations within the steps of explicit methods, whose inner stages are beside the constraints. There
// redundant rows may contradict each other, as those of an overconstrained linkage of no symmetry do
// (Bennett's loop): G has more rank than on the constraints, in directions as weak as the pose is far from
// them, and who keeps these holds a free motion by what is an error. From where that has been seen
// accelerations are those of the pose and rates on the constraints that stand for the stage's. On the
// constraints these are the same, and beside them they are smooth within a step: methods keep their order.
// Steps end on the constraints then: from beside them errors feed on themselves, and what begins anew there,
// as behind an event, has not seen it.
class StageAccelerations {
 public:
  explicit StageAccelerations(const System& system, bool clean_multipliers = false);
  void stabilise(double alpha) { index1_.stabilise(alpha); }
  void restart() { steps_ = ask_at_ = 0; }
  void begin(const State& state);  // a step
  bool evaluate(double t, const ConstVec& z, const ConstVec& w, MutVec acceleration, MutVec lambda);
  // Rows have been seen to contradict each other since begin(), which is to be called again: what the step
  // has of them is wrong.
  bool seen() const { return seen_; }
  // As if that had been seen before; and whether it has.
  void expect_contradictions() { seen_ = !known(); }
  bool known() const { return poses_ != nullptr; }
  // The end of a step onto the constraints, from where on that has been seen.
  void settle(double t, VectorXd& z, VectorXd& w);

 private:
  bool contradict(double t, const ConstVec& z, const ConstVec& w) const;
  const System& system_;
  bool clean_, seen_ = false, held_ = false;
  int steps_ = 0, ask_at_ = 0, wait_ = 1;  // since restart(); when to ask again, and how long then
  Index1 index1_;
  std::unique_ptr<Projection> poses_;
  VectorXd on_;
};

}  // namespace unfurl
