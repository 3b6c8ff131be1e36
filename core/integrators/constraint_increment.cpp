// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/constraint_increment.hpp"

#include <cmath>
#include <limits>

namespace unfurl {

ConstraintIncrement::ConstraintIncrement(const System& system)
    : system_(system), G_(system.jacobian_pattern()) {
  for (VectorXd* v : {&q0_, &pose_, &move_}) v->setZero(system.coordinates());
  for (VectorXd* v : {&sum_, &exact_, &target0_, &target_}) v->setZero(system.constraints());
}

void ConstraintIncrement::start(double t, const ConstVec& q0) {
  t0_ = t;
  q0_ = q0;
  if (system_.rheonomic()) system_.constraint(t, q0_, target0_);
}

void ConstraintIncrement::evaluate(double t, const ConstVec& D, MutVec change) {
  system_.expand_rate(D, move_);
  sum_.setZero();
  for (Index i = 0; i < gauss_.nodes.size(); ++i) {
    pose_ = q0_ + gauss_.nodes[i] * move_;
    system_.jacobian(pose_, G_, scratch_);
    sum_.noalias() += gauss_.weights[i] * (G_ * D);
  }
  take_what_points_miss();
  if (system_.rheonomic() && t != t0_) {
    system_.constraint(t, q0_, target_);
    sum_ += target_ - target0_;
  }
  change = sum_;
}

// Rows of large coefficients, sums that cancel, are left by rounding at some 1e-14 of the motion.
void ConstraintIncrement::take_what_points_miss() {
  constexpr double rounding = 512 * std::numeric_limits<double>::epsilon(), turns_little = 1e-5;
  const double moved = move_.size() > 0 ? move_.lpNorm<Eigen::Infinity>() : 0.0;
  if (sum_.size() == 0 || !(moved > turns_little * system_.constraint_lengths().minCoeff())) return;
  exact_ = sum_;
  system_.put_changes(q0_, move_, exact_);
  for (Index r = 0; r < sum_.size(); ++r)
    if (std::abs(exact_[r] - sum_[r]) > rounding * moved) sum_[r] = exact_[r];
}

}  // namespace unfurl
