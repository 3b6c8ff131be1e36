// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/anderson.hpp"

#include <algorithm>
#include <utility>

#include "core/math/factors.hpp"

namespace unfurl {

void Anderson::extrapolate(const ConstVec& c, MutVec x, MutVec y) {
  VectorXd x_now = x, y_now = y;
  if (known_ == 0) {
    changes_.resize(c.size(), depth), moves_.resize(x.size(), depth), along_.resize(y.size(), depth);
  } else {
    const Index column = (known_ - 1) % depth, columns = std::min(known_, depth);
    changes_.col(column) = c - c_;
    moves_.col(column) = x_now - x_;
    along_.col(column) = y_now - y_;
    const VectorXd share = least_squares(changes_.leftCols(columns), c);
    if (share.lpNorm<1>() < far) {
      x -= moves_.leftCols(columns) * share;
      y -= along_.leftCols(columns) * share;
    }
  }
  ++known_;
  c_ = c, x_ = std::move(x_now), y_ = std::move(y_now);
}

}  // namespace unfurl
