// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/solid_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace unfurl {

Surface surface_of(Finish finish) {
  switch (finish) {
    case Finish::paint:
      return {0.0f, 0.45f};
    case Finish::anodised:
      return {0.35f, 0.32f};
    case Finish::metal:
      return {0.85f, 0.30f};
    case Finish::carbon:
      return {0.0f, 0.22f};
    case Finish::foil:
      return {0.95f, 0.38f};
  }
  return {0.0f, 0.5f};
}

namespace {

constexpr float pi_f = std::numbers::pi_v<float>;

// A point of the outline in the half plane of the radius r and the axis z; lengths in radii.
struct Outline {
  float r, z, normal_r, normal_z, end;
};

// Turn an outline, listed from the far negative end to the positive one, around the z axis. Two outline
// points at one place with two normals make an edge.
Mesh revolve(const std::vector<Outline>& outline, int sides) {
  Mesh mesh;
  for (const Outline& p : outline) {
    for (int k = 0; k < sides; ++k) {
      const float angle = 2 * pi_f * static_cast<float>(k) / static_cast<float>(sides);
      const float c = std::cos(angle), s = std::sin(angle);
      mesh.vertices.push_back({{p.r * c, p.r * s, p.z}, {p.normal_r * c, p.normal_r * s, p.normal_z}, p.end});
    }
  }
  for (std::size_t ring = 0; ring + 1 < outline.size(); ++ring) {
    const Outline &p = outline[ring], &q = outline[ring + 1];
    if (p.r == q.r && p.z == q.z && p.end == q.end) continue;  // an edge
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides, base = static_cast<int>(ring) * sides;
      const auto corner = [&](int i) { mesh.indices.push_back(static_cast<std::uint16_t>(base + i)); };
      if (p.r > 0) corner(k), corner(next), corner(k + sides);
      if (q.r > 0) corner(next), corner(next + sides), corner(k + sides);
    }
  }
  return mesh;
}

SolidInstance solid(const Vec3f& a, const Vec3f& b, float radius_a, float radius_b, const Color& c,
                    Finish finish) {
  const Surface surface = surface_of(finish);
  return {a, b, radius_a, radius_b, c.r, c.g, c.b, surface.metal, surface.roughness, Vec3f::Zero()};
}

void add_arrow(const Arrow& arrow, std::vector<SolidInstance>& cylinders) {
  const Vec3f along = arrow.head - arrow.tail;
  const float length = along.norm();
  if (length <= 0) return;
  const float head_length = std::min(6.5f * arrow.radius, 0.6f * length);
  const Vec3f neck = arrow.head - along * (head_length / length);
  cylinders.push_back(solid(arrow.tail, neck, arrow.radius, arrow.radius, arrow.color, Finish::paint));
  cylinders.push_back(solid(neck, arrow.head, 2.4f * arrow.radius, 0.0f, arrow.color, Finish::paint));
}

}  // namespace

Mesh capsule_mesh(int sides, int cap_rings) {
  std::vector<Outline> outline;
  for (int half = 0; half < 2; ++half) {
    for (int ring = 0; ring <= cap_rings; ++ring) {
      const float angle =
          0.5f * pi_f * (static_cast<float>(ring) / static_cast<float>(cap_rings) - (half ? 0.0f : 1.0f));
      const bool pole = ring == (half ? cap_rings : 0);
      const float r = pole ? 0.0f : std::cos(angle), z = std::sin(angle);
      outline.push_back({r, z, r, z, static_cast<float>(half)});
    }
  }
  return revolve(outline, sides);
}

Mesh cylinder_mesh(int sides) {
  constexpr float bevel = 0.18f, slant = std::numbers::sqrt2_v<float> / 2;
  return revolve({{0, 0, 0, -1, 0},
                  {1 - bevel, 0, 0, -1, 0},
                  {1 - bevel, 0, slant, -slant, 0},
                  {1, bevel, slant, -slant, 0},
                  {1, bevel, 1, 0, 0},
                  {1, -bevel, 1, 0, 1},
                  {1, -bevel, slant, slant, 1},
                  {1 - bevel, 0, slant, slant, 1},
                  {1 - bevel, 0, 0, 1, 1},
                  {0, 0, 0, 1, 1}},
                 sides);
}

