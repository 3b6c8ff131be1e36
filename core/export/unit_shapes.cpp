// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/unit_shapes.hpp"

#include <cmath>

#include "core/math/types.hpp"

namespace unfurl {
namespace {

std::uint16_t add_vertex(ShapeMesh& mesh, const Vec3& position, const Vec3& normal) {
  for (int k = 0; k < 3; ++k) {
    mesh.positions.push_back(static_cast<float>(position[k]));
    mesh.normals.push_back(static_cast<float>(normal[k]));
  }
  return static_cast<std::uint16_t>(mesh.positions.size() / 3 - 1);
}

Vec3 on_circle(int i, int sides) {
  const double angle = 2 * pi * i / sides;
  return {std::cos(angle), 0, std::sin(angle)};
}

// `up`: +1 or -1, the end of the y axis that the cap closes.
void add_cap(ShapeMesh& mesh, int sides, int up) {
  const Vec3 normal(0, up, 0);
  const auto centre = add_vertex(mesh, 0.5 * normal, normal);
  std::vector<std::uint16_t> rim;
  for (int i = 0; i < sides; ++i) rim.push_back(add_vertex(mesh, on_circle(i, sides) + 0.5 * normal, normal));
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const auto next = rim[(i + 1) % rim.size()];
    if (up > 0)
      mesh.triangles.insert(mesh.triangles.end(), {centre, next, rim[i]});
    else
      mesh.triangles.insert(mesh.triangles.end(), {centre, rim[i], next});
  }
}

// Two triangles of the strip between vertex columns i and i + 1 that stand `lower` below.
void add_quad(ShapeMesh& mesh, int low, int low_next, int high, int high_next) {
  for (const int v : {low, high, low_next, low_next, high, high_next})
    mesh.triangles.push_back(static_cast<std::uint16_t>(v));
}

}  // namespace

ShapeMesh unit_cylinder(int sides) {
  ShapeMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const Vec3 out = on_circle(i, sides);
    add_vertex(mesh, out - Vec3(0, 0.5, 0), out);
    add_vertex(mesh, out + Vec3(0, 0.5, 0), out);
  }
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    add_quad(mesh, 2 * i, 2 * next, 2 * i + 1, 2 * next + 1);
  }
  add_cap(mesh, sides, 1);
  add_cap(mesh, sides, -1);
  return mesh;
}

ShapeMesh unit_cone(int sides) {
  ShapeMesh mesh;
  for (int i = 0; i < sides; ++i) {  // the tip once for each side, with the normal of its middle
    const Vec3 out = on_circle(i, sides), middle = (out + on_circle(i + 1, sides)).normalized();
    add_vertex(mesh, out - Vec3(0, 0.5, 0), (out + Vec3::UnitY()).normalized());
    add_vertex(mesh, Vec3(0, 0.5, 0), (middle + Vec3::UnitY()).normalized());
  }
  for (int i = 0; i < sides; ++i)
    for (const int v : {2 * i, 2 * i + 1, 2 * ((i + 1) % sides)})
      mesh.triangles.push_back(static_cast<std::uint16_t>(v));
  add_cap(mesh, sides, -1);
  return mesh;
}

ShapeMesh unit_sphere(int sides) {
  ShapeMesh mesh;
  const int bands = sides / 2;
  for (int b = 0; b <= bands; ++b) {
    const double latitude = pi * b / bands - pi / 2;
    for (int i = 0; i < sides; ++i) {
      const Vec3 p = std::cos(latitude) * on_circle(i, sides) + Vec3(0, std::sin(latitude), 0);
      add_vertex(mesh, p, p.normalized());
    }
  }
  for (int b = 0; b < bands; ++b)
    for (int i = 0; i < sides; ++i) {
      const int next = (i + 1) % sides, low = b * sides, high = low + sides;
      if (b > 0)
        mesh.triangles.insert(mesh.triangles.end(),
                              {static_cast<std::uint16_t>(low + i), static_cast<std::uint16_t>(high + i),
                               static_cast<std::uint16_t>(low + next)});
      if (b + 1 < bands)
        mesh.triangles.insert(mesh.triangles.end(),
                              {static_cast<std::uint16_t>(low + next), static_cast<std::uint16_t>(high + i),
                               static_cast<std::uint16_t>(high + next)});
    }
  return mesh;
}

}  // namespace unfurl
