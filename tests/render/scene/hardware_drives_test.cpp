// SPDX-License-Identifier: BSD-3-Clause
// Pulleys, telescopes, actuators and motors: where they are and around what they turn.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/frame_builder.hpp"

using namespace unfurl;

namespace hardware_drives_test {

namespace {

// A telescope A-D, an arm H-Q that a motor turns, a cable K-W-M over W, and an actuator N-M.
const std::string machine = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.5, 0, 0], mass = 1},
  {name = "C", position = [1.2, 0, 0], mass = 2}, {name = "D", position = [1.6, 0, 0], mass = 4},
  {name = "P", position = [-0.4, 1.1, 0.3], fixed = true}, {name = "H", position = [0, 1.1, 0.3], fixed = true},
  {name = "Q", position = [0.5, 1.1, 0.9], mass = 0.6},
  {name = "K", position = [0.5, 0.5, 0], fixed = true}, {name = "W", position = [1.0, 0.6, 1.5], fixed = true},
  {name = "M", position = [1.5, 0.5, 1.0], mass = 1.5}, {name = "N", position = [1.5, 0.5, 0], fixed = true}]
rods = [{name = "arm", nodes = ["H", "Q"], mass = 0.4}]
[[structure.constraints]]
kind = "line"
nodes = ["D"]
direction = [1, 0, 0]
[[structure.constraints]]
kind = "line"
nodes = ["M"]
direction = [0, 0, 1]
[[structure.constraints]]
kind = "plane"
nodes = ["Q"]
normal = [0, 1, 0]
[[constraints]]
kind = "telescope"
nodes = ["A", "B", "C", "D"]
motion = "smooth"
to = 2.4
duration = 0.6
[[constraints]]
kind = "length"
nodes = ["N", "M"]
motion = "smooth"
to = 0.7
duration = 0.6
[[constraints]]
kind = "cable"
nodes = ["K", "W", "M"]
axial_stiffness = 1e3
[[forces]]
kind = "motor"
nodes = ["P", "H", "Q"]
axis = [0, 1, 0]
stall_torque = 0.02
no_load_speed = 90
inertia = 1e-3
[solver]
step = 0.05
end_time = 0.6
)";

bool same(const Vec3f& a, const Vec3f& b) {
  return (a - b).norm() < 1e-5f;  // single precision of a metre
}

}  // namespace

