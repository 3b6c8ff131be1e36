// SPDX-License-Identifier: BSD-3-Clause
// Forces that grow without bound towards a singular pose on the way have no peak, and a run says so.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/library.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace unbounded_peak_test {

namespace {

bool warns(const Simulation& run, const Diagnostics& d) {
  return std::ranges::any_of(accuracy_warnings(run, d), [](const std::string& w) {
    return w.find("grows without bound towards a singular pose beside t = ") != std::string::npos;
  });
}

Simulation with_poses(Simulation run) {
  record_singular_poses(run);
  return run;
}

// Two scissors in a row, pulled towards the bundle, in which all of their bars lie on each other.
const std::string scissors = R"toml(
variables = {L = 0.5, th = 0.5}
structure.kind = "custom"
structure.youngs_modulus = 2e11
structure.nodes = [{name = "A0", position = [0,0,0], fixed = true},
  {name = "B0", position = [0,0,"=2*L*cos(th)"]},
  {repeat = {i = "0:2"}, name = "M{i}", position = ["=(2*i+1)*L*sin(th)",0,"=L*cos(th)"]},
  {repeat = {i = "1:3"}, name = "A{i}", position = ["=2*i*L*sin(th)",0,0]},
  {repeat = {i = "1:3"}, name = "B{i}", position = ["=2*i*L*sin(th)",0,"=2*L*cos(th)"]}]
structure.rods = [{repeat = {i = "0:2"}, nodes = ["A{i}","M{i}"], mass = 0.2, area = 1.3e-5},
  {repeat = {i = "0:2"}, nodes = ["M{i}","B{i+1}"], mass = 0.2, area = 1.3e-5},
  {repeat = {i = "0:2"}, nodes = ["B{i}","M{i}"], mass = 0.2, area = 1.3e-5},
  {repeat = {i = "0:2"}, nodes = ["M{i}","A{i+1}"], mass = 0.2, area = 1.3e-5}]
constraints = [{kind = "plane", nodes = ["*"], normal = [0,1,0]},
  {repeat = {i = "0:2"}, kind = "collinear", nodes = ["A{i}","B{i+1}","M{i}"]},
  {repeat = {i = "0:2"}, kind = "collinear", nodes = ["B{i}","A{i+1}","M{i}"]},
  {kind = "line", nodes = ["B0"], direction = [0,0,1]}]
loads = [{nodes = ["A2"], force = [-4,0,0]}]
solver = {stages = 6, end_time = 0.7}
)toml";

}  // namespace

// Beside the poses in which the windows of the ladder are in line its rods bear c / |t - t*|, with the same c
// whatever the steps: 0.10 to 0.12 N s on both sides, of states up to 0.3 ms from them.
TEST_CASE("the peak of a force that has no bound is not unique, and a run says so") {
  for (const double step : {0.02, 0.01, 0.005, 0.0025, 0.0017, 0.001}) {
    INFO(step);
    const Scene scene = read_scene_file(find_scene("ladder"), {"solver.step=" + std::to_string(step)});
    const Simulation run = with_poses(simulate(build_model(scene), scene.solver));
    const Diagnostics d = diagnose(run);
    const PeakForce peak = peak_rod_force(run, d);
    CHECK_FALSE(peak.unique);
    CHECK(warns(run, d));
    double nearest = 1;
    for (const Event& e : run.events)
      if (e.kind == "singular_pose") nearest = std::min(nearest, std::abs(e.t - peak.t));
    CHECK(std::abs(peak.force_N) * nearest > 0.08);  // what other poses add, 25 N and less, at 1 ms
    CHECK(std::abs(peak.force_N) * nearest < 0.15);
  }
}

// By numbers of its own for the multipliers: 1.5 N over the angle to the bundle.
TEST_CASE("a bundle of scissors is passed with a force that has no bound, full and along the path") {
  for (const bool path : {false, true})
    for (const double step : {0.05, 0.01, 0.002}) {
      INFO(path << " " << step);
      const Scene scene = read_scene_text(scissors, "s.toml", {"solver.step=" + std::to_string(step)});
      const auto model = build_model(scene);
      const Simulation run =
          with_poses(path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver));
      const Diagnostics d = diagnose(run);
      const PeakForce peak = peak_rod_force(run, d);
      const WorstRod stress = worst_rod(run, d, axial_stress);
      CHECK_FALSE(peak.unique);
      CHECK_FALSE(stress.unique);
      CHECK(stress.value == Approx(peak.force_N / 1.3e-5).epsilon(1e-12));
      CHECK(warns(run, d));
    }
}

