// SPDX-License-Identifier: BSD-3-Clause
// Loads that last less than a method can step over: their impulse arrives.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>

#include "core/path/path_run.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace blow_test {

namespace {

// A free mass of 1 kg, or one on a line, under a load along x.
Scene pushed(const std::string& times, const std::string& values, double force, double step, double end,
             bool on_line = false) {
  const std::string line = "[[constraints]]\nkind = 'line'\nnodes = ['P', 'Q']\ndirection = [1, 0, 0]\n";
  return read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [1, 0, 0], mass = 0.5}, "
      "{name = 'Q', position = [2, 0, 0], mass = 0.5}]\nrods = [{nodes = ['P', 'Q'], mass = 0}]\n" +
          (on_line ? line : std::string()) + "[[forces]]\nkind = 'load_over_time'\nnodes = ['P']\nforce = [" +
          number(force) + ", 0, 0]\ntimes = " + times + "\nvalues = " + values +
          "\n[solver]\nstep = " + number(step) + "\nend_time = " + number(end) + "\n",
      "blow.toml", {});
}

double way(const Simulation& run) {
  REQUIRE(run.status == RunStatus::completed);
  return testing::end_positions(run)[0] - 1;
}
double speed(const Simulation& run) {
  return run.trajectory.node_velocities(run.trajectory.size() - 1)[0];
}

std::string list(std::initializer_list<double> numbers) {
  std::string text = "[";
  for (const double x : numbers) text += (text.size() > 1 ? ", " : "") + number(x);
  return text + "]";
}

}  // namespace

// A flank of less than 1e-7 of a step becomes a jump, and what is beside it may be as short. The impulse is
// the area below the line; times are known to 1e-16 of themselves, 1e-9 of the shortest flank here.
TEST_CASE("no flank that becomes a jump takes a part of its blow away") {
  int refused = 0;
  for (const double step : {0.01, 1.0, 10.0})
    for (const double behind : {0.2e-7, 1e-7, 3e-7, 1e-6, 1e-4, 0.3})
      for (const auto& y :
           {std::array{0.0, 1.0, 0.0}, {0.0, 1.0, 1.0}, {1.0, 0.0, 0.5}, {0.5, 2.0, 0.0}, {1.0, 1.1, 0.0}})
        for (const bool turned : {false, true}) {
          double w1 = 0.9e-7 * step, w2 = behind * step;
          if (turned) std::swap(w1, w2);
          const double t0 = 0.5 * step, end = 3 * step,
                       area = w1 * (y[0] + y[1]) / 2 + w2 * (y[1] + y[2]) / 2;
          CAPTURE(step, w1, w2, y[0], y[1], y[2]);
          // Nothing before and behind but for what the first and the last value say.
          const double rest = y[0] * t0 + y[2] * (end - t0 - w1 - w2), force = 1 / (area + rest);
          try {
            const Scene scene =
                pushed(list({t0, t0 + w1, t0 + w1 + w2}), list({y[0], y[1], y[2]}), force, step, end);
            const Simulation run = simulate(build_model(scene), scene.solver);
            CHECK(speed(run) == Approx(1).epsilon(1e-7));
          } catch (const Error& error) {
            CHECK(std::string(error.what()).find("no step follows so short a blow") != std::string::npos);
            ++refused;
          }
        }
  CHECK(refused < 90);
}

// 2 N s within 2 us of 1000 s: the grids that a tolerance tries have steps of up to 28 s.
TEST_CASE("a tolerance does not lose a blow") {
  for (const double end : {100.0, 1000.0, 1e4}) {
    const double width = 2e-9 * end, at = 0.5 * end, force = 4 / width;
    CAPTURE(end);
    Scene scene = pushed(list({at, at + width, at + width}), "[0, 1, 0]", force, 0.01, end);
    scene.solver.tolerance = 1e-3;
    const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
    // The times that stand for the blow's are off by an ulp of `at`, 1e-7 of its width.
    const double exact = 2 * (end - at - width) + 2 * width / 3;
    CHECK(way(run) == Approx(exact).epsilon(0).margin(1e-3 + 2e-7 * exact));
  }
}

