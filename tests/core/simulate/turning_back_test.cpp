// SPDX-License-Identifier: BSD-3-Clause
// What a user is told of forces whose measure turns back inside a step.
#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace turning_back_test {

namespace {

using testing::run_scene;

// A crank that begins across the base and swings through its line at 2 rad/s, which takes pi / 4 s.
const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "E", position = [-1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
  {name = "T", position = [0, 1, 0], velocity = [2, 0, 0], mass = 1}]
rods = [{nodes = ["O", "T"], mass = 0}]
constraints = [{kind = "plane", nodes = ["T"], normal = [0, 0, 1]}]
[[forces]]
kind = "torsion_spring"
name = "hinge"
nodes = ["E", "O", "T"]
stiffness = 1e-3
[solver]
step = 0.01
end_time = 1.2
)";

// A mass on a guide through the other end of its spring.
const std::string guide = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0.4, 0.3, 0], velocity = [-0.8, -0.6, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["A"], direction = [0.8, 0.6, 0]}]
[[forces]]
kind = "spring"
name = "bar"
nodes = ["O", "A"]
stiffness = 1e-3
[solver]
step = 0.013
end_time = 0.9
)";

std::size_t said(const Simulation& run, const char* what) {
  std::size_t n = 0;
  for (const std::string& warning : run.warnings) n += warning.find(what) != std::string::npos ? 1 : 0;
  return n;
}

}  // namespace

TEST_CASE("an angle without an axis that passes rods in line is told once") {
  for (const char* method : {"dvm", "rk4"}) {
    const Simulation run = run_scene(crank, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.warnings.size() == 1);
    CHECK(said(run, "the rods of hinge pass through one line") == 1);
    CHECK(said(run, "at t = 0.79 s") == 1);  // pi / 4 and its step's end; the spring is too weak to count
  }
  // There and back, twice in all.
  CHECK(said(run_scene(crank, {"solver.end_time=2.9", "structure.nodes[2].velocity=[4, 0, 0]"}), "hinge") ==
        1);
}

TEST_CASE("no spring is told to turn back that has an axis, no force there, or turns before") {
  for (const std::vector<std::string>& changes : {std::vector<std::string>{"forces[0].axis=[0, 0, 1]"},
                                                  {"forces[0].free_angle=180"},
                                                  {"forces[0].stiffness=0", "forces[0].damping=1e-3"},
                                                  {"solver.end_time=0.7"}})
    CHECK(run_scene(crank, changes).warnings.empty());
  // Past the line at a distance, as a crank in a plane beside it does.
  CHECK(
      run_scene(crank, {"structure.nodes[2].position=[0, 0.8, 0.6]",
                        "structure.constraints[0].normal=[0, 0, 1]", "structure.nodes[2].velocity=[2, 0, 0]"})
          .warnings.empty());
}

TEST_CASE("ends of a spring that pass each other are told") {
  const Simulation run = run_scene(guide);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(said(run, "the ends of bar pass each other") == 1);
  CHECK(run_scene(guide, {"forces[0].free_length=0"}).warnings.empty());
  CHECK(run_scene(guide, {"forces[0].tension_only=true"}).warnings.empty());
  CHECK(run_scene(guide, {"solver.end_time=0.4"}).warnings.empty());
}

TEST_CASE("ends of a spring that pass close by are told where the step does not resolve it") {
  // At 1 m/s past the other end, 5 mm beside it: in a step of 13 mm, from 6 before to 7 behind, the force
  // turns by 105 degrees; in steps of 5 mm by 45 at most.
  const std::vector<std::string> beside{"structure.nodes[1].position=[0.4, 0.3, 0.005]"};
  const Simulation run = run_scene(guide, beside);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(said(run, "the ends of bar pass each other at 0.005 m") == 1);
  CHECK(said(run, "make solver.step 0.0025 s") == 1);  // 13 ms * 0.5 * 5 / 13: some 30 degrees
  auto changed = [&](const std::string& change) {
    std::vector<std::string> all = beside;
    all.push_back(change);
    return run_scene(guide, all);
  };
  CHECK(changed("solver.step=0.005").warnings.empty());
  CHECK(changed("forces[0].free_length=0").warnings.empty());
  // A crank whose tip passes the base's line 5 mm beside it, in the same way an angle.
  const std::string hinge = "the rods of hinge pass one line at";
  CHECK(said(run_scene(crank, {"structure.nodes[2].position=[0, 1, 0.005]",
                               "structure.nodes[2].velocity=[2, 0, 0]"}),
             hinge.c_str()) == 1);
}

}  // namespace turning_back_test
