// SPDX-License-Identifier: BSD-3-Clause
// Damped cables that let go while they are still stretched: where their energy goes.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace damped_cable_test {

namespace {

constexpr double mass = 1.7, k = 260, c = 14, stretch = 0.11;

// m on a guide, drawn to A by k e + c e' from the stretch e: slack where that is nothing, and free then. Over
// a pulley at P, along a straight line, it is a path.
std::string thrown(const std::string& cable, double start, double step) {
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
         "{name = 'P', position = [0.4, 0, 0], fixed = true}, {name = 'B', position = [" +
         testing::number(1 + stretch) + ", 0, 0], velocity = [" + testing::number(start) +
         ", 0, 0], mass = 1.7}]\nrods = []\n"
         "constraints = [{kind = 'line', nodes = ['B'], direction = [1, 0, 0]}]\n[[forces]]\n" +
         cable + "\ndamping = 14\n[solver]\nstages = 4\nstep = " + testing::number(step) +
         "\nend_time = 0.5\n";
}

}  // namespace

// e = exp(-d t) (e_0 cos w t + (v + d e_0) / w sin w t), d = c / 2m, w^2 = k / m - d^2; k e + c e' = -m e''
// is nothing for the first time where it lets go with e > 0. From there on m keeps its speed u: it has lost
// all but m u^2 / 2. Where steps are, in the middle of the way of the slack cable or not, is nothing to that.
TEST_CASE("a damped cable that lets go while it is stretched has lost its energy at its length") {
  const double d = c / (2 * mass), w = std::sqrt(k / mass - d * d);
  for (const double start : {0.0, 0.3, -1.1, -2.2})  // thrown at 2.2 m/s it lets go at once
    for (const char* cable :
         {"kind = 'spring'\nnodes = ['A', 'B']\nfree_length = 1\nstiffness = 260\ntension_only = true",
          "kind = 'cable'\nnodes = ['A', 'P', 'B']\nlength = 1\naxial_stiffness = 260"})
      for (const double step : {0.01, 0.017}) {
        CAPTURE(start, cable, step);
        const Simulation run = testing::run_scene(thrown(cable, start, step));
        REQUIRE(run.status == RunStatus::completed);
        const double b = (start + d * stretch) / w;
        const auto at = [&](double t) {
          return std::exp(-d * t) * (stretch * std::cos(w * t) + b * std::sin(w * t));
        };
        const auto rate = [&](double t) {
          return std::exp(-d * t) *
                 ((b * w - d * stretch) * std::cos(w * t) - (stretch * w + d * b) * std::sin(w * t));
        };
        const auto pull = [&](double t) { return k * at(t) + c * rate(t); };
        double low = 0, high = 0;
        if (pull(0) > 0) {
          while (pull(high) > 0) high += 1e-4;
          for (int i = 0; i < 60; ++i) (pull(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
        }
        CHECK(at(high) > 0.01);
        const double stored = 0.5 * mass * start * start + 0.5 * k * stretch * stretch,
                     left = 0.5 * mass * rate(high) * rate(high);
        const Diagnostics figures = diagnose(run);
        // Steps of w h = 0.2 of order 8, and a cable that is told as slack at 1e-11 m of its length.
        CHECK(figures.at("kinetic_energy_J").values.back() == Approx(left).epsilon(1e-7));
        CHECK(figures.at("dissipated_J").values.back() == Approx(stored - left).epsilon(1e-7));
        for (const double x : figures.at("energy_balance_J").values) CHECK(std::abs(x) < 1e-7 * stored);
      }
}

}  // namespace damped_cable_test
