// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/index1.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/interleaved.hpp"

namespace unfurl {

namespace {

constexpr double clean_regularisation = 1e-7;
constexpr double unsettled = 1e-12;                   // a residual, of the right-hand side
constexpr double hidden = 30 * clean_regularisation;  // pivots below may be of redundant rows

}  // namespace

// Refinement leaves (e / sigma^2)^refinements of a direction: weaker ones than `weak_` need finer factors.
Index1::Index1(const System& system, bool clean_multipliers)
    : system_(system),
      G_(system.jacobian_pattern()),
      saddle_(system.mass(), G_, 1,
              clean_multipliers ? clean_regularisation : SaddleSolver::standard_regularisation,
              SaddleSolver::Order::sparse_first),
      clean_(clean_multipliers),
      weak_(clean_multipliers ? 3 * clean_regularisation : 100 * SaddleSolver::standard_regularisation),
      q_(system.coordinates()),
      v_(system.coordinates()),
      f_(system.coordinates()),
      force_(system.solved_coordinates()),
      bias_(system.constraints()),
      phi_(system.constraints()) {}

// The matrix and its right-hand sides.
void Index1::place(double t, const ConstVec& z, const ConstVec& w, const VectorXd& tension) {
  system_.expand(z, q_);
  system_.expand_rate(w, v_);
  system_.jacobian(q_, G_, scratch_);
  f_.setZero();
  if (tension.size() > 0) {
    system_.add_other_force(t, q_, v_, tension, 1.0, f_);
    system_.add_giving_rod_forces(q_, tension, 1.0, f_);
  } else {
    system_.add_applied_force(t, q_, v_, 1.0, f_);
  }
  system_.reduce_force(f_, force_);
  system_.constraint_bias(t, q_, v_, bias_);
  bias_ = -bias_;
}

bool Index1::assemble(double t, const ConstVec& z, const ConstVec& w, const VectorXd& tension) {
  place(t, z, w, tension);
  return saddle_.factorise(G_);
}

bool Index1::evaluate(double t, const ConstVec& z, const ConstVec& w, MutVec acceleration, MutVec lambda,
                      const VectorXd& tension) {
  return assemble(t, z, w, tension) && solve(t, w, acceleration, lambda);
}

bool Index1::evaluate_on(double t, const ConstVec& z, VectorXd& w, MutVec acceleration, MutVec lambda,
                         const VectorXd& tension) {
  if (!assemble(t, z, w, tension)) return false;
  VectorXd rate(lambda.size());
  system_.target_rate(t, rate);
  rate.noalias() -= G_ * w;
  settle(VectorXd::Zero(w.size()), rate, acceleration, lambda);
  w += acceleration;
  place(t, z, w, tension);
  return solve(t, w, acceleration, lambda);
}

void Index1::move_onto(double t, VectorXd& z, const VectorXd& tension) {
  VectorXd move = VectorXd::Zero(z.size()), lambda(phi_.size());
  if (!assemble(t, z, move, tension)) return;
  system_.constraint(t, q_, phi_);
  phi_ = -phi_;
  settle(VectorXd::Zero(z.size()), phi_, move, lambda);
  if (move.allFinite()) z += move;
}

double Index1::out_of_reach(double weak) {
  return weak > 0 && saddle_.weakest_pivot(weak) < weak ? std::numeric_limits<double>::infinity() : left_;
}

bool Index1::evaluate(const State& state, MutVec acceleration, MutVec lambda) {
  return assemble(state.t, state.z, state.w, state.tension) && solve(state.t, state.w, acceleration, lambda);
}

void Index1::accelerate(const ConstVec& f, MutVec acceleration) {
  VectorXd lambda(bias_.size());
  saddle_.solve(f, VectorXd::Zero(bias_.size()), acceleration, lambda, refinements());
}

bool Index1::evaluate_at_rest(State state, MutVec acceleration, MutVec lambda) {
  state.w.setZero(state.z.size());
  if (!assemble(state.t, state.z, state.w, state.tension)) return false;
  bias_.setZero();
  return solve(state.t, state.w, acceleration, lambda);
}

bool Index1::solve(double t, const ConstVec& w, MutVec acceleration, MutVec lambda) {
  const bool weak = saddle_.weakest_pivot(weak_) < weak_;
  if (alpha_ > 0) {
    system_.target_rate(t, phi_);
    phi_.noalias() -= G_ * w;
    bias_ += 2.0 * alpha_ * phi_;
    system_.constraint(t, q_, phi_);
    bias_ -= alpha_ * alpha_ * phi_;
  }
  settle(force_, bias_, acceleration, lambda);
  if (weak) left_ = std::numeric_limits<float>::infinity();
  return acceleration.allFinite() && lambda.allFinite();
}

// A weak direction that the pivots do not show (they are up to as many times the square of its singular value
// as it has rows) is one that refinement does not reach. With the small regularisation such a direction is
// that of a singular pose next by, and all that there is of it is round-off. Where nothing moves, rows hold
// none.
void Index1::settle(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y) {
  const double left = saddle_.solve(f, g, x, y, refinements());
  left_ = static_cast<float>(left);
  const auto still = [&] { return g.lpNorm<Eigen::Infinity>() <= unsettled * x.lpNorm<Eigen::Infinity>(); };
  if (clean_ && left > unsettled && !saddle_.fine() && (still() || saddle_.left_a_direction()) &&
      saddle_.factorise_finely())
    saddle_.solve(f, g, x, y, refinements());
}

const VectorXd& Index1::applied_force(const State& state) {
  place(state.t, state.z, state.w, state.tension);
  return force_;
}

bool Index1::correct(const State& state, std::span<VectorXd> lambdas, const VectorXd& applied) {
  if (!assemble(state.t, state.z, state.w, state.tension)) return false;
  if (applied.size() > 0) force_ = applied;
  const Index n = state.w.size(), m = bias_.size();
  VectorXd acceleration(n), change(m), force(n), rate(m);
  for (VectorXd& lambda : lambdas) {
    force.noalias() = force_ - G_.transpose() * lambda;
    settle(force, bias_, acceleration, change);
    // What no acceleration can reach is round-off of the velocities, and would come back over e.
    rate.noalias() = G_ * acceleration;
    settle(force, rate, acceleration, change);
    lambda += change;
  }
  return true;
}

// The motion x alone that answers rows: in twice the digits their multipliers are what takes long.
void Index1::answer(const VectorXd& rows, VectorXd& x, VectorXd& y) {
  if (saddle_.fine())
    saddle_.solve_motion(rows, x);
  else
    settle(VectorXd::Zero(x.size()), rows, x, y);
}

// Onto the constraints' rates at its pose, which is placed then.
void Index1::move_rates(State& state, VectorXd& rows, VectorXd& x, VectorXd& y) {
  place(state.t, state.z, state.w, state.tension);
  system_.target_rate(state.t, rows);
  rows.noalias() -= G_ * state.w;
  answer(rows, x, y);
  state.w += x;
}

bool Index1::evaluate_closely(State state, VectorXd& acceleration, VectorXd& lambda, VectorXd& doubt) {
  constexpr double unit = std::numeric_limits<double>::epsilon();
  constexpr int moves = 2;
  const Index n = state.z.size(), m = bias_.size();
  VectorXd x(n), y(m), rows(m), force = VectorXd::Zero(n);
  acceleration.resize(n);
  lambda.resize(m);
  weak_ = hidden;  // from now on
  if (!assemble(state.t, state.z, state.w, state.tension)) return false;
  saddle_.weakest_pivot(weak_);
  for (int k = 0; k < moves; ++k) {
    system_.expand(state.z, q_);
    system_.constraint(state.t, q_, phi_);
    phi_ = -phi_;
    answer(phi_, x, y);
    state.z += x;
  }
  move_rates(state, rows, x, y);
  if (!evaluate(state, acceleration, lambda)) return false;
  // What redundant rows hold of each other's round-off is reached by nothing, and would come back over e; in
  // twice the digits it is left out already.
  const auto solve = [&] {
    settle(force, rows, x, y);
    if (saddle_.fine()) return;
    rows.noalias() = G_ * x;
    settle(force, rows, x, y);
  };
  system_.constraint(state.t, q_, phi_);
  const IndependentParts parts(system_);
  const VectorXd error = parts.largest_beside(phi_).cwiseMax(unit * q_.lpNorm<Eigen::Infinity>());
  for (Index r = 0; r < m; ++r) rows[r] = std::cos(1.0 + static_cast<double>(r));
  solve();
  rows = y.cwiseProduct(error.cwiseQuotient(parts.largest_beside(y).cwiseMax(1e-300)));
  answer(rows, x, y);
  state.z += x;
  move_rates(state, rows, x, y);
  place(state.t, state.z, state.w, state.tension);
  force.noalias() = force_ - G_.transpose() * lambda;
  force.noalias() -= system_.mass() * acceleration;
  rows.noalias() = bias_ - G_ * acceleration;
  solve();
  if (!y.allFinite()) y.setConstant(std::numeric_limits<double>::infinity());
  doubt = y.cwiseAbs();
  return true;
}

// By what multipliers are more than what they answer, both of each part, where that is most.
double Index1Lanes::by_parts(const VectorXd& lambda, const VectorXd& answered) const {
  const VectorXd most = parts_.largest_of_rows(lambda);
  double out = 0;
  for (Index p = 0; p < most.size(); ++p)
    if (answered[p] > 0) out = std::max(out, most[p] / answered[p]);
  return out;
}

Index1Lanes::Index1Lanes(const System& system)
    : system_(system), one_(system_, true), lanes_(one_.saddle_), parts_(system_) {
  mixed_.resize(system.solved_coordinates());
  for (Index i = 0; i < mixed_.size(); ++i) mixed_[i] = std::cos(1.0 + static_cast<double>(i));
  none_ = VectorXd::Zero(mixed_.size());
  size_ = parts_.largest(VectorXd(system_.mass() * mixed_).data());
}

void Index1Lanes::evaluate(std::span<const State* const> states) {
  constexpr double much = 1e4;  // beyond what redundant rows make of it
  SaddleLanes::Vectors none, rows, own_acceleration, own_lambda;
  SaddleLanes::Vectors acts;
  for (std::size_t k = 0; k < ok_.size(); ++k) {
    force_[k].resize(0);
    if (k >= states.size()) continue;
    const State& s = *states[k];
    system_.follow(s);
    one_.place(s.t, s.z, s.w, s.tension);
    lanes_.set(static_cast<int>(k), one_.G_);
    force_[k] = one_.force_;
    acts[k] = parts_.largest(one_.force_.data());
    bias_[k] = one_.bias_;
    own_acceleration[k].resize(force_[k].size());
    own_lambda[k].resize(bias_[k].size());
    none[k] = none_;
    rows[k].noalias() = one_.G_ * mixed_;
  }
  lanes_.factorise();
  std::array<bool, SaddleLanes::lanes> alone{}, in_doubt{};
  for (std::size_t k = 0; k < states.size(); ++k) {
    ok_[k] = true;
    if (lanes_.shows_none_below(static_cast<int>(k), hidden, one_.saddle_)) continue;  // nor a smaller bound
    ok_[k] = lanes_.hand_over(static_cast<int>(k), one_.saddle_);
    if (!ok_[k]) continue;
    const double pivot = one_.saddle_.weakest_pivot(one_.weak_);
    in_doubt[k] = !one_.saddle_.shows_none_below(hidden);
    if (!(alone[k] = !one_.saddle_.in_first_order())) continue;
    if (one_.saddle_.fine()) {
      weakness_[k] = 1 / std::sqrt(pivot);
    } else {
      one_.saddle_.solve(none[k], rows[k], own_acceleration[k], own_lambda[k], -1);
      weakness_[k] = by_parts(own_lambda[k], size_);
    }
    one_.settle(force_[k], bias_[k], own_acceleration[k], own_lambda[k]);
    for (VectorXd* done : {&force_[k], &none[k]}) done->resize(0);
  }
  lanes_.solve(none, rows, acceleration_, lambda_, -1);
  for (std::size_t k = 0; k < states.size(); ++k)
    if (ok_[k] && !alone[k]) weakness_[k] = by_parts(lambda_[k], size_);
  const SaddleLanes::Norms left = lanes_.solve(force_, bias_, acceleration_, lambda_, one_.refinements());
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (ok_[k] && !alone[k] && left[k] > unsettled && lanes_.hand_over(static_cast<int>(k), one_.saddle_)) {
      one_.settle(force_[k], bias_[k], acceleration_[k], lambda_[k]);
      if (one_.saddle_.fine()) {
        one_.saddle_.solve(none[k], rows[k], own_acceleration[k], own_lambda[k]);
        weakness_[k] = by_parts(own_lambda[k], size_);
      }
    }
    if (alone[k]) acceleration_[k] = own_acceleration[k], lambda_[k] = own_lambda[k];
    if (in_doubt[k]) {
      const VectorXd inertia = parts_.largest(VectorXd(system_.mass() * acceleration_[k]).data());
      const double times = by_parts(lambda_[k], acts[k].cwiseMax(inertia));
      weakness_[k] = times > much ? times : std::numeric_limits<double>::infinity();
    }
    ok_[k] = ok_[k] && acceleration_[k].allFinite() && lambda_[k].allFinite();
  }
}

}  // namespace unfurl
