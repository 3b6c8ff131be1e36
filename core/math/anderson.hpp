// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/types.hpp"

namespace unfurl {

// Anderson's extrapolation of an iteration x <- x + c(x), linear near its end, of which a few modes are
// slower than the others: to where combinations of the last corrections are nearest to zero. Walker & Ni,
// SIAM J. Numer. Anal. 49 (2011), 1715, problem (4.1).
class Anderson {
 public:
  void restart() { known_ = 0; }

  // x, y: what the correction c of x has led to; y goes along.
  void extrapolate(const ConstVec& c, MutVec x, MutVec y);

 private:
  static constexpr Index depth = 3;
  static constexpr double far = 100;  // changes: what is slower gains nothing that rounding leaves
  Index known_ = 0;
  VectorXd c_, x_, y_;
  MatrixXd changes_, moves_, along_;
};

}  // namespace unfurl
