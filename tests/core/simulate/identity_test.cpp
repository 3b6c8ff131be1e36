// SPDX-License-Identifier: BSD-3-Clause
// What tells drives, stops and constraints apart is their place in the structure, never their name.
#include <catch2/catch.hpp>
#include <set>

#include "core/structure/structure_error.hpp"
#include "core/system/consistency.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace identity_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

Simulation run_with(const std::string& text, void (*change)(Structure&)) {
  const Scene scene = read_scene_text(text, "test.toml", {});
  Structure structure = build_structure(scene);
  change(structure);
  System system(structure, scene.solver.eliminate_linear);
  return simulate(std::make_shared<const Model>(Model{std::move(structure), std::move(system)}),
                  scene.solver);
}

// Two balls that fall on floors of their own; the second, of 2 kg, is drawn up later with up to 60 N.
const std::string two_balls = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0.3], mass = 3},
  {name = "B", position = [1, 0, 0.2], mass = 2}]
[[constraints]]
kind = "coordinate_stop"
name = "floor A"
nodes = ["A"]
direction = [0, 0, 1]
min = 0
[[constraints]]
kind = "coordinate_stop"
name = "floor B"
nodes = ["B"]
direction = [0, 0, 1]
min = 0
[[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0, 0, 60]
times = [0.5, 1.5]
values = [0, 1]
[gravity]
acceleration = [0, 0, -10]
[solver]
step = 0.01
end_time = 1.3
)";

// A ball on two drives of its own: along x to 0.7 m, along z to 1.1 m, within 0.8 s.
const std::string two_drives = R"(
[structure]
kind = "custom"
nodes = [{name = "B", position = [0, 0, 0], mass = 2}]
[[constraints]]
kind = "coordinate"
nodes = ["B"]
direction = [1, 0, 0]
motion = "smooth"
to = 0.7
duration = 0.8
[[constraints]]
kind = "coordinate"
nodes = ["B"]
direction = [0, 0, 1]
motion = "smooth"
to = 1.1
duration = 0.8
[gravity]
acceleration = [0, 0, -10]
[solver]
step = 0.01
end_time = 0.8
)";

// The force of a drive that lifts 2 kg by `rise` within T = 0.8 s along rise u^3 (10 - 15 u + 6 u^2), u = t /
// T, against the weight g [m/s^2].
double force_at(double t, double rise, double g) {
  const double T = 0.8, u = t / T;
  return 2 * (rise / (T * T) * 60 * u * (1 - u) * (1 - 2 * u) + g);
}

void check_forces(const Diagnostics& d, const char* along_x, const char* along_z) {
  const Series &x = d.at(along_x), &z = d.at(along_z);
  for (std::size_t i = 0; i < d.t.size(); ++i) {  // one body, one row each: the multipliers are exact
    CHECK(x.values[i] == Approx(force_at(d.t[i], 0.7, 0)).epsilon(0).margin(1e-9));
    CHECK(z.values[i] == Approx(force_at(d.t[i], 1.1, 10)).epsilon(0).margin(1e-9));
  }
}

void check_unique(const Diagnostics& d) {
  std::set<std::string> names;
  for (const Series& column : d.columns) CHECK(names.insert(column.name).second);
}

}  // namespace

TEST_CASE("two stops of one name each let go when they would have to pull") {
  const Simulation named = run_scene(two_balls);
  const Simulation run = run_with(two_balls, [](Structure& s) {
    for (Stop& stop : s.stops) stop.name = "floor";
  });
  REQUIRE(run.status == RunStatus::completed);
  // 60 N (t - 0.5) = 20 N at 0.8333 s, then z'' = 30 (t - 0.8333) m/s^2: z = 5 (t - 0.8333)^3. Releases are
  // seen at the end of a step: 0.01 s of 0.4667 s, of the third power.
  const double left = 1.3 - (0.5 + 1.0 / 3);
  const VectorXd q = end_positions(run);
  CHECK(q[5] == Approx(5 * left * left * left).epsilon(0.08));
  CHECK(std::abs(q[2]) <= 1e-9);  // the other stays down
  CHECK(end_positions(run) == end_positions(named));
}

TEST_CASE("two drives without a name have columns and forces of their own") {
  const Diagnostics d = diagnose(run_scene(two_drives));
  check_unique(d);
  check_forces(d, "coordinate of B.force_N", "coordinate of B (2).force_N");
}

TEST_CASE("two drives of one name in a structure that a program made have forces of their own") {
  const Diagnostics d = diagnose(run_with(two_drives, [](Structure& s) {
    for (Constraint& c : s.constraints) c.name = "lift";
  }));
  check_unique(d);
  check_forces(d, "lift.force_N", "lift (2).force_N");
}

TEST_CASE("a drive against what is held is found by its place, not its name") {
  // The second drive, along z, moves what a plane holds; the first of the same name does not.
  CHECK_THROWS_WITH(run_with(two_drives,
                             [](Structure& s) {
                               s.constraints.push_back({"plane", "lift", {0}, {Vec3::UnitZ()}, 0.0, {}, {}});
                               for (Constraint& c : s.constraints) c.name = "lift";
                               check_consistency(s, System(s, true));
                             }),
                    Catch::Contains("the drive lift moves what other constraints hold"));
}

TEST_CASE("the reader refuses two entries of one name, with place") {
  const std::string text = error_of(two_balls, {"constraints[1].name=floor A"});
  CHECK(text.find("constraints[1].name: constraints[0] is called 'floor A' already") != std::string::npos);
  // One of them may be there to be switched on instead.
  CHECK(error_of(two_balls, {"constraints[1].name=floor A", "constraints[1].enabled=false"}).empty());
  // A made-up name makes way for a given one.
  const Scene scene = read_scene_text(two_drives, "test.toml", {"constraints[1].name=coordinate of B"});
  CHECK(scene.constraints[0].name == "coordinate of B (2)");
  CHECK(scene.constraints[1].name == "coordinate of B");
}

TEST_CASE("a constraint or a force of a kind that nobody takes is refused") {
  CHECK_THROWS_AS(
      run_with(two_balls,
               [](Structure& s) {
                 s.constraints.push_back({"plain", "plane of A", {0}, {Vec3::UnitZ()}, 0.0, {}, {}});
               }),
      StructureError);
  CHECK_THROWS_AS(run_with(two_balls, [](Structure& s) { s.forces[0].kind = "load"; }), StructureError);
  CHECK_THROWS_AS(run_with(two_balls,
                           [](Structure& s) {
                             s.constraints.push_back({"rod", "rod of A", {0}, {}, 0.0, {}, {}});
                           }),
                  StructureError);
}

}  // namespace identity_test
