// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/assembly.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "core/system/system.hpp"
#include "tests/support/family_structure.hpp"

using namespace unfurl;

namespace assembly_test {

namespace {

// Four nodes far from the origin and from every plane of coordinates, a massless pin m of the first rod and c
// the point that divides it.
Assembly started() {
  Assembly a;
  a.node("p", {1.3, -0.7, 2.1}, 1.0);
  a.node("q", {2.9, 0.6, 1.2}, 1.0);
  a.node("r", {1.1, 0.9, 1.9}, 1.0);
  a.node("s", {3.1, -1.0, 1.4}, 1.0);  // r + s = p + q: the rods pq and rs cross at their middles
  a.node("m", {2.1, -0.05, 1.65});
  a.node("c", {1.3 + 0.3 * 1.6, -0.7 + 0.3 * 1.3, 2.1 - 0.3 * 0.9});
  return a;
}

}  // namespace

TEST_CASE("what an assembly constrains holds where its nodes are, and nowhere beside it") {
  const Vec3 n = Vec3(2, -1, 2) / 3;
  struct Case {
    const char* what;
    std::function<void(Assembly&)> add;
    int node;      // to be moved
    Vec3 out;      // of what is held
    double error;  // then, over all rows [m]; NaN: of a unit of its own
  };
  for (const Case& c :
       {Case{"fix", [](Assembly& a) { a.fix(0); }, 0, Vec3(0.1, 0, 0), 0.1},
        Case{"plane", [&](Assembly& a) { a.plane(1, n); }, 1, 0.1 * n, 0.1},
        Case{"line", [&](Assembly& a) { a.line(2, n); }, 2, 0.1 * n.unitOrthogonal(), 0.1},
        Case{"relation",
             [&](Assembly& a) {
               a.relation("sum", {0, 3}, {n, 0.7 * Vec3::UnitX()});
             },
             3, Vec3(0.1, 0, 0), 0.07},
        Case{"point of a rod", [](Assembly& a) { a.point_of_rod(5, 0, 1, 0.3); }, 5, Vec3(0, 0.1, 0), 0.1},
        Case{"middles", [](Assembly& a) { a.pin_middles(4, 0, 1, 2, 3); }, 3, Vec3(0, 0, 0.1), 0.1},
        Case{"coplanar",
             [](Assembly& a) {
               a.coplanar({0, 1, 2, 3}, "face");
             },
             3, Vec3(0.3, 0.2, 0.5), std::nan("")}}) {
    INFO(c.what);
    Assembly a = started();
    c.add(a);
    for (const int i : {4, 5}) a.structure.nodes[static_cast<std::size_t>(i)].mass = 0.1;
    const System system(a.structure, false);
    VectorXd q = node_positions(a.structure), phi(system.all_constraints());
    REQUIRE(phi.size() >= 1);
    system.all_constraint_values(0, q, phi);
    CHECK(phi.lpNorm<Eigen::Infinity>() <= 1e-15);  // sums of a few numbers of some metres
    q.segment<3>(3 * c.node) += c.out;
    system.all_constraint_values(0, q, phi);
    CHECK(phi.norm() >= 0.01);
    if (!std::isnan(c.error)) CHECK(phi.norm() == Approx(c.error).epsilon(1e-12));
  }
}

TEST_CASE("what is shown as solved is shown once, however often that is said") {
  Assembly a = started();
  a.rod(0, 1, (a.position(1) - a.position(0)).norm(), 1.0, "rod", 0.01);
  a.load(2, {0.1, 0.2, 0.3});
  for (int times = 0; times < 2; ++times) {
    show_as_solved(a.structure);
    REQUIRE(a.structure.node_copies.size() == 6);
    CHECK(a.structure.rod_copies.size() == 1);
    CHECK(a.structure.load_copies.size() == 1);
    CHECK(whole_positions(a.structure, node_positions(a.structure)) == node_positions(a.structure));
  }
}

}  // namespace assembly_test
