// SPDX-License-Identifier: BSD-3-Clause
// Angles between planes whose sides lie nearly along their common edge, as those of folded rings do.
#include "core/structure/dihedral.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"

using namespace unfurl;

namespace dihedral_test {

namespace {

using Exact = Eigen::Matrix<long double, 3, 1>;

// Of the coordinates as they are, in 64 bits of mantissa and by what is across the edge.
long double exact(const VectorXd& q) {
  const auto node = [&](Index k) -> Exact { return q.segment<3>(3 * k).cast<long double>(); };
  const Exact along = node(2) - node(1), a = along.cross(node(0) - node(1)),
              d = along.cross(node(3) - node(1));
  return std::atan2(a.cross(d).dot(along) / along.norm(), a.dot(d));
}

}  // namespace

// A plane at x from its edge is known to round-off over x, of the four nodes' coordinates, some 1 m: ten
// units are granted. By products of the sides it would be known to round-off over x^2.
TEST_CASE("a dihedral angle is as exact as the coordinates of its nodes") {
  std::mt19937 seeded(3);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<int> stencil(12);
  std::iota(stencil.begin(), stencil.end(), 0);
  VectorXd gradient(12);
  for (const double x : {1.0, 0.1, 0.01, 0.001})
    for (int k = 0; k < 50; ++k) {
      VectorXd q(12);
      for (double& value : q) value = any(seeded);
      const Vec3 foot = q.segment<3>(3), along = (Vec3(q.segment<3>(6)) - foot).normalized();
      for (const Index node : {0, 3}) {
        const Vec3 across = along.cross(Vec3(any(seeded), any(seeded), any(seeded))).normalized();
        q.segment<3>(3 * node) = foot + std::cos(x) * along + std::sin(x) * across;
      }
      const double off = std::remainder(
          dihedral(q.data(), stencil, gradient.data()) - static_cast<double>(exact(q)), 2 * std::acos(-1.0));
      CAPTURE(x, k);
      CHECK(std::abs(off) <= 10 * std::numeric_limits<double>::epsilon() / x);
    }
}

// Folded so far, the bays of this ring of four turned about their posts by angles of which 1e-14 was
// round-off: no step of 2.5 ms reached it, and the run ended at 0.235 s after 3 s of trying.
TEST_CASE("a ring of bays that is folded to 85 degrees unfolds in short steps") {
  const Scene scene = read_scene_file(
      find_scene("cable_ring"),
      {"structure.units=4", "structure.fold_angle=85.37", "structure.joint_damping=0.15",
       "structure.cable_rate=0.978", "solver.stages=6", "solver.step=0.0025", "solver.end_time=0.5"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(run.status == RunStatus::completed);
  CHECK(run.newton_iterations <= 10 * run.steps);
}

}  // namespace dihedral_test
