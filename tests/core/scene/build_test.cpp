// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/build.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace build_test {

namespace {

using testing::error_of;

const std::string hoop = "[structure]\nkind = 'hoop'\n";

}  // namespace

TEST_CASE("every built-in scene becomes a model") {
  REQUIRE(library_scenes().size() >= 6);
  for (const auto& row : library_scenes()) {
    INFO(row.name);
    const auto model = build_model(read_scene_file(row.path));
    CHECK(model->system.coordinates() == static_cast<Index>(3 * model->structure.nodes.size()));
  }
}

TEST_CASE("gravity and loads reach the structure") {
  const Structure s =
      build_structure(read_scene_text(hoop + "hinge_force = 0\n[gravity]\nacceleration = [0, 0, "
                                             "-2]\n[[loads]]\nnodes = ['B?']\nforce = [0, 0, 5]\n",
                                      "x"));
  CHECK(s.gravity == Vec3(0, 0, -2));
  double on_corners = 0;
  for (const auto& load : s.loads)
    if (s.nodes[static_cast<std::size_t>(load.node)].name.starts_with("B")) on_corners += load.force[2];
  CHECK(on_corners == 6 * 5.0);  // B0..B5
}

TEST_CASE("entries that are switched off are as if they were not there, and stay in the file") {
  const std::string entries =
      "[[loads]]\nnodes = ['B?']\nforce = [0, 0, 5]\n[[forces]]\nkind = 'drag'\nnodes = ['B0']\ndamping = 1\n"
      "[[constraints]]\nkind = 'angle'\nfold_angle = true\n";
  const Structure bare = build_structure(read_scene_text(hoop, "x"));
  const std::vector<std::string> off = {"loads[0].enabled=false", "forces[0].enabled=false",
                                        "constraints[0].enabled=false"};
  const Scene scene = read_scene_text(hoop + entries, "x", off);
  const Structure s = build_structure(scene);
  CHECK(s.loads.size() == bare.loads.size());
  CHECK(s.forces.size() == bare.forces.size());
  CHECK(s.constraints.size() == bare.constraints.size());
  const Scene again = read_scene_text(scene_text(scene), "x");
  CHECK_FALSE(again.loads.at(0).enabled);
  CHECK_FALSE(again.forces.at(0).enabled);
  CHECK_FALSE(again.constraints.at(0).enabled);
  // A sector refuses elements, but not those that are off.
  CHECK_NOTHROW(build_structure(read_scene_text(hoop + "model = 'sector'\n" + entries, "x", off)));
  CHECK_THROWS_AS(build_structure(read_scene_text(hoop + "model = 'sector'\n" + entries, "x")), SceneError);
}

TEST_CASE("what a drive or a spring measures at the start is known") {
  const Scene scene = read_scene_text(
      hoop +
          "fold_angle = 60\n[[constraints]]\nkind = 'angle'\nfold_angle = true\n[[forces]]\nkind = "
          "'spring'\nstiffness = 3\nnodes = ['B0', 'T0']\n[[forces]]\nkind = 'drag'\nnodes = ['B0']\ndamping "
          "= 1\n",
      "x");
  const Structure s = build_structure(scene);
  CHECK(start_value(scene.constraints[0], s) ==
        Approx(60).epsilon(0).margin(1e-9));  // degrees, round-off of an arctangent
  CHECK(start_value(scene.forces[0], s) == Approx(scene.structure.real("post_length")).epsilon(1e-12));
  CHECK(std::isnan(start_value(scene.forces[1], s)));  // measures nothing
}

TEST_CASE("a load on a sector is a load on every copy, turned with it") {
  const Structure s = build_structure(read_scene_text(
      hoop + "model = 'sector'\nhinge_force = 0\n[[loads]]\nnodes = 'B0'\nforce = [1, 0, 0]\n", "x"));
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const auto& copy : s.load_copies)
    if (copy.force.norm() > 0.5) {
      sum += copy.force;
      ++count;
    }
  CHECK(count == 6);
  CHECK(sum.norm() < 1e-14);  // six unit vectors that cancel, each entry within an ulp
}

