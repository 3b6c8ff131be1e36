// SPDX-License-Identifier: BSD-3-Clause
// How a System counts the turns of angles.
#include "core/system/system_data.hpp"

namespace unfurl {

Index System::followed_angles() const {
  return static_cast<Index>(data_->followed.size());
}

Moment System::moment(double t, const double* tension) const {
  Moment at(t);
  at.tension = tension;
  if (angles_.size() == 0) return at;
  at.since = since_;
  at.angles = angles_.data();
  at.rates = rates_.data();
  return at;
}

// The angles of a state, each on the branch of `measured_`, and their rates.
void System::measure_angles(const State& state) {
  q_.resize(coordinates());
  v_.resize(coordinates());
  expand(state.z, q_);
  expand_rate(state.w, v_);
  for (Index i = 0; i < followed_angles(); ++i) {
    const MeasureFunction& angle = data_->followed[static_cast<std::size_t>(i)];
    gradient_.resize(angle.stencil().size());
    measured_[i] = angle.value_and_gradient(q_.data(), gradient_.data(), measured_[i]);
    measured_rates_[i] = angle.rate(gradient_.data(), v_.data());
  }
}

void System::follow(const State& state) {
  const Index n = followed_angles();
  since_ = state.t;
  if (n == 0) return;
  if (measured_rates_.size() != n) measured_rates_.resize(n);
  // What a stop or a latch holds adds angles behind the others.
  measured_.resize(n);
  for (Index i = 0; i < n; ++i)
    measured_[i] =
        i < state.angles.size() ? state.angles[i] : data_->followed[static_cast<std::size_t>(i)].reference();
  measure_angles(state);
  angles_ = measured_;
  rates_ = measured_rates_;
}

System System::at(const State& state) const {
  System copy = *this;
  copy.follow(state);
  return copy;
}

// With the rates r_0 and r_1 at both ends an angle changes by about (t_1 - t_0) (r_0 + r_1) / 2; the branch
// nearest to that is right where the rule is right to half a turn.
void System::count_on(State& later) {
  const Index n = followed_angles();
  if (n == 0) return;
  measured_ = angles_;
  measure_angles(later);
  for (Index i = 0; i < n; ++i) {
    const double expected = angles_[i] + 0.5 * (later.t - since_) * (rates_[i] + measured_rates_[i]);
    measured_[i] -= 2 * pi * std::round((measured_[i] - expected) / (2 * pi));
  }
  later.angles = measured_;
}

}  // namespace unfurl
