// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/generalized_alpha.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/integrators/index1.hpp"
#include "core/integrators/row_noise.hpp"
#include "core/integrators/stage_equations.hpp"
#include "core/math/factors.hpp"
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
// Up to these h^2 dF/dz / m and h dF/dw / m a step begins with the true acceleration. Of rods, springs and
// their masses h omega is below 4 then and h c / m below 3: by the recursion (3 x 3) nothing gains up to 5
// and 3, however often steps begin anew.
constexpr double resolved_stiffness = 4.0, resolved_damping = 0.5;
// A step that is so many times as long as the one before it begins anew.
constexpr double longer = 2.0, same_step = 1e-9;

class GeneralizedAlpha final : public Integrator {
 public:
  GeneralizedAlpha(const System& system, double rho)
      : system_(system),
        steady_(steady_weights(rho)),
        stiff_first_{rho / (rho + 1), 0.0, 0.5, 1.0},
        start_(system),
        G_(system.jacobian_pattern()),
        saddle_(system.mass(), G_),
        least_mass_(system.mass().diagonal().minCoeff()),
        least_moving_(system.moving_mass().minCoeff()),
        rows_(system),
        parts_(system) {
    lead_ = steady_.alpha_m - steady_.alpha_f;
    for (VectorXd* v :
         {&a0_, &a_, &change_, &acceleration0_, &acceleration_, &z_, &w_, &residual_, &dz_, &inertia_})
      v->setZero(system.solved_coordinates());
    for (VectorXd* v : {&lambda_, &dlambda_, &phi_, &offset_}) v->setZero(system.constraints());
    for (VectorXd* v : {&q_, &v_, &force_, &applied_}) v->setZero(system.coordinates());
  }

  StepReport step(State& state, double h) override {
    StepReport report;
    if (!begin(state, h, report)) return report;
    iterate(state, h, report);
    goes_on_ = report.ok();
    if (!report.ok()) {
      restart();
      return report;
    }
    change_ = a_ - a0_;
    if (trapezium_)
      a0_ = a_ + lead_ * change_;
    else
      a0_ = a_;
    trapezium_ = false;
    h_ = h;
    weights_ = steady_;
    acceleration0_ = acceleration_;
    state.t += h;
    state.z = z_;
    state.w = w_;
    state.lambda = lambda_;
    return report;
  }

  void restart() override { have_acceleration_ = stiff_ = false; }

 private:
  // How a_1 weighs on the step.
  struct Weights {
    double alpha_f, alpha_m, beta, gamma;
  };
  static Weights steady_weights(double rho) {
    const double alpha_f = rho / (rho + 1), alpha_m = (2 * rho - 1) / (rho + 1),
                 gamma = 0.5 + alpha_f - alpha_m;
    return {alpha_f, alpha_m, 0.25 * (gamma + 0.5) * (gamma + 0.5), gamma};
  }
  bool resolves(double h) const {
    return h * h * stiffness_ <= resolved_stiffness * least_moving_ &&
           h * damping_ <= resolved_damping * least_moving_;
  }
  bool begin(const State& state, double h, StepReport& report);
  void look_at_forces(const State& state);
  void predict(const State& state, double h);
  void stay(const State& state, double h);
  void set_pose(const State& state, double h);
  double evaluate(double t, double h);
  double momentum_level(double h, double reach, bool far);
  void correct(double h, StepReport& report);
  bool correct_with_forces(double t, double h, StepReport& report);
  void iterate(const State& state, double h, StepReport& report);
  double newton_scale(double h) const {
    return (1 - weights_.alpha_m) / (h * h * weights_.beta * (1 - weights_.alpha_f));
  }

  const System& system_;
  // A first step has no algorithmic acceleration behind it: it takes a_0 = a_1, of order 1. The true
  // acceleration would do for motions that the step resolves; of stiff ones it is (h omega)^2 too large.
  // Behind edges of time, of which there may be as many as steps, those that go on where the last one has led
  // begin with it, by the trapezium, of order 2, where they resolve what moves.
  static constexpr Weights resolved_first{0.5, 0.5, 0.25, 0.5};
  Weights steady_, stiff_first_, weights_ = stiff_first_;
  Index1 start_;
  SparseRows G_;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  VectorXd a0_, a_, acceleration0_, acceleration_;  // algorithmic and true accelerations [m/s^2]
  VectorXd z_, w_, residual_, dz_, inertia_, lambda_, dlambda_, phi_, offset_, q_, v_, force_, applied_;
  double residual_size_ = 0;
  bool have_acceleration_ = false;
  double h_ = 0;            // of the last step
  bool goes_on_ = false;    // the last step was solved
  bool trapezium_ = false;  // this is a first step by resolved_first
  double lead_ = 0;  // alpha_m - alpha_f: a_0 of steady steps is that of the time t + (alpha_m - alpha_f) h
  VectorXd change_;  // of a_0 in the last step
  bool stiff_ = false;  // forces are too stiff for corrections that know nothing of them
  double least_mass_, least_moving_;
  SparseRows by_z_, by_w_;              // derivatives of the forces at the first of these steps
  double stiffness_ = 0, damping_ = 0;  // their largest entries, of what moves
  RowNoise rows_;
  PartSizes parts_;
};