TEST_CASE("the comparison of models says of a force that has no bound that it is not unique") {
  const auto models =
      compare_models({"s.toml", {"solver.step=0.05"}, std::make_shared<const std::string>(scissors)}, 1, {});
  std::size_t rigid = 0;
  for (const MeasuredModel& m : models)
    if (m.choice.name == "as the scene says" || m.choice.name.starts_with("path:")) {
      INFO(m.choice.name);
      ++rigid;
      CHECK(m.peak_force > 0);
      CHECK_FALSE(m.peak_unique);
    }
  CHECK(rigid == 2);
}

// A load towards the bundle takes the mast through it; what its tip weighs has nothing to do with that.
TEST_CASE(
    "a mast that is pulled through its bundle is told of whatever its tip weighs and how long it runs") {
  for (const char* mass : {"0", "1.5", "6"})
    for (const char* end : {"3", "8"}) {
      INFO(mass << " kg, " << end << " s");
      const Scene scene = read_scene_file(
          find_scene("scissor_mast"), {"structure.tip_force=-10", std::string("structure.tip_mass=") + mass,
                                       std::string("solver.end_time=") + end});
      const Simulation run = with_poses(simulate(build_model(scene), scene.solver));
      const Diagnostics d = diagnose(run);
      const bool passed =
          std::ranges::any_of(run.events, [](const Event& e) { return e.kind == "singular_pose"; });
      CHECK(passed);
      CHECK_FALSE(peak_rod_force(run, d).unique);
      CHECK(warns(run, d));
    }
}

// Smooth peaks, and those of steps that are too long for them, a corner of a drive's force and a blow.
TEST_CASE("a peak that has a bound is as unique as it was") {
  for (const char* name :
       {"pendulum", "four_bar", "double_pendulum", "hoberman", "hoop6_sector", "scissor_mast"})
    for (const char* step : {"solver.step=0.01", "solver.step=0.05"}) {
      INFO(name << " " << step);
      const Scene scene = read_scene_file(find_scene(name), {step});
      const Simulation run = with_poses(simulate(build_model(scene), scene.solver));
      const Diagnostics d = diagnose(run);
      CHECK(peak_rod_force(run, d).unique == peak_rod_force(d).unique);
      CHECK_FALSE(warns(run, d));
      CHECK(extreme_of_column(run, d, "axial_force_max_N", true).bounded);
      CHECK(extreme_of_column(run, d, "axial_force_min_N", false).bounded);
    }
}

// 1.5 kg that a damper stops: the rod between 1 kg and the damper bears c v 1.25 / 1.5, most at the start.
TEST_CASE("what dies away within a step is as large as at its start") {
  for (const double damping : {90.0, 225.0, 300.0, 450.0})
    for (const double step : {0.05, 0.01}) {
      INFO(damping << " " << step);
      const Simulation run = with_poses(testing::run_scene(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'G', position = [2, 0, 0], fixed = true}, "
          "{name = 'A', position = [0, 0, 0], velocity = [1, 0, 0], mass = 1}, "
          "{name = 'B', position = [1, 0, 0], velocity = [1, 0, 0]}]\n"
          "rods = [{nodes = ['A', 'B'], mass = 0.5}]\n[[constraints]]\nkind = 'line'\nnodes = ['A', "
          "'B']\ndirection = [1, 0, 0]\n[[forces]]\nkind = 'spring'\nnodes = ['G', 'B']\ndamping = " +
          std::to_string(damping) +
          "\n[solver]\nstages = 6\nend_time = 0.5\nstep = " + std::to_string(step)));
      const PeakForce peak = peak_rod_force(run, diagnose(run));
      CHECK(std::abs(peak.force_N) == Approx(damping * 1.25 / 1.5).epsilon(1e-12));
      CHECK(peak.t == 0.0);
      CHECK(peak.unique);
    }
}

