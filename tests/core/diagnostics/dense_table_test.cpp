// SPDX-License-Identifier: BSD-3-Clause
// Drives by tables of ten points a step, whose values have the digits of a file: their work.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/structure/time_function.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace dense_table_test {

namespace {

constexpr double spacing = 1e-3;
using Points = std::pair<std::vector<double>, std::vector<double>>;

// offset + rise sin^2 3t over 1.2 s, rounded to multiples of `unit` from the offset.
Points rounded(double offset, double rise, double unit) {
  Points out;
  for (int i = 0; i <= 1200; ++i) {
    const double t = i * spacing, s = std::sin(3 * t);
    out.first.push_back(t);
    out.second.push_back(offset + unit * std::round(rise * s * s / unit));
  }
  return out;
}

std::string list(const std::vector<double>& values) {
  std::string out = "[";
  for (const double x : values) out += testing::number(x) + ", ";
  return out + "]";
}

std::string table(const Points& points) {
  return "\ntimes = " + list(points.first) + "\nvalues = " + list(points.second) + "\n";
}

std::string solver(const std::string& more) {
  return "[solver]\nstep = 0.01\nend_time = 1\n" + more;
}

std::string pushed(const Points& points, const std::string& more) {
  return R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], mass = 2}, {name = "O", position = [0, 0, 0], fixed = true}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]}]
[[constraints]]
kind = "length"
name = "d"
nodes = ["O", "A"]
motion = "table")" +
         table(points) + solver(more);
}

}  // namespace

// Nothing else does work: what a drive puts into 2 kg on a line is f'^2 of the clamped spline, whatever the
// method holds its rates by. With 4 digits f'' is up to 200 m/s^2 and alternates. Rates are as the states
// have them, to the round-off of 1 m over the shortest time (2e-16 / 1e-3): 1e-10 bears a thousand times
// that, of which 1e-7 of the squares of rates may be left in steps that are not split.
TEST_CASE("the work of a drive by a rounded dense table is the energy that it gives") {
  const double unit = GENERATE(1e-6, 1e-4);
  const Points points = rounded(1, 0.2, unit);
  const TimeFunction f = make_spline(points.first, points.second);
  for (const char* more : {"stages = 2", "stages = 3", "stages = 5", "method = 'rk4_projected'",
                           "adaptive = true", "model = 'path'"}) {
    CAPTURE(unit, more);
    const Simulation run = testing::run_scene(pushed(points, more));
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    CHECK(mistrust(run, d).empty());
    CHECK(accuracy_warnings(run, d).empty());
    double most = 0;
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      const double rate = f.derivative(1, d.t[i]);
      most = std::max(most, rate * rate);
      CHECK(d.at("drive_work_J").values[i] == Approx(rate * rate).epsilon(0).margin(2e-7 * most + 1e-10));
      CHECK(d.at("d.energy_J").values[i] == Approx(rate * rate).epsilon(0).margin(2e-7 * most + 1e-10));
    }
    CHECK(most > 0.3);
  }
}

// Poses whose inertia and weight follow the drive, and a pendulum that is shaken by it: energy is conserved.
// Rates are some 1 % off a smooth table's, and alternate; what the path between states is off by then, 1e-3
// of a step's way, enters with the changes of inertia and weight: to 1e-3 of the 1 % of the energy that is
// the rates', and ten steps more or less all of one sign.
TEST_CASE("the energy balance of mechanisms that rounded dense tables drive closes") {
  const std::string arm = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [0.6, 0, 0.8], mass = 1.5},
  {name = "B", position = [1.8, 0, 0.8], mass = 0.7}, {name = "H", position = [1, 0, 0], fixed = true}]
rods = [{nodes = ["O", "A"], mass = 0.4}, {nodes = ["A", "B"], mass = 0.3}]
constraints = [{kind = "plane", nodes = ["A", "B"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
)";
  const std::string slide = R"([[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
)";
  const std::string turn = R"([[constraints]]
kind = "angle"
name = "d"
nodes = ["H", "O", "A"]
axis = [0, -1, 0]
motion = "table")" + table(rounded(std::acos(0.6) * 180 / std::numbers::pi, 30, 0.001));
  const std::string cable = R"(
[structure]
kind = "custom"
nodes = [{name = "Q", position = [0.5, 0, 0], fixed = true}, {name = "M", position = [0.5, 0, -1], mass = 2}]
constraints = [{kind = "line", nodes = ["M"], direction = [0, 0, 1]}]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "cable"
nodes = ["Q", "M"]
motion = "table")" + table(rounded(1, -0.1, 1e-5));
  const std::string warm = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, -1], mass = 2}, {name = "O", position = [0, 0, 0], fixed = true}]
rods = [{nodes = ["O", "A"], mass = 0.5}]
constraints = [{kind = "line", nodes = ["A"], direction = [0, 0, 1]}]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "temperature"
rods = ["*"]
expansion = 1e-3
change = 100)" + table(rounded(0, 1, 1e-4));
  for (const std::string& scene : {arm + slide + turn, arm + turn, cable, warm}) {
    const Simulation run = testing::run_scene(scene + solver("stages = 4"));
    CAPTURE(scene.substr(0, 300), run.message);
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    CHECK(mistrust(run, d).empty());
    CHECK(testing::largest(d, "energy_balance_J") < 1e-4 * energy_turned_over(d));
  }
}

// A method whose rates are not those of the table is off; what helps is said.
TEST_CASE("a dense table that a method does not follow is named with the step that does") {
  const Simulation run = testing::run_scene(pushed(rounded(1, 0.2, 1e-4), "method = 'rk4'"));
  CHECK(mistrust(run, diagnose(run))
            .ends_with(" % of the energy turned over; the table of d has 10 points within a step: "
                       "solver.step = 0.001 follows them"));
}

}  // namespace dense_table_test
