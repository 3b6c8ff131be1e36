// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

struct RodGroup {
  std::string name;
  std::vector<int> rods;  // of the solved structure
  int shown = 0;          // rods of the whole structure
  int color = 0;          // of the palette
};

// By Rod::group, in the order of first appearance; without those that the whole structure does not show.
std::vector<RodGroup> rod_groups(const Structure& structure);

}  // namespace unfurl
