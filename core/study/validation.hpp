// SPDX-License-Identifier: BSD-3-Clause
// Published benchmarks with digits, solved by Unfurl: what `unfurl reproduce --validation` prints.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/study/reference.hpp"
#include "core/study/table.hpp"

namespace unfurl {

struct ValidationRow {
  std::string_view problem, source;  // "pendulum from the horizontal", "IFToMM benchmark A01"
  std::string_view quantity;         // "x at 10 s (m)"
  std::string_view published;        // as printed, digit by digit
  double ours = 0.0;
  double allowed =
      0.0;  // largest difference that passes: round-off of the run, or half of the last digit printed
  double difference() const;
  bool holds() const;  // false where ours is not a number
};

// Solves all of them. Throws Cancelled.
std::vector<ValidationRow> validate(const StudyHooks& hooks);

Table validation_table(const std::vector<ValidationRow>& rows);

// Benchmarks of the same kind that a scene cannot say, and why.
Table not_expressible_table();

}  // namespace unfurl
