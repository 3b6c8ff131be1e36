// SPDX-License-Identifier: BSD-3-Clause
// Meshes of unit size that exported rods and joints are instances of.
#pragma once

#include <cstdint>
#include <vector>

namespace unfurl {

// Triangles with outward normals, counter-clockwise seen from outside; three floats a vertex.
struct ShapeMesh {
  std::vector<float> positions, normals;
  std::vector<std::uint16_t> triangles;
};

ShapeMesh unit_cylinder(int sides);  // radius 1, along y from -1/2 to 1/2, with caps
ShapeMesh unit_cone(int sides);      // radius 1 at y = -1/2, its tip at 1/2, with a cap
ShapeMesh unit_sphere(int sides);    // radius 1; `sides` meridians, sides / 2 bands

}  // namespace unfurl
