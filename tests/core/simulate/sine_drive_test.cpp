// SPDX-License-Identifier: BSD-3-Clause
// What moves as a sine: motions, their order, the work of drives, steps that follow it, and where it turns.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/integrators/integrator.hpp"
#include "core/path/path_run.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace sine_drive_test {

namespace {

using testing::end_positions, testing::error_of, testing::largest, testing::number, testing::run_scene;

// 2 kg on a spring of 50 N/m, 5 rad/s, from a support of 1 kg that is shaken by 0.1 m.
const std::string shaken = R"(
[structure]
kind = "custom"
nodes = [{name = "S", position = [0, 0, 0], mass = 1}, {name = "M", position = [1, 0, 0], mass = 2}]
constraints = [{kind = "line", nodes = ["S", "M"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate"
name = "shake"
nodes = ["S"]
direction = [1, 0, 0]
motion = "sine"
amplitude = 0.1
frequency = 1.5
[[forces]]
kind = "spring"
nodes = ["S", "M"]
stiffness = 50
[solver]
stages = 4
step = 0.01
end_time = 3
)";
constexpr double A = 0.1, own = 5;  // [m], [rad/s]

double support(double t, double w, double phase, double start) {
  return t < start ? 0.0 : A * (std::sin(w * (t - start) + phase) - std::sin(phase));
}

// u'' + own^2 u = own^2 (what the support does), from rest: the forced swing and the free one that makes up
// for where that begins.
double mass(double t, double w, double phase, double start) {
  if (t < start) return 0;
  const double s = t - start, C = A * own * own / (own * own - w * w), at_rest = A * std::sin(phase);
  const double u0 = C * std::sin(phase) - at_rest, v0 = C * w * std::cos(phase);
  return C * std::sin(w * s + phase) - at_rest - u0 * std::cos(own * s) - v0 / own * std::sin(own * s);
}

// The farthest that a run is from both at any of its states.
double off(const Simulation& run, double frequency, double phase, double start) {
  double most = 0;
  const double w = 2 * pi * frequency;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double t = run.trajectory.time(i);
    const VectorXd q = run.trajectory.node_positions(i);
    most = std::max(most, std::abs(q[3] - 1 - mass(t, w, phase, start)));
    // Prescribed, to what the phase is rounded by.
    CHECK(std::abs(q[0] - support(t, w, phase, start)) < 1e-15 * (1 + w * t));
  }
  return most;
}

bool says(const Simulation& run, const std::string& words) {
  return std::ranges::any_of(run.warnings, [&](const std::string& w) { return w.find(words) != w.npos; });
}

}  // namespace

// Twice the step, 2^order times the error: here 14 steps a wave are the fewest, and what follows the leading
// term is a hundredth of it. At round-off there is no order: 1e-15 of some 100 steps.
TEST_CASE("a mass on a spring from a shaken support moves as the closed form with the order of its stages") {
  for (const auto& [phase, start] : {std::pair{0.0, 0.0}, {90.0, 0.0}, {37.0, 0.25}, {-90.0, 0.5}})
    for (int stages = 2; stages <= 6; ++stages) {
      double error[2];
      for (const int k : {0, 1}) {
        const Simulation run = run_scene(
            shaken, {"constraints[shake].phase=" + number(phase), "constraints[shake].start=" + number(start),
                     "solver.stages=" + std::to_string(stages), "solver.step=" + number(k ? 0.025 : 0.05)});
        REQUIRE(run.status == RunStatus::completed);
        error[k] = off(run, 1.5, phase * pi / 180, start);
      }
      INFO(stages << " stages: " << error[0] << ", " << error[1]);
      if (error[0] > 1e-13) CHECK(std::log2(error[0] / error[1]) == Approx(2 * stages - 2).margin(0.1));
      CHECK(error[1] < (stages == 6 ? 1e-14 : 1.0));
    }
}

// A clamped cubic spline through a sine that begins and ends at rest is off by 5/384 of the spacing to the
// fourth power times the largest fourth derivative, A w^4; what swings on it by no more than resonance makes
// of that, some ten times as much.
TEST_CASE("a finely tabulated sine moves what a sine does") {
  const double f = 1.5, w = 2 * pi * f, end = 2;  // three whole waves
  const Simulation sine = run_scene(
      shaken, {"constraints[shake].phase=90", "solver.end_time=2", "solver.stages=6", "solver.step=0.005"});
  double last = 0;
  for (const int points : {200, 400}) {
    std::string times = "[", values = "[";
    for (int i = 0; i <= points; ++i) {
      const double t = end * i / points;
      times += (i ? ", " : "") + number(t);
      values += (i ? ", " : "") + number(A * (std::cos(w * t) - 1));
    }
    const Simulation table = run_scene(
        shaken,
        {"constraints[shake].motion=table", "solver.end_time=2", "constraints[shake].times=" + times + "]",
         "constraints[shake].values=" + values + "]", "solver.stages=6", "solver.step=0.005"});
    const double apart = (end_positions(table) - end_positions(sine)).lpNorm<Eigen::Infinity>(),
                 spline = 5.0 / 384 * std::pow(end / points, 4) * A * std::pow(w, 4);
    CHECK(apart < 10 * spline);
    if (last > 0) CHECK(apart < last / 8);  // of order 4, but for what swings about zero
    last = apart;
  }
}

// One state a wave, or two, see no motion. What is prescribed is in the books all the same where steps follow
// it: 20 Hz in five steps a wave, whose 79 J go to and fro in the drive, by Gauss points in eighths of a
// wave.
TEST_CASE("steps that do not resolve a sine are warned of and others keep its books") {
  const std::string words = "does not resolve the sine of shake, 0.05 s a wave";
  for (const double step : {0.01, 0.05, 0.049, 0.025, 0.0126}) {
    const Simulation run = run_scene(
        shaken, {"constraints[shake].frequency=20", "solver.stages=3", "solver.step=" + number(step)});
    CHECK(says(run, words) == (step > 0.0125));  // a quarter
  }
  const Simulation run = run_scene(shaken, {"constraints[shake].frequency=20"});
  CHECK(off(run, 20, 0, 0) < 1e-7);
  CHECK(largest(diagnose(run), "energy_balance_J") < 1e-3);
  CHECK(!says(run_scene(shaken, {"constraints[shake].frequency=20", "constraints[shake].start=3"}), words));
  // With `turn` 0.1 some 63 steps a wave, each with an error of 1e-16.
  const Simulation adaptive =
      run_scene(shaken, {"constraints[shake].frequency=100", "solver.adaptive=true", "solver.step=0.01"});
  CHECK(!says(adaptive, "does not resolve"));
  CHECK(off(adaptive, 100, 0, 0) < 1e-12);
}

// By the closed form. With many stages the steps that are picked are longer than a wave, their states right.
TEST_CASE("a tolerance holds where steps are longer than a wave and what they do not show is said") {
  for (const double frequency : {1.5, 140 / 3.0, 100.0}) {  // of 3 s, as many waves as a grid has steps
    const Scene scene = read_scene_text(
        shaken, "s.toml", {"solver.tolerance=1e-6", "constraints[shake].frequency=" + number(frequency)});
    const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(off(run, frequency, 0, 0) < 1e-6);
    CHECK_FALSE(says(run, "motions and forces are not to be trusted"));
    CHECK(says(run, "what it does between states is not seen") == (run.options.step > 0.5 / frequency));
  }
}

TEST_CASE("the step that a warning asks for is not warned of") {
  for (const double frequency : {0.3, 7.0, 99.9, 1234.5}) {
    const auto with = [&](double step) {
      return run_scene(shaken, {"constraints[shake].frequency=" + number(frequency),
                                "solver.end_time=" + number(2 * step), "solver.step=" + number(step)});
    };
    const std::string phrase = "to follow it, solver.step = ";
    double asked = 0;
    for (const std::string& w : with(0.7 / frequency).warnings)
      if (const std::size_t at = w.find(phrase); at != w.npos)
        asked = std::stod(w.substr(at + phrase.size()));
    REQUIRE(asked > 0);
    CHECK(!says(with(asked), "the sine of"));
  }
}

// F = 3 N sin(2 pi 1.5 t) on a free mass of 2 kg from rest: x = F0 / (m w) (t - sin(w t) / w).
TEST_CASE("a load that goes as a sine moves a free mass as the closed form") {
  const std::string pushed = R"(
[structure]
kind = "custom"
nodes = [{name = "M", position = [0.2, 0, 0], mass = 2}]
[[forces]]
kind = "load_over_time"
nodes = ["M"]
force = [3, 0, 0]
frequency = 1.5
[solver]
stages = 5
step = 0.02
end_time = 3
)";
  const double w = 2 * pi * 1.5;
  for (const double start : {0.0, 0.333}) {
    const Simulation run = run_scene(pushed, {"forces[0].start=" + number(start)});
    const double t = 3 - start, x = 0.2 + 3 / (2 * w) * (t - std::sin(w * t) / w);
    CHECK(end_positions(run)[0] == Approx(x).epsilon(1e-11));
    CHECK(largest(diagnose(run), "energy_balance_J") < 1e-8);
  }
  CHECK(error_of(pushed, {"forces[0].times=[0, 1]", "forces[0].values=[0, 1]"}).find("in place of times") !=
        std::string::npos);
}

