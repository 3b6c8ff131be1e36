// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include "core/structure/structure.hpp"

namespace unfurl {

// The fold angle, which counts on where it passes half a turn, and its rate; not a number where nothing
// folds.
class FoldAngle {
 public:
  explicit FoldAngle(const Deployment& deployment) : deployment_(deployment) {}
  void go_to(double t, const VectorXd& q, const VectorXd& v) {
    if (!deployment_.folds()) return;
    const double angle = deployment_.fold_angle(q), rate = deployment_.fold_rate(q, v);
    const double expected = std::isnan(t_) ? angle : angle_ + 0.5 * (t - t_) * (rate_ + rate);
    t_ = t;
    rate_ = rate;
    angle_ = angle - 2 * pi * std::round((angle - expected) / (2 * pi));
  }
  double angle() const { return angle_; }
  double rate() const { return rate_; }

 private:
  const Deployment& deployment_;
  double t_ = std::numeric_limits<double>::quiet_NaN(), angle_ = t_, rate_ = t_;
};

}  // namespace unfurl
