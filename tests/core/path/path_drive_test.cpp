// SPDX-License-Identifier: BSD-3-Clause
// Drives on the path, up to what the structure can reach and beyond.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/path/path_run.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace path_drive_test {

namespace {

// The crank A-B of length 1 and D at 3 from A: B-D is at most 4, where the crank points away from D.
const std::string four_bar = R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0, 0, 1]},
  {name = "C", position = [2.6, 0, 2.4]}, {name = "D", position = [3, 0, 0], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 3}, {nodes = ["C", "D"], mass = 2.4}]
[[constraints]]
kind = "plane"
nodes = ["B", "C"]
normal = [0, 1, 0]
[[constraints]]
kind = "length"
name = "drive"
nodes = ["B", "D"]
)toml";

Scene driven(const std::vector<std::string>& drive) {
  std::vector<std::string> changes{"solver.step=0.01"};
  for (const std::string& one : drive)
    changes.push_back((one.starts_with("solver.") ? "" : "constraints[1].") + one);
  return read_scene_text(four_bar, "s.toml", changes);
}

std::string refusal(const Scene& scene) {
  try {
    simulate_on_path(build_model(scene), scene.solver);
  } catch (const PathRefused& refused) {
    return refused.what();
  }
  return "";
}

double length_at_end(const Simulation& run) {
  const VectorXd q = testing::end_positions(run);
  return (q.segment<3>(3) - q.segment<3>(9)).norm();
}

}  // namespace

// Coordinates a million times as long as the only rod are known to fewer digits than a path is traced with.
TEST_CASE("a drive that leads beyond where the path can be followed is refused") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, 0, 0], mass = 0.05}, {name = 'Q', "
      "position = [0.02, 0, 0], mass = 0.05}]\nrods = [{nodes = ['P', 'Q'], mass = 0.01}]\n"
      "[[constraints]]\nkind = 'line'\nnodes = ['P', 'Q']\ndirection = [1, 0, 0]\n"
      "[[constraints]]\nkind = 'coordinate'\nnodes = ['P']\ndirection = [1, 0, 0]\nmotion = 'smooth'\nto = "
      "40000\n"
      "duration = 20\n[solver]\nstep = 0.1\nend_time = 25\n",
      "cart.toml", {});
  CHECK_THROWS_AS(simulate_on_path(build_model(scene), scene.solver), PathRefused);
}

// 4 m are passed by a lot, a little and by 1e-9 of them; 1e-11 of them more or less is 1e-5 rad of the crank.
TEST_CASE("a drive beyond what the structure can reach is refused where it gets there") {
  CHECK(refusal(driven({"motion=\"rate\"", "rate=0.5", "ramp=0.1", "solver.end_time=4"})).find("the drive") !=
        std::string::npos);
  for (const double to : {5.0, 4.5, 4.00001, 4 + 4e-9}) {
    CAPTURE(to);
    const std::vector<std::string> drive{"motion=\"smooth\"", "to=" + number(to), "duration=1",
                                         "solver.end_time=1.5"};
    CHECK(refusal(driven(drive)).find("the drive") != std::string::npos);
    std::vector<std::string> by_itself = drive;
    by_itself.push_back("solver.model=\"auto\"");
    const Scene scene = driven(by_itself);
    CHECK(simulate_as_asked(build_model(scene), scene.solver).status == RunStatus::failed);
  }
  for (const double to : {4 - 4e-9, 3.99999, 3.9, 2.1}) {
    CAPTURE(to);
    const Scene scene =
        driven({"motion=\"smooth\"", "to=" + number(to), "duration=1", "solver.end_time=1.5"});
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    CHECK(run.status == RunStatus::completed);
    CHECK(length_at_end(run) == Approx(to).epsilon(1e-14));
  }
}

// A wave whose top is the straight pose, 1/4 of a period behind its beginning and within a step: the rods go
// on to the other side there, where the path has another branch.
TEST_CASE("a drive that turns round in a dead centre is refused at the time of that") {
  for (const double frequency : {0.4, 0.26, 0.7}) {
    CAPTURE(frequency);
    const double start = std::sqrt(10.0);  // of B-D
    const std::string said =
        refusal(driven({"motion=\"sine\"", "amplitude=" + number(4 - start), "frequency=" + number(frequency),
                        "solver.step=0.1", "solver.end_time=1.5"}));
    CHECK_THAT(said, Catch::Contains("turns round in a dead centre"));
    CHECK_THAT(said, Catch::Contains(number(0.25 / frequency).substr(0, 5)));
  }
}

