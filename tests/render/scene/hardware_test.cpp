// SPDX-License-Identifier: BSD-3-Clause
// Joints as they would be built: where their axes are, which rods lie side by side, what holds and what is
// carried.
#include "render/scene/hardware.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/frame_builder.hpp"

using namespace unfurl;

namespace hardware_test {

namespace {

struct Run {
  Scene scene;
  Simulation simulation;
};

Run run(const std::string& name, const std::vector<std::string>& overrides = {}) {
  Scene scene = read_scene_file(find_scene(name), overrides);
  Simulation simulation = simulate(build_model(scene), scene.solver);
  return {std::move(scene), std::move(simulation)};
}

FrameBuilder builder(const Run& r) {
  FrameStyle style;
  style.options = r.scene.render;
  return {r.simulation.trajectory, style};
}

// The smallest distance of two segments, by trying 200 x 200 points: off by at most a half of a 200th of each
// length, which the tubes' clearance has to spare.
float distance(const Tube& a, const Tube& b) {
  float least = 1e9f;
  for (int i = 0; i <= 200; ++i) {
    const Vec3f p = a.a + static_cast<float>(i) / 200 * (a.b - a.a);
    const Vec3f along = b.b - b.a;
    const float u = std::clamp((p - b.a).dot(along) / along.squaredNorm(), 0.0f, 1.0f);
    least = std::min(least, (p - b.a - u * along).norm());
  }
  return least;
}

}  // namespace

TEST_CASE("rods that cross lie side by side, pinned or not, in every pose") {
  for (const char* name : {"scissor_mast", "scissor_mast_square", "scissor_ring", "hoop6"}) {
    const Run r = run(name);
    const FrameBuilder frames = builder(r);
    const auto& copies = r.simulation.trajectory.structure().rod_copies;
    int crossings = 0;
    for (const double share : {0.3, 0.55, 0.8}) {
      const Trajectory& motion = r.simulation.trajectory;
      const DrawList list =
          frames.build(motion.start_time() + share * (motion.end_time() - motion.start_time()));
      for (std::size_t i = 0; i < copies.size(); ++i)
        for (std::size_t j = i + 1; j < copies.size(); ++j) {
          const RodCopy &p = copies[i], &q = copies[j];
          if (p.a == q.a || p.a == q.b || p.b == q.a || p.b == q.b) continue;
          const Tube &a = list.tubes[i], &b = list.tubes[j];
          const Vec3f x = (a.b - a.a).normalized(), y = (b.b - b.a).normalized();
          if (x.cross(y).norm() < 0.15f) continue;  // nearly parallel: stowed
          const float apart = distance(a, b);
          if (apart > 3 * (a.radius + b.radius)) continue;
          ++crossings;
          INFO(name << " at " << share << ": " << p.name << " and " << q.name);
          CHECK(apart > 1.02f * (a.radius + b.radius));
        }
    }
    CHECK(crossings >= 9);
  }
}

TEST_CASE("a lug's pin is across its rod, and at a hinge across both") {
  const Run r = run("hoop6");
  const FrameBuilder frames = builder(r);
  for (const double share : {0.4, 0.95, 1.0}) {  // at the end the chords are on one line
    const DrawList list = frames.build(share * r.simulation.trajectory.end_time());
    REQUIRE(list.plates.size() >= 60);  // an end has one or two
    for (const Plate& plate : list.plates) {
      CHECK(std::abs(plate.side.norm() - 1) < 1e-5f);
      CHECK(std::abs(plate.side.dot((plate.b - plate.a).normalized())) < 1e-5f);
    }
  }
  // The chords of a face turn in its plane: their axes are level and point away from the ring's axis.
  const DrawList list = frames.build(0.8 * r.simulation.trajectory.end_time());
  std::size_t level = 0;
  for (const Plate& plate : list.plates) level += std::abs(plate.side.z()) < 1e-3f;
  CHECK(level == list.plates.size());
}

TEST_CASE("what is held stands on a plate, what is carried is a body") {
  const Run r = run("scissor_mast_square");
  const DrawList list = builder(r).build(0.5);
  const Structure& s = r.simulation.trajectory.structure();
  std::size_t carried = 0;
  for (const NodeCopy& copy : s.node_copies)
    carried += s.nodes[static_cast<std::size_t>(copy.source)].mass > 0;
  REQUIRE(carried == 4);
  const auto foil = std::ranges::count(list.sleeves, Finish::foil, &Sleeve::finish);
  CHECK(static_cast<std::size_t>(foil) == carried);

  const Run bar = run("four_bar");
  const FrameBuilder frames = builder(bar);
  const DrawList linkage = frames.build(0);
  float widest = 0, thickest = 0;
  for (const Sleeve& sleeve : linkage.sleeves) widest = std::max(widest, sleeve.radius);
  for (const Tube& tube : linkage.tubes) thickest = std::max(thickest, tube.radius);
  CHECK(widest > 3.5f * thickest);  // a plate, not a fitting
  for (const Sleeve& sleeve : linkage.sleeves) CHECK(std::min(sleeve.a.z(), sleeve.b.z()) > linkage.ground.z);
}

TEST_CASE("no rod goes through the plate that it turns beside") {
  for (const char* scene : {"ladder", "pendulum", "four_bar", "chain"}) {
    const Run r = run(scene);
    const FrameBuilder frames = builder(r);
    const Trajectory& trajectory = r.simulation.trajectory;
    std::size_t plates = 0;
    for (int k = 0; k <= 40; ++k) {
      const double t = trajectory.start_time() + k * (trajectory.end_time() - trajectory.start_time()) / 40;
      const DrawList list = frames.build(t);
      float thickest = 0;
      for (const Tube& tube : list.tubes) thickest = std::max(thickest, tube.radius);
      for (const Sleeve& plate : list.sleeves) {
        if (plate.radius < 3.5f * thickest) continue;
        ++plates;
        const Vec3f n = (plate.b - plate.a).normalized(), middle = 0.5f * (plate.a + plate.b);
        for (const Tube& tube : list.tubes) {
          const float a = n.dot(tube.a - middle), b = n.dot(tube.b - middle);
          const Vec3f begins = (tube.a - middle).norm() < (tube.b - middle).norm() ? tube.a : tube.b;
          if (a * b >= 0 || (begins - middle).norm() > 3 * plate.radius) continue;  // of another joint
          const Vec3f through = tube.a + a / (a - b) * (tube.b - tube.a);
          CAPTURE(scene, t);
          CHECK((through - middle).norm() > plate.radius);
        }
      }
    }
    CHECK(plates > 0);
  }
}

TEST_CASE("a material is that of its groups, and the fittings then tell the group") {
  const Run r =
      run("hoop6", {"render.material=aluminium", "render.materials=[{group=\"ch*\",material=\"cfrp\"}]"});
  const DrawList list = builder(r).build(3.0);
  const auto carbon = std::ranges::count(list.tubes, Finish::carbon, &Tube::finish);
  CHECK(carbon == 24);  // the chords
  CHECK(std::ranges::count(list.tubes, Finish::metal, &Tube::finish) == 6);
  const auto in_group_color = [&](std::size_t group) {
    return std::ranges::count_if(list.sleeves, [&](const Sleeve& s) {
      const Color c = group_color(group);
      return s.color.r == c.r && s.color.g == c.g && s.color.b == c.b;
    });
  };
  CHECK(in_group_color(0) == 48);
  CHECK(in_group_color(1) == 12);
}

TEST_CASE("a line drawing has plain joints") {
  const Run r = run("hoop6", {"render.look=blueprint"});
  const DrawList list = builder(r).build(3.0);
  CHECK(list.plates.empty());
  CHECK(list.balls.size() == 24);
}

TEST_CASE("a picture of a rod does not depend on how finely it is cut") {
  const auto cantilever = [](int segments) {
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nrod_model = 'elastic'\nsegments = " +
            std::to_string(segments) +
            "\n[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nfixed = true\n"
            "[[structure.nodes]]\nname = 'B'\nposition = [10, 0, 0]\n"
            "[[structure.nodes]]\nname = 'C'\nposition = [10, 4, 0]\nfixed = true\n"
            "[[structure.rods]]\nnodes = ['A', 'B']\nmass = 1\narea = 1e-4\n"
            "[[structure.rods]]\nnodes = ['B', 'C']\nmass = 1\narea = 1e-4\nsegments = 1\n"
            "[[loads]]\nnodes = ['B']\nforce = [0, 0, -0.1]\n[solver]\nend_time = 0.01\nstep = 0.001\n",
        "c.toml");
    const Simulation simulation = simulate(build_model(scene), scene.solver);
    FrameStyle style;
    style.options.rod_labels = true;
    return FrameBuilder(simulation.trajectory, style).build(0.01);
  };
  const DrawList whole = cantilever(1);
  REQUIRE(whole.arrows.size() == 1);
  for (const int segments : {2, 5, 40}) {
    CAPTURE(segments);
    const DrawList cut = cantilever(segments);
    CHECK(cut.sleeves.size() == whole.sleeves.size());
    CHECK(cut.plates.size() == whole.plates.size());
    REQUIRE(cut.tubes.size() == whole.tubes.size() + static_cast<std::size_t>(segments - 1));
    // It bends by far less than a thousandth of its length in so short a time.
    float length = 0, all = 0;
    for (const Tube& tube : cut.tubes) {
      length += (tube.b - tube.a).norm();
      CHECK(tube.radius == Approx(whole.tubes.front().radius).epsilon(1e-3));
    }
    for (const Tube& tube : whole.tubes) all += (tube.b - tube.a).norm();
    CHECK(length == Approx(all).epsilon(1e-3));
    CHECK((cut.arrows[0].head - cut.arrows[0].tail).norm() ==
          Approx((whole.arrows[0].head - whole.arrows[0].tail).norm()).epsilon(1e-3));
    const auto names = [](const DrawList& list) {
      std::vector<std::string> out;
      for (const TextLabel& l : list.labels)
        if (l.text.starts_with("A-B") || l.text.starts_with("B-C")) out.push_back(l.text);
      std::ranges::sort(out);
      return out;
    };
    CHECK(names(cut) == names(whole));
  }
}

