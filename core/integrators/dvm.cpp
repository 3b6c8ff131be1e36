// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/dvm.hpp"

#include <stdexcept>
#include <utility>

#include "core/forces/elastic_rods.hpp"
#include "core/integrators/dvm_method.hpp"
#include "core/math/coupled_columns.hpp"

namespace unfurl {

// In each part that rods and constraints do not join with others, which does what it does alone. Counted are
// coordinates that constraints may hold: a net on a ring of few units makes none of its modes weaker.
bool Dvm::is_small(const System& system, int stages) {
  const SparseRows& G = system.jacobian_pattern();
  CoupledColumns parts(G.cols());
  parts.join_rows_of(system.mass());
  parts.join_rows_of(G);
  VectorXd columns = VectorXd::Zero(G.cols()), rows = columns;
  for (Index i = 0; i < G.cols(); ++i) ++columns[parts.set_of(i)];
  for (int r = 0; r < G.outerSize(); ++r)
    if (const SparseRows::InnerIterator it(G, r); it) ++rows[parts.set_of(it.col())];
  return ((columns.cwiseMin(2 * rows) + rows).array() * (stages - 1) <= full_newton_unknowns).all();
}

void Dvm::analyse_mass() {
  const SparseRows& M = system_.mass();
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < M.outerSize(); ++r)
    for (SparseRows::InnerIterator it(M, r); it; ++it)
      if (it.col() >= r) entries.emplace_back(r, it.col(), it.value());
  SparseRows upper(M.rows(), M.cols());
  upper.setFromTriplets(entries.begin(), entries.end());
  mass_factor_.analyse(upper, minimum_degree_order(upper));
  if (!mass_factor_.factorise(upper.valuePtr()))
    throw std::logic_error("the mass matrix is not positive definite");
}

void Dvm::set_matrices(double h) {
  matrices_h_ = h;
  momentum_to_f_ = -h * c_.C_inverse;
  for (int k = 0; k + 1 < c_.s; ++k) y_to_lambda_.row(k) = c_.C.row(k) / (-h * h * c_.b[k]);
}

// Prolong the last step's polynomial; at a start, fly on with the present velocity. Multipliers start from
// the last step's end, which is solved afresh every step: prolonging stage multipliers would amplify their
// round-off in directions where they are not unique. A step much longer than the last one learns from it
// neither: prolonged so far its round-off grows by the ratio's power, and its multipliers are round-off over
// the square of its length.
void Dvm::predict(const State& state, double h) {
  const double ratio = have_history_ ? h / previous_h_ : 0.0;
  const bool far = std::abs(ratio) > most_prolonged;
  if (have_history_ && !far) {
    if (std::abs(ratio - 1.0) < 1e-12)
      prolong_ = c_.extrapolation;
    else
      c_.extrapolate(ratio, prolong_);
    with_wide_columns(c_.s - 1, [from = previous_.data(), rows = previous_.rows(), T = prolong_.data(),
                                 to = eq_.dX.data()](auto k) { mix<k()>(from, rows, T, to); });
  } else {
    for (int j = 0; j + 1 < c_.s; ++j) eq_.dX.col(j) = (h * c_.basis.nodes()[j + 1]) * state.w;
  }
  eq_.lambda.setZero();
  if (!far && state.lambda.size() > 0 && state.lambda.size() == eq_.lambda.rows())
    for (int k = 0; k < (eq_.at_ends ? 1 : c_.s - 1); ++k) eq_.lambda.col(k) = state.lambda;
}

void Dvm::freeze(const ConstVec& q, StepReport& report) {
  system_.jacobian(q, G_, scratch_);
  frozen_ = saddle_.factorise(G_);
  ++report.factorisations;
}

// The prediction's pose halfway: half as far from every node as the step's start, so that motions which turn
// far in a step take half the iterations.
void Dvm::freeze_in_the_middle(StepReport& report) {
  eq_.place_nodes();
  pose_.noalias() = eq_.Q * halfway_;
  freeze(pose_, report);
}

