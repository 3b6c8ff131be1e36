// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/extrapolation.hpp"

namespace unfurl {

Extrapolation::Extrapolation(const System& system)
    : system_(system), accelerations_(system_, true), n_(system.solved_coordinates()), projection_(system_) {
  for (VectorXd* v : {&y0_, &y_, &before_, &now_, &after_, &f_, &f0_}) v->setZero(2 * n_);
  lambda_.setZero(system.constraints());
}

bool Extrapolation::rate(double t, const VectorXd& dy, VectorXd& f) {
  y_ = y0_ + dy;
  f.head(n_) = y_.tail(n_);
  return accelerations_.evaluate(t, y_.head(n_), y_.tail(n_), f.tail(n_), lambda_) && !accelerations_.seen();
}

// y_1 = y_0 + h f_0,  y_{m+1} = y_{m-1} + 2 h f_m,  S = (y_n + y_{n-1} + h f_n) / 2,  h = H / n. The products
// are divided and not the step: the rounding of one h, the same in all of them, would be multiplied by the
// extrapolation and added up by the steps.
bool Extrapolation::midpoint(const State& state, double H, int n, VectorXd& out) {
  before_.setZero();
  now_ = H * f0_ / n;
  for (int m = 1; m < n; ++m) {
    if (!rate(state.t + m * H / n, now_, f_)) return false;
    after_ = before_ + 2 * H * f_ / n;
    before_.swap(now_);
    now_.swap(after_);
  }
  if (!rate(state.t + H, now_, f_)) return false;
  out = 0.5 * (now_ + before_ + H * f_ / n);
  return out.allFinite();
}

bool Extrapolation::step(State& state, double H) {
  system_.follow(state);
  accelerations_.begin(state);
  y0_ << state.z, state.w;
  before_.setZero();
  if (!rate(state.t, before_, f0_)) return accelerations_.seen() && step(state, H);
  for (int j = 0; j < columns; ++j) {
    VectorXd next;
    if (!midpoint(state, H, 2 * (j + 1), next)) return accelerations_.seen() && step(state, H);
    // T_{j,k+1} = T_{j,k} + (T_{j,k} - T_{j-1,k}) / ((n_j / n_{j-k-1})^2 - 1); the row is kept in place.
    for (int k = 0; k < j; ++k) {
      const double ratio = static_cast<double>(j + 1) / (j - k);
      VectorXd better = next + (next - tableau_[k]) / (ratio * ratio - 1);
      tableau_[k] = std::move(next);
      next = std::move(better);
    }
    tableau_[j] = std::move(next);
  }
  VectorXd dz = tableau_[columns - 1].head(n_);
  if (!projection_.increment(state.t, state.z, state.t + H, dz)) return false;
  state.t += H;
  carried_.add(dz, state.z);
  state.w += tableau_[columns - 1].tail(n_);
  if (!projection_.velocities(state.t, state.z, state.w)) return false;
  system_.count_on(state);
  return state.z.allFinite() && state.w.allFinite();
}

}  // namespace unfurl