Mesh plain_cylinder_mesh(int sides) {
  return revolve({{0, 0, 0, -1, 0},
                  {1, 0, 0, -1, 0},
                  {1, 0, 1, 0, 0},
                  {1, 0, 1, 0, 1},
                  {1, 0, 0, 1, 1},
                  {0, 0, 0, 1, 1}},
                 sides);
}

Mesh ribbon_mesh(float before, float beyond) {
  return {{{{-1, 0, -before}, {-1, 0, 0}, 2},
           {{1, 0, -before}, {1, 0, 0}, 2},
           {{1, 0, beyond}, {1, 0, 0}, 3},
           {{-1, 0, beyond}, {-1, 0, 0}, 3}},
          {0, 3, 2, 0, 2, 1}};
}

// The outline in the plane of y and z, counter-clockwise seen from +x: round at a, then along to b.
Mesh plate_mesh(int parts) {
  struct Corner {
    float y, z, end;
  };
  std::vector<Corner> outline;
  for (int k = 0; k <= parts; ++k) {
    const float angle = pi_f * (1 + static_cast<float>(k) / static_cast<float>(parts));
    outline.push_back({std::cos(angle), std::sin(angle), 0});
  }
  outline.push_back({1, 0, 1});
  outline.push_back({-1, 0, 1});
  Mesh mesh;
  const auto count = outline.size();
  for (const float x : {-1.0f, 1.0f})
    for (const Corner& c : outline) mesh.vertices.push_back({{x, c.y, c.z}, {x, 0, 0}, c.end});
  const auto corner = [&](std::size_t i) { mesh.indices.push_back(static_cast<std::uint16_t>(i)); };
  for (std::size_t k = 1; k + 1 < count; ++k) {
    corner(0), corner(k + 1), corner(k);
    corner(count), corner(count + k), corner(count + k + 1);
  }
  for (std::size_t k = 0; k < count; ++k) {  // the rim
    const Corner &p = outline[k], &q = outline[(k + 1) % count];
    const bool arc = k < static_cast<std::size_t>(parts);
    const Vec3f flat(0, k + 2 == count ? 0.0f : p.y, k + 2 == count ? 1.0f : 0.0f);
    for (const Corner* c : {&p, &q})
      for (const float x : {-1.0f, 1.0f})
        mesh.vertices.push_back({{x, c->y, c->z}, arc ? Vec3f(0, c->y, c->z) : flat, c->end});
    const std::size_t first = mesh.vertices.size() - 4;
    corner(first), corner(first + 2), corner(first + 1);
    corner(first + 1), corner(first + 2), corner(first + 3);
  }
  return mesh;
}

std::vector<SolidInstance> tubes_of(const std::vector<Tube>& tubes) {
  std::vector<SolidInstance> out;
  for (const Tube& t : tubes) out.push_back(solid(t.a, t.b, t.radius, t.radius, t.color, t.finish));
  return out;
}

Solids solids_of(const DrawList& list) {
  Solids out;
  out.capsules = tubes_of(list.tubes);
  for (const Sleeve& s : list.sleeves)
    out.cylinders.push_back(solid(s.a, s.b, s.radius, s.radius, s.color, s.finish));
  for (const Plate& p : list.plates) {
    out.plates.push_back(solid(p.a, p.b, p.half_width, p.half_thickness, p.color, p.finish));
    out.plates.back().side = p.side;
  }
  for (const Ball& b : list.balls) {
    out.balls.push_back(solid(b.center, b.center, b.radius, b.radius, b.color, b.finish));
  }
  for (const Arrow& a : list.arrows) add_arrow(a, out.cylinders);
  return out;
}

}  // namespace unfurl
