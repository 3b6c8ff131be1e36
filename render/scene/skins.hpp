// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of a scene as triangles: what is spanned between nodes at a moment.
#pragma once

#include <vector>

#include "core/math/types.hpp"
#include "core/scene/surfaces.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

// What holds for a surface all through a motion, so that it keeps its front and its triangles wherever it
// goes.
struct SkinPlan {
  bool turned = false;   // its front, the side that is above, is where its nodes go round clockwise
  std::vector<int> cut;  // triangles between its nodes, from the one that is last on where it is turned
};

// As it is where the motion ends, or where that begins if it is folded up at the end.
SkinPlan plan_of(const SceneSurface& surface, const std::vector<Vec3>& first, const std::vector<Vec3>& last);

// A surface of the scene with the copied nodes along its edge.
struct ShownSurface {
  SceneSurface surface;
  std::vector<int> nodes;
  SkinPlan plan = {};
};

// `edge`: the places of its nodes [m], z up. A flat one is straight lines between the middle of its edge and
// the edge (with four nodes: between opposite edges), or where the plan has them, as these would leave what
// is within the edge, at a notch, triangles between nodes. A paraboloid sinks below those lines by depth (1 -
// s^2), s from 0 in the middle to 1 at the edge, depth = D / (16 F) for the diameter D of the ring and F =
// focal_ratio, to its back.
Skin skin_of(const SceneSurface& surface, const std::vector<Vec3>& edge, const SkinPlan& plan);

}  // namespace unfurl
