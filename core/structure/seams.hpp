// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

// Which copied nodes lie between two parts of one rod that was cut to bend: points of that rod, no joints.
inline std::vector<bool> seams(const Structure& s) {
  std::vector<int> ends(s.node_copies.size(), 0), parts(s.node_copies.size(), 0);
  std::vector<const Rod*> rod_at(s.node_copies.size(), nullptr);
  for (const RodCopy& copy : s.rod_copies) {
    const Rod& rod = s.rods[static_cast<std::size_t>(copy.source)];
    for (const int end : {copy.a, copy.b}) {
      const auto n = static_cast<std::size_t>(end);
      const bool same = rod_at[n] == nullptr || rod_at[n]->whole == rod.whole;
      ++ends[n], parts[n] += !rod.whole.empty() && same ? 1 : 0;
      rod_at[n] = &rod;
    }
  }
  std::vector<bool> out(ends.size(), false);
  for (std::size_t n = 0; n < ends.size(); ++n) out[n] = ends[n] == 2 && parts[n] == 2;
  return out;
}

}  // namespace unfurl
