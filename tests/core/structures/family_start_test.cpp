// SPDX-License-Identifier: BSD-3-Clause
// What every family says of its own deployment, and what a broken list says of itself.
#include <catch2/catch.hpp>

#include "core/structures/custom.hpp"
#include "core/system/system.hpp"
#include "tests/support/family_structure.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace family_start_test {

TEST_CASE("every structure says of which family it is") {
  for (const Family& family : families()) CHECK(family_structure(family.kind).kind == family.kind);
}

TEST_CASE("every family: a deployment begins at fraction 0, at the fold angle that it names") {
  int found = 0;
  for (const Family& family : families()) {
    const Structure structure = family_structure(family.kind);
    const Deployment& deployment = structure.deployment;
    if (deployment.empty()) continue;
    ++found;
    INFO(family.kind);
    const VectorXd q = node_positions(structure);
    CHECK(deployment.fold_angle(q) == Approx(deployment.initial_fold_angle).epsilon(1e-12));
    CHECK(deployment.fraction(q) == Approx(0).epsilon(0).margin(1e-12));
    CHECK(deployment.initial_fold_angle > deployment.deployed_fold_angle);
    CHECK(deployment.remaining(q) > 0);
  }
  CHECK(found >= 6);
}

TEST_CASE("no family starts within 1e-9 rad of its deployed pose, and beyond its fraction is a number") {
  const std::string level =
      "fold_angle: fold_angle must be larger than 0 degrees, at which the structure is deployed";
  const std::string unlike =
      "deployed_angle: deployed_angle must be smaller than fold_angle, at which the motion starts";
  for (const char* model : {"full", "sector", "joints"})
    for (const double fold : {0.0, 5e-10 / radians_per_degree})
      CHECK(refusal("hoop", {{"fold_angle", fold}, {"model", std::string(model)}}) == level);
  CHECK(refusal("cable_ring", {{"fold_angle", 5e-10 / radians_per_degree}}) == level);
  for (const char* kind : {"cable_ring", "hoberman", "reentrant_sheet", "scissor_mast", "scissor_ring"}) {
    INFO(kind);
    const double near = 20.0 + 5e-10 / radians_per_degree;
    CHECK(refusal(kind, {{"fold_angle", near}, {"deployed_angle", 20.0}}) == unlike);
  }
  // At 2e-9 rad the cosines of the folded and of the deployed pose are the same double. The fold angle itself
  // is known to the rounding of node positions, some 1e-15 rad: 1e-6 of that way.
  for (const char* kind : {"hoop", "cable_ring"}) {
    INFO(kind);
    const Structure structure = family_structure(kind, {{"fold_angle", 2e-9 / radians_per_degree}});
    CHECK(structure.deployment.fraction(node_positions(structure)) == Approx(0).epsilon(0).margin(1e-5));
  }
  Deployment
      deployment;  // of a rod of length 1 in the plane x z, half way: 1 - cos is a quarter of the whole
  deployment.fold_cosine = {{0}, {Vec3::UnitX()}, 0.0};
  deployment.fold_sine = {{0}, {Vec3::UnitZ()}, 0.0};
  deployment.initial_fold_angle = 2e-9;
  const Vec3 half(1.0, 0.0, 1e-9);
  CHECK(deployment.fraction(half) == Approx(0.75).epsilon(1e-12));
}

TEST_CASE("braces of every family are called so, by the nodes that they join") {
  int found = 0;
  for (const Family& family : families()) {
    INFO(family.kind);
    const Structure structure = family_structure(family.kind);
    for (const Rod& rod : structure.rods) {
      CHECK((rod.group == "brace") == rod.name.starts_with("brace "));
      if (rod.group != "brace") continue;
      ++found;
      const auto name = [&](int node) { return structure.nodes[static_cast<std::size_t>(node)].name; };
      CHECK(rod.name == "brace " + name(rod.a) + "-" + name(rod.b));
    }
  }
  CHECK(found > 10);
}

TEST_CASE("a broken list says each thing once") {
  CustomSpec spec;
  spec.nodes = {{"A", {0, 0, 0}, {0, 0, 0}, 1.0, false}, {"B", {1.3, 0.2, 0}, {0, 0, 0}, 1.0, false}};
  spec.rods = {{"long", {"A", "X"}, 1.0}, {"right", {"A", "B"}, 1.0}};
  const auto one = check_custom(spec);
  REQUIRE(one.size() == 1);
  CHECK(one[0].table == "rods");
  CHECK(one[0].index == 0);
  CHECK(one[0].key == "nodes");
  CHECK(one[0].message.find("'X'") != std::string::npos);
  // A node that lacks what was to be attached to it is not told of its mass as well.
  spec.nodes.push_back({"C", {2, 0, 0}, {0, 0, 0}, 0.0, false});
  spec.rods = {{"far", {"C", "X"}, 1.0}, {"right", {"A", "B"}, 1.0}};
  CHECK(check_custom(spec).size() == 1);
  // Where the list is otherwise whole, the equations say it: a node without mass may be one that follows
  // others.
  spec.rods.erase(spec.rods.begin());
  CHECK(check_custom(spec).empty());
  CHECK_THROWS_AS(System(build_custom(spec), true), StructureError);
}

}  // namespace family_start_test
