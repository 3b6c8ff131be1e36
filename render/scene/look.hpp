// SPDX-License-Identifier: BSD-3-Clause
// The looks that pictures can have. To add one: a row in look.cpp and its name in the key render.look.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "render/scene/draw_list.hpp"

namespace unfurl {

// Colours that people with any colour vision tell apart (Okabe and Ito 2008): one per group of rods.
using GroupColors = std::array<Color, 6>;

struct Look {
  std::string_view name, help;
  Shading shading = Shading::studio;
  Color background_top, background_bottom;
  Color ink;                     // of text and lines
  Color load;                    // of arrows
  Color fitting, joint, anchor;  // of rod ends, hinges, held nodes
  const GroupColors* groups = nullptr;
  Color grid{0.36f, 0.44f, 0.54f, 0.34f}, shadow{0.045f, 0.10f, 0.20f, 0.50f};  // of the ground
  bool ground = false;                                                          // with grid and shadow
  bool earth = false;
  bool dimensions = false;
  bool transparent = false;
  float stars = 0, depth_fade = 0;

  // Beyond the sixth the same again in other shades: towards the ink, towards the ground, and on.
  Color group(std::size_t index) const {
    const std::size_t round = index / groups->size();
    const Color& first = (*groups)[index % groups->size()];
    if (round == 0) return first;
    return mixed(first, round % 2 == 1 ? ink : background_bottom, round % 4 < 3 ? 0.5f : 0.75f);
  }
  // Of loads, and of the group of a ShownLine: beside rods in colours from blue to red, where red is tension,
  // a load is green and a cable as the ink; the other colours have no red.
  Color load_color(bool diverging) const { return diverging ? group(2) : load; }
  Color line_color(const std::string& line, bool diverging) const {
    if (line == "net") return mixed(joint, ink, 0.5f);
    return diverging ? ink : load;
  }
  // Of what is slack among lines in the colours of their forces: darker than the pale grey of none.
  Color slack_color() const {
    return ink.g > background_bottom.g ? mixed(joint, background_bottom, 0.35f) : ink;
  }
};

std::span<const Look> looks();
const Look* find_look(std::string_view name);  // nullptr where there is none

}  // namespace unfurl
