// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/generalized_alpha.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/integrators/index1.hpp"
#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

constexpr int max_iterations = 40, frozen_iterations = 8;
// Residual levels: 1 is what round-off leaves. Up to `accepted_level` a stalled iteration counts as
// converged.
constexpr double wanted_level = 2.0, accepted_level = 100.0;
constexpr double ulp = std::numeric_limits<double>::epsilon();
// Where forces vary, corrections that leave more than this share of the residual take their derivatives in.
constexpr double contracting = 0.1;

class GeneralizedAlpha final : public Integrator {
 public:
  GeneralizedAlpha(const System& system, double rho)
      : system_(system),
        alpha_m_((2 * rho - 1) / (rho + 1)),
        alpha_f_(rho / (rho + 1)),
        gamma_(0.5 + alpha_f_ - alpha_m_),
        beta_(0.25 * (gamma_ + 0.5) * (gamma_ + 0.5)),
        start_(system),
        G_(system.jacobian_pattern()),
        saddle_(system.mass(), G_) {
    for (VectorXd* v :
         {&a0_, &a_, &acceleration0_, &acceleration_, &z_, &w_, &free_z_, &residual_, &dz_, &inertia_})
      v->setZero(system.solved_coordinates());
    for (VectorXd* v : {&lambda_, &dlambda_, &phi_, &offset_}) v->setZero(system.constraints());
    for (VectorXd* v : {&q_, &v_, &force_}) v->setZero(system.coordinates());
  }

  StepReport step(State& state, double h) override {
    StepReport report;
    if (!begin(state, report)) return report;
    predict(state, h);
    iterate(state, h, report);
    if (!report.ok()) {
      restart();
      return report;
    }
    a0_ = a_;
    acceleration0_ = acceleration_;
    state.t += h;
    state.z = z_;
    state.w = w_;
    state.lambda = lambda_;
    return report;
  }

  void restart() override { have_acceleration_ = false; }

 private:
  bool begin(const State& state, StepReport& report);
  void predict(const State& state, double h);
  void set_pose(const State& state, double h);
  double evaluate(double t);
  void correct(double h, StepReport& report);
  bool correct_with_forces(double t, double h, StepReport& report);
  void iterate(const State& state, double h, StepReport& report);
  double newton_scale(double h) const { return (1 - alpha_m_) / (h * h * beta_ * (1 - alpha_f_)); }

  const System& system_;
  double alpha_m_, alpha_f_, gamma_, beta_;
  Index1 start_;
  SparseRows G_;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  VectorXd a0_, a_, acceleration0_, acceleration_;  // algorithmic and true accelerations [m/s^2]
  VectorXd z_, w_, free_z_, residual_, dz_, inertia_, lambda_, dlambda_, phi_, offset_, q_, v_, force_;
  bool have_acceleration_ = false;
};

// A first step has no algorithmic acceleration to go on from: it takes the true one.
bool GeneralizedAlpha::begin(const State& state, StepReport& report) {
  if (have_acceleration_) return true;
  ++report.factorisations;
  ++report.right_hand_sides;
  if (!start_.evaluate(state.t, state.z, state.w, acceleration0_, lambda_)) {
    report.status = StepStatus::not_finite;
    return false;
  }
  a0_ = acceleration0_;
  return have_acceleration_ = true;
}

// Unchanged acceleration and multipliers.
void GeneralizedAlpha::predict(const State& state, double h) {
  lambda_ = state.lambda;
  acceleration_ = acceleration0_;
  free_z_ = state.z + h * state.w + h * h * (0.5 - beta_) * a0_;
  set_pose(state, h);
}

// a_1, z_1, w_1 that belong to w'_1.
void GeneralizedAlpha::set_pose(const State& state, double h) {
  a_ = ((1 - alpha_f_) * acceleration_ + alpha_f_ * acceleration0_ - alpha_m_ * a0_) / (1 - alpha_m_);
  z_ = free_z_ + h * h * beta_ * a_;
  w_ = state.w + h * ((1 - gamma_) * a0_ + gamma_ * a_);
}

// Residuals at the present pose; returns their size in units of what round-off leaves of them.
double GeneralizedAlpha::evaluate(double t) {
  system_.expand(z_, q_);
  system_.expand_rate(w_, v_);
  system_.constraint(t, q_, phi_);
  force_.setZero();
  system_.add_applied_force(t, q_, v_, 1.0, force_);
  system_.add_constraint_force(q_, lambda_, -1.0, force_);
  system_.reduce_force(force_, residual_);
  inertia_.noalias() = system_.mass() * acceleration_;
  const double size = std::max({residual_.lpNorm<Eigen::Infinity>(), inertia_.lpNorm<Eigen::Infinity>(),
                                lambda_.size() ? lambda_.lpNorm<Eigen::Infinity>() : 0.0, 1e-300});
  residual_ = inertia_ - residual_;
  double level = residual_.lpNorm<Eigen::Infinity>() / (8 * ulp * size);
  const double reach = q_.lpNorm<Eigen::Infinity>();
  for (Index r = 0; r < phi_.size(); ++r)
    level = std::max(level, std::abs(phi_[r]) / (2 * ulp * std::max(system_.constraint_lengths()[r], reach)));
  return residual_.allFinite() && phi_.allFinite() ? level : std::numeric_limits<double>::infinity();
}

