// SPDX-License-Identifier: BSD-3-Clause
// The benchmarks of single elements among those that `unfurl reproduce --validation` prints.
#pragma once

#include <vector>

#include "core/study/validation.hpp"

namespace unfurl {

// Elastic rods, cables over pulleys, friction, ropes that carry weight, gears: solved, one row per digit.
void add_element_benchmarks(std::vector<ValidationRow>& rows);

}  // namespace unfurl