// A parallel crank of 1 m that is driven once a second, through its flat pose twice a turn. Nothing pulls
// along the coupler in any pose: a third of the cranks' and half of the coupler's mass at either pin turn
// alike, so that each crank bears 5/6 kg w^2 r. Round-off of the coupler's zero grows towards the pose.
TEST_CASE("a force that is none does not grow without bound") {
  const auto driven = [](double start, double step) {
    return testing::run_scene("[variables]\ne = " + std::to_string(start) + "\n" + R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = ["=cos(e)", 0, "=sin(e)"]},
         {name = "C", position = ["=2+cos(e)", 0, "=sin(e)"]}, {name = "D", position = [2, 0, 0], fixed = true},
         {name = "K", position = [0, 0, -1], fixed = true}]
rods = [{name = "AB", nodes = ["A", "B"], mass = 1}, {name = "BC", nodes = ["B", "C"], mass = 1},
        {name = "CD", nodes = ["C", "D"], mass = 1}]
constraints = [{kind = "plane", nodes = ["B", "C"], normal = [0, 1, 0]},
               {kind = "angle", nodes = ["K", "A", "B"], axis = [0, 1, 0], motion = "rate", rate = 360}]
[solver]
stages = 4
end_time = 4
step = )toml" + std::to_string(step) +
                              "\n");
  };
  const double crank = (1.0 / 3 + 0.5) * 4 * pi * pi;
  for (const double step : {0.1, 0.0625, 0.01}) {
    INFO(step);
    const Simulation run = with_poses(driven(0.3, step));
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    CHECK(d.at("axial_force_max_N").values.back() == Approx(crank).epsilon(1e-6));
    CHECK_FALSE(warns(run, d));
  }
  // 1e-3 rad from it once a turn, at every eighth state: round-off over the third power of that is 1e-7,
  // which the states between tell from what the coupler bears.
  const Simulation run = driven(1e-3, 0.125);
  const Diagnostics d = diagnose(run);
  for (const Index turn : {8, 16, 24}) {
    INFO(turn);
    CHECK(std::abs(d.axial_force(turn, 1)) < 1e-6 * crank);
    CHECK(d.force_unique(turn, 1));
  }
}

// A parallel crank of three rods of 1 kg and 1 m swings up to th = asin(4 / 2.4 g) and falls through its flat
// pose, in which all of them are in line: th'^2 = 4 - 2.4 g sin(th), a crank bears 5/6 th'^2 - g sin(th), so
// 10/3 - 3 g sin(th): least at the top, -5/3 N, and the coupler nothing but round-off, which grows towards
// the flat pose.
TEST_CASE("the least force of a motion is unique where only round-off grows without bound") {
  const Simulation run = with_poses(testing::run_scene(R"toml([structure]
kind = "custom"
nodes = [{name = "A0", position = [0, 0, 0], fixed = true}, {name = "A1", position = [1, 0, 0], fixed = true},
         {name = "B0", position = [1, 0, 0], velocity = [0, 2, 0]},
         {name = "B1", position = [2, 0, 0], velocity = [0, 2, 0]}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1}]
constraints = [{kind = "plane", nodes = ["B*"], normal = [0, 0, 1]}]
[gravity]
acceleration = [0, -9.81, 0]
[solver]
step = 0.005
stages = 6
end_time = 1
)toml"));
  const Diagnostics d = diagnose(run);
  CHECK_FALSE(warns(run, d));
  const PeakForce least = peak_rod_force(run, d, Pull::compression);
  CHECK(std::abs(least.force_N) == Approx(5.0 / 3).epsilon(1e-7));  // of its time within a step, squared
  CHECK(least.unique);
  CHECK(least.t == Approx(0.171224).margin(1e-4));  // half of the time until it is flat again, 0.342449 s
}

// A parallelogram of uniform rods, of which one leg is a ten-thousandth heavier, falls from 63 degrees
// through its flat pose: the legs differ there by c / |t - t*|, which no state shows beside what they bear at
// the start.
TEST_CASE("a force without bound is told where it grows, not where another is largest") {
  const Simulation run = with_poses(testing::run_scene(R"toml([structure]
kind = "custom"
nodes = [{name = "A0", position = [0, 0, 0], fixed = true}, {name = "B0", position = ["=cos(63*deg)", 0, "=sin(63*deg)"]},
         {name = "A1", position = [0.7, 0, 0], fixed = true}, {name = "B1", position = ["=0.7+cos(63*deg)", 0, "=sin(63*deg)"]}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1.0001}, {nodes = ["B0", "B1"], mass = 1}]
constraints = [{kind = "plane", nodes = ["B*"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 1
stages = 4
)toml"));
  const auto pose = std::ranges::find(run.events, "singular_pose", &Event::kind);
  REQUIRE(pose != run.events.end());
  const Rise rise = rise_on_the_way(run, diagnose(run));
  CHECK(rise.text.find("the force of rod ") == 0);
  CHECK(rise.t == Approx(pose->t).margin(run.options.step));
}

}  // namespace unbounded_peak_test