TEST_CASE("masses and supports are there where no rod ends, too") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
      "{name = 'B', position = [0, 0, -1], mass = 5}, {name = 'C', position = [1, 0, 0], fixed = true},\n"
      "{name = 'D', position = [1, 0, -1], mass = 5}, {name = 'E', position = [2, 0, 0], fixed = true},\n"
      "{name = 'F', position = [2, 0, -1], mass = 5}]\nrods = [{nodes = ['E', 'F'], mass = 0.1}]\n"
      "[[forces]]\nkind = 'spring'\nnodes = ['A', 'B']\nstiffness = 200\n"
      "[[forces]]\nkind = 'cable'\nnodes = ['C', 'D']\naxial_stiffness = 1000\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 0.1\nstep = 0.005\n",
      "hang.toml");
  const Simulation simulation = simulate(build_model(scene), scene.solver);
  const DrawList list = FrameBuilder(simulation.trajectory, {}).build(0);
  // Something solid within a hand's breadth of each, as large for the two as for the one on the rod.
  std::vector<float> sizes;
  for (const float x : {0.0f, 1.0f, 2.0f})
    for (const float z : {0.0f, -1.0f}) {
      float widest = 0;
      for (const Sleeve& sleeve : list.sleeves)
        if ((0.5f * (sleeve.a + sleeve.b) - Vec3f(x, 0, z)).norm() < 0.2f)
          widest = std::max(widest, sleeve.radius);
      for (const Ball& ball : list.balls)
        if ((ball.center - Vec3f(x, 0, z)).norm() < 0.1f) widest = std::max(widest, ball.radius);
      CHECK(widest > 0.01f);
      sizes.push_back(widest);
    }
  CHECK(sizes[1] == Approx(sizes[5]));
  CHECK(sizes[3] == Approx(sizes[5]));
  const Scene thrown = read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], velocity = [3, 0, 4], mass "
      "= 2}]\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 0.5\nstep = 0.01\n",
      "thrown.toml");
  const Simulation flight = simulate(build_model(thrown), thrown.solver);
  const DrawList stone = FrameBuilder(flight.trajectory, {}).build(0.2);
  CHECK(stone.sleeves.size() + stone.balls.size() > 0);
}

