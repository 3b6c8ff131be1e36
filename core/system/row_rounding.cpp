// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/system_data.hpp"

namespace unfurl {

void System::Data::clear_rounding(const std::vector<double>& node_entries, SparseRows& G) const {
  // A few products and sums; coefficients of what was eliminated are of order one.
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  const double* entry = node_entries.data();
  for (Index r = 0; r < G.rows(); ++r) {
    double* const begin = G.valuePtr() + G.outerIndexPtr()[r];
    double* const end = G.valuePtr() + G.outerIndexPtr()[r + 1];
    const double* const row_end = node_entries.data() + row_ends[static_cast<std::size_t>(r)];
    double whole = 0, left = 0;
    for (; entry < row_end; ++entry) whole = std::max(whole, std::abs(*entry));
    for (const double* x = begin; x < end; ++x) left = std::max(left, std::abs(*x));
    if (left <= rounding * whole) std::fill(begin, end, 0.0);
  }
}

}  // namespace unfurl
