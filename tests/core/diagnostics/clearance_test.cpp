// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/clearance.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace clearance_test {

namespace {

// Two parallel rods along z that fly past each other, nothing acting on them: `away` apart at first, with the
// velocity `by` against each other, so that they are nearest at t = -away . by / by^2, |away x by| / |by|
// apart.
Structure passing(const Vec3& away, const Vec3& by, double radius_a, double radius_b) {
  const Vec3 up(0, 0, 0.8), drift(0.31, -0.12, 0);
  CustomSpec spec;
  spec.nodes = {{"A0", Vec3::Zero(), drift, 0.0, false},
                {"A1", up, drift, 0.0, false},
                {"B0", away, drift + by, 0.0, false},
                {"B1", away + up, drift + by, 0.0, false}};
  spec.rods = {{"A", {"A0", "A1"}, 1.3}, {"B", {"B0", "B1"}, 0.7}};
  Structure s = build_custom(spec);
  s.rods[0].radius = radius_a;
  s.rods[1].radius = radius_b;
  return s;
}

}  // namespace

TEST_CASE("segments are as far apart as a search over both finds them") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> some(-1, 1);
  const auto point = [&] { return Vec3(some(random), some(random), some(random)); };
  for (int round = 0; round < 40; ++round) {
    const Vec3 a0 = point(), a1 = point(), b0 = point();
    const Vec3 b1 = round % 4 == 0 ? Vec3(b0 + 0.7 * (a1 - a0)) : point();  // parallel now and then
    double least = 1e9;
    constexpr int n = 400;
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k <= n; ++k)
        least = std::min(least, (a0 + (a1 - a0) * i / n - b0 - (b1 - b0) * k / n).norm());
    const double distance = segment_distance(a0, a1, b0, b1);
    CHECK(distance <= least + 1e-15);
    CHECK(distance >= least - 3.5 / n);  // half a cell of each, segments up to 2 sqrt(3) long
  }
}

TEST_CASE("two rods that pass each other are nearest where straight lines say, between two steps") {
  const Vec3 away(0.53, 0.21, 0.11), by(-0.74, -0.06, 0);
  const Vec3 across(away.x(), away.y(), 0);
  const double when = -across.dot(by) / by.squaredNorm(), axes = across.cross(by).norm() / by.norm();
  const Simulation run = simulate(make_model(passing(away, by, 0.012, 0.019)), dvm_options(3, 0.13, 1.5));
  const auto c = least_clearance(run.trajectory, run.trajectory.size());
  REQUIRE(c);
  // A golden section finds where a parabola is least to the root of round-off, and its value to round-off.
  CHECK(c->t == Approx(when).epsilon(0).margin(1e-7));
  CHECK(c->axes == Approx(axes).epsilon(1e-12));
  CHECK(c->distance == Approx(axes - 0.031).epsilon(1e-12));
  CHECK((c->rod_a == 0 && c->rod_b == 1));
  CHECK(c->overlapping == 0);
  CHECK(c->states == run.trajectory.size());
}

// Boxes around rods leave pairs out; all pairs, each looked at, say which are nearest. A third of the rods
// hang on the one before; thick ones pass through others.
TEST_CASE("of many rods the nearest pair and all that overlap are those of all pairs") {
  for (const double radius : {0.0, 0.02, 0.15}) {
    INFO("radius " << radius);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> some(-1, 1);
    CustomSpec spec;
    const auto point = [&](const Vec3& beside, double reach) {
      const std::string name = "N" + std::to_string(spec.nodes.size());
      const Vec3 at = beside + reach * Vec3(some(random), some(random), some(random));
      spec.nodes.push_back({name, at, {0, 0, 0}, 0.0, false});
      return name;
    };
    for (int r = 0; r < 60; ++r) {
      const std::string from = r % 3 == 2 ? spec.nodes.back().name : point({0, 0, 0}, 3);
      const std::string to = point(spec.nodes.back().position, 0.6);
      spec.rods.push_back({"R" + std::to_string(r), {from, to}, 1.0});
    }
    Structure structure = build_custom(spec);
    for (Rod& rod : structure.rods) rod.radius = radius;
    const Simulation run = simulate(make_model(structure), dvm_options(3, 0.01, 0.01));
    const VectorXd q = run.trajectory.positions(0);
    const auto node = [&](int n) -> Vec3 { return q.segment<3>(3 * Index(n)); };
    double least = 1e9;
    std::size_t overlapping = 0;
    std::pair<int, int> pair;
    const std::vector<RodCopy>& rods = run.trajectory.structure().rod_copies;
    for (std::size_t a = 0; a < rods.size(); ++a)
      for (std::size_t b = a + 1; b < rods.size(); ++b) {
        if (rods[a].b == rods[b].a) continue;
        const double distance =
            segment_distance(node(rods[a].a), node(rods[a].b), node(rods[b].a), node(rods[b].b)) - 2 * radius;
        if (distance < least) least = distance, pair = {static_cast<int>(a), static_cast<int>(b)};
        overlapping += distance < 0 ? 1 : 0;
      }
    CHECK((overlapping > 0) == (radius > 0.1));
    const auto c = least_clearance(run.trajectory, 1);
    REQUIRE(c);
    CHECK(c->distance == Approx(least).epsilon(0).margin(1e-15));  // radii are taken off one by one
    CHECK(std::pair(c->rod_a, c->rod_b) == pair);
    CHECK(c->overlapping == overlapping);
  }
}

