#pragma once

#include <limits>
#include <string>
#include <vector>

#include "app/panel/simulator.hpp"

namespace unfurl {

// One quantity of two runs, as people read it; "-" where a run has none.
struct ComparisonRow {
  std::string label, a, b, change;  // change: of b against a, "+12 %" or a factor
};

// Deployment time, peak rod force, errors, steps, CPU time. Position errors are the caller's, where they are
// known [m].
std::vector<ComparisonRow> compare(const LiveRun& a, const LiveRun& b,
                                   double error_a = std::numeric_limits<double>::quiet_NaN(),
                                   double error_b = std::numeric_limits<double>::quiet_NaN());

}  // namespace unfurl