bool GeneralizedAlpha::begin(const State& state, double h, StepReport& report) {
  if (have_acceleration_ && !(resolves(h) && h > longer * h_)) {
    if (resolves(h) && std::abs(h - h_) > same_step * h_) a0_ += lead_ * (h / h_ - 1) * change_;
    return true;
  }
  ++report.factorisations;
  ++report.right_hand_sides;
  if (!start_.evaluate(state, acceleration0_, lambda_)) {
    report.status = StepStatus::not_finite;
    return false;
  }
  a0_ = acceleration0_;
  look_at_forces(state);
  trapezium_ = goes_on_ && state.z == z_ && resolves(h);
  weights_ = trapezium_ ? resolved_first : stiff_first_;
  return have_acceleration_ = true;
}

void GeneralizedAlpha::look_at_forces(const State& state) {
  if (system_.constant_forces()) return;
  system_.expand(state.z, q_);
  system_.expand_rate(state.w, v_);
  system_.force_derivatives(state.t, q_, v_, by_z_, by_w_);
  const VectorXd m = system_.moving_mass();
  stiffness_ = largest_of_moving(by_z_, m);
  damping_ = largest_of_moving(by_w_, m);
  parts_.look(state.t, q_, v_);
}

// Unchanged acceleration and multipliers.
void GeneralizedAlpha::predict(const State& state, double h) {
  lambda_ = state.lambda;
  acceleration_ = acceleration0_;
  set_pose(state, h);
}

// The acceleration that leaves the pose as it is. Accelerations of stiff forces lead anywhere, through the
// middle of a spring to its other side, too.
void GeneralizedAlpha::stay(const State& state, double h) {
  const auto& [alpha_f, alpha_m, beta, gamma] = weights_;
  lambda_ = state.lambda;
  a_ = (-h * state.w - h * h * (0.5 - beta) * a0_) / (h * h * beta);
  acceleration_ = ((1 - alpha_m) * a_ + alpha_m * a0_ - alpha_f * acceleration0_) / (1 - alpha_f);
  set_pose(state, h);
}

// a_1, z_1, w_1 that belong to w'_1.
void GeneralizedAlpha::set_pose(const State& state, double h) {
  const auto& [alpha_f, alpha_m, beta, gamma] = weights_;
  a_ = ((1 - alpha_f) * acceleration_ + alpha_f * acceleration0_ - alpha_m * a0_) / (1 - alpha_m);
  z_ = state.z + (h * state.w + h * h * ((0.5 - beta) * a0_ + beta * a_));
  w_ = state.w + h * ((1 - gamma) * a0_ + gamma * a_);
}

// Residuals at the present pose; returns their size in units of what round-off leaves of them.
double GeneralizedAlpha::evaluate(double t, double h) {
  system_.expand(z_, q_);
  system_.expand_rate(w_, v_);
  system_.constraint(t, q_, phi_);
  applied_.setZero();
  system_.add_applied_force(t, q_, v_, 1.0, applied_);
  force_ = applied_;
  system_.add_constraint_force(q_, lambda_, -1.0, force_);
  system_.reduce_force(force_, residual_);
  inertia_.noalias() = system_.mass() * acceleration_;
  residual_size_ = residual_.lpNorm<Eigen::Infinity>();
  residual_ = inertia_ - residual_;
  const VectorXd& lengths = system_.constraint_lengths();
  const double reach = q_.lpNorm<Eigen::Infinity>();
  const bool far = lengths.size() > 0 && reach > far_reach * lengths.minCoeff();
  if (parts_.several()) {
    parts_.start(q_);
    rows_.start_with(parts_.reaches());
  }
  double level = momentum_level(h, reach, far);
  for (Index r = 0; r < phi_.size(); ++r) {
    const double own = parts_.several() ? parts_.reach(r, rows_) : far ? rows_.reach(r) : reach;
    level = std::max(level, std::abs(phi_[r]) / constraint_noise(lengths[r], own));
  }
  return residual_.allFinite() && phi_.allFinite() ? level : std::numeric_limits<double>::infinity();
}