// 1 kg at the end of an arm of 0.5 m that rocks by 40 degrees: the torque is m r^2 th''.
TEST_CASE("a rocking arm takes the torque of its inertia") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "X", position = [1, 0, 0], fixed = true},
         {name = "A", position = [0.3, 0.4, 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]}]
[[constraints]]
kind = "angle"
name = "motor"
nodes = ["X", "O", "A"]
axis = [0, 0, 1]
motion = "sine"
amplitude = 40
frequency = 2
phase = 25
ramp = 0.3
[solver]
stages = 5
end_time = 2
)");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const double w = 4 * pi, a = 40 * pi / 180, phase = 25 * pi / 180;
  for (std::size_t i = 0; i < d.t.size(); ++i)
    if (d.t[i] > 0.3) {
      CHECK(
          d.at("motor.angle_rad").values[i] ==
          Approx(std::atan2(0.4, 0.3) + a * (std::sin(w * d.t[i] + phase) - std::sin(phase))).epsilon(1e-13));
      CHECK(d.at("motor.torque_N_m").values[i] ==
            Approx(-0.25 * a * w * w * std::sin(w * d.t[i] + phase)).epsilon(0).margin(1e-9));
    }
}

TEST_CASE("a sine that takes a length to nothing is refused however fast it goes") {
  const std::string drawn = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "M", position = [0.8, 0, 0], mass = 2}]
