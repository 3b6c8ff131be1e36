// SPDX-License-Identifier: BSD-3-Clause
// What cables and springs pull with, span by span.
#include "core/diagnostics/line_forces.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"

using namespace unfurl;

namespace line_forces_test {

namespace {

struct Pulled {
  explicit Pulled(const std::string& text)
      : scene(read_scene_text(text, "cables.toml")),
        run(simulate(build_model(scene), scene.solver)),
        diagnostics(diagnose(run)),
        forces(line_forces(run, diagnostics)) {}
  Scene scene;
  Simulation run;
  Diagnostics diagnostics;
  LineForces forces;
};

}  // namespace

// Weights of 2 kg and 3 kg at rest: m g in every span, however the cable runs, and none in one that is too
// long.
TEST_CASE("cables and springs at rest bear what hangs on them and slack ones nothing") {
  constexpr double g = 9.81, stiffness = 1e4, length = 2;
  const double taut = length * (1 + 2 * g / stiffness);
  const Pulled p(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "Q", position = [1, 0, 0], fixed = true},
  {name = "E", position = [1, 0, )" +
                 std::to_string(1 - taut) + R"(], mass = 2},
  {name = "F", position = [1, 1, -1], mass = 2}, {name = "S", position = [3, 0, -1], mass = 3},
  {name = "R", position = [1, 1, 0], fixed = true}, {name = "T", position = [3, 0, 0], fixed = true}]
[[constraints]]
kind = "cable"
name = "elastic"
nodes = ["P", "Q", "E"]
axial_stiffness = 1e4
length = 2
[[constraints]]
kind = "cable"
name = "loose"
nodes = ["P", "F"]
axial_stiffness = 1e4
length = 2.5
[[constraints]]
kind = "cable"
name = "held"
nodes = ["P", "R", "F"]
motion = "hold"
[[forces]]
kind = "spring"
nodes = ["T", "S"]
stiffness = 300
free_length = )" +
                 std::to_string(1 - 3 * g / 300) +
                 R"(
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 3
step = 0.01
end_time = 0.2
)");
  REQUIRE(p.run.trajectory.structure().lines.size() == 5);
  REQUIRE(p.forces.lines.cols() == 5);
  // The scene's lengths have six digits: E A / L 1e-6 m and 300 N/m 1e-6 m, and what swings by them.
  for (Index i = 0; i < p.forces.lines.rows(); ++i) {
    for (const Index span : {0, 1}) CHECK(p.forces.lines(i, span) == Approx(2 * g).epsilon(0).margin(0.02));
    CHECK(p.forces.lines(i, 2) == 0.0);
    // A row, whose multiplier a state has to round-off.
    for (const Index span : {3, 4}) CHECK(p.forces.lines(i, span) == Approx(2 * g).epsilon(1e-9));
    CHECK(p.forces.springs(i, 0) == Approx(3 * g).epsilon(0).margin(1e-3));
    CHECK(std::isnan(p.forces.springs(i, 1)));  // a cable has spans
  }
}

// A cable that runs over a fixed pin at more than its creep, half a turn around it: T2 / T1 = exp(-mu pi)
// towards the first node, and the reverse away from it.
TEST_CASE("tensions on both sides of a pulley that rubs are those of the capstan") {
  for (const double speed : {1.0, -1.0}) {
    const std::string v = std::to_string(speed);
    const Pulled p(
        "[structure]\nkind = \"custom\"\n"
        "nodes = [{name = \"A\", position = [0, 0, -2], velocity = [0, 0, " +
        std::to_string(-speed) +
        "], mass = 1}, {name = \"Q\", position = [0, 0, 0], fixed = true},\n"
        "{name = \"B\", position = [0, 0, -1.5], velocity = [0, 0, " +
        v +
        "], mass = 1}]\n"
        "[[constraints]]\nkind = \"cable\"\nnodes = [\"A\", \"Q\", \"B\"]\naxial_stiffness = 1e4\n"
        "length = 3.49\npulley_friction = 0.2\npulley_creep = 0.05\n"
        "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 3\nstep = 0.0001\nend_time = 0.001\n");
    REQUIRE(p.forces.lines.cols() == 2);
    const double first = p.forces.lines(0, 0), second = p.forces.lines(0, 1);
    CHECK(first == Approx(1e4 * (3.5 / 3.49 - 1)).epsilon(1e-9));
    CHECK(second / first == Approx(std::exp(-0.2 * pi * speed)).epsilon(1e-9));
  }
}

}  // namespace line_forces_test
