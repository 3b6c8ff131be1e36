// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace unfurl {

// Rates that dampers of h c / m > 1.5 take at once are resolved: by steps of h c / m = s / 5 until nothing is
// left of them, then by steps each half as long again, for weaker dampers, up to the step that was asked for.
// A long step would keep such rates, of changing sign. What follows is slow. Where such steps would be
// shorter than the noise of positions, somewhat longer ones are taken that let go of these rates. What is
// asked for may be short at first, up to a time of the grid or an edge: what counts is a whole step.
class Settling {
 public:
  void restart() { *this = Settling(); }
  bool over() const { return over_; }
  bool lets_go() const { return lets_go_; }
  // The step to take in place of h, which may be what is left of a `whole` one; the first of them where h c /
  // m is `z`, which is asked for then only.
  template <class Rate>
  double longest_step(double h, double whole, int stages, const Rate& z_at_start) {
    // Of a whole step; shorter ones are little more than noise. Beyond the second, slow rates would notice.
    constexpr double least_share = 2e-7, let_go_share = 1e-3;
    constexpr double gone = 30;  // times m / c
    if (h <= calm_) return quiet_ += h, h;
    if (step_ == 0) {
      const double z = whole / h * z_at_start();
      over_ = !std::isfinite(z) || (z > 1.5 && z * quiet_ > gone * whole);
      if (over_ || !(z > 1.5)) return calm_ = whole, quiet_ += h, h;
      lets_go_ = 0.2 * stages < least_share * z;
      step_ = whole * std::max((lets_go_ ? 200 : 0.2 * stages) / z, least_share);
      left_ = lets_go_ ? 25 : 50 / stages;
    } else if (--left_ < 0) {
      lets_go_ =
          lets_go_ && step_ < let_go_share * whole;  // what rounding leaves in rates falls with the step
      step_ *= 1.5;
      if (step_ > whole) calm_ = step_;
    }
    return h < 1.5 * step_ ? h : std::min(step_, 0.5 * h);
  }

 private:
  double step_ = 0;       // the present one of those that strong dampers ask for [s]
  double calm_ = 0;       // no rates are left that dampers take within steps up to this one [s]
  double quiet_ = 0;      // time that such steps have taken since the start [s]
  int left_ = 0;          // so many more are as short as the first
  bool lets_go_ = false;  // that step is still too long for the strongest of them
  bool over_ = false;     // within any step
};

}  // namespace unfurl
