// SPDX-License-Identifier: BSD-3-Clause
// [[surfaces]] of a scene: meshes, membranes and panels that are shown between nodes and carried by them.
// They have no mass and no force.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_error.hpp"
#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

struct SceneSurface {
  std::string kind = "mesh";
  std::vector<std::string> nodes;  // names or globs, in order around the edge
  std::string shape = "flat";      // what is spanned between them: "flat" or "paraboloid"
  double focal_ratio = 0.5;        // of a paraboloid: focal length over diameter of the ring
  int cells = 16;                  // of a net or a panel, from edge to edge
  double opacity = 0.0;            // 0: the kind's own
  bool enabled = true;
  SourceLocation where = {};

  bool operator==(const SceneSurface& o) const {
    return kind == o.kind && nodes == o.nodes && shape == o.shape && focal_ratio == o.focal_ratio &&
           cells == o.cells && opacity == o.opacity && enabled == o.enabled;
  }
};

struct SurfaceKind {
  std::string_view name, help;
};
std::span<const SurfaceKind> surface_kinds();  // unfurl list surfaces

const std::vector<ParamSpec>& surface_params();  // of an entry, but for its nodes
SceneSurface scene_surface(const ParamSet& values);
ParamSet surface_values(const SceneSurface& surface);

// The copied nodes along its edge, in the order given; globs give theirs in ascending order. Throws
// SceneError with `key` where a name is none of the structure's or fewer than three are left.
std::vector<int> surface_nodes(const SceneSurface& surface, const std::string& key,
                               const Structure& structure);

}  // namespace unfurl