[[constraints]]
kind = "length"
name = "winch"
nodes = ["O", "M"]
motion = "sine"
amplitude = 0.7999999
frequency = 1
[solver]
end_time = 100
)";
  CHECK(error_of(drawn).empty());
  for (const double frequency : {0.01, 1.0, 40.0, 1e5}) {  // 40 Hz: once for each of 4000 times
    const std::string set = "constraints[winch].frequency=" + number(frequency);
    CHECK(error_of(drawn, {set, "constraints[winch].phase=-90"}).empty());  // begins at its shortest
    CHECK(error_of(drawn, {set, "constraints[winch].amplitude=0.8"}).find("must stay > 0") !=
          std::string::npos);
    CHECK(error_of(drawn, {set, "constraints[winch].ramp=300", "constraints[winch].amplitude=5"}).empty() ==
          (frequency < 0.1));  // grows to a fifth of it
  }
  // By a billionth of a metre, and as little short of it, between all times that divide a wave.
  const double utmost = 0.8 / (1 + std::sin(37.7 * pi / 180));
  for (const double over : {-1e-9, 1e-9})
    CHECK(error_of(drawn,
                   {"constraints[winch].phase=37.7", "constraints[winch].amplitude=" + number(utmost + over)})
              .empty() == (over < 0));
  CHECK(error_of(drawn, {"constraints[winch].frequency=0"}).find("must be > 0 Hz") != std::string::npos);
}

// 80 - A (1 - cos(w t)) degrees is 0 for the first time at acos(1 - 80 / A) / w, or for A = 40 in the turning
// point, half a wave after the start.
TEST_CASE("a ring that a sine folds is deployed when its drive says so") {
  const std::string ring = R"(
[structure]
kind = "hoop"
fold_angle = 80
[[constraints]]
kind = "angle"
name = "motor"
fold_angle = true
motion = "sine"
amplitude = -50
frequency = 0.25
phase = -90
[solver]
end_time = 3
)";
  for (const bool on_path : {false, true})
    for (const double amplitude : {50.0, 40.0}) {
      const Scene scene =
          read_scene_text(ring, "s.toml", {"constraints[motor].amplitude=" + number(-amplitude)});
      const auto model = build_model(scene);
      const Simulation run = on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
      INFO((on_path ? "path " : "full ") << amplitude);
      REQUIRE(run.status == RunStatus::deployed);
      CHECK(run.trajectory.end_time() == Approx(std::acos(1 - 80 / amplitude) / (0.5 * pi)).epsilon(1e-9));
    }
}

// A slider of a crank, led to the dead centre, where it turns round. The crank of 0.3 m goes on through it:
// by then it turns at a rate that is not zero, and what is left of the slider's way is 0.15 (1 + 0.3) of the
// square of its angle.
TEST_CASE("a drive that turns round in a dead centre leads through it") {
  const std::string slider = R"scene(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = ["=0.3*cos(50*deg)", "=0.3*sin(50*deg)", 0]},
         {name = "S", position = ["=0.3*cos(50*deg)+sqrt(1-(0.3*sin(50*deg))^2)", 0, 0], mass = 2}]
rods = [{nodes = ["O", "A"], mass = 1}, {nodes = ["A", "S"], mass = 1}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]},
               {kind = "line", nodes = ["S"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate"
nodes = ["S"]
direction = [1, 0, 0]
motion = "sine"
amplitude = "=0.5*(1.3-(0.3*cos(50*deg)+sqrt(1-(0.3*sin(50*deg))^2)))"
phase = -90
frequency = 0.5
[solver]
stages = 4
end_time = 1.5
)scene";
  const Scene scene = read_scene_text(slider, "s.toml");
  const auto model = build_model(scene);
  const Simulation run = simulate(model, scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  // Where the slider is there, by the closed form, the crank is at the angle below the line.
  const double begin =
                   0.3 * std::cos(50 * pi / 180) + std::sqrt(1 - std::pow(0.3 * std::sin(50 * pi / 180), 2)),
               x = begin + 0.5 * (1.3 - begin);
  const double cosine = (x * x + 0.09 - 1) / (0.6 * x);
  const VectorXd q = end_positions(run);
  CHECK(q[6] == Approx(x).epsilon(1e-12));
  CHECK(q[3] == Approx(0.3 * cosine).epsilon(1e-9));
  CHECK(q[4] == Approx(-0.3 * std::sqrt(1 - cosine * cosine)).epsilon(1e-9));
  CHECK_THROWS_WITH(simulate_on_path(model, scene.solver), Catch::Contains("turns round in a dead centre"));
}

}  // namespace sine_drive_test
