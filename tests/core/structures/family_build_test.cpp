// SPDX-License-Identifier: BSD-3-Clause
// What families make of their parameters, beside the motions that follow.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "core/structures/rod_material.hpp"
#include "tests/support/family_structure.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace family_build_test {

TEST_CASE("every family says which mass matrix its rods have and how its nodes are called") {
  int found = 0;
  for (const Family& family : families()) {
    INFO(family.kind);
    const Structure structure = family_structure(family.kind);
    std::set<std::string> names;
    for (const Node& node : structure.nodes) names.insert(node.name);
    CHECK(names.size() == structure.nodes.size());
    for (const Rod& rod : structure.rods) {
      CHECK(rod.name.ends_with(structure.nodes[static_cast<std::size_t>(rod.a)].name + "-" +
                               structure.nodes[static_cast<std::size_t>(rod.b)].name));
      CHECK_FALSE(rod.group.empty());
    }
    if (std::ranges::none_of(family.params(), [](const ParamSpec& p) { return p.name == "mass"; })) continue;
    ++found;
    CHECK_FALSE(structure.lumped_mass);
    CHECK(family_structure(family.kind, {{"mass", std::string("lumped")}}).lumped_mass);
  }
  CHECK(found > 0);
}

TEST_CASE("the joints of a chain are counted from its start") {
  const Structure chain = family_structure("chain", {{"links", 17L}});
  for (std::size_t i = 0; i < chain.nodes.size(); ++i) CHECK(chain.nodes[i].name == "J" + std::to_string(i));
}

TEST_CASE("the rods of a ladder have the mass and the length that are given") {
  const Structure ladder =
      family_structure("four_bar_ladder", {{"windows", 3L}, {"rod_length", 1.4}, {"rod_mass", 0.37}});
  for (const Rod& rod : ladder.rods) {
    CHECK(rod.mass == 0.37);
    CHECK(rod.length == 1.4);
  }
  CHECK(std::ranges::count(ladder.rods, "upright", &Rod::group) == 4);
  CHECK(std::ranges::count(ladder.rods, "bar", &Rod::group) == 3);
}

TEST_CASE("a sheet stands with its middle at the origin") {
  for (const auto& [rows, columns] : {std::pair{1L, 1L}, {2L, 3L}, {3L, 2L}, {5L, 6L}}) {
    INFO(rows << " x " << columns);
    const Structure sheet =
        family_structure("reentrant_sheet", {{"rows", rows}, {"columns", columns}, {"fold_angle", 37.0}});
    Vec3 low = Vec3::Constant(1e9), high = -low;
    for (const Node& node : sheet.nodes)
      low = low.cwiseMin(node.position), high = high.cwiseMax(node.position);
    CHECK((low + high).lpNorm<Eigen::Infinity>() < 1e-13);  // of some metres
  }
}

// A latch of a bay is how far a longeron's end is above the other, less that of the deployed pose: in the one
// that it starts in, l (sin fold - sin deployed). Both ends of each longeron have a damper of their own.
TEST_CASE("a cable ring has a latch in every bay and a damper at either end of every longeron") {
  for (const double fold : {77.0, 31.0}) {
    const Structure ring = family_structure(
        "cable_ring",
        {{"units", 8L}, {"longeron_length", 1.7}, {"fold_angle", fold}, {"deployed_angle", 12.0}});
    const VectorXd q = node_positions(ring);
    const auto sine = [](double degrees) { return std::sin(degrees * radians_per_degree); };
    REQUIRE(ring.deployment.latches.size() == 8);
    for (const LinearForm& latch : ring.deployment.latches)
      CHECK(std::abs(latch(q)) == Approx(1.7 * (sine(fold) - sine(12))).epsilon(1e-12));
    CHECK(ring.deployment.fold_sine(q) == Approx(sine(fold)).epsilon(1e-12));
    CHECK(ring.deployment.fold_cosine(q) == Approx(sine(90 - fold)).epsilon(1e-12));
    std::set<std::vector<int>> dampers;
    for (const Force& force : ring.forces)
      if (force.damping > 0) dampers.insert(force.measure.nodes);
    CHECK(dampers.size() == 4 * 8);
  }
}

// The posts of a cable ring stand alternately high and low: it is its own image in the plane of a post and
// the axis, and so are nets that are hung into it.
TEST_CASE("nets lie in the rim as symmetrically as it is") {
  for (const long rings : {2L, 3L}) {
    INFO(rings);
    const Structure s = family_structure("mesh_reflector", {{"net_rings", rings}, {"fold_angle", 74.0}});
    const auto corner = std::ranges::find(s.nodes, "B0", &Node::name);
    REQUIRE(corner != s.nodes.end());
    const Vec3 normal = Vec3::UnitZ().cross(corner->position).normalized();
    for (const Node& node : s.nodes) {
      INFO(node.name);
      const Vec3 image = node.position - 2 * normal.dot(node.position) * normal;
      CHECK(std::ranges::any_of(s.nodes,
                                [&](const Node& other) { return (other.position - image).norm() < 1e-9; }));
    }
  }
}

// Of a hinge a part is how far it is above the middle of its neighbours.
TEST_CASE("a ring of joints starts at the angle that is given and its parts are heights of hinges") {
  Structure ring = family_structure("hoop", {{"model", std::string("joints")}, {"fold_angle", 63.0}});
  CHECK(ring.deployment.initial_fold_angle == Approx(63 * radians_per_degree).epsilon(1e-14));
  REQUIRE(ring.deployment.parts.size() == 12);
  const VectorXd q = node_positions(ring);
  for (const LinearForm& part : ring.deployment.parts) {
    VectorXd moved = q;
    moved[3 * part.nodes[0] + 2] += 0.03;
    CHECK(part(moved) - part(q) == Approx(0.03).epsilon(1e-12));
    moved = q;
    for (Index i = 2; i < q.size(); i += 3) moved[i] += 0.4;
    CHECK(part(moved) == Approx(part(q)).epsilon(0).margin(1e-14));
  }
  for (const long unit : {0L, 3L})
    CHECK(refusal("hoop", {{"perturbed_unit", unit}}).starts_with("perturbed_unit: planes of symmetry"));
}

TEST_CASE("a material is read back as it was") {
  const RodMaterial m{7.1e10, 3.3e8, "tube", 1.3e-3, "elastic", 0.017, 2e-4, 5, 3e-5, 41};
  const RodMaterial back = rod_material(rod_material_values(m));
  CHECK(back.youngs_modulus == m.youngs_modulus);
  CHECK(back.strength == m.strength);
  CHECK(back.section == m.section);
  CHECK(back.wall_thickness == m.wall_thickness);
  CHECK(back.rod_model == m.rod_model);
  CHECK(back.damping_ratio == m.damping_ratio);
  CHECK(back.damping_time == m.damping_time);
  CHECK(back.segments == m.segments);
  CHECK(back.length_error == m.length_error);
  CHECK(back.error_seed == m.error_seed);
}

}  // namespace family_build_test
