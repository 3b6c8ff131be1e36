// SPDX-License-Identifier: BSD-3-Clause
// Peaks and the motion between states where steps are long for the motion.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/number.hpp"

using namespace unfurl;

namespace long_step_peaks_test {

namespace {

double measured(const std::string& name, const Simulation& run) {
  return find_measure(name).value(run, diagnose(run));
}

Simulation run_of(const std::string& scene, const std::vector<std::string>& changes, bool on_path = false) {
  const Scene read = read_scene_file(find_scene(scene), changes);
  const auto model = build_model(read);
  return on_path ? simulate_on_path(model, read.solver) : simulate(model, read.solver);
}

std::string number(double x) {
  return std::to_string(x);
}

// The largest distance of a node between two runs, at times within the steps of the first.
double apart(const Simulation& run, const Simulation& truth, double until) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < run.trajectory.size(); ++i)
    for (const double u : {0.2, 0.5, 0.9}) {
      const double t = run.trajectory.time(i) + u * (run.trajectory.time(i + 1) - run.trajectory.time(i));
      if (t < until)
        most = std::max(
            most,
            (run.trajectory.positions_at(t) - truth.trajectory.positions_at(t)).lpNorm<Eigen::Infinity>());
    }
  return most;
}

}  // namespace

// Of a bob on a rod from rest at 73 degrees: v^2 = 2 g l (1 - cos), tension m g (3 - 2 cos) at the bottom. Of
// eight stages steps of up to a third of the swing leave 1e-9 of the motion.
TEST_CASE("peaks of a pendulum are found in steps of any length") {
  const double angle = 73 * std::acos(-1.0) / 180, l = 0.8, m = 2.5, g = 9.81;
  for (const double step : {0.05, 0.13, 0.21, 0.35, 0.5}) {
    Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, "
        "{name = 'P', position = [" +
            number(l * std::sin(angle)) + ", 0, " + number(-l * std::cos(angle)) +
            "], mass = 2.5}]\nrods = [{nodes = ['O', 'P'], mass = 0}]\n[gravity]\nacceleration = [0, 0, "
            "-9.81]\n"
            "[[constraints]]\nkind = 'plane'\nnodes = ['P']\nnormal = [0, 1, 0]\n[solver]\nstages = "
            "8\nend_time = "
            "2.9\n",
        "swing.toml", {});
    scene.solver.step = step;
    const auto model = build_model(scene);
    for (const bool on_path : {false, true}) {
      CAPTURE(step, on_path);
      const Simulation run = on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
      REQUIRE(run.status == RunStatus::completed);
      // Positions are given to 1e-6 m.
      CHECK(measured("peak_speed", run) ==
            Approx(std::sqrt(2 * g * l * (1 - std::cos(angle)))).epsilon(5e-6));
      CHECK(measured("peak_energy", run) == Approx(m * g * l * (1 - std::cos(angle))).epsilon(1e-5));
      CHECK(measured("peak_tension", run) == Approx(m * g * (3 - 2 * std::cos(angle))).epsilon(1e-5));
    }
  }
}

// A linkage that passes dead centres within a tenth of a second: what states every 2 ms hold, to the square
// of 2 ms over that. In steps of 0.1 s eight stages leave 1e-5 of the forces.
TEST_CASE("peaks beside dead centres are found between states that hold none of it") {
  const auto four_bar = [](double step, bool on_path) {
    return run_of("four_bar", {"solver.stages=8", "solver.step=" + number(step)}, on_path);
  };
  const Simulation fine = four_bar(0.002, false);
  const Diagnostics d = diagnose(fine);
  for (const char* name : {"peak_tension", "peak_compression", "peak_speed", "peak_energy"}) {
    const double truth = find_measure(name).value(fine, d);
    for (const double step : {0.1, 0.07, 0.05})
      for (const bool on_path : {false, true}) {
        CAPTURE(name, step, on_path);
        CHECK(measured(name, four_bar(step, on_path)) == Approx(truth).epsilon(2e-4));
      }
  }
}