TEST_CASE("what drives and guides is drawn where it acts") {
  const Scene scene = read_scene_text(machine, "machine.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  const FrameBuilder frames(run.trajectory, {});
  for (const double t : {0.0, 0.35, 0.6}) {
    const DrawList list = frames.build(t);
    const VectorXd x = run.trajectory.positions_at(t);
    const auto node = [&](int k) { return Vec3f(x.segment<3>(3 * k).cast<float>()); };
    CAPTURE(t);
    // The telescope from node to node, thinner from stage to stage.
    float last = 1;
    for (int k = 0; k < 3; ++k) {
      const auto stage = std::ranges::find_if(
          list.tubes, [&](const Tube& tube) { return same(tube.a, node(k)) && same(tube.b, node(k + 1)); });
      REQUIRE(stage != list.tubes.end());
      CHECK(stage->radius < last);
      last = stage->radius;
    }
    // The actuator begins and ends at its nodes.
    CHECK(std::ranges::count_if(list.tubes, [&](const Tube& u) { return same(u.a, node(10)); }) == 1);
    CHECK(std::ranges::count_if(list.tubes, [&](const Tube& u) { return same(u.b, node(9)); }) >=
          2);  // and the cable
    // The wheel: across both spans, inside the bend, the cable on its rim.
    const Vec3f back = (node(7) - node(8)).normalized(), on = (node(9) - node(8)).normalized();
    int parts = 0;
    for (const Sleeve& s : list.sleeves) {
      const Vec3f axis = (s.b - s.a).normalized(), to = 0.5f * (s.a + s.b) - node(8);
      if (to.norm() > 0.2f) continue;
      ++parts;
      CHECK(std::abs(axis.dot(back)) < 1e-4f);
      CHECK(std::abs(axis.dot(on)) < 1e-4f);
      const Vec3f center = to - axis * axis.dot(to);
      CHECK(center.normalized().dot((back + on).normalized()) > 0.9999f);
      CHECK(s.radius < 1.3f * center.norm());
    }
    CHECK(parts == 4);
    // The motor's three parts lie on the axis that was asked for, beside the hinge.
    CHECK(std::ranges::count_if(list.sleeves, [&](const Sleeve& s) {
            const Vec3f a = s.a - node(5), b = s.b - node(5);
            return a.y() < -last && b.y() < a.y() && same(a, {0, a.y(), 0}) && same(b, {0, b.y(), 0});
          }) == 3);
  }
}

// Housings, the longest part of a motor and the only black sleeve.
std::vector<Sleeve> housings(const DrawList& list) {
  std::vector<Sleeve> found;
  for (const Sleeve& s : list.sleeves)
    if (s.finish == Finish::anodised && s.color.r < 0.2f && s.color.b < 0.2f) found.push_back(s);
  return found;
}

// Where joints are balls, drives are plain: without wheels and housings, and each between its nodes.
TEST_CASE("line drawings and exports have telescopes and actuators too") {
  const Scene scene = read_scene_text(machine, "machine.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  FrameStyle blueprint;
  blueprint.options.look = "blueprint";
  const DrawList list = FrameBuilder(run.trajectory, blueprint).build(0.35);
  const VectorXd x = run.trajectory.positions_at(0.35);
  const auto node = [&](int k) { return Vec3f(x.segment<3>(3 * k).cast<float>()); };
  for (int k = 0; k < 3; ++k)
    CHECK(std::ranges::count_if(list.tubes, [&](const Tube& tube) {
            return same(tube.a, node(k)) && same(tube.b, node(k + 1));
          }) == 1);
  CHECK(std::ranges::count_if(list.tubes, [&](const Tube& u) { return same(u.a, node(10)); }) == 1);
  CHECK(std::ranges::count_if(list.tubes, [&](const Tube& u) { return same(u.b, node(9)); }) >= 2);
  CHECK(std::ranges::none_of(list.sleeves, [&](const Sleeve& s) {
    return s.finish == Finish::anodised || (0.5f * (s.a + s.b) - node(8)).norm() < 0.2f;
  }));
}

TEST_CASE("a telescope of one stage is an actuator, however it is written") {
  const std::string one_stage = [] {
    std::string text = machine;
    const std::string length = "kind = \"length\"\nnodes = [\"N\", \"M\"]";
    text.replace(text.find(length), length.size(), "kind = \"telescope\"\nnodes = [\"N\", \"M\"]");
    return text;
  }();
  std::vector<std::size_t> tubes;
  for (const std::string& text : {machine, one_stage}) {
    const Scene scene = read_scene_text(text, "machine.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    tubes.push_back(FrameBuilder(run.trajectory, {}).build(0.35).tubes.size());
  }
  CHECK(tubes[0] == tubes[1]);
}

TEST_CASE("a pulley stands for what its node weighs, a canister for that of others") {
  const Scene scene = read_scene_file(find_scene("cable_ring"));
  const Simulation run = simulate(build_model(scene), scene.solver);
  const DrawList list = FrameBuilder(run.trajectory, {}).build(2.0);
  const auto canisters =
      std::ranges::count_if(list.sleeves, [](const Sleeve& s) { return s.finish == Finish::foil; });
  // 24 corners: the cable bends at every second one above and below, and begins and ends at one.
  CHECK(canisters > 0);
  CHECK(canisters <= 13);
}

TEST_CASE("what drives a fold angle is drawn at the hinges that turn most") {
  const Scene scene = read_scene_file(find_scene("hoop6_motor"));
  const Simulation run = simulate(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  const FrameBuilder frames(run.trajectory, {});
  const Structure& s = run.trajectory.structure();
  for (const double t : {0.0, 2.5, 5.9}) {
    const VectorXd x = run.trajectory.positions_at(t);
    const auto node = [&](int k) { return Vec3(x.segment<3>(3 * k)); };
    const double fold = s.deployment.fold_angle(x);
    Vec3 middle = Vec3::Zero();
    for (std::size_t k = 0; k < s.nodes.size(); ++k)
      middle += node(static_cast<int>(k)) / static_cast<double>(s.nodes.size());
    const std::vector<Sleeve> found = housings(frames.build(t));
    CHECK(found.size() == 12);  // six units, at their hinges above and below
    for (const Sleeve& housing : found) {
      const Vec3 axis = (housing.b - housing.a).cast<double>().normalized();
      int hinges = 0;
      for (int k = 0; k < static_cast<int>(s.nodes.size()); ++k) {
        const Vec3 off = housing.a.cast<double>() - node(k);
        if (off.cross(axis).norm() > 1e-4 || off.norm() > 0.3) continue;
        std::vector<Vec3> arms;  // of the rods that meet there
        for (const Rod& rod : s.rods)
          if (rod.a == k || rod.b == k)
            arms.push_back((node(rod.a == k ? rod.b : rod.a) - node(k)).normalized());
        REQUIRE(arms.size() == 2);
        ++hinges;
        // Both turn through the fold angle, from upright to level: pi - 2 fold is between them. Single
        // precision.
        CHECK(std::acos(arms[0].dot(arms[1])) == Approx(std::numbers::pi - 2 * fold).margin(1e-5));
        for (const Vec3& arm : arms) CHECK(std::abs(arm.dot(axis)) < 1e-4);
        CHECK(axis.dot(node(k) - middle) > 0);
      }
      CHECK(hinges == 1);
    }
  }
}

TEST_CASE("a line drawing has no drives") {
  Scene scene = read_scene_text(machine, "machine.toml", {"render.look=blueprint"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  FrameStyle style;
  style.options = scene.render;
  const DrawList list = FrameBuilder(run.trajectory, style).build(0.3);
  CHECK(list.plates.empty());
  for (const Sleeve& s : list.sleeves) CHECK((s.a - Vec3f(1.0f, 0.6f, 1.5f)).norm() > 0.1f);
}

}  // namespace hardware_drives_test