// M dz + G^T (dlambda / b) = -r / b,  G dz = -Phi,  dw' = b dz.
void GeneralizedAlpha::correct(double h, StepReport& report) {
  const double b = newton_scale(h);
  residual_ *= -1.0 / b;
  offset_ = -phi_;
  saddle_.solve(residual_, offset_, dz_, dlambda_, 1);
  acceleration_ += b * dz_;
  lambda_ += b * dlambda_;
  ++report.right_hand_sides;
  ++report.newton_iterations;
}

// The same with the derivatives of the forces, of which the others know nothing:
//     (M - (dF/dz + gamma / (h beta) dF/dw) / b) dz + G^T (dlambda / b) = -r / b,  G dz - e dlambda / b =
//     -Phi
// rows and columns scaled as in SaddleSolver. For forces that are stiff at this step; allocates.
bool GeneralizedAlpha::correct_with_forces(double t, double h, StepReport& report) {
  const double b = newton_scale(h), by_rate = gamma_ / (h * beta_);
  const Index n = z_.size(), m = phi_.size();
  SparseRows by_z, by_w;
  system_.force_derivatives(t, q_, v_, by_z, by_w);
  system_.jacobian(q_, G_, scratch_);
  VectorXd scale = VectorXd::Ones(n + m);
  for (Index i = 0; i < n; ++i) scale[i] = 1.0 / std::sqrt(system_.mass().coeff(i, i));
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index row, Index column, double value) {
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value * scale[row] * scale[column]);
  };
  const auto add_all = [&](const SparseRows& A, double factor) {
    for (int r = 0; r < A.outerSize(); ++r)
      for (SparseRows::InnerIterator it(A, r); it; ++it) add(r, it.col(), factor * it.value());
  };
  add_all(system_.mass(), 1.0);
  add_all(by_z, -1.0 / b);
  add_all(by_w, -by_rate / b);
  for (int r = 0; r < G_.outerSize(); ++r) {
    double square = 0;
    for (SparseRows::InnerIterator it(G_, r); it; ++it) square += std::pow(it.value() * scale[it.col()], 2);
    if (square > 0) scale[n + r] = 1.0 / std::sqrt(square);
    for (SparseRows::InnerIterator it(G_, r); it; ++it)
      add(n + r, it.col(), it.value()), add(it.col(), n + r, it.value());
    entries.emplace_back(static_cast<int>(n + r), static_cast<int>(n + r),
                         -SaddleSolver::standard_regularisation);
  }
  Eigen::SparseMatrix<double> A(n + m, n + m);
  A.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(A);
  ++report.factorisations;
  if (factors.info() != Eigen::Success) return false;
  VectorXd right(n + m);
  right << residual_ / -b, -phi_;
  const VectorXd x = scale.cwiseProduct(VectorXd(factors.solve(scale.cwiseProduct(right))));
  acceleration_ += b * x.head(n);
  lambda_ += b * x.tail(m);
  ++report.right_hand_sides;
  ++report.newton_iterations;
  return x.allFinite();
}

void GeneralizedAlpha::iterate(const State& state, double h, StepReport& report) {
  double best = std::numeric_limits<double>::infinity(), before = best;
  int without_gain = 0;
  bool stiff = false;
  for (int it = 0;; ++it) {
    const double level = evaluate(state.t + h);
    report.residual = level;
    report.constraint_norm = phi_.size() ? phi_.lpNorm<Eigen::Infinity>() : 0.0;
    if (level <= wanted_level) return;
    without_gain = level < 0.5 * best ? 0 : without_gain + 1;
    best = std::min(best, level);
    if (without_gain >= 3 && level <= accepted_level) return;
    if (it == max_iterations || !std::isfinite(level)) break;
    stiff = stiff || (it > 1 && !system_.constant_forces() && level > contracting * before);
    before = level;
    if (stiff) {
      if (!correct_with_forces(state.t + h, h, report)) {
        report.status = StepStatus::diverged;
        return;
      }
      set_pose(state, h);
      continue;
    }
    if (it % frozen_iterations == 0) {
      system_.jacobian(q_, G_, scratch_);
      ++report.factorisations;
      if (!saddle_.factorise(G_)) {
        report.status = StepStatus::diverged;
        return;
      }
    }
    correct(h, report);
    set_pose(state, h);
  }
  report.status = std::isfinite(report.residual) ? StepStatus::stalled : StepStatus::not_finite;
}

}  // namespace

Claims generalized_alpha_claims(const SolverOptions&) {
  return {.order = 2, .implicit = true, .holds_positions = true};
}

std::unique_ptr<Integrator> make_generalized_alpha(const System& system, const SolverOptions& options) {
  return std::make_unique<GeneralizedAlpha>(system, options.rho_inf);
}

}  // namespace unfurl
