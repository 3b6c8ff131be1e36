// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "app/panel/runs/trade.hpp"

namespace unfurl {

// One quantity of two runs, as people read it; "-" where a run has none.
struct ComparisonRow {
  std::string label, a, b, change;  // change: of b against a, "+12 %" or a factor
};

// Deployment time, peak rod force, errors, steps, CPU time; of each drive the peaks of its effort and power,
// and its energy. What is known of the runs beside that is in their
// points of the trade, null where they have none.
std::vector<ComparisonRow> compare(const LiveRun& a, const LiveRun& b, const TradePoint* point_a = nullptr,
                                   const TradePoint* point_b = nullptr);

}  // namespace unfurl