// From one time of the grid to the next over more than a piece of the path, and there and back.
TEST_CASE("a drive may go far in a step") {
  for (const double step : {0.01, 0.2, 1.0}) {
    CAPTURE(step);
    const Scene scene = driven(
        {"motion=\"smooth\"", "to=2.001", "duration=1", "solver.end_time=2", "solver.step=" + number(step)});
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    CHECK(run.status == RunStatus::completed);
    CHECK(length_at_end(run) == Approx(2.001).epsilon(1e-14));
  }
}

// A crank of 0.3 m that is turned at 90 deg/s from the start, a rod of 1 m and a slider on the crank's level.
TEST_CASE("a drive that sets out at speed is followed as far from the origin as the path is") {
  const double pi = std::acos(-1.0), r = 0.3, from = -1, until = 0.7;
  for (const double far : {0.0, 30.0, 130.0, 2.1e3, 1.7e4, 3.3e5}) {
    CAPTURE(far);
    const auto slider = [&](double angle) {
      return far + r * std::cos(angle) + std::sqrt(1 - std::pow(r * std::sin(angle), 2));
    };
    const auto at = [](double x, double y) { return "[" + number(x) + ", " + number(y) + ", 0]"; };
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = " + at(far, 0) +
            ", fixed = true}, {name = 'X', position = " + at(far + 1, 0) +
            ", fixed = true}, {name = 'A', mass = 1, position = " +
            at(far + r * std::cos(from), r * std::sin(from)) +
            "}, {name = 'B', mass = 0.5, position = " + at(slider(from), 0) +
            "}]\nrods = [{nodes = ['O', 'A'], mass = 0, length = 0.3}, {nodes = ['A', 'B'], mass = 0, length "
            "= 1}]\n[[constraints]]\nkind = 'angle'\nnodes = ['X', 'O', 'A']\naxis = [0, 0, 1]\nmotion = "
            "'rate'\nrate = 90\n[[constraints]]\nkind = 'line'\nnodes = ['B']\ndirection = [1, 0, 0]\n"
            "[[constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 0, 1]\n[solver]\nstep = 0.01\n"
            "end_time = " +
            number(until) + "\n",
        "s.toml");
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    // Rounding of each coordinate, over this size and in a table's sums of 25.
    const double rounding = 1e-13 + 25 * std::numeric_limits<double>::epsilon() * far;
    CHECK(std::abs(testing::end_positions(run)[9] - slider(from + 0.5 * pi * until)) <= rounding);
  }
}

// A slider-crank whose slider is guided by a line, or by what holds its height.
TEST_CASE("what is held does not change with time: a path as of any other guide") {
  const auto crank = [](const std::string& guide) {
    return read_scene_text(R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.3, 0, 0.4]},
  {name = "C", position = [1.4, 0, 0.1], mass = 2}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 3}]
[[constraints]]
kind = "plane"
nodes = ["B", "C"]
normal = [0, 1, 0]
[[constraints]]
nodes = ["C"]
)toml" + guide + R"toml(
[[loads]]
nodes = ["C"]
force = [3, 0, 0]
[solver]
step = 0.01
stages = 6
end_time = 0.4
)toml",
                           "s.toml", {});
  };
  const Scene line = crank("kind = \"line\"\ndirection = [1, 0, 0]"),
              held = crank("kind = \"coordinate\"\ndirection = [0, 0, 1]");
  const Simulation by_line = simulate_on_path(build_model(line), line.solver),
                   by_hold = simulate_on_path(build_model(held), held.solver),
                   full = simulate(build_model(held), held.solver);
  REQUIRE(by_hold.status == RunStatus::completed);
  CHECK((testing::end_positions(by_hold) - testing::end_positions(by_line)).lpNorm<Eigen::Infinity>() <
        1e-11);
  CHECK((testing::end_positions(by_hold) - testing::end_positions(full)).lpNorm<Eigen::Infinity>() < 1e-11);
  CHECK(testing::end_positions(full)[6] > 1.401);
}

}  // namespace path_drive_test