void Dvm::iterate(const State& state, double h, StepReport& report) {
  if (!stiff_) {
    if (frozen_iterations(report)) return;
    if (!slow_ && !eq_.at_ends) {
      predict(state, h);  // once more
      freeze_in_the_middle(report);
      if (frozen_iterations(report)) return;
    }
  }
  if (!system_.constant_forces()) {
    if (steered_iterations(state, report)) return;
    if ((stiff_ || is_stiff()) && stiff_iterations(state, report)) return;
  }
  if (!(small_ || stiff_)) return;
  predict(state, h);
  eq_.take_rods_as_unknowns(true);
  report.status = newton_.solve(eq_, wanted, accepted, false, report);
  frozen_ = false;
}

// The frozen iteration contracts by about the larger of (h omega)^2 and h c / m, over some s^2 and s.
bool Dvm::is_stiff() {
  if (system_.constant_forces()) return false;
  eq_.look_at_forces();
  return forces_are_stiff();
}

// With constraints at the ends rates that dampers take are never lost, however short steps are.
double Dvm::longest_step(const State& state, double h, double whole) {
  if (settling_.over() || system_.constant_forces() || eq_.at_ends) return h;
  return settling_.longest_step(h, whole, c_.s, [&] {
    eq_.start(state.t, state.z, state.w, h);
    return eq_.h_rate();
  });
}

// Up to three stages the polynomial has no higher degree than the ends' cubic and is no better.
bool Dvm::inside(const State& start, double h, double share, VectorXd& z, VectorXd& w) const {
  if (c_.s < 4 || !have_history_ || h != previous_h_) return false;
  const VectorXd l = c_.basis.values(share);
  const VectorXd slope = slopes_.transpose() * l;  // l' is the interpolant of its own values at the nodes
  z.noalias() = previous_ * l.tail(c_.s - 1);
  z += start.z;
  w.noalias() = previous_ * slope.tail(c_.s - 1);
  w /= h;
  return true;
}

// Corrections with the forces' derivatives at the middle of the predicted step; where they do not converge,
// at the middle of the step as they left it.
bool Dvm::steered_iterations(const State& state, StepReport& report) {
  constexpr int most_looks = 6;
  if (!steerable_) return false;
  if (!steering_) steering_.emplace(c_, eq_.dX.rows(), eq_.lambda.rows());
  if (eq_.h_omega() > 1) have_history_ = false;
  predict(state, eq_.h);
  if (!frozen_) freeze(eq_.start_pose(), report);
  steered_ = true;
  bool done = false;
  for (int look = 0; look < most_looks && !done; ++look) {
    eq_.place_nodes();
    eq_.look_at_forces(eq_.Q * halfway_);
    if (!(eq_.h_omega() < most_steered && eq_.h_rate() < most_steered)) break;
    stiff_ = forces_are_stiff();
    steering_->take(eq_.h, system_.mass(), eq_.force_by_z(), eq_.force_by_w());
    ++report.factorisations;
    done = frozen_iterations(report);
  }
  steered_ = false;
  return done;
}

// From a step without motion: prolonging oscillations that the step does not resolve leads anywhere, through
// the middle of a spring to its other side, too.
bool Dvm::stiff_iterations(const State& state, StepReport& report) {
  stiff_ = true;
  predict(state, eq_.h);
  eq_.dX.setZero();
  eq_.take_rods_as_unknowns(true);
  report.status = newton_.solve(eq_, wanted, accepted, true, report);
  frozen_ = false;
  return report.ok();
}