TEST_CASE("a spring between masses without a rod is wound, and a load is seen however small it is") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
      "{name = 'B', position = [0, 0, -1], mass = 5}]\nrods = []\n[[loads]]\nnodes = ['B']\n"
      "force = [1e-13, 0, 0]\n[[forces]]\nkind = 'spring'\nnodes = ['A', 'B']\nstiffness = 200\n"
      "[solver]\nend_time = 0.1\nstep = 0.005\n",
      "spring.toml");
  const Simulation simulation = simulate(build_model(scene), scene.solver);
  const DrawList list = FrameBuilder(simulation.trajectory, {}).build(0);
  REQUIRE(list.tubes.size() > 100);  // ten to a turn, of twelve
  float widest = 0;                  // of its turns, from the line between its ends
  for (const Tube& tube : list.tubes) {
    CHECK(tube.radius > 5e-4f);
    widest = std::max(widest, std::hypot(tube.a.x(), tube.a.y()));
  }
  CHECK(widest > 4 * list.tubes[0].radius);
  CHECK(list.arrows.size() == 1);
}

TEST_CASE("groups with a word for what only pulls are thin, and no other is") {
  const auto radius_of = [](const std::string& group) {
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
        "{name = 'B', position = [0, 0, -1]}]\n"
        "rods = [{nodes = ['A', 'B'], mass = 1, area = 1e-4, group = '" +
            group + "'}]\n[render]\nrod_scale = 1\n[solver]\nend_time = 0.1\nstep = 0.05\n",
        "group.toml");
    const Simulation simulation = simulate(build_model(scene), scene.solver);
    FrameStyle style;
    style.options = scene.render;
    return FrameBuilder(simulation.trajectory, style).build(0).tubes.at(0).radius;
  };
  const float own = std::sqrt(1e-4f / static_cast<float>(pi));
  for (const char* group : {"bar", "accordion", "magnet boom", "properties", "kinetic", "Electromagnets"})
    CHECK(radius_of(group) == Approx(own));
  for (const char* group : {"cable", "front ties", "Net 2", "net_back", "frontnet", "SteelCables 3"})
    CHECK(radius_of(group) < 0.5f * own);
}

TEST_CASE("a rod that turns about a held node in a plane has a lug there, its pin across the plane") {
  const Run r = run("pendulum", {"solver.end_time=0.5"});
  const DrawList list = builder(r).build(0.2);
  REQUIRE_FALSE(list.plates.empty());
  for (const Plate& plate : list.plates) CHECK(std::abs(plate.side.y()) == Approx(1).epsilon(1e-5));
}

}  // namespace hardware_test
