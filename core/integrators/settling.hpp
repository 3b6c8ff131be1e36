// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace unfurl {

// Rates that dampers of h c / m > 1.5 take at once are resolved: by steps of h c / m = s / 5 until nothing is
// left of them, then by steps each half as long again, for weaker dampers, up to the step that was asked for.
// A long step would keep such rates, of changing sign. What follows is slow.
class Settling {
 public:
  void restart() { *this = Settling(); }
  bool over() const { return over_; }
  // The step to take in place of h, the first of them where h c / m is `z`, which is asked for then only.
  template <class Rate>
  double longest_step(double h, int stages, const Rate& z_at_start) {
    constexpr double least_share = 2e-7;  // of a step; shorter ones are little more than noise
    if (step_ == 0) {
      const double z = z_at_start();
      over_ = !(z > 1.5) || !std::isfinite(z);
      step_ = over_ ? 0.0 : std::max(h * 0.2 * stages / z, least_share * h);
      left_ = 50 / stages;
    } else if (--left_ < 0) {
      step_ *= 1.5;
      over_ = step_ > h;
    }
    return over_ || h < 1.5 * step_ ? h : std::min(step_, 0.5 * h);
  }

 private:
  double step_ = 0;    // the present one of those that strong dampers ask for [s]
  int left_ = 0;       // so many more are as short as the first
  bool over_ = false;  // no rates are left that dampers take within a step
};

}  // namespace unfurl
