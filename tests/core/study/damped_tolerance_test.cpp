// SPDX-License-Identifier: BSD-3-Clause
// Tolerances of a method that damps what its steps do not resolve, against an oscillator's closed form.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/study/tolerance.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace damped_tolerance_test {

namespace {

constexpr double amplitude = 0.01;

// 1 kg on a spring, from its rest at x = 1 m, with a swing of 1 cm.
Scene oscillator(double omega, double rho_inf, double tolerance) {
  const auto text_of = [](double x) { return std::to_string(x); };
  return read_scene_text(
      R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "P", position = [1, 0, 0], velocity = [)" +
          text_of(amplitude * omega) + R"(, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["O", "P"]
stiffness = )" +
          text_of(omega * omega) + R"(
free_length = 1
[solver]
method = "generalized_alpha"
end_time = 2
rho_inf = )" +
          text_of(rho_inf) + "\ntolerance = " + text_of(tolerance) + "\n",
      "s.toml", {});
}

struct Answer {
  double error = 0, estimate = 0;
  bool said = false;
};

Answer answer(double omega, double rho_inf, double tolerance) {
  const Scene scene = oscillator(omega, rho_inf, tolerance);
  const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
  Answer out;
  REQUIRE(run.status == RunStatus::completed);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    out.error = std::max(out.error, std::abs(run.trajectory.positions(i)[3] - 1 -
                                             amplitude * std::sin(omega * run.trajectory.time(i))));
  out.estimate = run.position_estimate;
  out.said = std::ranges::any_of(run.warnings,
                                 [](const std::string& w) { return w.find("out of reach") != w.npos; });
  return out;
}

}  // namespace

// All of its grids damp a swing of 3000 rad to rest in a few steps. Estimates are the distance from a run
// that does not: at worst as far off as that one, whose phase may agree for a while, but not for the whole
// run.
TEST_CASE("grids that all damp an oscillation out do not agree on what it would have been") {
  for (const double rho_inf : {0.0, 0.5, 0.9}) {
    const Answer fast = answer(1e4, rho_inf, 1e-3);
    INFO("rho_inf " << rho_inf << ", error " << fast.error << ", estimate " << fast.estimate);
    CHECK((fast.said || fast.error <= 1e-3));
    CHECK(fast.estimate >= 0.1 * fast.error);
  }
}

TEST_CASE("a tolerance that is larger than what damping takes, or whose steps resolve it, is kept") {
  for (const double rho_inf : {0.0, 0.5}) {
    const Answer small = answer(1e4, rho_inf, 0.1);  // twice the swing is a fifth of it
    CHECK_FALSE(small.said);
    CHECK(small.error <= 0.1);
    const Answer slow = answer(7, rho_inf, 1e-4);
    CHECK_FALSE(slow.said);
    CHECK(slow.error <= 1e-4);
  }
}

}  // namespace damped_tolerance_test
