// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/stage_accelerations.hpp"

#include <algorithm>

namespace unfurl {
namespace {

// Of the rows that poses are moved along. What redundant ones contradict each other by, r, comes into the
// motion as s r / e, s the singular value that they have by then; weak directions of others take iterations.
constexpr double moving_regularisation = 1e-9;
// What is out of the rows' reach from where on it is asked why, and how much less it is to be on the
// constraints.
constexpr double asked_share = 1e-12, cleared_share = 0.03;
// Pivots that count as weak; at a start or behind an event, where states may be a good deal beside the
// constraints, there are larger ones at once. On the constraints the weakest are to be so much clearer.
constexpr double weak_pivot_later = 1e-11, weak_pivot_at_first = 1e-8, clearer = 100;
constexpr int longest_wait = 32;  // steps until it is asked again

}  // namespace

StageAccelerations::StageAccelerations(const System& system, bool clean_multipliers)
    : system_(system), clean_(clean_multipliers), index1_(system, clean_multipliers) {}

// The rows of a pose on the constraints, to which those of the last step lead.
void StageAccelerations::begin(const State& state) {
  ++steps_;
  if (seen_) poses_ = std::make_unique<Projection>(system_, moving_regularisation);
  seen_ = false;
  if (!poses_) return;
  on_ = state.z;
  if (!held_ || !poses_->along_held_rows(state.t, on_)) {
    on_ = state.z;
    if (!poses_->hold_rows_at(on_) || !poses_->along_held_rows(state.t, on_)) on_ = state.z;
  }
  held_ = poses_->hold_rows_at(on_);
}

// Whether the rows have more out of their reach beside the constraints than on them, leaving aside terms that
// let errors decay. Next to a singular pose it is as much there.
bool StageAccelerations::contradict(double t, const ConstVec& z, const ConstVec& w) const {
  const double bound = steps_ > 1 ? weak_pivot_later : weak_pivot_at_first;
  Projection poses(system_, moving_regularisation);
  Index1 index1(system_, clean_);
  VectorXd on = z, acceleration(z.size()), lambda(system_.constraints());
  if (!index1.evaluate(t, z, w, acceleration, lambda)) return false;
  const double beside = index1.out_of_reach(bound);
  if (!(beside > asked_share)) return false;
  for (int pass = 0; pass < 2; ++pass) {
    if (!poses.hold_rows_at(on)) return false;
    on = z;
    if (!poses.along_held_rows(t, on)) return false;
  }
  VectorXd rate = w;
  return index1.evaluate_on(t, on, rate, acceleration, lambda) &&
         index1.out_of_reach(clearer * bound) < cleared_share * std::min(beside, 1.0);
}

bool StageAccelerations::evaluate(double t, const ConstVec& z, const ConstVec& w, MutVec acceleration,
                                  MutVec lambda) {
  if (held_) {
    on_ = z;
    VectorXd rate = w;
    if (poses_->along_held_rows(t, on_) && index1_.evaluate_on(t, on_, rate, acceleration, lambda))
      return true;
  }
  if (!index1_.evaluate(t, z, w, acceleration, lambda)) return false;
  if (!poses_ && steps_ < ask_at_) return true;
  if (!(index1_.out_of_reach(steps_ > 1 ? 0 : weak_pivot_at_first) > asked_share)) return true;
  if (poses_) return false;
  seen_ = contradict(t, z, w);
  ask_at_ = steps_ + wait_;
  wait_ = std::min(2 * wait_, longest_wait);
  return true;
}

void StageAccelerations::settle(double t, VectorXd& z, VectorXd& w) {
  if (!held_) return;
  on_ = z;
  VectorXd rate = w;
  if (!poses_->along_held_rows(t, on_) || !poses_->hold_rows_at(on_) || !poses_->rates_by_held_rows(t, rate))
    return;
  z = on_;
  w = rate;
}

}  // namespace unfurl
