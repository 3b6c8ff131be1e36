// SPDX-License-Identifier: BSD-3-Clause
// What is taken out of a step's end: errors of lengths that are held, and rates that dampers have taken.
#include "core/forces/elastic_rods.hpp"
#include "core/integrators/dvm_method.hpp"

namespace unfurl {

void Dvm::still(double h) {
  if (!eq_.rods.as_unknowns && part_of_whole(h) == 1) return eq_.rods.held.clear();
  eq_.rods.still(unheld, slowest_still, eq_.t + h, std::max(whole_, std::abs(h)), pose_, G_, w1_, mu_);
}

// Of modes far beyond a step the scheme leaves -1 of what they begin with where its stages are even in
// number, 1 where they are odd (Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.3:
// R at infinity of s - 1 Gauss points). Errors of lengths that a step ends with add up with odd ones, and are
// taken out. With even ones they are half of a step's, this way and that in turn, which is what makes the
// motion symmetric: steps of one length go on with them, although states have none.
void Dvm::start(const State& state, double h) {
  constexpr double same = 1e-9;
  if (std::abs(unheld_.h - h) <= same * std::abs(h) && unheld_.left_z == state.z && unheld_.left_w == state.w)
    eq_.start(state.t, unheld_.z, unheld_.w, h);
  else
    eq_.start(state.t, state.z, state.w, h);
}

// Modes of elastic rods that are held still have at the end's coordinates an error of the method, no wave:
// it is taken out as that of their rates, z_1 += M^-1 D^T nu, and p_1 goes with it as with any change of
// coordinates, p_1 -= (D^T nu)' w_1: else mechanisms would lose what their arms are longer by. Constraints
// keep what they are; where that takes far more motion, of their weak modes, nothing is taken out.
void Dvm::hold_lengths(double h, StepReport& report) {
  constexpr int passes = 4;  // each leaves a thousandth, the share of a rod's length that it is about
  constexpr double far = 100;
  VectorXd v(pose_.size()), nu = VectorXd::Zero(std::ssize(system_.giving_rods()));
  VectorXd phi(eq_.phi.rows()), y(phi.size()), dz(eq_.dX.rows());
  const VectorXd tension = eq_.held_tension(w1_, part_of_whole(h) * resolved * (c_.s - 1));
  if (tension.size() == 0) return;
  system_.expand_rate(w1_, v);
  end_z_ = eq_.dX.col(c_.s - 2);
  end_q_ = pose_;
  double asked = 0;
  for (int pass = 0; pass < passes; ++pass) {
    const VectorXd way = eq_.rods.towards(eq_.t + h, end_q_, v, tension, nu);
    end_z_ += way;
    asked = std::max(asked, way.lpNorm<Eigen::Infinity>());
    if (phi.size() > 0) {
      system_.expand(eq_.z0 + end_z_, end_q_);
      system_.constraint(eq_.t + h, end_q_, phi);
      saddle_.solve(VectorXd::Zero(dz.size()), -phi, dz, y);
      end_z_ += dz;
    }
    system_.expand(eq_.z0 + end_z_, end_q_);
  }
  if (!((end_z_ - eq_.dX.col(c_.s - 2)).lpNorm<Eigen::Infinity>() <= far * asked)) return;
  if (c_.s % 2 == 0) unheld_.z = eq_.z0 + eq_.dX.col(c_.s - 2), unheld_.w = w1_, unheld_.h = h;
  p1_ -= eq_.rods.turned(pose_, v, nu);
  pose_ = end_q_;
  eq_.dX.col(c_.s - 2) = end_z_;
  eq_.place_nodes();
  if (phi.size() > 0) {
    system_.constraint(eq_.t + h, pose_, phi);
    eq_.phi.col(c_.s - 2) = phi;
  }
  freeze(pose_, report);
  saddle_.solve(p1_, rate_, w1_, mu_);
  still(h);
}

// Rates at the Gauss points are those that the damper leaves, the rate at the end is not: w_1 becomes what
// their polynomial says there. What the step resolves changes by an error of order s - 1, of a step without
// length.
void Dvm::let_go(double h) {
  w1_ = eq_.dX * (c_.slope.bottomRows(c_.s - 1) * c_.tau_to_end) / h;
  p1_.noalias() = system_.mass() * w1_;
  saddle_.solve(p1_, rate_, w1_, mu_);
}

}  // namespace unfurl
