// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/rod_groups.hpp"

#include <algorithm>

#include "render/plot/figure.hpp"

namespace unfurl {

std::vector<RodGroup> rod_groups(const Structure& structure) {
  std::vector<RodGroup> groups;
  std::vector<std::size_t> group_of(structure.rods.size());
  for (std::size_t r = 0; r < structure.rods.size(); ++r) {
    const std::string& name = structure.rods[r].group;
    auto g =
        std::find_if(groups.begin(), groups.end(), [&](const RodGroup& have) { return have.name == name; });
    if (g == groups.end()) g = groups.insert(g, {name, {}, 0, 0});
    g->rods.push_back(static_cast<int>(r));
    group_of[r] = static_cast<std::size_t>(g - groups.begin());
  }
  std::vector<bool> shown(structure.rods.size(), false);
  for (const RodCopy& copy : structure.rod_copies) {
    ++groups[group_of[static_cast<std::size_t>(copy.source)]].shown;
    shown[static_cast<std::size_t>(copy.source)] = true;
  }
  // Colours go by what is shown first, as in pictures.
  int next = first_group_color;
  for (std::size_t r = 0; r < shown.size(); ++r)
    if (int& color = groups[group_of[r]].color; shown[r] && color == 0) color = next++;
  std::erase_if(groups, [](const RodGroup& group) { return group.shown == 0; });
  return groups;
}

}  // namespace unfurl
