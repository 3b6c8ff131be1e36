// SPDX-License-Identifier: BSD-3-Clause
// What a sweep may ask of a run, against two pendulums whose tensions follow from their energy.
#include "core/diagnostics/measures.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace measures_test {

namespace {

// The first falls from upright at 1.1 rad/s, the second is let go level at 3 rad/s.
const std::string pendulums = R"(
[structure]
kind = "custom"
section = "round"
nodes = [
  {name = "P", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0, 0, 0.8], velocity = [0.88, 0, 0], mass = 1.3},
  {name = "Q", position = [5, 0, 0], fixed = true},
  {name = "B", position = [6.1, 0, 0], velocity = [0, 0, -3.3], mass = 0.9}]
rods = [{name = "one", nodes = ["P", "A"], mass = 0, area = 2e-5, youngs_modulus = 7e10, strength = 3e7},
        {name = "two", nodes = ["Q", "B"], mass = 0, area = 1e-5, youngs_modulus = 2e11, strength = 5e7}]
[[structure.constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 5
step = 0.013
end_time = 2.6
)";

constexpr double g = 9.81;

// l w^2 / 2 = l w_0^2 / 2 + g (cos f - cos f_0) with f from straight down: T = m (l w_0^2 + 3 g cos f - 2 g
// cos f_0).
double tension(double m, double l, double w0, double cos_f0, double cos_f) {
  return m * (l * w0 * w0 + 3 * g * cos_f - 2 * g * cos_f0);
}

double euler(double modulus, double area, double l) {
  return pi * pi * modulus * (area * area / (4 * pi)) / (l * l);
}

}  // namespace

TEST_CASE("measures of a run are those of the motion, between its steps, too") {
  const Simulation run = testing::run_scene(pendulums);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const auto measure = [&](const std::string& name) { return find_measure(name).value(run, d); };
  const double one = tension(1.3, 0.8, 1.1, -1, 1), two = tension(0.9, 1.1, 3, 0, 1),
               push_one = -tension(1.3, 0.8, 1.1, -1, -1),
               push_two = -tension(0.9, 1.1, 3, 0, -1.1 * 9 / (2 * g));  // where it turns round
  REQUIRE((one > two && push_one > push_two && push_two > 0));
  // Within a step a peak is found on a parabola through 9 points: third derivatives of some 1e3 m w^3 ... of
  // the tension, some 10^4 of it, times (0.013 / 32)^4.
  const double near = 1e-6;
  CHECK(measure("peak_tension") == Approx(one).epsilon(near));
  CHECK(measure("peak_compression") == Approx(push_one).epsilon(near));
  CHECK(measure("peak_rod_force") == Approx(one).epsilon(near));
  CHECK(measure("max:axial_force_max_N") == Approx(one).epsilon(near));
  CHECK(measure("min:axial_force_min_N") == Approx(-push_one).epsilon(near));
  CHECK(measure("final:axial_force_max_N") == d.axial_force.row(d.axial_force.rows() - 1).maxCoeff());
  CHECK(measure("peak_stress") == Approx(std::max(one / 2e-5, two / 1e-5)).epsilon(near));
  CHECK(measure("stress_margin") ==
        Approx(std::min(3e7 / (one / 2e-5), 5e7 / (two / 1e-5)) - 1).epsilon(near));
  CHECK(measure("buckling_margin") ==
        Approx(std::min(euler(7e10, 2e-5, 0.8) / push_one, euler(2e11, 1e-5, 1.1) / push_two) - 1)
            .epsilon(near));
  CHECK(measure("peak_speed") == Approx(std::sqrt(3.3 * 3.3 + 2 * g * 1.1)).epsilon(near));  // of the second
  for (const char* name : {"peak_rod_force_unique", "peak_tension_unique", "peak_compression_unique",
                           "peak_stress_unique", "stress_margin_unique", "buckling_margin_unique"})
    CHECK(measure(name) == 1.0);
  CHECK(measure("end_time") == 2.6);
  CHECK(std::isnan(measure("deploy_time")));
  double newton = 0;
  for (const double x : d.at("newton_iterations").values) newton += std::isnan(x) ? 0 : x;
  CHECK(measure("newton_iterations") == newton);
}

}  // namespace measures_test
