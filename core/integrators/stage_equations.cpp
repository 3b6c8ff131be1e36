#include "core/integrators/stage_equations.hpp"

namespace unfurl {

StageEquations::StageEquations(const System& sys, const GalerkinCoefficients& coefficients, bool ends)
    : system(sys), c(coefficients), at_ends(ends) {
  const Index n = system.solved_coordinates(), m = system.constraints(), k = c.s - 1;
  z0.setZero(n);
  p0.setZero(n);
  dX.setZero(n, k);
  momentum.setZero(n, k);
  lambda.setZero(m, k);
  phi.setZero(m, k);
  Q.setZero(system.coordinates(), c.s);
  MdX_.setZero(n, k);
  force_.setZero(system.coordinates(), system.constant_forces() ? 1 : c.s);
  z_.setZero(n);
  f_.setZero(system.coordinates());
  q_tau_.setZero(system.coordinates());
  v_tau_.setZero(system.coordinates());
}

double StageEquations::multiplier_weight(int k) const {
  return at_ends ? 0.5 : c.b[k];
}

void StageEquations::start(double time, const ConstVec& z, const ConstVec& w, double step) {
  t = time;
  h = step;
  z0 = z;
  p0.noalias() = system.mass() * w;
  system.expand(z0, Q.col(0));
  if (system.constant_forces()) {
    force_.setZero();
    system.add_applied_force(t, Q.col(0), v_tau_, 1.0, force_.col(0));
  }
  if (stiffness_ < 0) find_stiffness();
}

void StageEquations::find_stiffness() {
  stiffness_ = 0;
  if (system.constant_forces()) return;
  SparseRows by_z, by_w;
  v_tau_.setZero();
  system.force_derivatives(t, Q.col(0), v_tau_, by_z, by_w);
  for (int r = 0; r < by_z.outerSize(); ++r)
    for (SparseRows::InnerIterator it(by_z, r); it; ++it)
      stiffness_ = std::max(stiffness_, std::abs(it.value()));
}

// f += h sum_j w_j l_k(tau_j) F(tau_j)
void StageEquations::add_forces(int k, MutVec f) {
  if (system.constant_forces()) {
    f.noalias() += (h * c.b[k]) * force_.col(0);
    return;
  }
  for (int j = 0; j < c.s; ++j) f.noalias() += (h * c.weight[j] * c.value(k, j)) * force_.col(j);
}

void StageEquations::place_nodes() {
  for (int j = 0; j + 1 < c.s; ++j) {
    z_ = z0 + dX.col(j);
    system.expand(z_, Q.col(j + 1));
  }
}

void StageEquations::evaluate() {
  const int stages = c.s - 1;
  place_nodes();
  for (int j = 0; j < stages; ++j) {
    if (!at_ends || j == stages - 1)
      system.constraint(t + c.basis.nodes()[j + 1] * h, Q.col(j + 1), phi.col(j));
    MdX_.col(j).noalias() = system.mass() * dX.col(j);
  }
  if (!system.constant_forces()) {
    force_.setZero();
    for (int j = 0; j < c.s; ++j) {
      q_tau_.noalias() = Q * c.value.col(j);
      v_tau_.noalias() = Q * c.slope.col(j) / h;
      system.add_applied_force(t + c.tau[j] * h, q_tau_, v_tau_, 1.0, force_.col(j));
    }
  }
  force_scale_ = 0;
  for (int k = 0; k < stages; ++k) {
    f_.setZero();
    add_forces(k, f_);
    if (!at_ends || k == 0)
      system.add_constraint_force(Q.col(k), lambda.col(k), -h * multiplier_weight(k), f_);
    force_scale_ = std::max(force_scale_, f_.lpNorm<Eigen::Infinity>());
    // Rows have unit gradients: single rod forces may far exceed their sum.
    if (lambda.rows())
      force_scale_ = std::max(force_scale_,
                              std::abs(h * multiplier_weight(k)) * lambda.col(k).lpNorm<Eigen::Infinity>());
    system.reduce_force(f_, momentum.col(k));
    for (int j = 0; j < stages; ++j) momentum.col(k) += (c.C(k, j) / h) * MdX_.col(j);
  }
  momentum.col(0) += p0;
  measure();
}

// Momentum: compared with the sizes of the terms that cancel in it, and with what rounding the coordinates
// leaves of spring forces. Constraints: with the larger of a row's
// length and the coordinates, whose rounding moves a row by that much.
void StageEquations::measure() {
  reach_ = Q.lpNorm<Eigen::Infinity>();
  double size = force_scale_ + p0.lpNorm<Eigen::Infinity>();
  size = std::max(size, std::abs(h) * stiffness_ * reach_);
  size = std::max(size, MdX_.lpNorm<Eigen::Infinity>() * c.C.lpNorm<Eigen::Infinity>() / std::abs(h));
  momentum_level_ = size > 0 ? momentum.lpNorm<Eigen::Infinity>() / (4 * ulp * size) : 0.0;
  constraint_level_ = 0;
  for (Index j = 0; j < phi.cols(); ++j)
    for (Index r = 0; r < phi.rows(); ++r)
      constraint_level_ = std::max(constraint_level_, std::abs(phi(r, j)) / constraint_noise(r));
  if (!momentum.allFinite() || !phi.allFinite())
    momentum_level_ = constraint_level_ = std::numeric_limits<double>::infinity();
}

void StageEquations::end_momentum(MutVec p1) {
  const int last = c.s - 1;
  f_.setZero();
  add_forces(last, f_);
  system.reduce_force(f_, p1);
  for (int j = 0; j < last; ++j) p1 += (c.K(last, j + 1) / h) * MdX_.col(j);
}

}  // namespace unfurl
