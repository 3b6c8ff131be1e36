// SPDX-License-Identifier: BSD-3-Clause
// How the parts of a structure look: colours by group, sizes that can be seen.
#pragma once

#include <string>
#include <vector>

#include "core/structure/structure.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

struct Look;

// Of a group of rods in the first look (render/scene/look.hpp).
Color group_color(std::size_t index);

struct Appearance {
  std::vector<std::string> groups;  // of the rods, in order of appearance: colour group_color(i)
  std::vector<int> rod_group;       // per solved rod, index into groups
  std::vector<double> rod_radius;   // per solved rod, as drawn [m]
  // The least and largest ratio of a drawn radius to the rod's own; 1 where no rod has one of its own.
  double least_scale = 1, largest_scale = 1;
  double bare_radius = 0;            // of a rod that is just thick enough to be seen [m]
  std::vector<double> joint_radius;  // per copied node, of its ball; 0: nothing is there [m]
  std::vector<bool> bare;    // per copied node: no rod ends there, yet it is held, heavy, or pulled at
  std::vector<bool> fixed;   // per copied node: held in place
  double arrow_length = 0;   // of the largest load [m]
  double arrow_radius = 0;   // [m]
  double largest_force = 0;  // [N]
};

// `size`: the radius of a sphere around the whole motion [m]. rod_scale: how many times as thick as they are
// rods are drawn; 0: those thinner than can be seen at that size are drawn thicker.
Appearance appearance_of(const Structure& structure, double size, double rod_scale = 0.0);

// Of trails: none of the groups'.
Color trail_color(const Look& look, const Appearance& looks);

}  // namespace unfurl
