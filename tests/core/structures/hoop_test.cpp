// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/hoop.hpp"
#include "core/math/singular_values.hpp"
#include "core/structure/node_positions.hpp"

#include <catch2/catch.hpp>

#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace hoop_test {

namespace {

MatrixXd scaled_jacobian(const System& system, const VectorXd& q) {
  return MatrixXd(system.all_jacobian(q));
}

Index rank(const MatrixXd& G) {
  // The smallest true one is above 1e-5 in these tests, round-off 1e-15.
  return (singular_values(G).array() > 1e-9).count();
}

}  // namespace

TEST_CASE("a ring of n units has 12 n coordinates and 13 n constraints of rank 12 n - 1") {
  for (long n : {3L, 4L, 6L, 9L}) {
    const Structure s = hoop_structure({{"units", n}, {"fold_angle", 45.0}});
    const System system(s, true);
    INFO("n = " << n);
    CHECK(system.coordinates() == 12 * n);
    CHECK(system.all_constraints() == 13 * n);
    CHECK(system.solved_coordinates() == 4 * n);
    CHECK(rank(scaled_jacobian(system, node_positions(s))) == 12 * n - 1);
    VectorXd phi(system.all_constraints());
    system.all_constraint_values(0.0, node_positions(s), phi);
    CHECK(phi.lpNorm<Eigen::Infinity>() <= 1e-14);  // coordinates of some 10 m: a few ulp
  }
  // A motion starts folded: the deployed pose is the one at 60 degrees, its radii doubled, its hinges level
  // with the ends of the posts.
  Structure deployed = hoop_structure({{"fold_angle", 60.0}});
  for (std::size_t i = 0; i < deployed.nodes.size(); ++i) {
    Vec3& x = deployed.nodes[i].position;
    x.head<2>() *= 2.0;
    x[2] = i % 2 == 0 ? -0.6 : 0.6;
  }
  CHECK(rank(scaled_jacobian(System(deployed, true), node_positions(deployed))) ==
        60);  // 10 n: a bifurcation
}

TEST_CASE("the sector shows the same ring as the full model") {
  const Structure full = hoop_structure({{"units", 7L}, {"fold_angle", 70.0}});
  const Structure sector =
      hoop_structure({{"units", 7L}, {"fold_angle", 70.0}, {"model", std::string("sector")}});
  REQUIRE(sector.nodes.size() == 4);
  REQUIRE(sector.node_copies.size() == full.node_copies.size());
  REQUIRE(sector.rod_copies.size() == full.rod_copies.size());
  const VectorXd a = whole_positions(full, node_positions(full)),
                 b = whole_positions(sector, node_positions(sector));
  CHECK((a - b).lpNorm<Eigen::Infinity>() <= 1e-14);  // rotations of coordinates of a few metres
  for (std::size_t i = 0; i < full.node_copies.size(); ++i)
    CHECK(full.node_copies[i].name == sector.node_copies[i].name);
  for (std::size_t i = 0; i < full.rod_copies.size(); ++i) {
    CHECK(full.rod_copies[i].name == sector.rod_copies[i].name);
    CHECK(full.rod_copies[i].a == sector.rod_copies[i].a);
    CHECK(full.rod_copies[i].b == sector.rod_copies[i].b);
  }
  CHECK(System(sector, true).solved_coordinates() == 4);
}

TEST_CASE("kinetic energy of the ring is the closed form") {
  // T per unit = l1^2 theta'^2 G(theta), the work of two hinge forces 2 f l1 (sin theta_0 - sin theta); with
  // theta' = 1 at theta = 0.7 rad.
  for (const char* model : {"full", "sector"}) {
    const double theta = 0.7;
    const Structure s =
        hoop_structure({{"fold_angle", theta / radians_per_degree}, {"model", std::string(model)}});
    const exact::Hoop hoop = exact_hoop();
    const System system(s, true);
    VectorXd v = VectorXd::Zero(system.coordinates());
    const double l1 = 3.0, radius_rate = -l1 * std::sin(theta) / std::sin(pi / 6);
    for (std::size_t i = 0; i < s.nodes.size(); ++i) {
      const Vec3 x = s.nodes[i].position;
      const Vec3 e = Vec3(x[0], x[1], 0).normalized();
      const std::size_t role = i % 4;
      Vec3 rate = e * radius_rate * (role < 2 ? 1.0 : std::cos(pi / 6));
      if (role == 2) rate[2] = l1 * std::cos(theta);
      if (role == 3) rate[2] = -l1 * std::cos(theta);
      v.segment<3>(3 * static_cast<Index>(i)) = rate;
    }
    const double expected = l1 * l1 * hoop.G(theta) * (s.nodes.size() == 24 ? 6 : 1);
    // Sums of some 30 terms of equal sign: 1e-14.
    CHECK(system.kinetic_energy(system.reduce_rate(v)) == Approx(expected).epsilon(1e-14));
  }
}

}  // namespace hoop_test