// As in StageEquations: one size for all rows where that does no harm, else each row by its own terms. Poses
// are as precise as the accelerations that they follow from.
double GeneralizedAlpha::momentum_level(double h, double reach, bool far) {
  const auto most = [](const VectorXd& x) { return x.size() ? x.lpNorm<Eigen::Infinity>() : 0.0; };
  const double speed = most(w_) + h * most(a_), way = reach + h * h * (most(acceleration_) + most(a_));
  const double size =
      std::max({residual_size_, most(inertia_), most(lambda_), stiffness_ * way, damping_ * speed, 1e-300});
  if (!far && h * h * size <= harmless_noise * least_mass_ * reach) return most(residual_) / (8 * ulp * size);
  if (!parts_.several()) rows_.start(q_);
  rows_.add_forces(applied_);
  rows_.add_multipliers(lambda_, 1.0);
  rows_.add_inertia(acceleration_, 1.0);
  if (stiffness_ > 0) {
    rows_.add_stiffness(by_z_, 1.0);
    rows_.add_products(by_z_, h * h * (acceleration_.cwiseAbs() + a_.cwiseAbs()), 1.0);
  }
  if (damping_ > 0) rows_.add_products(by_w_, w_.cwiseAbs() + h * a_.cwiseAbs(), 1.0);
  VectorXd sizes = rows_.size();
  if (parts_.several()) sizes = sizes.cwiseMax(parts_.least(h * h));
  double level = 0;
  for (Index i = 0; i < residual_.size(); ++i)
    if (const double error = std::abs(residual_[i]); error > 0)
      level = std::max(level, error / (8 * ulp * sizes[i]));
  return level;
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
  const double b = newton_scale(h), by_rate = weights_.gamma / (h * weights_.beta);
  const Index n = z_.size(), m = phi_.size();
  system_.force_derivatives(t, q_, v_, by_z_, by_w_);
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
  add_all(by_z_, -1.0 / b);
  add_all(by_w_, -by_rate / b);
  for (int r = 0; r < G_.outerSize(); ++r) {
    double square = 0;
    for (SparseRows::InnerIterator it(G_, r); it; ++it) square += std::pow(it.value() * scale[it.col()], 2);
    if (square > 0) scale[n + r] = 1.0 / std::sqrt(square);
    for (SparseRows::InnerIterator it(G_, r); it; ++it)
      add(n + r, it.col(), it.value()), add(it.col(), n + r, it.value());
    entries.emplace_back(static_cast<int>(n + r), static_cast<int>(n + r),
                         -SaddleSolver::standard_regularisation);
  }
  SparseColumns A(n + m, n + m);
  A.setFromTriplets(entries.begin(), entries.end());
  const SparseLu factors(A);
  ++report.factorisations;
  if (!factors.ok()) return false;
  VectorXd right(n + m);
  right << residual_ / -b, -phi_;
  const VectorXd x = scale.cwiseProduct(factors.solve(scale.cwiseProduct(right)));
  acceleration_ += b * x.head(n);
  lambda_ += b * x.tail(m);
  ++report.right_hand_sides;
  ++report.newton_iterations;
  return x.allFinite();
}

void GeneralizedAlpha::iterate(const State& state, double h, StepReport& report) {
  double best = std::numeric_limits<double>::infinity(), before = best;
  int without_gain = 0;
  stiff_ ? stay(state, h) : predict(state, h);
  for (int it = 0;; ++it) {
    const double level = evaluate(state.t + h, h);
    report.residual = level;
    report.constraint_norm = phi_.size() ? phi_.lpNorm<Eigen::Infinity>() : 0.0;
    if (level <= wanted_level) return;
    without_gain = level < 0.5 * best ? 0 : without_gain + 1;
    best = std::min(best, level);
    if (without_gain >= 3 && level <= accepted_level) return;
    if (it == max_iterations || (stiff_ && !std::isfinite(level))) break;
    if (!stiff_ && !system_.constant_forces() && it > 1 && !(level <= contracting * before)) {
      stiff_ = true;
      best = std::numeric_limits<double>::infinity();
      stay(state, h);
      continue;
    }
    if (!std::isfinite(level)) break;
    before = level;
    if (stiff_) {
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

Claims generalized_alpha_claims(const SolverOptions& options) {
  return {.order = 2, .implicit = true, .holds_positions = true, .damps = options.rho_inf < 1};
}

std::unique_ptr<Integrator> make_generalized_alpha(const System& system, const SolverOptions& options) {
  return std::make_unique<GeneralizedAlpha>(system, options.rho_inf);
}

}  // namespace unfurl
