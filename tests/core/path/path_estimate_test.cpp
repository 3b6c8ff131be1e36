// SPDX-License-Identifier: BSD-3-Clause
// What is said of the error of a run along the path.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/study/tolerance.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace path_estimate_test {

namespace {

constexpr double g = 9.81;

// A rod on its end, d off the vertical: tan(theta / 4) grows as cosh(k t), k^2 = 3 g / 2 l, but for d^2.
struct Fall {
  double d, end;
  explicit Fall(double off) : d(off), end((std::log(2 / off) + 0.5) / std::sqrt(1.5 * g)) {}
  Simulation run(const std::string& model, double tolerance) const {
    const Scene scene = read_scene_text(
        R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "P", position = [)toml" +
            number(d) + R"toml(, 0, 1]}]
rods = [{nodes = ["A", "P"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["P"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
)toml",
        "s.toml",
        {"solver.model=" + model, "solver.end_time=" + number(end), "solver.tolerance=" + number(tolerance)});
    return simulate_as_asked(build_model(scene), scene.solver);
  }
  double error_of(const Simulation& run) const {
    const double theta = 4 * std::atan(d / 8 * std::exp(std::sqrt(1.5 * g) * end));
    const VectorXd q = testing::end_positions(run);
    return std::hypot(q[3] - std::sin(theta), q[5] - std::cos(theta));
  }
};

bool out_of_reach(const Simulation& run) {
  for (const std::string& warning : run.warnings)
    if (warning.find("out of reach") != std::string::npos) return true;
  return false;
}

}  // namespace

// Rounding of the place grows e^(k t) times on the way, some 1 / d.
TEST_CASE("beside an unstable rest a run along the path says what rounding has grown to") {
  for (const double d : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    CAPTURE(d);
    const Fall fall(d);
    const Simulation run = fall.run("path", 1e-9);
    CHECK(run.solved_as.name == "path");
    // The closed form is off by some d^2, as the length of the rod is.
    CHECK(fall.error_of(run) <= run.position_estimate + 10 * d * d);
    CHECK(run.position_estimate <= 1e-14 / d);
    CHECK(out_of_reach(run) == (run.position_estimate > 1e-9));
    CHECK(out_of_reach(run) == (d < 1e-5));
  }
}

// The full model begins with the start's own numbers: an error of the start is none of the distance d.
TEST_CASE("where the path does not keep a tolerance that the full model keeps that is solved") {
  for (const double d : {1e-8, 1e-11}) {
    CAPTURE(d);
    const Fall fall(d);
    const Simulation run = fall.run("auto", 1e-8);
    CHECK(solved_as(run).name == "full");
    CHECK(run.solved_as.why.find("rounding of the start grows") != std::string::npos);
    CHECK(fall.error_of(run) <= 1e-8);
    CHECK(!out_of_reach(run));
  }
  // Of a motion that forgives rounding the path is the answer.
  const Simulation easy = Fall(0.1).run("auto", 1e-9);
  CHECK(easy.solved_as.name == "path");
  CHECK(easy.position_estimate <= 1e-11);
}

TEST_CASE("a tolerance below what a path can keep is out of reach") {
  for (const std::string model : {"path", "auto"}) {
    const Simulation run = Fall(0.1).run(model, 1e-15);
    CHECK(run.solved_as.name == "path");
    CHECK(out_of_reach(run));
  }
}

}  // namespace path_estimate_test
