// SPDX-License-Identifier: BSD-3-Clause
// How large the values of a run are, for colours.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

struct Magnitudes {
  double most = 0;   // of the finite values; 0 where there are none
  double usual = 0;  // what colours must tell apart: rare ones saturate, should they be more than twice that
};

// Forces blow up for an instant where a mechanism is straight: what is above 98 % of all is rare.
inline Magnitudes magnitudes(const MatrixXd& values) {
  std::vector<double> all;
  for (Index i = 0; i < values.size(); ++i)
    if (std::isfinite(values.data()[i])) all.push_back(std::abs(values.data()[i]));
  if (all.empty()) return {};
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  const double most = *std::max_element(at, all.end());
  return {most, *at > 0 && most > 2 * *at ? *at : most};
}

}  // namespace unfurl
