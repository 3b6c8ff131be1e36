// SPDX-License-Identifier: BSD-3-Clause
// The few shapes that a scene is made of, as bodies of revolution between two points.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scene/draw_list.hpp"

namespace unfurl {

// A point of a body around the z axis, to be placed between the points a and b of an instance by the shader:
// at a (end 0) or b (end 1), moved by `offset` times the radius there, the z axis turned to b - a.
struct MeshVertex {
  Vec3f offset;
  Vec3f normal;  // of a cylinder; the shader tilts it where the radii differ
  float end;
};

struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint16_t> indices;  // triangles, counter-clockwise seen from outside
};

Mesh capsule_mesh(int sides, int cap_rings);  // round ends beyond a and b; a ball where a = b
Mesh cylinder_mesh(int sides);                // flat ends at a and b with a bevel; a cone where a radius is 0
Mesh plate_mesh(int parts);                   // round around a, flat at b; x is across it
Mesh plain_cylinder_mesh(int sides);          // the same without the bevel
// Flat, between the two sides of a body as they are seen: for what is a few pixels wide. Its ends are 2 and
// 3, x is across the line of sight, y towards the eye; it goes on by so much before a and beyond b [radii].
Mesh ribbon_mesh(float before, float beyond);

// One body of a mesh: 16 floats, as the shader takes them.
struct SolidInstance {
  Vec3f a, b;
  float radius_a, radius_b;    // of a plate half its width and half its thickness [m]
  float red, green, blue;      // sRGB-encoded
  float metal, roughness;      // 0..1
  Vec3f side = Vec3f::Zero();  // of a plate: across it; else zero
};

struct Surface {
  float metal, roughness;  // 0..1
};
Surface surface_of(Finish finish);

// The instances of a picture by the mesh that they use.
struct Solids {
  std::vector<SolidInstance> capsules, balls, cylinders, plates;
};
Solids solids_of(const DrawList& list);
std::vector<SolidInstance> tubes_of(const std::vector<Tube>& tubes);

}  // namespace unfurl
