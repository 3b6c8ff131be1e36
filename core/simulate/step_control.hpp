// SPDX-License-Identifier: BSD-3-Clause
// Step sizes that follow the motion, chosen so that the choice is the same forwards and backwards in time.
#pragma once

#include <memory>

#include "core/integrators/index1.hpp"
#include "core/integrators/solver_options.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Rates [1/s] at which a motion turns and changes: over the rods of `structure` the largest omega, with which
// v h + b h^2 / 2 = alpha for h = alpha / omega, v = |v_b - v_a| / l and b = |e x (a_b - a_a)| / l of a rod
// along e, and the frequency of the fastest that swings in it by more than a millionth of the structure,
// (|M^-1 K x| / |x|)^1/2 of forces F(z), K = -dF/dz, in directions x of the motion (of w' h_0 as well, where
// it is at rest) but those in which drives lead it, with rods that give only where nothing is driven; that of
// the fastest sine that something follows; and r = |w'| / (|w| + |w'| / r_0) in the mass norm, which a motion
// from rest keeps below r_0.
//
//     Q(z, w) = sqrt(1 + (h_0 (omega + r) / alpha)^2),     h_{n-1/2} h_{n+1/2} = (h_0 / Q(z_n, w_n))^2
//
// with h_0 the largest step (solver.step) and alpha the turn and relative change that a step may bring
// (solver.turn). Q is even in w and the recursion is symmetric in its two steps, so a symmetric method stays
// symmetric (Huang & Leimkuhler 1997; Hairer, Lubich & Wanner, Geometric Numerical Integration, VIII.3, here
// in geometric instead of arithmetic mean, which keeps steps positive). What a step differs from the wanted
// one by, the recursion keeps in steps that alternate about it: where that is much (behind a start from rest,
// an event), it starts anew. A symplectic method is no longer symplectic with it.
class StepControl {
 public:
  static constexpr double smallest_share = 1e-5;  // of the largest step: below, a run is better refused
  StepControl(const Structure& structure, const System& system, const SolverOptions& options);
  // The step that follows `state` [s]; to be asked once for every accepted state, in order.
  double next(const State& state);
  // The fastest that swings on springs in the state last asked for, and the same by rates alone [1/s].
  struct Swing {
    double omega = 0, of_rates = 0;
  };
  const Swing& swing() const { return asked_; }
  // The step that follows one which no step leads to.
  double anew(const State& state) { return clamped(start(state)); }
  // As if the last step had been h [s].
  void continue_from(double h) { previous_ = h; }
  double last() const { return previous_; }

 private:
  double density(const State& state);  // Q
  bool driven(double t) const;
  Swing swing(const State& state);  // at rates and accelerations in v_, a_
  double start(const State& state);
  double clamped(double h) const;

  const Structure& structure_;
  System system_;  // follows the states
  Index1 index1_;
  double largest_, turn_, length_;
  bool bends_;
  Swing swing_, asked_;
  double previous_ = 0;  // the last step [s]; 0 before the first
  bool known_ = false;   // acceleration_ is that of the last state asked for
  VectorXd acceleration_, lambda_, q_, v_, a_, f_;
  Eigen::ArrayXd moving_;  // 0 of integrals of controllers: no numbers of theirs are lengths
};

}  // namespace unfurl
