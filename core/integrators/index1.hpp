// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "core/integrators/independent_parts.hpp"
#include "core/math/saddle_lanes.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Accelerations and multipliers from the equations of motion with the constraints differentiated twice (index
// 1):
//
//     [ M  G^T ] [w']     [ F(t, q, v)                                  ]
//     [ G   0  ] [lambda] [ -v^T Hess Phi v - 2 alpha G v - alpha^2 Phi ]
//
// The terms with alpha vanish where the constraints hold; alpha = 0 unless stabilise() sets it. Multipliers
// that are not unique come with least scaled norm. One evaluation is one factorisation.
class Index1 {
 public:
  // clean_multipliers: for reporting forces rather than for stepping; slower, with round-off in redundant
  // multipliers held at 1e-9 of their size instead of 1e-6.
  explicit Index1(const System& system, bool clean_multipliers = false);
  const System& system() const { return system_; }
  // Let constraint errors decay at the rate alpha [1/s] (Baumgarte 1972).
  void stabilise(double alpha) { alpha_ = alpha; }
  // False where the factorisation broke down or the result is not finite.
  // `tension`: what rods that give pull with, where their lengths do not tell.
  bool evaluate(double t, const ConstVec& z, const ConstVec& w, MutVec acceleration, MutVec lambda,
                const VectorXd& tension = {});
  // The same where rates are moved first onto those that the constraints have then.
  bool evaluate_on(double t, const ConstVec& z, VectorXd& w, MutVec acceleration, MutVec lambda,
                   const VectorXd& tension = {});
  // A step of Newton's method onto the constraints' values: a pose between states, where a drive has moved
  // on.
  void move_onto(double t, VectorXd& z, const VectorXd& tension = {});
  // The share of its right-hand side that the last evaluation has left, out of the rows' reach; infinite
  // where a direction is hardly in their reach, by a pivot below `weak`.
  double out_of_reach(double weak);
  // The same as evaluate() at a state. What rods that give pull with is what the state says, where its step
  // did not resolve them and their lengths do not tell.
  bool evaluate(const State& state, MutVec acceleration, MutVec lambda);
  // What forces f [N] more would add to the last acceleration, the rows as they are.
  void accelerate(const ConstVec& f, MutVec acceleration);
  // The same at rest in the state's pose, for good: G a = 0, whatever drives and warming do then.
  bool evaluate_at_rest(State state, MutVec acceleration, MutVec lambda);
  // Where G has lost rank: the multipliers that the equations determine, next to those given, of which the
  // rest is kept; for each of `lambdas`. Directions of singular values below some 1e-7 count as lost.
  // `applied`: what acts, where that is not what the state says.
  bool correct(const State& state, std::span<VectorXd> lambdas, const VectorXd& applied = {});
  // What acts in a state, in its solved coordinates.
  const VectorXd& applied_force(const State& state);
  // evaluate() at a state next to a pose where the rank falls, x from it, and how far each multiplier may be
  // off. The state is moved onto the constraints first, as far as round-off lets it: what its step left there
  // may be more. `doubt`, from above: the answer of the multipliers, to first order, to an error as large as
  // round-off in the rows, all of which add up in the weakest direction of each independent part; that is
  // 1e-16 / x^3 of the forces.
  bool evaluate_closely(State state, VectorXd& acceleration, VectorXd& lambda, VectorXd& doubt);

 private:
  friend class Index1Lanes;
  void place(double t, const ConstVec& z, const ConstVec& w, const VectorXd& tension);
  bool assemble(double t, const ConstVec& z, const ConstVec& w, const VectorXd& tension = {});
  bool solve(double t, const ConstVec& w, MutVec acceleration, MutVec lambda);
  int refinements() const { return clean_ ? 40 : 8; }
  void settle(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y);
  void answer(const VectorXd& rows, VectorXd& x, VectorXd& y);
  void move_rates(State& state, VectorXd& rows, VectorXd& x, VectorXd& y);
  const System& system_;
  SparseRows G_;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  bool clean_;
  float left_ = 0;
  double weak_;  // pivots below this are solved for in twice the digits
  double alpha_ = 0;
  VectorXd q_, v_, f_, force_, bias_, phi_;
};

// Index1 with clean multipliers at a few states of one system at once, to the same bits: half the price of
// one after the other. What the weakest directions need is done for each state in turn.
class Index1Lanes {
 public:
  explicit Index1Lanes(const System& system);
  bool take_loads_of(const System& system) { return system_.take_loads_of(system); }
  void evaluate(std::span<const State* const> states);  // at most SaddleLanes::lanes
  // Of the k-th of them; false where Index1::evaluate would say so.
  bool ok(std::size_t k) const { return ok_[k]; }
  const VectorXd& acceleration(std::size_t k) const { return acceleration_[k]; }
  const VectorXd& lambda(std::size_t k) const { return lambda_[k]; }
  // About 1 / s, s the smallest singular value but for those of redundant rows, or somewhat less: the
  // multipliers that answer G x over M x, x of every direction something, in the independent part where that
  // is most. Where doubles may not tell a weak direction from a redundant row: no bound, or how many times
  // multipliers are what they answer, where that tells.
  double weakness(std::size_t k) const { return weakness_[k]; }

 private:
  double by_parts(const VectorXd& lambda, const VectorXd& answered) const;
  System system_;  // follows each state in turn
  Index1 one_;
  SaddleLanes lanes_;
  IndependentParts parts_;
  VectorXd mixed_, none_, size_;  // size_: of M times what is mixed, of each part
  std::array<bool, SaddleLanes::lanes> ok_{};
  std::array<double, SaddleLanes::lanes> weakness_{};
  SaddleLanes::Vectors force_, bias_, acceleration_, lambda_;
};

}  // namespace unfurl
