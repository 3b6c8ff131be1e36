// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/custom.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "core/structure/structure_error.hpp"
#include "core/text/name_index.hpp"

using namespace unfurl;

namespace custom_test {

namespace {

CustomNode node(const char* name, Vec3 position, double mass = 1.0) {
  return {name, position, Vec3::Zero(), mass, false};
}

CustomRod rod(const char* a, const char* b, double mass = 1.0) {
  CustomRod r;
  r.nodes = {a, b};
  r.mass = mass;
  return r;
}

CustomSpec triangle() {
  CustomSpec spec;
  spec.nodes = {node("A", {0, 0, 0}), node("B", {3, 0, 0}), node("C", {0, 4, 0})};
  spec.rods = {rod("A", "B"), rod("B", "C"), rod("C", "A")};
  return spec;
}

// "table[index].key: message", one line each.
std::string problems_of(const CustomSpec& spec) {
  std::string text;
  for (const auto& p : check_custom(spec))
    text += p.table + "[" + std::to_string(p.index) + "]." + p.key + ": " + p.message + "\n";
  return text;
}

}  // namespace

TEST_CASE("a list becomes a structure with measured rods") {
  CustomSpec spec = triangle();
  spec.nodes[0].fixed = true;
  spec.rods[1].mass.reset();
  spec.rods[1].density = 2.0;
  spec.rods[1].area = 0.5;
  const Structure s = build_custom(spec);
  REQUIRE(s.nodes.size() == 3);
  REQUIRE(s.rods.size() == 3);
  CHECK(s.rods[0].name == "A-B");
  CHECK(s.rods[1].length == 5.0);  // 3-4-5, exact in binary
  CHECK(s.rods[1].mass == 5.0);    // density * area * length
  CHECK(s.rods[1].radius == Approx(std::sqrt(0.5 / pi)));
  REQUIRE(s.constraints.size() == 1);
  CHECK(s.constraints[0].kind == "fixed");
  CHECK(s.constraints[0].nodes == std::vector<int>{0});
  CHECK(s.node_copies.size() == 3);
  CHECK(s.rod_copies.size() == 3);
}

TEST_CASE("globs match as in a shell") {
  CHECK(glob_match("B*", "B12"));
  CHECK(glob_match("*", ""));
  CHECK(glob_match("B?", "B1"));
  CHECK(glob_match("*1*2", "a1b2c12"));
  CHECK_FALSE(glob_match("B?", "B12"));
  CHECK_FALSE(glob_match("B", "B1"));
  CHECK_FALSE(glob_match("", "B"));
  // A naive matcher needs 2^30 steps here.
  CHECK_FALSE(glob_match("*a*a*a*a*a*a*a*a*a*a*a*a*a*a*ab", std::string(60, 'a')));
}

TEST_CASE("globs match as their definition says: all short patterns against all short names") {
  // A star stands for any text: nothing, or one character and a star.
  const std::function<bool(std::string_view, std::string_view)> defined = [&](std::string_view p,
                                                                              std::string_view n) {
    if (p.empty()) return n.empty();
    if (p[0] == '*') return defined(p.substr(1), n) || (!n.empty() && defined(p, n.substr(1)));
    return !n.empty() && (p[0] == '?' || p[0] == n[0]) && defined(p.substr(1), n.substr(1));
  };
  const auto texts = [](std::string_view letters, std::size_t longest) {
    std::vector<std::string> all = {""};
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].size() < longest)
        for (const char c : letters) all.push_back(all[i] + c);
    return all;
  };
  std::string wrong;
  for (const std::string& pattern : texts("ab*?", 4))
    for (const std::string& name : texts("ab", 5))
      if (glob_match(pattern, name) != defined(pattern, name)) wrong += pattern + " " + name + "\n";
  CHECK(wrong == "");
}

TEST_CASE("a sound list has no problems") {
  CHECK(problems_of(triangle()) == "");
}

TEST_CASE("each mistake is found, with its place and its cure") {
  CustomSpec spec = triangle();
  SECTION("no nodes") {
    CHECK(problems_of({}) == "nodes[-1].: a custom structure needs nodes: [[structure.nodes]]\n");
  }
  SECTION("the same name twice") {
    spec.nodes.push_back(node("B", {9, 9, 9}));
    CHECK(problems_of(spec) == "nodes[3].name: there is already a node 'B', entry 1\n");
  }
  SECTION("a rod to nowhere") {
    spec.rods.push_back(rod("A", "Bb"));
    CHECK(problems_of(spec) == "rods[3].nodes: there is no node 'Bb'; did you mean 'B'?\n");
  }
  SECTION("a rod to nowhere from a node that has no mass but the rod's") {
    spec.nodes.push_back(node("D", {9, 9, 9}, 0.0));
    spec.rods.push_back(rod("D", "Bb"));
    CHECK(problems_of(spec) == "rods[3].nodes: there is no node 'Bb'; did you mean 'B'?\n");
  }
  SECTION("a rod to itself") {
    spec.rods.push_back(rod("A", "A"));
    CHECK(problems_of(spec) == "rods[3].nodes: a rod from 'A' to itself\n");
  }
  SECTION("a rod of no length") {
    spec.nodes.push_back(node("D", {3, 0, 0}));
    spec.rods.push_back(rod("B", "D"));
    CHECK(problems_of(spec) == "rods[3].nodes: zero length: 'B' and 'D' have the same position\n");
  }
  SECTION("a rod whose squared length is no double") {
    spec.nodes.push_back(node("D", {3e200, 0, 0}));
    spec.rods.push_back(rod("A", "D"));
    CHECK(problems_of(spec) ==
          "rods[3].nodes: the square of its length is outside the range of double precision\n");
  }
  SECTION("the same rod twice without names of their own") {
    spec.rods.push_back(rod("A", "B"));
    CHECK(problems_of(spec) ==
          "rods[3].name: there is already a rod 'A-B', entry 0; give this one a name of its own\n");
  }
  SECTION("no mass") {
    spec.rods[0].mass.reset();
    CHECK(problems_of(spec) ==
          "rods[0].mass: give mass (0: a pure distance constraint), or both density and area\n");
  }
  SECTION("negative mass of a rod") {
    spec.rods[0].mass = -1;
    CHECK(problems_of(spec) == "rods[0].mass: must be >= 0 kg\n");
  }
  SECTION("negative mass of a node") {
    spec.nodes[0].mass = -1;
    CHECK(problems_of(spec) == "nodes[0].mass: must be >= 0 kg\n");
  }
  SECTION("what is not finite") {
    spec.nodes[1].position[0] = std::nan("");
    CHECK(problems_of(spec) == "nodes[1].position: must be finite\n");
  }
}

