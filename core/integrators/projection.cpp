// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

constexpr int max_projections = 20, refreeze_after = 6;
constexpr double accepted_error =
    30.0;  // level of constraint error at which a stalled iteration counts as done
// Pivots that eight refinements do not resolve.
constexpr double weak = 100 * SaddleSolver::standard_regularisation;

}  // namespace

Projection::Projection(const System& system, double regularisation)
    : system_(system),
      G_(system.jacobian_pattern()),
      saddle_(system.mass(), G_, 1, regularisation),
      rows_(system) {
  q_.setZero(system.coordinates());
  for (VectorXd* v : {&phi_, &offset_, &y_}) v->setZero(system.constraints());
  for (VectorXd* v : {&force_, &x_, &move_}) v->setZero(system.solved_coordinates());
}

double Projection::level() {
  const double reach = q_.lpNorm<Eigen::Infinity>();
  const VectorXd& lengths = system_.constraint_lengths();
  const bool far = lengths.size() > 0 && reach > far_reach * lengths.minCoeff();
  if (far) rows_.start(q_);
  double worst = 0;
  for (Index r = 0; r < phi_.size(); ++r) {
    const double noise =
        2 * std::numeric_limits<double>::epsilon() * std::max(lengths[r], far ? rows_.reach(r) : reach);
    const double ratio = std::abs(phi_[r]) / noise;
    if (!(ratio <= worst)) worst = ratio;  // NaN too
  }
  return worst;
}

// As in Dvm: do errors at round-off of the coordinates show in the motion?
bool Projection::needs_care(const VectorXd& z0, const VectorXd& z) {
  constexpr double harmless = 1e-8, strong = 1e-3;
  system_.expand(z0, q_);
  system_.jacobian(q_, G_, scratch_);
  if (phi_.size() == 0 || !saddle_.factorise(G_)) return false;
  const double reach = std::max(q_.lpNorm<Eigen::Infinity>(), system_.constraint_lengths().maxCoeff());
  const double motion = std::max((z - z0).lpNorm<Eigen::Infinity>(), 1e-300);
  const double needed =
      std::min(strong, saddle_.motion_of_error() * 2 * std::numeric_limits<double>::epsilon() * reach /
                           (harmless * motion));
  return saddle_.weakest_pivot(needed * needed) < needed * needed;
}

bool Projection::increment(double t0, const VectorXd& z0, double t, VectorXd& move) {
  force_ = z0 + move;
  system_.expand(force_, q_);
  system_.jacobian(q_, G_, scratch_);
  if (!saddle_.factorise(G_)) return false;
  saddle_.weakest_pivot(weak);
  system_.expand(z0, q_);
  return reach(t0, t, move);
}

// The increment onto the constraints, by the present factors; q_ has the node coordinates of z_0.
bool Projection::reach(double t0, double t, VectorXd& move) {
  if (!increment_) increment_ = std::make_unique<ConstraintIncrement>(system_);
  increment_->start(t0, q_);
  double best = std::numeric_limits<double>::infinity();
  for (iterations_ = 0; iterations_ < max_projections; ++iterations_) {
    increment_->evaluate(t, move, phi_);
    force_.setZero();
    offset_ = -phi_;
    saddle_.solve(force_, offset_, x_, y_, 1);
    if (!x_.allFinite()) return false;
    move += x_;
    const double size = x_.lpNorm<Eigen::Infinity>();
    if (size > 0.5 * best) break;
    best = size;
  }
  return true;
}

bool Projection::positions(double t0, const VectorXd& z0, double t, VectorXd& z) {
  if (needs_care(z0, z)) {
    move_ = z - z0;
    const bool there = reach(t0, t, move_);
    z = z0 + move_;
    return there;
  }
  double best = std::numeric_limits<double>::infinity();
  for (iterations_ = 0;; ++iterations_) {
    system_.expand(z, q_);
    system_.constraint(t, q_, phi_);
    const double now = level();
    if (now <= 1.0) return true;
    if (!std::isfinite(now)) return false;
    if (now > 0.5 * best && now <= accepted_error) return true;
    if (iterations_ == max_projections) return false;
    best = std::min(best, now);
    if (iterations_ % refreeze_after == 0) {
      system_.jacobian(q_, G_, scratch_);
      if (!saddle_.factorise(G_)) return false;
    }
    force_.setZero();
    offset_ = -phi_;
    saddle_.solve(force_, offset_, x_, y_, 1);
    z += x_;
  }
}

bool Projection::hold_rows_at(const VectorXd& z) {
  system_.expand(z, q_);
  system_.jacobian(q_, G_, scratch_);
  return saddle_.factorise(G_);
}

// Until moves are round-off or, where lengths of redundant rows have too few digits to agree, what these
// leave. What rows that have lost their rank do not reach stays.
bool Projection::along_held_rows(double t, VectorXd& z) {
  constexpr double unit = std::numeric_limits<double>::epsilon(), settled = 1e-9;
  double best = std::numeric_limits<double>::infinity();
  for (iterations_ = 0; iterations_ < 2 * max_projections; ++iterations_) {
    system_.expand(z, q_);
    system_.constraint(t, q_, phi_);
    force_.setZero();
    offset_ = -phi_;
    saddle_.solve(force_, offset_, x_, y_, 1);
    if (!x_.allFinite()) return false;
    z += x_;
    const double size = x_.lpNorm<Eigen::Infinity>(), reach = q_.lpNorm<Eigen::Infinity>();
    const double next = iterations_ == 0 ? size : size * (size / best);
    if (next <= unit * reach) return true;
    if (size >= best) return size <= settled * reach;
    best = size;
  }
  return false;
}

bool Projection::rates_by_held_rows(double t, VectorXd& w) {
  system_.target_rate(t, offset_);
  offset_.noalias() -= G_ * w;
  force_.setZero();
  saddle_.solve(force_, offset_, x_, y_);
  w += x_;
  return w.allFinite();
}

bool Projection::velocities(double t, const VectorXd& z, VectorXd& w) {
  system_.expand(z, q_);
  system_.jacobian(q_, G_, scratch_);
  if (!saddle_.factorise(G_)) return false;
  saddle_.weakest_pivot(weak);
  force_.noalias() = system_.mass() * w;
  system_.target_rate(t, offset_);
  saddle_.solve(force_, offset_, x_, y_);
  w = x_;
  return w.allFinite();
}

}  // namespace unfurl
