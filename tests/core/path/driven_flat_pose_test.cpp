// SPDX-License-Identifier: BSD-3-Clause
// Drives that lead a linkage on its path into a flat pose, where its constraints lose rank: beyond it they
// rest, or go on.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/path/path_run.hpp"
#include "core/simulate/run_words.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace driven_flat_pose_test {

namespace {

// Two legs of 1 m and 1 kg under a coupler of 1 kg, which only shifts: with a torque T at the angle a
//
//     I a'' = T - 2 g cos a,     I = 1/3 + 1/3 + 1,
//
// through the flat pose and beyond.
const std::string parallelogram = R"toml(
[structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = ["=cos(60*deg)", 0, "=sin(60*deg)"]},
  {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)"]}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "angle"
name = "m"
nodes = ["X", "A0", "B0"]
axis = [0, -1, 0]
)toml";
const std::string deployment = R"toml([deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
)toml";
const std::string smooth = "motion = \"smooth\"\nto = 0\nduration = 0.5\n";
const std::string table = "motion = \"table\"\ntimes = [0, 0.5]\nvalues = [60, 0]\n";
const std::string through = "motion = \"table\"\ntimes = [0, 1]\nvalues = [60, -60]\n";

double from_angle() {
  return std::acos(0.5);
}

// Of the motion at t; a table's cubic has its own second rate at its end.
double true_torque(const std::string& motion, double t, bool behind) {
  const double a0 = from_angle(), T = motion == through ? 1.0 : 0.5, u = std::min(t / T, 1.0);
  double a = 0, second = 0;
  if (motion == smooth) {
    a = a0 * (1 - u * u * u * (10 + u * (-15 + 6 * u)));
    second = -a0 / (T * T) * 60 * u * (1 - u) * (1 - 2 * u);
  } else {
    const double fall = motion == through ? 2 * a0 : a0;
    a = a0 - fall * u * u * (3 - 2 * u);
    second = behind ? 0.0 : -fall / (T * T) * (6 - 12 * u);
  }
  return 5.0 / 3 * second + 2 * 9.81 * std::cos(a);
}

Simulation run_of(const std::string& motion, const std::string& deployed, const std::string& at_deployed) {
  const std::string end = "[solver]\nstep = 0.01\nend_time = 0.7\nat_deployed = \"" + at_deployed + "\"\n";
  const Scene scene = read_scene_text(parallelogram + motion + deployed + end, "s.toml", {});
  return simulate_on_path(build_model(scene), scene.solver);
}

}  // namespace

// Within 1e-9 of the torque: a law of motion with one coordinate, of series at rounding, 1e-13 of forces next
// to the pose. Of rods in the flat pose, whose forces go like one over the angle that is left, nothing is
// known, and that is told.
TEST_CASE("a drive's torque in a flat pose on its path is that of the motion") {
  for (const std::string& motion : {smooth, table, through})
    for (const std::string& deployed : {deployment, std::string()})
      for (const std::string at_deployed : {"stop", "pass"}) {
        if (deployed.empty() && (at_deployed == "stop" || motion == through)) continue;
        const Simulation run = run_of(motion, deployed, at_deployed);
        const Diagnostics d = diagnose(run);
        const std::vector<double>&torque = d.at("m.torque_N_m").values,
              &unique = d.at("m.torque_unique").values;
        CAPTURE(motion, deployed, at_deployed, run.message);
        int flat = 0;
        for (std::size_t i = 0; i < d.t.size(); ++i) {
          // A time before the table's end and that time: the last one is behind it.
          const bool behind = motion == table && (d.t[i] > 0.5 || (i > 0 && d.t[i] - d.t[i - 1] < 1e-9));
          CAPTURE(d.t[i], behind);
          CHECK(torque[i] == Approx(true_torque(motion, d.t[i], behind)).epsilon(0).margin(1e-7));
          CHECK(unique[i] == 1.0);
          const double height = run.trajectory.node_positions(i)[3 * 2 + 2];
          if (std::abs(height) > 1e-9) continue;
          ++flat;
          const auto row = static_cast<Index>(i);
          CHECK(d.axial_force.row(row).array().isNaN().all());
          CHECK_FALSE(d.force_unique.row(row).any());
        }
        CHECK(flat == (at_deployed == "stop" || motion == through ? 1 : motion == table ? 22 : 21));
        const std::vector<std::string> said = accuracy_warnings(run, d);
        CHECK(std::ranges::any_of(
            said, [](const std::string& one) { return one.find("without bound") != std::string::npos; }));
        // The drive's work is what the motion has of energy, as closely as quadrature between states has it.
        CHECK(std::abs(d.at("energy_balance_J").values.back()) < 1e-4);
      }
}

// At rest by virtual work: 2 g, and a load of up to 10 N at an arm of 1 m. A post beside it, of 2 kg, bears
// half of its weight in every pose: to rounding of forces of 1e5 N that the legs have next to the flat one.
TEST_CASE("beside legs at rest in a flat pose on the path a post and a growing load are known") {
  std::string scene = parallelogram + smooth + R"toml([[forces]]
kind = "load_over_time"
nodes = ["B1"]
force = [0, 0, -10]
times = [0, 0.55, 0.65]
values = [0, 0, 1]
[[constraints]]
kind = "plane"
nodes = ["T"]
normal = [0, 1, 0]
[[constraints]]
kind = "plane"
nodes = ["T"]
normal = [1, 0, 0]
[solver]
step = 0.01
end_time = 0.7
)toml";
  scene.insert(scene.find("{name = \"B1\""),
               R"({name = "S", position = [5, 0, 0], fixed = true}, {name = "T", position = [5, 0, 2]}, )");
  scene.insert(scene.find("{nodes = [\"A0\", \"B0\"]"), R"({nodes = ["S", "T"], mass = 2}, )");
  const Scene read = read_scene_text(scene, "s.toml", {});
  const Simulation run = simulate_on_path(build_model(read), read.solver);
  const Diagnostics d = diagnose(run);
  int rests = 0;
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    if (d.t[i] < 0.499) continue;
    const auto row = static_cast<Index>(i);
    CAPTURE(d.t[i]);
    const double load = 10 * std::clamp((d.t[i] - 0.55) / 0.1, 0.0, 1.0);
    CHECK(d.at("m.torque_N_m").values[i] == Approx(2 * 9.81 + load).epsilon(0).margin(1e-7));
    CHECK(d.axial_force(row, 0) == Approx(-9.81).epsilon(0).margin(1e-6));
    CHECK(d.force_unique(row, 0));
    CHECK(d.axial_force.row(row).tail(3).array().isNaN().all());
    ++rests;
  }
  CHECK(rests == 21);
}

}  // namespace driven_flat_pose_test
