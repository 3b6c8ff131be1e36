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
    CHECK(deployment.fraction(q) == Approx(0).margin(1e-12));
    CHECK(deployment.initial_fold_angle > deployment.deployed_fold_angle);
    CHECK(deployment.remaining(q) > 0);
  }
  CHECK(found >= 6);
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