// a (1 - u) for a millisecond from 500 s on, a = 4000 m/s^2: a w^2 / 3 and a w / 2 at its end.
TEST_CASE("a load that jumps late in a run acts from its time on") {
  const double a = 4e3, at = 500, w = std::ldexp(1, -10);
  for (const bool on_path : {true, false}) {
    CAPTURE(on_path);
    const Scene scene = pushed(list({at, at, at + w}), "[0, 1, 0]", a, 0.5, 600, true);
    const auto model = build_model(scene);
    const Simulation run = on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
    CHECK(speed(run) == Approx(a * w / 2).epsilon(1e-12));
    CHECK(way(run) == Approx(a * w * w / 3 + a * w / 2 * (600 - at - w)).epsilon(1e-12));
  }
}

// Lines between points, each of which is met by steps of its own: the trapezium has their impulse exactly,
// and their way to h^3 / 12 of the jerk, h^2 / 12 of how the acceleration changes on each.
TEST_CASE("a blow gives its impulse whatever generalized_alpha damps") {
  const double t0 = 0.2111, end = 0.5;
  for (const auto& [w1, w2] : {std::pair{0.00076, 0.00076}, {0.0001, 0.0008}, {0.0008, 0.0001}})
    for (const auto& y : {std::array{0.0, 1.0, 0.0}, {1.0, 0.4, 0.0}, {0.0, -0.3, 1.0}})
      for (const double rho : {0.0, 0.5, 0.9, 1.0})
        for (const double step : {0.004, 0.001, 0.00025}) {
          CAPTURE(w1, w2, y[0], y[1], y[2], rho, step);
          // Nothing before and behind it: what begins or ends with a value does so at once.
          Scene scene = pushed(list({t0, t0, t0 + w1, t0 + w1 + w2, t0 + w1 + w2}),
                               list({0.0, y[0], y[1], y[2], 0.0}), 1000, step, end);
          scene.solver.method = "generalized_alpha";
          scene.solver.rho_inf = rho;
          const Simulation run = simulate(build_model(scene), scene.solver);
          const double v1 = 1000 * w1 * (y[0] + y[1]) / 2, v2 = v1 + 1000 * w2 * (y[1] + y[2]) / 2;
          const double x = 1000 * w1 * w1 * (y[0] / 3 + y[1] / 6) + v1 * w2 +
                           1000 * w2 * w2 * (y[1] / 3 + y[2] / 6) + v2 * (end - t0 - w1 - w2);
          CHECK(way(run) == Approx(x).epsilon(0).margin(2 * 1000 * 0.0008 * 0.0008 / 12));
          CHECK(speed(run) == Approx(v2).epsilon(0).margin(1000 * 1e-12));  // jumps have a width
        }
}

// 0.1 m at 20 rad/s, and a load that bends every 1 ms, or every 2.7 ms: its impulses of 1e-6 N s, of any
// sign, add up to some 1e-5 of the speed of 2 m/s. A trapezium keeps what swings; steady steps of rho_inf = 0
// take (h omega)^3 / 8 or so of it in each radian: of 100, with h of 1 ms, 1e-4.
TEST_CASE("a load that bends at every step takes nothing of a swing with generalized_alpha") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const double apart : {0.001, 0.0027}) {
    std::string times = "[0", values = "[0";
    for (double t = apart; t < 5; t += apart) times += ", " + number(t), values += ", " + number(any(random));
    for (const double rho : {0.0, 0.5, 0.9, 1.0})
      for (const double step : {0.001, 0.01}) {
        if (apart > 0.001 && step > 0.001) continue;
        CAPTURE(apart, rho, step);
        Scene scene = read_scene_text(
            "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name "
            "= "
            "'P', position = [1, 0, 0], mass = 1, velocity = [2, 0, 0]}]\n[[constraints]]\nkind = "
            "'line'\nnodes = ['P']\ndirection = [1, 0, 0]\n[[forces]]\nkind = 'spring'\nnodes = ['O', 'P']\n"
            "stiffness = 400\n[[forces]]\nkind = 'load_over_time'\nnodes = ['P']\nforce = [1e-3, 0, 0]\n"
            "times = " +
                times + "]\nvalues = " + values +
                "]\n[solver]\nmethod = 'generalized_alpha'\n"
                "end_time = 5\n",
            "swing.toml", {"solver.rho_inf=" + number(rho), "solver.step=" + number(step)});
        const Simulation run = simulate(build_model(scene), scene.solver);
        REQUIRE(run.status == RunStatus::completed);
        const double x = testing::end_positions(run)[3] - 1,
                     v = run.trajectory.node_velocities(run.trajectory.size() - 1)[3];
        CHECK(std::hypot(x, v / 20) == Approx(0.1).epsilon(5e-4));
      }
  }
}

}  // namespace blow_test