// Residuals are computed from the equations themselves every time; the frozen matrix only steers.
bool Dvm::frozen_iterations(StepReport& report) {
  eq_.take_rods_as_unknowns(false);
  careful_ = !system_.constant_forces();  // what is carried asks for more iterations than rods do
  feed_ = true;
  double best_momentum = infinity, best_constraint = infinity, last_momentum = infinity;
  int without_gain = 0;
  bool was_slow = false;
  for (int it = 0; it <= max_frozen_iterations; ++it) {
    eq_.evaluate();
    const double level = eq_.level(), momentum = eq_.momentum_level(), constraint = eq_.constraint_level();
    report.residual = level;
    // What is left of a weak mode's constraint error near round-off would need multipliers of error /
    // sigma^2: leave it.
    if (constraint <= left_constraint_ && constraint > 0.5 * best_constraint) feed_ = false;
    if (momentum <= wanted && constraint <= (feed_ ? wanted_constraint : left_constraint_))
      return report.status = StepStatus::converged, true;
    // Redundant rows answer the constraint error of one iteration with momentum in the next: either may lag.
    const bool gain =
        momentum < 0.5 * best_momentum || (constraint > wanted && constraint < 0.5 * best_constraint);
    best_momentum = std::min(best_momentum, momentum);
    best_constraint = std::min(best_constraint, constraint);
    if (gain) {
      without_gain = 0;
    } else if (careful_ = true; ++without_gain >= 3 || !std::isfinite(level)) {
      if (level <= accepted) return report.status = StepStatus::converged, true;
      break;
    }
    if (it == max_frozen_iterations) break;
    ++report.newton_iterations;
    if (eq_.at_ends) {
      correct_at_ends(report);
      continue;
    }
    // Not through the kinks of cables that go taut within a step.
    const bool slow = !steerable_ && momentum > 4 * wanted && momentum > 0.02 * last_momentum;
    if (slow) with_wide_columns(c_.s - 1, [this, was_slow](auto k) { accelerate<k()>(was_slow); });
    was_slow = slow;
    last_momentum = momentum;
    correct(report);
  }
  report.status = std::isfinite(eq_.level()) ? StepStatus::stalled : StepStatus::not_finite;
  return false;
}

// Anderson's extrapolation of depth one: once single modes are slower than the rest (those of redundant rows,
// whose multipliers hardly move anything, by a third where others take a hundredth), the iterate goes where
// the line through the last two momentum residuals is nearest to zero; all is linear in that iterate.
// Walker & Ni, SIAM J. Numer. Anal. 49 (2011), 1715.
template <LaneCount K>
void Dvm::accelerate(bool extrapolate) {
  Interleaved* const now[] = {&eq_.momentum, &eq_.phi, &eq_.dX, &eq_.lambda};
  double theta = 0;
  if (extrapolate) {
    Lanes<K> along = Lanes<K>::all(0.0), square = along;
    const double *const r = eq_.momentum.data(), *const before = last_[0].data();
    for (Index i = 0, size = eq_.momentum.size(); i < size; i += K) {
      const Lanes<K> x(r + i), change = x - Lanes<K>(before + i);
      along = along + x * change;
      square = square + change * change;
    }
    theta = along.sum() / square.sum();
    if (!(std::abs(theta) < 3)) theta = 0;
  }
  for (std::size_t i = 0; i < last_.size(); ++i) {
    double *const x = now[i]->data(), *const before = last_[i].data();
    for (Index j = 0, size = now[i]->size(); j < size; j += K) {
      const Lanes<K> here(x + j);
      if (theta != 0) (here - theta * (here - Lanes<K>(before + j))).store(x + j);
      here.store(before + j);
    }
  }
}

// M dX_j + G^T Y_j = -h (C^-1 r)_j,  G dX_j = -Phi_j,  then  b_k dlambda_k = -(C Y)_k / h^2.
//
// Where rows of G depend on each other, the part of Phi that no motion can remove (round-off, above all)
// comes back as a multiplier (that part / regularisation), which disturbs the momentum at the other nodes'
// poses. Once the iteration no longer gains, the right-hand side is therefore replaced by what it can reach,
// G times the motion it caused.
void Dvm::correct(StepReport& report) {
  with_columns(c_.s - 1, [this](auto k) { correct_stages<k()>(); });
  report.right_hand_sides += (careful_ ? 2 : 1) * (c_.s - 1);
}

template <LaneCount K>
void Dvm::correct_stages() {
  const Index n = eq_.dX.rows(), m = eq_.lambda.rows();
  double* const f = rhs_f_.data();
  double* const g = rhs_g_.data();
  with_wide<K>(
      [n, f, r = eq_.momentum.data(), T = momentum_to_f_.data()](auto lanes) { mix<lanes()>(r, n, T, f); });
  with_wide<K>([m, g, phi = eq_.phi.data(), this](auto lanes) {
    using Row = Lanes<lanes()>;
    for (Index r = 0; r < m; ++r) beyond(Row::all(0.0) - Row(phi + r * K), left_alone(r)).store(g + r * K);
  });
  if (careful_) std::copy(rhs_f_.begin(), rhs_f_.end(), consistent_f_.data());
  if (careful_) {
    saddle_.apply(f, g, K);
    multiply<K>(G_, f, g);
    std::copy_n(consistent_f_.data(), rhs_f_.size(), f);
  }
  if (steered_)
    steering_->solve(saddle_, f, g);
  else
    saddle_.apply(f, g, K);
  double* const dX = eq_.dX.data();
  for (Index i = 0; i < n * K; ++i) dX[i] += f[i];
  with_wide<K>([m, g, lambda = eq_.lambda.data(), T = y_to_lambda_.data()](auto lanes) {
    constexpr LaneCount all = lanes();
    for (Index r = 0; r < m * K; r += K) mixed<all>(Lanes<all>(lambda + r), g + r, T).store(lambda + r);
  });
}

