#pragma once

#include <string>
#include <vector>

#include "app/panel/simulator.hpp"

namespace unfurl {

// One quantity of two runs, as people read it; "-" where a run has none.
struct ComparisonRow {
  std::string label, a, b, change;  // change: of b against a, "+12 %" or a factor
};

// Deployment time, peak rod force, errors, steps, CPU time.
std::vector<ComparisonRow> compare(const LiveRun& a, const LiveRun& b);

}  // namespace unfurl