TEST_CASE("loads on nodes that are not there are reported together") {
  CHECK(error_of(hoop + "[[loads]]\nnodes = ['Bx', 'B6']\nforce = [0, 0, 1]\n") ==
        "s.toml:4:9: loads[0].nodes: no node matches 'Bx'; did you mean 'B0'?\n"
        "s.toml:4:9: loads[0].nodes: no node matches 'B6'; did you mean 'B0'?");
}

TEST_CASE("gravity across a sector's axis is refused, along it is not") {
  CHECK(error_of(hoop + "model = 'sector'\n[gravity]\nacceleration = [0, 0, -9.81]\n") == "");
  CHECK(error_of(hoop + "model = 'sector'\n[gravity]\nacceleration = [1, 0, 0]\n") ==
        "s.toml:5:16: gravity.acceleration: must act along the axis of symmetry in a sector model; set "
        "structure.model to \"full\"");
  CHECK(error_of(hoop + "[gravity]\nacceleration = [1, 0, 0]\n") == "");
}

TEST_CASE("what only the equations of motion can tell is located as well") {
  // A third of the smallest double is zero: the list gives the tip a mass, the mass matrix does not.
  const Scene scene = read_scene_file(find_scene("double_pendulum"), {"structure.rods[1].mass=5e-324"});
  try {
    build_model(scene);
    FAIL("built a model with a massless node");
  } catch (const SceneError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems()[0].key == "structure.nodes[2].mass");
    CHECK(error.problems()[0].where.file == find_scene("double_pendulum"));
    CHECK(error.problems()[0].where.line == 17);  // the entry [[structure.nodes]] of the tip
    CHECK(error.problems()[0].message.find("tip") != std::string::npos);
  }
}

// What acts on each node that a pattern names does so on nodes of the scene, however finely its rods are cut.
TEST_CASE("patterns pass over nodes within rods that are cut to bend") {
  const std::string text =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\n"
      "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'M1', position = [1, 0, 0], mass = "
      "1},\n"
      "{name = 'B', position = [2, 0, 0], mass = 1}]\n"
      "rods = [{nodes = ['A', 'M1'], mass = 1, area = 1e-4}, {nodes = ['M1', 'B'], mass = 1, area = 1e-4}]\n"
      "[[forces]]\nkind = 'drag'\nnodes = ['*']\ndamping = 0.5\n[[loads]]\nforce = [0, 0, -1]\nnodes = ";
  const auto counts = [&](const std::string& names, const std::string& segments) {
    const Structure s =
        build_structure(read_scene_text(text + names, "cut.toml", {"structure.segments=" + segments}));
    const auto drags = std::ranges::count_if(s.forces, [](const Force& f) { return f.kind == "drag"; });
    return std::pair{std::ranges::count_if(s.loads, [](const auto& load) { return load.force.norm() > 0; }),
                     drags};
  };
  for (const char* segments : {"1", "4"}) {
    INFO(segments);
    CHECK(counts("['M*']", segments) == std::pair<std::ptrdiff_t, std::ptrdiff_t>{1, 3});
    CHECK(counts("['*']", segments).first == 3);
  }
  CHECK(counts("['M1-B.*']", "4").first == 3);  // with a point they are meant
  CHECK(counts("['M1-B.2']", "4").first == 1);
  // An offload carries each node's weight: all of a rod's, however it is cut.
  const Structure hung =
      build_structure(read_scene_text(text + "['B']\n[[forces]]\nkind = 'offload'\nnodes = ['*']\n[gravity]\n"
                                             "acceleration = [0, 0, -9.81]\n",
                                      "hung.toml", {"structure.segments=4"}));
  const auto ropes = std::ranges::count_if(hung.forces, [](const Force& f) { return f.kind == "offload"; });
  CHECK(ropes == std::ssize(hung.nodes));
}

}  // namespace build_test
