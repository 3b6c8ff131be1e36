// SPDX-License-Identifier: BSD-3-Clause
// Steps of Dvm next to singular poses, whose weak modes show what counts as round-off elsewhere.
#include "core/integrators/dvm_method.hpp"

namespace unfurl {

// Is there a mode so weak that the errors which count as round-off elsewhere would show in the motion? Next
// to a dead centre, where the motion is small and the constraints hold it by small angles.
bool Dvm::needs_care() {
  if (!frozen_ || eq_.phi.rows() == 0) return false;
  by_parts_ = false;
  const double motion = largest_magnitude(eq_.dX.data(), eq_.dX.size());
  const double reach =
      std::max(eq_.start_pose().lpNorm<Eigen::Infinity>(), system_.constraint_lengths().maxCoeff());
  const double needed =
      saddle_.motion_of_error() * constraint_noise(reach, reach) / std::max(harmless_ * motion, 1e-300);
  needed_pivot_ = std::pow(std::min(needed, strong), 2);
  if (needed > 1) {  // so small a motion that every error shows
    saddle_.weakest_pivot(needed_pivot_);
    return true;
  }
  if (saddle_.weakest_pivot(needed_pivot_) < needed_pivot_) return true;
  return eq_.parts.several() && some_part_needs_care();
}

// By its own motion, beside others that are faster.
bool Dvm::some_part_needs_care() {
  const VectorXd motions = eq_.parts.largest(eq_.dX.data(), c_.s - 1);
  const PartSizes::Care care = eq_.parts.care(saddle_, motions, harmless_, strong);
  needed_pivot_ = care.always ? strong * strong : care.pivot;
  return by_parts_ =
             needed_pivot_ > 0 && (saddle_.weakest_pivot(needed_pivot_) < needed_pivot_ || care.always);
}

// Whether the last correction was nothing beside the motion, or no longer gains, in every part by itself.
bool Dvm::nothing_moves(std::vector<Stall>& stalls, double enough, int patience) const {
  const auto done = [=](Stall& stall, double size, double motion) {
    stall.without_gain = size < 0.5 * stall.best ? 0 : stall.without_gain + 1;
    stall.best = std::min(stall.best, size);
    return size <= enough * motion || stall.without_gain >= patience;
  };
  const IndependentParts& parts = eq_.parts;
  if (!by_parts_)
    return done(stalls[0], largest_magnitude(rhs_f_.data(), eq_.dX.size()),
                largest_magnitude(eq_.dX.data(), eq_.dX.size()));
  const VectorXd sizes = parts.largest(rhs_f_.data(), c_.s - 1),
                 motions = parts.largest(eq_.dX.data(), c_.s - 1);
  bool all = true;
  for (Index p = 0; p < sizes.size(); ++p)
    all = done(stalls[static_cast<std::size_t>(p)], sizes[p], motions[p]) && all;
  return all;
}

// The constraints in increments, corrections from factors that see every mode, until the corrections are
// nothing beside the motion: residuals do not tell, because a small one may be a large error of a weak mode.
// What factors in doubles see of the weakest ones, e / sigma^2 or so, is the share that an iteration leaves
// of them: in large systems, where that is what makes an iteration slow, it is extrapolated, and where that
// gets nowhere the factors are made in twice the digits.
bool Dvm::tight_iterations(const State& state, StepReport& report) {
  constexpr int most = 40;
  constexpr double slow = 0.05, digits = 1e-14, left_by_stall = 1e-8;
  constexpr int steps_finely = 20;
  const int patience = small_ ? 2 : 4;
  eq_.take_rods_as_unknowns(false);
  eq_.in_increments = true;
  if (finely_ > 0 && --finely_ > 0 && !saddle_.fine() && !saddle_.factorise_finely()) finely_ = 0;
  careful_ = !saddle_.fine();  // fine factors leave out by themselves what the rows cannot reach
  feed_ = true;
  weak_modes_.restart();
  const double enough = std::max(std::numeric_limits<double>::epsilon(), nothing * harmless_);
  double best = infinity, last = infinity;
  std::vector<Stall> stalls(static_cast<std::size_t>(eq_.parts.count()));
  bool done = false, good = false;
  for (int it = 0; it <= most; ++it) {
    eq_.evaluate();
    report.residual = eq_.level();
    if (done) good = report.residual <= accepted;
    if (done || !std::isfinite(report.residual)) break;
    ++report.newton_iterations;
    correct(report);
    const double size = largest_magnitude(rhs_f_.data(), eq_.dX.size()),
                 motion = largest_magnitude(eq_.dX.data(), eq_.dX.size());
    best = std::min(best, size);
    done = nothing_moves(stalls, enough, patience);
    if (!small_ && done && best > left_by_stall * motion && !saddle_.fine() && saddle_.factorise_finely()) {
      done = careful_ = false;
      finely_ = steps_finely;
      for (Stall& stall : stalls) stall.without_gain = 0;
      weak_modes_.restart();
    } else if (!small_ && !done && size > std::max(slow * last, digits * motion)) {
      const auto flat = [](auto& x, Index length) { return Eigen::Map<VectorXd>(x.data(), length); };
      weak_modes_.extrapolate(flat(rhs_f_, eq_.dX.size()), flat(eq_.dX, eq_.dX.size()),
                              flat(eq_.lambda, eq_.lambda.size()));
    }
    last = size;
  }
  eq_.in_increments = false;
  if (good) {
    report.status = StepStatus::converged;
    return true;
  }
  tight_ = false;
  predict(state, eq_.h);
  freeze(eq_.start_pose(), report);
  return false;
}

}  // namespace unfurl
