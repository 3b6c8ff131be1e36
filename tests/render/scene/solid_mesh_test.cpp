// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/solid_mesh.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "render/scene/renderer_bodies.hpp"

using namespace unfurl;

namespace solid_mesh_test {

namespace {

// The corners of a mesh between a = (0,0,0) and b = (0,0,length), with radius 1.
std::vector<Vec3f> placed(const Mesh& mesh, float length) {
  std::vector<Vec3f> out;
  for (const MeshVertex& v : mesh.vertices) out.push_back(v.offset + Vec3f(0, 0, length * v.end));
  return out;
}

double volume(const Mesh& mesh, float length) {
  const std::vector<Vec3f> p = placed(mesh, length);
  double six = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    six += static_cast<double>(p[mesh.indices[i]].cross(p[mesh.indices[i + 1]]).dot(p[mesh.indices[i + 2]]));
  }
  return six / 6;
}

// How often each directed edge occurs, by place.
using Place = std::tuple<long, long, long>;
std::map<std::pair<Place, Place>, int> edges(const Mesh& mesh, float length) {
  const std::vector<Vec3f> points = placed(mesh, length);
  const auto place = [&](std::size_t i) {
    const Vec3f p = points[mesh.indices[i]] * 1e4f;
    return Place{std::lround(p.x()), std::lround(p.y()), std::lround(p.z())};
  };
  std::map<std::pair<Place, Place>, int> count;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) ++count[{place(i + k), place(i + (k + 1) % 3)}];
  }
  return count;
}

}  // namespace

TEST_CASE("meshes are closed surfaces that face outwards") {
  std::vector<Mesh> meshes;
  for (const BodyKind kind : {BodyKind::capsule, BodyKind::ball, BodyKind::cylinder})
    for (int level = 0; level < detail_levels; ++level) meshes.push_back(detailed_mesh(kind, level));
  for (const Mesh& mesh : meshes) {
    const auto all = edges(mesh, 4);
    for (const auto& [edge, times] : all) {
      CHECK(times == 1);
      CHECK(all.count({edge.second, edge.first}) == 1);
    }
    for (const MeshVertex& v : mesh.vertices) CHECK(v.normal.norm() == Approx(1).margin(1e-6));
  }
}

TEST_CASE("fine meshes have the volume of the body, from inside") {
  constexpr double pi_d = std::numbers::pi;
  // Chords of a circle of n sides leave out less than 3.3/n^2 of its area twice over: 64 sides, 0.2 %.
  const double capsule = pi_d * 4 + 4.0 / 3.0 * pi_d, ball = 4.0 / 3.0 * pi_d;
  CHECK(volume(capsule_mesh(64, 16), 4) < capsule);
  CHECK(volume(capsule_mesh(64, 16), 4) == Approx(capsule).epsilon(0.005));
  CHECK(volume(capsule_mesh(64, 16), 0) == Approx(ball).epsilon(0.005));
  // A cylinder less its two bevels of 0.18: each takes pi (0.18^2 - 0.18^3 / 3).
  const double cylinder = pi_d * 4 - 2 * pi_d * (0.18 * 0.18 - 0.18 * 0.18 * 0.18 / 3);
  CHECK(volume(cylinder_mesh(64), 4) == Approx(cylinder).epsilon(0.003));
}

TEST_CASE("what is a few pixels wide is a ribbon, unless its end would be seen") {
  CHECK(is_ribbon(BodyKind::capsule, 3, 0.5f));
  CHECK_FALSE(is_ribbon(BodyKind::capsule, 3, 0.95f));
  CHECK_FALSE(is_ribbon(BodyKind::capsule, 6, 0));
  CHECK_FALSE(is_ribbon(BodyKind::ball, 1, 0));
  // The flat end of a cylinder is an ellipse of radius times cosine: about a pixel at most is left out.
  for (float radius = 0.3f; radius < 6; radius *= 1.2f)
    for (float cosine = 0; cosine < 1; cosine += 0.05f)
      for (const BodyKind kind : {BodyKind::cylinder, BodyKind::plate})
        if (is_ribbon(kind, radius, cosine)) CHECK(radius * cosine < 1.11f);
}

TEST_CASE("facets are finer the larger a body is in the picture, and never far from round") {
  CHECK(detail_level(0.5f) == 0);
  CHECK(detail_level(500) == detail_levels - 1);
  for (float radius = 0.5f; radius < 40; radius *= 1.1f) {
    const int level = detail_level(radius);
    CHECK(detail_level(1.1f * radius) >= level);
    const Mesh mesh = detailed_mesh(BodyKind::capsule, level);
    // The middle of the widest ring's sides, inside the circle [pixels].
    float inside = 0;
    for (std::size_t i = 0; i + 1 < mesh.vertices.size(); ++i) {
      const Vec3f &a = mesh.vertices[i].offset, &b = mesh.vertices[i + 1].offset;
      if (std::abs(a.head<2>().norm() - 1) > 1e-4f || std::abs(b.head<2>().norm() - 1) > 1e-4f) continue;
      const Vec3f middle = 0.5f * (a + b);
      if (middle.head<2>().norm() > 0.5f) inside = std::max(inside, radius * (1 - middle.head<2>().norm()));
    }
    CHECK(inside > 0);
    CHECK(inside <= 0.35f);
  }
}

TEST_CASE("an arrow is a shaft and a cone whose tip is its head, one without length is nothing") {
  DrawList list;
  list.arrows.push_back({{0, 0, 0}, {0, 0, 2}, 0.05f, {}});
  list.arrows.push_back({{1, 1, 1}, {1, 1, 1}, 0.05f, {}});
  const Solids solids = solids_of(list);
  REQUIRE(solids.cylinders.size() == 2);
  CHECK(solids.cylinders[0].b == solids.cylinders[1].a);
  CHECK(solids.cylinders[1].b == Vec3f(0, 0, 2));
  CHECK(solids.cylinders[1].radius_b == 0);
  CHECK(solids.cylinders[1].radius_a > solids.cylinders[0].radius_a);
}

}  // namespace solid_mesh_test