TEST_CASE("rods that pass through each other are said to, those that meet in a node are not") {
  const Simulation run =
      simulate(make_model(passing({0.5, 0.004, 0.1}, {-0.8, 0, 0}, 0.012, 0.019)), dvm_options(3, 0.01, 1.0));
  const auto c = least_clearance(run.trajectory, run.trajectory.size());
  REQUIRE(c);
  CHECK(c->distance == Approx(0.004 - 0.031).epsilon(1e-10));
  CHECK(c->overlapping == 1);
  const Simulation hinged = simulate(make_model(double_pendulum()), dvm_options(3, 0.02, 1.0));
  CHECK_FALSE(least_clearance(hinged.trajectory, hinged.trajectory.size()));
}

// Arms of a scissor lie side by side on their pin; what crosses without one is in each other's way.
TEST_CASE("rods on a common pin meet there") {
  const auto crossing = [](bool pinned) {
    CustomSpec spec;
    spec.nodes = {{"A0", {0.1, 0, 0}, {0, 0, 0}, 0.0, false},
                  {"A1", {1.3, 0.9, 0}, {0, 0, 0}, 0.0, false},
                  {"B0", {0.1, 0.9, 0}, {0, 0, 0}, 0.0, false},
                  {"B1", {1.3, 0, 0}, {0, 0, 0}, 0.0, false}};
    if (pinned) spec.nodes.push_back({"P", {0.7, 0.45, 0}, {0, 0, 0}, 0.4, false});
    spec.rods = {{"A", {"A0", "A1"}, 1.3}, {"B", {"B0", "B1"}, 0.7}};
    Structure s = build_custom(spec);
    for (Rod& rod : s.rods) rod.radius = 0.015;
    const Simulation still = simulate(make_model(s), dvm_options(3, 0.1, 0.2));
    return least_clearance(still.trajectory, still.trajectory.size());
  };
  CHECK_FALSE(crossing(true));
  REQUIRE(crossing(false));
  CHECK(crossing(false)->distance == Approx(-0.03).epsilon(1e-12));
}

// As the rods that they are, whatever they are cut into: one does not pass through itself, those that meet in
// a node do so with all of their parts, and any other rod is as far as it was.
TEST_CASE("parts of a rod are the rod, to itself and to those that meet it") {
  const auto clearance = [](int segments) {
    const Simulation still = run_scene(R"([structure]
kind = 'custom'
youngs_modulus = 7e10
segments = )" + std::to_string(segments) +
                                       R"(
nodes = [{name = 'A', position = [0, 0, 0]}, {name = 'B', position = [1, 1, 0]}, {name = 'C', position = [2, 0, 1]},
         {name = 'D', position = [0.1, 0.9, 0.31]}, {name = 'E', position = [0.9, 0.1, 0.31]}]
rods = [{nodes = ['A', 'B'], density = 2700, area = 1e-3}, {nodes = ['B', 'C'], density = 2700, area = 1e-3},
        {nodes = ['D', 'E'], mass = 0.1, area = 1e-4, segments = 1}]
[solver]
step = 1e-3
end_time = 2e-3
)");
    return least_clearance(still.trajectory, still.trajectory.size());
  };
  const double radius = std::sqrt(1e-3 / pi), thin = std::sqrt(1e-4 / pi);
  for (const int segments : {1, 8, 33}) {
    INFO(segments);
    const auto found = clearance(segments);
    REQUIRE(found);
    CHECK(found->overlapping == 0);
    CHECK(found->axes == Approx(0.31).epsilon(1e-9));
    CHECK(found->distance == Approx(0.31 - radius - thin).epsilon(1e-9));
  }
}

