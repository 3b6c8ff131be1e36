#include "render/scene/look.hpp"

#include <algorithm>

namespace unfurl {
namespace {

// Darkened for a pale background: blue, orange, bluish green, reddish purple, sky blue, vermilion.
constexpr GroupColors on_pale{{{0.00f, 0.37f, 0.66f, 1},
                               {0.88f, 0.50f, 0.02f, 1},
                               {0.00f, 0.55f, 0.40f, 1},
                               {0.72f, 0.38f, 0.58f, 1},
                               {0.25f, 0.62f, 0.85f, 1},
                               {0.80f, 0.30f, 0.00f, 1}}};

// Lightened for a dark one.
constexpr GroupColors on_dark{{{0.36f, 0.68f, 0.94f, 1},
                               {0.96f, 0.64f, 0.12f, 1},
                               {0.10f, 0.76f, 0.56f, 1},
                               {0.88f, 0.58f, 0.77f, 1},
                               {0.62f, 0.86f, 1.00f, 1},
                               {0.96f, 0.46f, 0.20f, 1}}};

constexpr Look rows[] = {
    {"studio",
     "soft light, dimmer where rods meet and near the floor; shadows on a floor with a grid",
     Shading::studio,
     {0.80f, 0.85f, 0.90f, 1},
     {0.95f, 0.96f, 0.97f, 1},
     {0.13f, 0.17f, 0.22f, 1},
     {0.78f, 0.08f, 0.22f, 1},
     {0.62f, 0.64f, 0.67f, 1},
     {0.30f, 0.33f, 0.37f, 1},
     {0.16f, 0.18f, 0.21f, 1},
     &on_pale,
     true,
     false,
     false,
     0,
     0.30f},
    {"space",
     "sunlight and a bright rim before a dark sky",
     Shading::space,
     {0.015f, 0.025f, 0.060f, 1},
     {0.050f, 0.075f, 0.130f, 1},
     {0.86f, 0.90f, 0.96f, 1},
     {1.00f, 0.38f, 0.42f, 1},
     {0.80f, 0.82f, 0.85f, 1},
     {0.58f, 0.61f, 0.66f, 1},
     {0.90f, 0.90f, 0.92f, 1},
     &on_dark,
     false,
     false,
     false,
     0.75f,
     0.35f},
    {"blueprint",
     "thin dark lines on white, hidden lines pale, with dimensions",
     Shading::outline,
     {1, 1, 1, 1},
     {1, 1, 1, 1},
     {0.08f, 0.14f, 0.28f, 1},
     {0.78f, 0.08f, 0.22f, 1},
     {0.16f, 0.24f, 0.42f, 1},
     {0.16f, 0.24f, 0.42f, 1},
     {0.08f, 0.12f, 0.24f, 1},
     &on_pale,
     false,
     true,
     false,
     0,
     0.35f},
    {"print",
     "flat colours without a background, for pages and slides",
     Shading::flat,
     {1, 1, 1, 1},
     {1, 1, 1, 1},
     {0.10f, 0.10f, 0.12f, 1},
     {0.78f, 0.08f, 0.22f, 1},
     {0.45f, 0.47f, 0.50f, 1},
     {0.20f, 0.22f, 0.25f, 1},
     {0.10f, 0.11f, 0.13f, 1},
     &on_pale,
     false,
     false,
     true,
     0,
     0.35f},
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