// One multiplier: Y_j = (C^-1)_j1 / (C^-1)_s1 y with y that of the last node; the other nodes follow from M
// alone. What no motion reaches of Phi is left out from the first iteration on: on the way there dependent
// rows contradict each other by the square of the correction, and the multipliers of that would hide what
// else is left.
void Dvm::correct_at_ends(StepReport& report) {
  const Index last = c_.s - 2, n = eq_.dX.rows();
  const double h = eq_.h;
  Eigen::Map<VectorXd> f(rhs_f_.data(), n), y(rhs_g_.data(), eq_.lambda.rows());
  const auto push = [&] { f.noalias() = -h * (eq_.momentum * c_.C_inverse.row(last).transpose()); };
  push();
  for (Index r = 0; r < y.size(); ++r)
    y[r] = std::abs(eq_.phi(r, last)) > left_alone(r) ? -eq_.phi(r, last) : 0.0;
  saddle_.apply(rhs_f_.data(), rhs_g_.data(), 1);
  y.noalias() = G_ * f;
  push();
  saddle_.apply(rhs_f_.data(), rhs_g_.data(), 1);
  eq_.dX.col(last) += f;
  pull_.noalias() = G_.transpose() * y;
  for (Index j = 0; j < last; ++j) {
    f.noalias() = -h * (eq_.momentum * c_.C_inverse.row(j).transpose());
    f -= (c_.C_inverse(j, 0) / c_.C_inverse(last, 0)) * pull_;
    mass_factor_.solve(f.data(), 1);
    eq_.dX.col(j) += f;
  }
  report.right_hand_sides += static_cast<int>(c_.s);
  eq_.lambda.col(0) -= y / (0.5 * h * h * c_.C_inverse(last, 0));
}

// Takes away what the iteration left of Phi at the end pose where it shows in relative lengths (coordinates
// far from the origin) and a motion of about its own size does so. Weak modes, which would move far, keep
// theirs.
void Dvm::settle_end() {
  constexpr double far = 1000.0, settled = 32 * std::numeric_limits<double>::epsilon();
  const Index last = c_.s - 2;
  const auto relative = [this](const ConstVec& phi) {
    return phi.cwiseQuotient(system_.constraint_lengths()).lpNorm<Eigen::Infinity>();
  };
  if (eq_.phi.rows() == 0) return;
  Eigen::Map<VectorXd> dz(rhs_f_.data(), eq_.dX.rows()), phi(rhs_g_.data(), eq_.phi.rows());
  phi = eq_.phi.col(last);
  const double before = relative(phi);
  if (!(before > settled)) return;
  const double size = phi.lpNorm<Eigen::Infinity>();
  dz.setZero();
  phi *= -1;
  saddle_.apply(dz.data(), phi.data(), 1);
  if (!(dz.lpNorm<Eigen::Infinity>() <= far * size)) return;
  end_z_ = eq_.dX.col(last) + dz;
  dz = eq_.z0 + end_z_;
  system_.expand(dz, end_q_);
  system_.constraint(eq_.t + eq_.h, end_q_, phi);
  if (!(relative(phi) < before)) return;
  eq_.dX.col(last) = end_z_;
  eq_.phi.col(last) = phi;
}