TEST_CASE("every number of a rod that cannot be is named") {
  const double endless = std::numeric_limits<double>::infinity();
  const auto problem = [](double CustomRod::*key, double value) {
    CustomSpec spec = triangle();
    spec.rods[2].*key = value;
    const std::string text = problems_of(spec);
    return text.substr(0, text.find(':'));
  };
  for (const double wrong : {-1.0, endless, std::nan("")}) {
    INFO(wrong);
    CHECK(problem(&CustomRod::length, wrong) == "rods[2].length");
    CHECK(problem(&CustomRod::second_moment, wrong) == "rods[2].second_moment");
    CHECK(problem(&CustomRod::free_length, wrong) == "rods[2].free_length");
  }
  for (const double wrong : {-1.0, 0.0}) {
    INFO(wrong);
    CHECK(problem(&CustomRod::youngs_modulus, wrong) == "rods[2].youngs_modulus");
    CHECK(problem(&CustomRod::strength, wrong) == "rods[2].strength");
  }
  CHECK(problem(&CustomRod::length, 2.0).empty());
}

TEST_CASE("what a rod of a list lacks to give and to bend is named") {
  CustomSpec spec = triangle();
  spec.material.section = "tube";
  spec.material.wall_thickness = 2e-3;
  spec.rods[1].area = pi * 4e-6;  // of a rod of that radius
  CHECK(problems_of(spec).empty());
  spec.rods[1].area = 0.99 * pi * 4e-6;
  CHECK(problems_of(spec).starts_with("rods[1].area: a tube needs the thickness of its wall"));
  spec = triangle();
  spec.rods[1].segments = 3;
  CHECK(problems_of(spec).starts_with("rods[1].segments: a rod that bends needs its area"));
  spec.rods[1].area = 2e-5;
  CHECK(problems_of(spec).starts_with("rods[1].segments: a rod that bends needs its area"));
  spec.rods[1].youngs_modulus = 7e10;
  CHECK(problems_of(spec).empty());
  spec.rods[1].elastic = true;
  spec.rods[1].mass = 0.0;
  CHECK(problems_of(spec).empty());
  spec.material.damping_ratio = 0.02;
  CHECK(problems_of(spec) ==
        "rods[1].mass: damping_ratio needs the mass of an elastic rod; damping_time does not\n");
}

TEST_CASE("building a wrong list throws its first problem") {
  CustomSpec spec = triangle();
  spec.rods.push_back(rod("A", "X"));
  try {
    build_custom(spec);
    FAIL("built");
  } catch (const StructureError& error) {
    CHECK(error.key == "rods[3].nodes");
  }
}

TEST_CASE("a list that is wrong everywhere ends its report") {
  CustomSpec spec = triangle();
  for (int i = 0; i < 10000; ++i) spec.rods.push_back(rod("A", "X"));
  CHECK(check_custom(spec).size() == 100);
}

// Rods that start stretched have the material of their length without force.
TEST_CASE("the mass of a rod by its density is that of its length without force") {
  CustomSpec spec;
  spec.nodes = {{"A", {0.1, 0, 0}, {0, 0, 0}, 0.0, false}, {"B", {1.1, 0, 0}, {0, 0, 0}, 0.0, false}};
  CustomRod rod{"", {"A", "B"}};
  rod.density = 2500;
  rod.area = 4e-4;
  rod.youngs_modulus = 1e6;
  rod.elastic = true;
  spec.rods = {rod};
  CHECK(build_custom(spec).rods[0].mass == Approx(2500 * 4e-4 * 1.0).epsilon(1e-14));
  spec.rods[0].free_length = 0.5;
  CHECK(build_custom(spec).rods[0].mass == Approx(2500 * 4e-4 * 0.5).epsilon(1e-14));
  spec.rods[0].free_length = 0;
  spec.rods[0].length = 1.003;
  CHECK(build_custom(spec).rods[0].mass == Approx(2500 * 4e-4 * 1.003).epsilon(1e-14));
}

}  // namespace custom_test
