// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of a scene as triangles: what is spanned between nodes at a moment.
#pragma once

#include <vector>

#include "core/math/types.hpp"
#include "core/scene/surfaces.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

// A surface of the scene with the copied nodes along its edge.
struct ShownSurface {
  SceneSurface surface;
  std::vector<int> nodes;
  bool turned = false;  // its front is where its nodes go round clockwise
};

// Whether the front of what has this edge, the side that is above, is where the nodes go round clockwise; of
// a motion: where it ends, or where it begins if it is folded up at the end. A surface keeps its front,
// wherever it is turned to.
bool is_turned(const std::vector<Vec3>& edge);
bool is_turned(const std::vector<Vec3>& first, const std::vector<Vec3>& last);

// `edge`: the places of its nodes [m], z up. A flat one is straight lines between the middle of its edge and
// the edge (with four nodes: between opposite edges), or where these would leave what is within the edge, as
// at a notch, triangles between nodes. A paraboloid sinks below those lines by depth (1 - s^2), s from 0 in
// the middle to 1 at the edge, depth = D / (16 F) for the diameter D of the ring and F = focal_ratio, to its
// back.
Skin skin_of(const SceneSurface& surface, const std::vector<Vec3>& edge, bool turned);

}  // namespace unfurl
