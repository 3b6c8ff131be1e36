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

}  // namespace turning_back_test
