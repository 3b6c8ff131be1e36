// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/stage_equations.hpp"

#include "core/math/factors.hpp"

namespace unfurl {

StageEquations::StageEquations(const System& sys, const GalerkinCoefficients& coefficients, bool ends)
    : system(sys),
      c(coefficients),
      at_ends(ends),
      rods(sys, coefficients),
      parts(sys),
      C_size_(coefficients.C.lpNorm<Eigen::Infinity>()),
      rows_(sys) {
  const Index n = system.solved_coordinates(), m = system.constraints(), k = c.s - 1,
              nodes = system.coordinates();
  z0.setZero(n);
  p0.setZero(n);
  for (Interleaved* x : {&dX, &momentum, &Z_, &MdX_}) x->setZero(n, k);
  for (Interleaved* x : {&lambda, &phi}) x->setZero(m, k);
  Q.setZero(nodes, c.s);
  for (Interleaved* x : {&f_, &applied_}) x->setZero(nodes, k);
  force_.setZero(nodes, system.constant_forces() ? 1 : c.s - 1);
  impulse_.setZero(c.s, force_.cols());
  w_tau_.setZero(n);
  w_0_.setZero(n);
  least_mass_ = system.mass().diagonal().minCoeff();
  shortest_ = m > 0 ? system.constraint_lengths().minCoeff() : std::numeric_limits<double>::infinity();
  steepest_ = c.slope.cwiseAbs().colwise().sum().maxCoeff();
  C_by_h_.setZero(k, k);
  for (VectorXd* x : {&time_, &scale_}) x->setZero(k);
  for (VectorXd* x : {&f_end_, &q_0_, &q_tau_, &v_tau_, &scratch_.q, &scratch_.f}) x->setZero(nodes);
  scratch_.row.setZero(m);
}

double StageEquations::multiplier_weight(int k) const {
  return at_ends ? 0.5 : c.b[k];
}

void StageEquations::start(double time, const ConstVec& z, const ConstVec& w, double step) {
  t = time;
  const bool same_step = h == step;
  h = step;
  step_sizes_known_ = turned_known_ = false;
  z0 = z;
  multiply<1>(system.mass(), w.data(), p0.data());
  start_size_ = largest_magnitude(p0.data(), p0.size());
  system.expand(z0, q_0_);
  Q.col(0) = q_0_;
  for (Index k = 0; k < time_.size(); ++k) time_[k] = t + c.basis.nodes()[k + 1] * h;
  if (!same_step) use_step();
  if (!system.constant_forces()) w_0_ = w;
  if (stiffness_ < 0) look_at_forces();
  if (reach_ == 0) reach_ = largest_magnitude(q_0_.data(), q_0_.size());
  find_reach();
}

// What goes by the size of the step alone.
void StageEquations::use_step() {
  for (Index k = 0; k < scale_.size(); ++k) scale_[k] = -h * multiplier_weight(static_cast<int>(k));
  C_by_h_ = c.C / h;  // D_k S = (1/h) sum_j C_kj M dX_j + ...
  if (!system.constant_forces()) {
    impulse_ = h * (c.value * c.weight.asDiagonal());
    return;
  }
  impulse_ = h * c.b;
  force_.setZero();
  system.add_applied_force(t, q_0_, v_tau_, 1.0, force_.col(0));
  with_wide_columns(c.s - 1, [this](auto k) { spread_forces<k()>(); });
}

void StageEquations::look_at_forces(const VectorXd& q) {
  stiffness_ = damping_ = omega_ = rate_ = 0;
  looked_ = t;
  if (system.constant_forces()) return;
  system.expand_rate(w_0_, v_tau_);
  system.force_derivatives(t, q, v_tau_, derivatives_);
  by_z_ = derivatives_.by_z.sum();
  by_w_ = derivatives_.by_w.sum();
  parts.look(t, q, v_tau_);
  for (SparseRows* A : {&by_z_, &by_w_}) A->prune(0.0);  // of what is slack
  const VectorXd m = system.moving_mass();
  omega_ = std::sqrt(rate_bound(by_z_, m));
  rate_ = rate_bound(by_w_, m);
  // Forces that are unknowns are not known by rounded coordinates.
  if (rods.as_unknowns) system.force_derivatives(t, q, v_tau_, rods.tension.col(0), by_z_, by_w_);
  stiffness_ = largest_of_moving(by_z_, m);
  damping_ = largest_of_moving(by_w_, m);
}

bool StageEquations::look_at_turned_forces() {
  if (system.constant_forces() || !step_sizes_known_ || turned_known_) return false;
  turned_known_ = true;
  SparseRows by_z, by_w;
  force_derivatives(c.tau.size() - 1, by_z, by_w);
  rows_.restart(step_sizes_);
  rows_.add_stiffness(by_z, h);
  step_sizes_ = rows_.size();
  return true;
}

double StageEquations::h_omega() const {
  return std::abs(h) * omega_;
}

// Where the step has looked at its start, with what rods pull across, that may tell already.
bool StageEquations::others_unresolved(double resolved) {
  const VectorXd m = system.moving_mass();
  if (rods.as_unknowns && looked_ == t && std::abs(h) * std::sqrt(rate_bound(by_z_, m)) <= resolved)
    return false;
  const Index j = c.tau.size() - 1;
  move_to(j);
  SparseRows by_z, by_w;
  if (rods.any())
    system.force_derivatives(t + c.tau[j] * h, q_tau_, v_tau_, VectorXd::Zero(rods.tension.rows()), by_z,
                             by_w);
  else
    system.force_derivatives(t + c.tau[j] * h, q_tau_, v_tau_, by_z, by_w);
  return std::abs(h) * std::sqrt(rate_bound(by_z, m)) > resolved;
}

double StageEquations::h_rate() const {
  return std::abs(h) * rate_;
}

void StageEquations::take_rods_as_unknowns(bool unknowns) {
  if (!rods.tension.allFinite()) rods.tension.setZero();
  if (!rods.any() || unknowns == rods.as_unknowns) return;
  rods.as_unknowns = unknowns;
  look_at_forces();
}

// Rows go by the reach of their own nodes where that of all is far beyond the shortest length.
void StageEquations::find_reach() {
  far_ = reach_ > far_reach * shortest_;
  if (!far_ && !parts.several()) return;
  start_rows();
  if (!far_) return;
  row_reach_.resize(system.constraints());
  for (Index r = 0; r < row_reach_.size(); ++r)
    row_reach_[r] = parts.several() ? parts.reach(r, rows_) : rows_.reach(r);
}

void StageEquations::start_rows() {
  if (!parts.several()) return rows_.start(q_0_);
  parts.start(q_0_);
  rows_.start_with(parts.reaches());
}

void StageEquations::place_nodes() {
  with_wide_columns(c.s - 1, [n = dX.rows(), z = z0.data(), d = dX.data(), to = Z_.data()](auto k) {
    constexpr LaneCount K = k();
    for (Index i = 0; i < n; ++i) (Lanes<K>::all(z[i]) + Lanes<K>(d + i * K)).store(to + i * K);
  });
  system.expand_stages(Z_, 1, Q);
}

void StageEquations::evaluate() {
  place_nodes();
  if (in_increments)
    constraint_changes();
  else
    system.constraint_stages(time_.data(), Q, 1, phi, scratch_);
  if (at_ends) phi.leftCols(c.s - 2).setZero();
  if (!system.constant_forces()) applied_forces();
  evaluate_momentum();
  measure();
}

void StageEquations::constraint_changes() {
  if (!system.rheonomic() && system.constraint_changes(q_0_, dX, phi, scratch_)) return;
  if (!increment_) increment_ = std::make_unique<ConstraintIncrement>(system);
  increment_->start(t, q_0_);
  phi_j_.resize(phi.rows());
  for (Index j = 0; j < phi.cols(); ++j) {
    dX_j_ = dX.col(j);
    increment_->evaluate(time_[j], dX_j_, phi_j_);
    phi.col(j) = phi_j_;
  }
}

// Pose and velocity at point j of the quadrature, from the increments: what rounding leaves of the velocity
// goes by the motion.
void StageEquations::move_to(Index j) {
  q_tau_.noalias() = Q * c.value.col(j);
  w_tau_.noalias() = dX * c.slope.col(j).tail(c.s - 1);
  w_tau_ /= h;
  system.expand_rate(w_tau_, v_tau_);
}

void StageEquations::applied_forces() {
  force_.setZero();
  rods.start_measuring();
  for (Index j = 0; j < c.tau.size(); ++j) {
    move_to(j);
    const double at = t + c.tau[j] * h;
    if (rods.as_unknowns) {
      system.add_other_force(at, q_tau_, v_tau_, rods.tension.col(j), 1.0, force_.col(j));
      rods.evaluate(j, at, q_tau_, v_tau_, force_.col(j));
    } else {
      system.add_applied_force(at, q_tau_, v_tau_, 1.0, force_.col(j));
    }
  }
}

bool StageEquations::end_by_motion(const VectorXd& w_1, double resolved, VectorXd& tension) {
  for (Index j = 0; j < c.tau.size() && !rods.as_unknowns; ++j) {
    move_to(j);
    rods.take_from_lengths(j, t + c.tau[j] * h, q_tau_, v_tau_);
  }
  const bool tells = !others_unresolved(resolved);
  q_tau_ = Q.col(c.s - 1);
  system.expand_rate(w_1, v_tau_);
  tension.resize(rods.tension.rows());
  system.giving_rod_forces(t + h, q_tau_, v_tau_, tension);
  if (tells && !rods.held.rods().empty()) rods.held.find_forces(t + h, q_tau_, v_tau_, tension);
  return tells;
}

VectorXd StageEquations::held_tension(const VectorXd& w_1, double resolved) {
  VectorXd tension;
  if (!end_by_motion(w_1, resolved, tension)) return {};
  tension = rods.tension * c.tau_to_end;
  rods.held.find_forces(t + h, q_tau_, v_tau_, tension);
  return tension;
}

void StageEquations::end_tension(const VectorXd& w_1, double resolved, VectorXd& tension, VectorXd& error) {
  const bool tells = end_by_motion(w_1, resolved, tension), few = c.s < fewest_that_tell;
  VectorXd by_lengths(tension.size());
  system.giving_rod_forces(t + h, q_tau_, v_tau_, by_lengths);
  const SparseRows directions = system.giving_rod_directions(q_tau_);
  const std::vector<Index>& held = rods.held.rods();
  const auto is_held = [&](Index i) { return std::binary_search(held.begin(), held.end(), i); };
  std::vector<Index> fast;
  for (Index i = 0; i < tension.size(); ++i)
    if (rods.h_omega(i, h, directions) > resolved) fast.push_back(i);
  for (const Index i : fast)
    if (!tells || !(few || is_held(i))) tension[i] = rods.tension.row(i).dot(c.tau_to_end);
  VectorXd without = tension, amplitude = VectorXd::Zero(tension.size());
  const bool told = tells && take_unresolved(fast, directions, resolved);
  if (told) {
    rods.unresolved.find_forces(t + h, q_tau_, v_tau_, without);
    amplitude = resolved / h * rods.unresolved.impulse(t + h, w_1);
  }
  error.setZero(tension.size());
  for (const Index i : fast) {
    const double rate = rods.rate_over_omega(i, t + h, w_1, directions),
                 of_modes = std::hypot(tension[i] - without[i], amplitude[i]);
    if (is_held(i))
      error[i] = told ? of_modes : std::abs(rate);
    else
      error[i] = std::max(of_modes, std::hypot(by_lengths[i] - (few && told ? without : tension)[i], rate));
  }
  if (few && told) tension = without;
}

bool StageEquations::take_unresolved(std::vector<Index> fast, const SparseRows& directions, double stiff) {
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  system.jacobian(q_tau_, G, scratch);
  return rods.unresolved.take(std::move(fast), h, stiff, G, directions);
}

MatrixXd StageEquations::stage_tension(double beyond) {
  MatrixXd out = rods.tension;
  for (Index j = 0; j < c.tau.size() && c.s < fewest_that_tell; ++j) {
    move_to(j);
    const SparseRows directions = system.giving_rod_directions(q_tau_);
    std::vector<Index> fast;
    for (Index i = 0; i < directions.rows(); ++i)
      if (rods.h_omega(i, h, directions) > beyond) fast.push_back(i);
    VectorXd tension = out.col(j);
    if (!take_unresolved(std::move(fast), directions, 0.1 * beyond)) continue;
    rods.unresolved.find_forces(t + c.tau[j] * h, q_tau_, v_tau_, tension);
    out.col(j) = tension;
  }
  return out;
}

void StageEquations::add_multipliers(const VectorXd& last, MatrixXd& tension) const {
  const Index rods_above = tension.rows();
  tension.conservativeResize(rods_above + last.size(), c.tau.size());
  tension.bottomRows(last.size()) = lambda * c.value.topRows(c.s - 1) + last * c.value.row(c.s - 1);
}

bool StageEquations::held() {
  constexpr Index most_coordinates = 300;  // of a rank by dense factors
  if (held_) return *held_;
  const Index n = dX.rows();
  held_ = phi.rows() >= n && n <= most_coordinates;
  if (*held_) {
    SparseRows G = system.jacobian_pattern();
    std::vector<double> scratch;
    system.jacobian(q_0_, G, scratch);
    held_ = rank_of(MatrixXd(G)) == n;
  }
  return *held_;
}

void StageEquations::force_derivatives(Index j, SparseRows& by_z, SparseRows& by_w) {
  move_to(j);
  const double at = t + c.tau[j] * h;
  if (rods.as_unknowns)
    system.force_derivatives(at, q_tau_, v_tau_, rods.tension.col(j), by_z, by_w);
  else
    system.force_derivatives(at, q_tau_, v_tau_, by_z, by_w);
}

SparseRows StageEquations::tension_derivatives(Index j) {
  move_to(j);
  return system.tension_derivatives(t + c.tau[j] * h, q_tau_, v_tau_, rods.tension.col(j));
}

void StageEquations::rod_derivatives(Index j, SparseRows& directions, SparseRows& by_z, SparseRows& by_w) {
  move_to(j);
  directions = system.giving_rod_directions(q_tau_);
  system.giving_rod_rows(q_tau_, v_tau_, by_z, by_w);
}

// h sum_j w_j l_k(tau_j) F(tau_j)
template <LaneCount K>
void StageEquations::spread_forces() {
  for (Index i = 0, nodes = applied_.rows(); i < nodes; ++i) {
    Lanes<K> sum = Lanes<K>::all(0.0);
    for (Index j = 0; j < force_.cols(); ++j)
      sum = sum + force_.data()[j * nodes + i] * Lanes<K>(impulse_.data() + j * c.s);
    sum.store(applied_.data() + i * K);
  }
}

// B^T f_k + (1/h) sum_j C_kj M dX_j with f_k = h sum_j w_j l_k(tau_j) F(tau_j) - h b_k G(Q_k)^T lambda_k
void StageEquations::evaluate_momentum() {
  if (!system.constant_forces()) with_wide_columns(c.s - 1, [this](auto k) { spread_forces<k()>(); });
  std::copy_n(applied_.data(), applied_.size(), f_.data());
  system.add_constraint_force_stages(Q, 0, lambda, scale_.data(), f_, scratch_);
  system.reduce_force_stages(f_, momentum);
  with_wide_columns(c.s - 1, [this](auto k) { add_inertia<k()>(); });
  force_scale_ = std::max(force_scale_, largest_magnitude(f_.data(), f_.size()));
}

template <LaneCount K>
void StageEquations::add_inertia() {
  const Index n = dX.rows(), m = lambda.rows();
  const SparseRows& M = system.mass();
  // Rows have unit gradients: single rod forces may far exceed their sum.
  Lanes<K> most = Lanes<K>::all(0.0);
  const double* const multiplier = lambda.data();
  for (Index i = 0; i < m; ++i) most = larger(most, Lanes<K>(multiplier + i * K));
  force_scale_ = larger(Lanes<K>::all(0.0), most * Lanes<K>(scale_.data())).largest();

  Lanes<K> inertia = Lanes<K>::all(0.0), rest = inertia;
  most = inertia;
  const double *const x = dX.data(), *const C = C_by_h_.data(), *const p = p0.data();
  double *const out = momentum.data(), *const out_MdX = MdX_.data();
  for (Index i = 0; i < n; ++i) {
    double Mx[K];
    const Lanes<K> MdX = row_times<K>(M, i, x);
    MdX.store(Mx);
    MdX.store(out_MdX + i * K);
    inertia = larger(inertia, MdX);
    double* const r = out + i * K;
    mixed<K>(Lanes<K>(r), Mx, C).store(r);
    r[0] += p[i];
    most = larger(most, Lanes<K>(r));
    rest = rest + 0.0 * Lanes<K>(r);
  }
  finite_ = rest.sum() == 0.0;
  inertia_size_ = inertia.largest();
  momentum_size_ = most.largest();
}

// The largest |Phi_r| / constraint_noise(r).
template <LaneCount K>
void StageEquations::measure_constraints() {
  Lanes<K> rest = Lanes<K>::all(0.0);
  double level = 0;
  const double* const length = system.constraint_lengths().data();
  const double* const reach = far_ ? row_reach_.data() : nullptr;
  const double whole = reach_;
  for (Index r = 0, rows = phi.rows(); r < rows; ++r) {
    const Lanes<K> row(phi.data() + r * K);
    const double noise = unfurl::constraint_noise(length[r], reach ? reach[r] : whole);
    level = std::max(level, larger(Lanes<K>::all(0.0), row).largest() / noise);
    rest = rest + 0.0 * row;
  }
  finite_ = finite_ && rest.sum() == 0.0;
  constraint_level_ = level;
}

// Sizes go by the largest of the nodes, in one pass over each of the stages' arrays.
template <LaneCount K>
void StageEquations::measure_rows() {
  const auto largest = [](const Interleaved& x, Index i) {
    return larger(Lanes<K>::all(0.0), Lanes<K>(x.data() + i * K)).largest();
  };
  const auto add_applied = [&] {
    forces_.resize(applied_.rows());
    for (Index i = 0; i < forces_.size(); ++i) forces_[i] = largest(applied_, i);
    rows_.add_forces(forces_);
  };
  if (looked_ != t) look_at_forces();
  const bool constant = system.constant_forces();
  if (step_sizes_known_) {
    rows_.restart(step_sizes_);
  } else {
    start_rows();
    rows_.add(p0);
    if (constant) add_applied();
    step_sizes_ = rows_.size();
    step_sizes_known_ = true;
  }
  if (!constant) add_applied();
  if (rods.as_unknowns) {
    rod_sizes_.setZero(Q.rows());
    rods.add_sizes(h, rod_sizes_);
    rows_.add_forces(rod_sizes_);
  }
  const double weight = scale_.lpNorm<Eigen::Infinity>();
  for (Index r = 0; r < lambda.rows(); ++r) rows_.add_multiplier(r, weight * largest(lambda, r));
  motion_.resize(dX.rows());
  for (Index i = 0; i < motion_.size(); ++i) motion_[i] = largest(dX, i);
  if (!constant && !parts.several())
    motion_ = motion_.cwiseMax(beside_motion * motion_.lpNorm<Eigen::Infinity>());
  else if (!constant)
    motion_ = motion_.cwiseMax(beside_motion * parts.spread(parts.largest(motion_.data())));
  rows_.add_inertia(motion_, C_size_ / h);
  if (stiffness_ > 0) rows_.add_stiffness(by_z_, h);
  if (damping_ > 0) rows_.add_products(by_w_, motion_, steepest_);
  momentum_level_ = 0;
  const VectorXd least = parts.several() ? parts.least(std::abs(h)) : VectorXd();
  for (Index i = 0; i < momentum.rows(); ++i) {
    const double error = largest(momentum, i);
    const double size = least.size() > 0 ? std::max(least[i], rows_.size()[i]) : rows_.size()[i];
    if (error > 0) momentum_level_ = std::max(momentum_level_, error / (momentum_noise * size));
  }
}

// Momentum: compared with the sizes of the terms that cancel in it, and with what rounding the coordinates
// leaves of spring forces, the increments of damping forces. Constraints: with the larger of a row's length
// and the coordinates, whose rounding moves a row by that much.
void StageEquations::measure() {
  reach_ = largest_magnitude(Q.data(), Q.size());
  if (rods.as_unknowns) force_scale_ = std::max(force_scale_, std::abs(h) * rods.largest_force());
  double size = force_scale_ + start_size_;
  size = std::max(size, std::abs(h) * stiffness_ * reach_);
  size = std::max(size, inertia_size_ * C_size_ / std::abs(h));
  if (damping_ > 0) size = std::max(size, damping_ * steepest_ * largest_magnitude(dX.data(), dX.size()));
  momentum_level_ = size > 0 ? momentum_size_ / (momentum_noise * size) : 0.0;
  if (far_ || std::abs(h) * size > harmless_noise * least_mass_ * reach_)
    with_columns(c.s - 1, [this](auto k) { measure_rows<k()>(); });
  with_wide_columns(c.s - 1, [this](auto k) { measure_constraints<k()>(); });
  if (rods.as_unknowns) {
    constraint_level_ = std::max(constraint_level_, rods.level());
    finite_ = finite_ && std::isfinite(rods.level());
  }
  if (!finite_) momentum_level_ = constraint_level_ = std::numeric_limits<double>::infinity();
}

// p_1 = D_s S, taken as the sum over all nodes, of which the others' are zero (D_1 S = -p_0): because
// sum_k l_k' = 0, nothing is left of the kinetic terms but p_0, and what rounding makes of the coefficients
// does not feed the momentum step by step.
void StageEquations::end_momentum(MutVec p1) {
  f_end_.noalias() = force_ * impulse_.row(c.s - 1).transpose();
  with_columns(c.s - 1, [rows = f_.rows(), f = f_.data(), to = f_end_.data()](auto k) {
    for (Index i = 0; i < rows; ++i) to[i] += Lanes<k()>(f + i * k()).sum();
  });
  system.reduce_force(f_end_, p1);
  p1 += p0;
}

}  // namespace unfurl
