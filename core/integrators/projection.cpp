#include "core/integrators/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

constexpr int max_projections = 20, refreeze_after = 6;
constexpr double accepted_error =
    30.0;  // level of constraint error at which a stalled iteration counts as done

}  // namespace

Projection::Projection(const System& system)
    : system_(system), G_(system.jacobian_pattern()), saddle_(system.mass(), G_) {
  q_.setZero(system.coordinates());
  for (VectorXd* v : {&phi_, &offset_, &y_}) v->setZero(system.constraints());
  for (VectorXd* v : {&force_, &x_}) v->setZero(system.solved_coordinates());
}

double Projection::level() {
  const double reach = q_.lpNorm<Eigen::Infinity>();
  double worst = 0;
  for (Index r = 0; r < phi_.size(); ++r) {
    const double noise =
        2 * std::numeric_limits<double>::epsilon() * std::max(system_.constraint_lengths()[r], reach);
    const double ratio = std::abs(phi_[r]) / noise;
    if (!(ratio <= worst)) worst = ratio;  // NaN too
  }
  return worst;
}

bool Projection::positions(double t, VectorXd& z) {
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

bool Projection::velocities(double t, const VectorXd& z, VectorXd& w) {
  system_.expand(z, q_);
  system_.jacobian(q_, G_, scratch_);
  if (!saddle_.factorise(G_)) return false;
  force_.noalias() = system_.mass() * w;
  system_.target_rate(t, offset_);
  saddle_.solve(force_, offset_, x_, y_);
  w = x_;
  return w.allFinite();
}

}  // namespace unfurl
