// SPDX-License-Identifier: BSD-3-Clause
// Building a custom structure by hand: every step is a line of TOML beside the file, as --set would say it.
#pragma once

#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/document/selection.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

// How a point in space becomes one that a person can mean.
struct BuildGrid {
  double step = 0.1;   // [m]; 0: none
  int plane = -1;      // nodes move in planes across the axis 0 x, 1 y, 2 z; -1: in that of the view
  int mirror = -1;     // every step is done to the mirror image across that axis' plane too; -1: none
  bool follow = true;  // lengths of rods follow their nodes; else they stay, and the rest moves with a node

  bool operator==(const BuildGrid&) const = default;
};
Vec3 snapped(Vec3 point, const BuildGrid& grid);
Vec3 mirrored(Vec3 point, int axis);
// The nodes that a person sees, at the start; whether places lie in one plane across an axis.
std::vector<Vec3> places_of(const Structure& structure);
bool in_plane_across(int axis, const std::vector<Vec3>& places);

// These throw SceneError where the scene is none of nodes and rods of its own file.
// A new node, called `name`: one that is free.
SceneDocument with_node(const SceneDocument& document, const Vec3& position, std::string& name);
SceneDocument with_rod(const SceneDocument& document, const std::string& a, const std::string& b);
// Nodes elsewhere; `follow`: rods that give a length take the new distance.
struct NodePlace {
  std::string name;
  Vec3 position;
};
SceneDocument with_positions(const SceneDocument& document, const std::vector<NodePlace>& places,
                             bool follow);
// Without a node and its rods, or without a rod.
SceneDocument without_part(const SceneDocument& document, const Selection& part);
// The node that stands at a place; empty: none.
std::string node_at(const Scene& scene, const Vec3& place);

}  // namespace unfurl