// Does the step end so near to a singular pose that rounding tells its weak mode? Redundant rows look weak,
// too, but do so at its start as well.
bool Dvm::ends_weakly(StepReport& report) {
  const Index before = std::exchange(weak_rows_, saddle_.rows_below(weak_pivot)), below = weak_rows_;
  if (below <= std::max(before, never_weak_)) return false;
  const Index lost = saddle_.rows_below_finely(weak_pivot);
  freeze(eq_.start_pose(), report);
  const bool more = frozen_ && lost > saddle_.rows_below_finely(weak_pivot);
  freeze(pose_, report);
  if (!more) never_weak_ = below;
  return more;
}

// p_1 and the velocity-level constraint: [M G^T; G 0] [w_1; mu] = [p_1 free; g'(t)] at the end pose, mu = h
// b_s lambda_s. The factorisation is the one that the next step starts with.
void Dvm::finish(State& state, double h, StepReport& report) {
  eq_.end_momentum(p1_);
  eq_.pose(c_.s - 1, pose_);
  freeze(pose_, report);
  if (tight_ && frozen_) saddle_.weakest_pivot(needed_pivot_);
  if (system_.rheonomic()) system_.target_rate(state.t + h, rate_);
  saddle_.solve(p1_, rate_, w1_, mu_);
  still(h);
  unheld_.h = 0;
  if (!eq_.rods.held.rods().empty()) hold_lengths(h, report);
  report.right_hand_sides += 1;
  if (!frozen_ || !w1_.allFinite()) {
    report.status = StepStatus::not_finite;
    return;
  }
  if (tight_)
    system_.constraint(state.t + h, pose_, rate_);
  else if (!eq_.at_ends)
    settle_end();
  const auto norm = [](const auto& phi) { return phi.size() ? phi.template lpNorm<Eigen::Infinity>() : 0.0; };
  report.constraint_norm = tight_ ? norm(rate_) : norm(eq_.phi.col(c_.s - 2));
  if (tight_ && !system_.rheonomic()) rate_.setZero();
  previous_ = eq_.dX, previous_h_ = h, have_history_ = true;
  state.t += h;
  arrive(state);
  state.lambda = mu_ / (h * eq_.multiplier_weight(c_.s - 1));
  if (settling_.lets_go()) let_go(h);
  state.w = w1_;
  if (unheld_.h != 0) unheld_.left_z = state.z, unheld_.left_w = state.w;
  state.tension.resize(0), state.tension_error.resize(0);
  state.stage_tension.resize(0, 0);
  const double part = part_of_whole(h), followed = part * resolved * (c_.s - 1);
  const bool unresolved = system_.elastic_rods() != nullptr && eq_.h_omega() > followed && !eq_.held();
  const bool damped = unresolved && system_.has_power(true);
  if (eq_.rods.as_unknowns &&
      (system_.rheonomic() || system_.by_tension() || system_.elastic_rods()->has_power() || damped))
    state.stage_tension = unresolved ? eq_.stage_tension(part * unheld) : eq_.rods.tension;
  if (unresolved) eq_.end_tension(w1_, followed, state.tension, state.tension_error);
  if (damped && !eq_.rods.as_unknowns) state.stage_tension = eq_.rods.tension;  // by lengths there
  if (system_.rheonomic() && !eq_.at_ends && eq_.h_omega() > followed && eq_.others_unresolved(followed) &&
      !eq_.held()) {
    if (state.stage_tension.size() == 0) state.stage_tension = eq_.rods.tension;
    eq_.add_multipliers(state.lambda, state.stage_tension);
  }
  report.weak_end = !eq_.at_ends && ends_weakly(report);
}

// z_1 = z_0 + dX. In steps with care what rounding takes from the sum is added to the next one: near a dead
// centre the motion so far may be a thousand ulp of the coordinates.
void Dvm::arrive(State& state) {
  end_z_ = eq_.dX.col(c_.s - 2);
  if (tight_)
    carried_.add(end_z_, state.z);
  else
    state.z = eq_.z0 + end_z_;
}

std::unique_ptr<Integrator> make_dvm(const System& system, const SolverOptions& options) {
  return std::make_unique<Dvm>(system, options);
}

const Method& careful_dvm() {
  static const Method method{
      "dvm", "", dvm_claims,
      [](const System& system, const SolverOptions& options) -> std::unique_ptr<Integrator> {
        return std::make_unique<Dvm>(system, options, true);
      }};
  return method;
}

}  // namespace unfurl