// The last step ends in the deployed pose, which is singular; within it the posts bear most, 30 ms before.
TEST_CASE("peaks are found in a long step that ends in the deployed pose") {
  const Simulation fine = run_of("hoop6_sector", {"solver.stages=7", "solver.step=0.001"});
  const std::vector<double> force = diagnose(fine).at("axial_force_min_N").values;
  const double most = -*std::min_element(force.begin(), force.end());
  for (const double step : {0.171, 0.08, 0.02})
    for (const bool on_path : {false, true}) {
      CAPTURE(step, on_path);
      const Simulation run =
          run_of("hoop6_sector", {"solver.stages=7", "solver.step=" + number(step)}, on_path);
      REQUIRE(run.status == RunStatus::deployed);
      // The peak is as wide as a tenth of a second: states every millisecond miss (0.01)^2 of it.
      CHECK(measured("peak_compression", run) == Approx(most).epsilon(1e-3));
    }
}

// Whatever the scene's method and steps, which the path does not use, its motion between states is that of
// small steps of many stages.
TEST_CASE("between its states the path is as true as at them") {
  struct Case {
    const char* scene;
    double until, close;
  };
  for (const Case& c :
       {Case{"four_bar", 6, 1e-11}, Case{"hoop6_sector", 4.8, 1e-11}, Case{"hoberman", 1, 1e-11}}) {
    const Simulation truth = run_of(c.scene, {"solver.stages=8", "solver.step=0.002"});
    for (const char* solver : {"solver.stages=2", "solver.method=rk4", "solver.method=generalized_alpha"}) {
      CAPTURE(c.scene, solver);
      const Simulation run = run_of(c.scene, {solver, "solver.step=0.01"}, true);
      CHECK(apart(run, truth, std::min(c.until, truth.trajectory.end_time())) <= c.close);
    }
  }
}

// A motor with a rotor turns an arm that hangs on another one: in metres and kilograms, and with thousandths
// of both. Forces are a millionth; the rotor's angle, in radians, has no part in it.
TEST_CASE("peaks of mechanisms of millimetres are those of metres, with a rotor too") {
  const auto peak = [](double scale) {
    const auto in = [scale](double x, int power) { return testing::number(x * std::pow(scale, power)); };
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, "
        "{name = 'A', position = [" +
            in(0.8, 1) + ", 0, " + in(-0.3, 1) + "], mass = " + in(1.2, 1) + "}, {name = 'B', position = [" +
            in(1.3, 1) + ", 0, " + in(0.4, 1) + "], mass = " + in(0.7, 1) +
            "}]\nrods = [{nodes = ['O', 'A'], mass = " + in(0.9, 1) +
            "}, {nodes = ['A', 'B'], mass = " + in(0.4, 1) +
            "}]\n[[constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 1, 0]\n"
            "[[forces]]\nkind = 'motor'\nnodes = ['O', 'A', 'B']\naxis = [0, 1, 0]\nstall_torque = " +
            in(0.2, 3) + "\nno_load_speed = 300\ngear_ratio = 17\ninertia = " + in(1.5e-4, 3) +
            "\n[gravity]\nacceleration = [0, 0, " + in(-9.81, 1) +
            "]\n[solver]\nstages = 2\nstep = 0.05\nend_time = 1.5\n",
        "arms.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    return peak_rod_force(run, diagnose(run));
  };
  const auto metres = peak(1), millimetres = peak(1e-3);
  // As near as peaks are looked for: the motions themselves agree to rounding.
  CHECK(millimetres.force_N == Approx(1e-6 * metres.force_N).epsilon(1e-9));
  CHECK(millimetres.t == Approx(metres.t).epsilon(1e-6));
}

// Extremes that were found stay known; what was given up is found when it is asked for again.
TEST_CASE("looking for extremes within steps ends when it is told to and leaves nothing wrong behind") {
  const Simulation run = run_of("pendulum", {"solver.end_time=1"});
  const Diagnostics d = diagnose(run);
  const double top = largest_of_column(run, d, "kinetic_energy_J");
  const RememberedExtremes once;
  {
    const LooksUntil end([] { return true; });
    CHECK_THROWS_AS(largest_of_column(run, d, "kinetic_energy_J"), LookedEnough);
  }
  CHECK(largest_of_column(run, d, "kinetic_energy_J") == top);
  const LooksUntil end([] { return true; });
  CHECK(largest_of_column(run, d, "kinetic_energy_J") == top);
}

}  // namespace long_step_peaks_test
