// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/look.hpp"

#include <algorithm>

#include "render/plot/group_colors.hpp"

namespace unfurl {
namespace {

constexpr GroupColors on_pale = [] {
  GroupColors out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {group_colors_on_pale[i][0], group_colors_on_pale[i][1], group_colors_on_pale[i][2], 1};
  return out;
}();

// The same, lightened for a dark background.
constexpr GroupColors on_dark{{{0.36f, 0.68f, 0.94f, 1},
                               {0.96f, 0.64f, 0.12f, 1},
                               {0.10f, 0.76f, 0.56f, 1},
                               {0.88f, 0.58f, 0.77f, 1},
                               {0.62f, 0.86f, 1.00f, 1},
                               {0.96f, 0.46f, 0.20f, 1}}};

constexpr Look rows[] = {
    {.name = "studio",
     .help = "soft light, dimmer where rods meet and near the floor; shadows on a floor with a grid",
     .shading = Shading::studio,
     .background_top = {0.80f, 0.85f, 0.90f, 1},
     .background_bottom = {0.95f, 0.96f, 0.97f, 1},
     .ink = {0.13f, 0.17f, 0.22f, 1},
     .load = {0.78f, 0.08f, 0.22f, 1},
     .fitting = {0.62f, 0.64f, 0.67f, 1},
     .joint = {0.30f, 0.33f, 0.37f, 1},
     .anchor = {0.16f, 0.18f, 0.21f, 1},
     .groups = &on_pale,
     .ground = true,
     .depth_fade = 0.30f},
    {.name = "dark",
     .help = "the studio at night: lit metal before dark grey, for films and slides",
     .shading = Shading::studio,
     .background_top = {0.075f, 0.085f, 0.105f, 1},
     .background_bottom = {0.155f, 0.175f, 0.205f, 1},
     .ink = {0.90f, 0.92f, 0.95f, 1},
     .load = {1.00f, 0.36f, 0.40f, 1},
     .fitting = {0.72f, 0.74f, 0.77f, 1},
     .joint = {0.46f, 0.49f, 0.53f, 1},
     .anchor = {0.34f, 0.37f, 0.41f, 1},
     .groups = &on_dark,
     .grid = {0.56f, 0.64f, 0.74f, 0.26f},
     .shadow = {0.0f, 0.005f, 0.015f, 0.75f},
     .ground = true,
     .depth_fade = 0.30f},
    {.name = "space",
     .help = "sunlight, and the Earth's below, before a dark sky",
     .shading = Shading::space,
     .background_top = {0.015f, 0.025f, 0.060f, 1},
     .background_bottom = {0.050f, 0.075f, 0.130f, 1},
     .ink = {0.86f, 0.90f, 0.96f, 1},
     .load = {1.00f, 0.38f, 0.42f, 1},
     .fitting = {0.80f, 0.82f, 0.85f, 1},
     .joint = {0.58f, 0.61f, 0.66f, 1},
     .anchor = {0.90f, 0.90f, 0.92f, 1},
     .groups = &on_dark,
     .earth = true,
     .stars = 0.75f,
     .depth_fade = 0.35f},
    {.name = "blueprint",
     .help = "thin dark lines on white, hidden lines pale, with dimensions",
     .shading = Shading::outline,
     .background_top = {1, 1, 1, 1},
     .background_bottom = {1, 1, 1, 1},
     .ink = {0.08f, 0.14f, 0.28f, 1},
     .load = {0.78f, 0.08f, 0.22f, 1},
     .fitting = {0.16f, 0.24f, 0.42f, 1},
     .joint = {0.16f, 0.24f, 0.42f, 1},
     .anchor = {0.08f, 0.12f, 0.24f, 1},
     .groups = &on_pale,
     .dimensions = true,
     .depth_fade = 0.35f},
    {.name = "print",
     .help = "flat colours without a background, for pages and slides",
     .shading = Shading::flat,
     .background_top = {1, 1, 1, 1},
     .background_bottom = {1, 1, 1, 1},
     .ink = {0.10f, 0.10f, 0.12f, 1},
     .load = {0.78f, 0.08f, 0.22f, 1},
     .fitting = {0.45f, 0.47f, 0.50f, 1},
     .joint = {0.20f, 0.22f, 0.25f, 1},
     .anchor = {0.10f, 0.11f, 0.13f, 1},
     .groups = &on_pale,
     .transparent = true,
     .depth_fade = 0.35f},
};

}  // namespace

std::span<const Look> looks() {
  return rows;
}

const Look* find_look(std::string_view name) {
  const auto found = std::ranges::find(looks(), name, &Look::name);
  return found == looks().end() ? nullptr : &*found;
}

}  // namespace unfurl
