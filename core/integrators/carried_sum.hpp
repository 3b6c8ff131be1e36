// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/twofold.hpp"
#include "core/math/types.hpp"

namespace unfurl {

// z += dz, step after step, where what rounding takes from a sum is added to the next one: many small motions
// of large coordinates. Coordinates that are not those of the last sum begin afresh.
class CarriedSum {
 public:
  void add(const ConstVec& dz, VectorXd& z) {
    if (sum_.size() != z.size() || !(sum_.array() == z.array()).all()) rest_.setZero(z.size());
    for (Index i = 0; i < z.size(); ++i) {
      const Twofold sum = Twofold::sum(z[i], dz[i] + rest_[i]);
      z[i] = sum.hi;
      rest_[i] = sum.lo;
    }
    sum_ = z;
  }

 private:
  VectorXd sum_, rest_;
};

}  // namespace unfurl