// An arm of 1 m that turns at 8 rad/s through a bar at (0.31, -0.9): its axis meets that at atan2(0.9, 0.31)
// = 1.23908 rad, whatever the steps, and 18 mm between rails elsewhere are no clearance beside that.
TEST_CASE("rods that pass through each other within a step are seen to") {
  for (const double step : {0.05, 0.01, 0.007, 0.002})
    for (const bool rails : {false, true}) {
      INFO(step << " s" << (rails ? ", with rails" : ""));
      const Simulation run = run_scene(
          std::string(
              "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
              "{name = 'B', position = [1, 0, 0], velocity = [0, 0, -8]},\n"
              "{name = 'C', position = [0.31, -0.5, -0.9], fixed = true}, "
              "{name = 'D', position = [0.31, 0.5, -0.9], fixed = true}") +
          (rails ? ",\n{name = 'E', position = [-1, -0.5, 0.5], fixed = true}, {name = 'F', position = [-1, "
                   "0.5, 0.5], fixed = true}, {name = 'G', position = [-1.018, -0.5, 0.5], fixed = true}, "
                   "{name = 'H', position = [-1.018, 0.5, 0.5], fixed = true}"
                 : "") +
          "]\nrods = [{nodes = ['A', 'B'], mass = 1, area = 5e-5}, {nodes = ['C', 'D'], mass = 1, area = "
          "5e-5}" +
          (rails
               ? ", {nodes = ['E', 'F'], mass = 1, area = 5e-5}, {nodes = ['G', 'H'], mass = 1, area = 5e-5}"
               : "") +
          "]\n[[constraints]]\nkind = 'plane'\nnodes = ['B']\nnormal = [0, 1, 0]\n[solver]\nend_time = "
          "0.4\nstep = " +
          std::to_string(step) + "\n");
      const auto found = least_clearance(run.trajectory, run.trajectory.size());
      REQUIRE(found);
      CHECK(found->overlapping == 1);
      CHECK(found->rod_a == 0);
      CHECK(found->rod_b == 1);
      CHECK(found->distance == Approx(-2 * std::sqrt(5e-5 / pi)).epsilon(1e-6));
      // Steps of 0.4 rad are off by up to 1e-4 of the way.
      CHECK(found->t == Approx(std::atan2(0.9, 0.31) / 8).epsilon(1e-4));
    }
}

// Three fat rods side by side, the second nearer to the third than to the first, in whatever order.
TEST_CASE("of fat rods the nearest pair is found whichever lie before it") {
  for (const double sign : {1.0, -1.0})
    for (const double third : {1.9, 2.1}) {
      CustomSpec spec;
      const double x[] = {0.0, 1.0, third};
      for (int r = 0; r < 3; ++r) {
        const std::string name = std::string("R") + std::to_string(r);
        spec.nodes.push_back({name + "a", {sign * x[r], 0, 0}, Vec3::Zero(), 1.0, false});
        spec.nodes.push_back({name + "b", {sign * x[r], 2, 0}, Vec3::Zero(), 1.0, false});
        spec.rods.push_back({name, {name + "a", name + "b"}, 1.0});
      }
      Structure s = build_custom(spec);
      const double radius[] = {0.25, 0.3, 0.35};
      for (std::size_t r = 0; r < 3; ++r) s.rods[r].radius = radius[r];
      const Simulation run = simulate(make_model(s), dvm_options(2, 0.1, 0.1));
      const auto c = least_clearance(run.trajectory, run.trajectory.size());
      REQUIRE(c);
      INFO(sign << " " << third);
      const bool first = third - 1 - 0.65 > 1 - 0.55;
      CHECK(c->distance == Approx(first ? 0.45 : third - 1.65).epsilon(1e-12));
      CHECK((c->rod_a == (first ? 0 : 1) && c->rod_b == (first ? 1 : 2)));
    }
}

// A rod of 2 m that turns at 4 rad/s about its middle, which goes away from a pole at 0.2 m/s: it comes near
// once in every half turn, never again as near as at first.
TEST_CASE("the least clearance is that of the time at which it was seen") {
  const double away = 1.4, speed = 0.2, turns = 4, begin = -0.71;
  CustomSpec spec;
  for (const double end : {1.0, -1.0}) {
    const Vec3 along = end * Vec3(std::cos(begin), std::sin(begin), 0), across(-along.y(), along.x(), 0);
    spec.nodes.push_back({end > 0 ? "A" : "B", along, turns * across - Vec3(speed, 0, 0), 1.0, false});
  }
  spec.nodes.push_back({"P", {away, 0, -1}, Vec3::Zero(), 0.0, true});
  spec.nodes.push_back({"Q", {away, 0, 1}, Vec3::Zero(), 0.0, true});
  spec.rods = {{"AB", {"A", "B"}, 0.0}, {"PQ", {"P", "Q"}, 0.0}};
  const Simulation run = simulate(make_model(build_custom(spec)), dvm_options(4, 0.06, 4.0));
  // The tip is nearest where it is farthest on along x, but for its way across; by 1e6 times.
  double least = 1e9, when = 0;
  for (int k = 0; k <= 1000000; ++k) {
    const double t = 0.4 * k / 1e6, angle = begin + turns * t;
    const double x = away + speed * t, along = x * std::cos(angle), across = x * std::sin(angle);
    const double distance = std::hypot(std::max(0.0, along - 1), across);
    if (distance < least) least = distance, when = t;
  }
  const auto c = least_clearance(run.trajectory, run.trajectory.size());
  REQUIRE(c);
  CHECK(c->axes == Approx(least).epsilon(0).margin(1e-8));  // order 8 at 0.24 rad a step
  CHECK(c->t == Approx(when).epsilon(0).margin(1e-4));
}

}  // namespace clearance_test
