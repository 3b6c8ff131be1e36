// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace unfurl {

// The exponent p of error ~ step^p: least squares on logarithms, with the 95 % confidence interval of
// Student's t.
struct ObservedOrder {
  double order = 0, low = 0, high = 0;  // NaN: fewer than three points tell nothing
  int points = 0;
};
ObservedOrder fit_order(const std::vector<double>& step, const std::vector<double>& error);

}  // namespace unfurl
