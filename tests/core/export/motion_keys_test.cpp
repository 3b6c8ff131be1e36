// SPDX-License-Identifier: BSD-3-Clause
// Between the keys of files that others play, straight lines are the motion.
#include "core/export/motion_keys.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace motion_keys_test {

namespace {

// A rod of 1 m that turns about its end, as evenly as it began.
std::string spun(double turns_per_s, double end, double step) {
  return "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'A'\nposition = [1, 0, 0]\nvelocity = [0, 0, " +
         std::to_string(2 * M_PI * turns_per_s) +
         "]\n[[structure.rods]]\nname = 'OA'\nnodes = ['O', 'A']\nmass = 1\n"
         "[solver]\nstep = " +
         std::to_string(step) + "\nend_time = " + std::to_string(end) + "\n";
}

// The farthest that lines between keys are from where A is, and the shortest that the rod is drawn [m].
struct Drawn {
  double off = 0, shortest = 1;
};

Drawn drawn(const MotionKeys& keys, const Trajectory& run) {
  Drawn worst;
  for (std::size_t k = 0; k + 1 < keys.times.size(); ++k)
    for (const double u : {0.1, 0.25, 0.5, 0.7, 0.95}) {
      const double t = (1 - u) * keys.times[k] + u * keys.times[k + 1];
      const Vec3 line = ((1 - u) * keys.poses[k] + u * keys.poses[k + 1]).segment<3>(3);
      worst.off = std::max(worst.off, (line - run.positions_at(t).segment<3>(3)).norm());
      worst.shortest = std::min(worst.shortest, line.norm());
    }
  return worst;
}

}  // namespace

TEST_CASE("fast motion has keys as close as straight lines between them need") {
  // Of 1 m, a thousandth; up to a tenth more between the places that are looked at. 120 turns a second are
  // four from frame to frame: every frame of the film, its middle and its quarters show the same pose.
  for (const double turns : {0.1, 20.0, 30.0, 60.0, 120.0}) {
    INFO(turns << " turns a second");
    const Simulation run = run_scene(spun(turns, 0.5, 0.05 / std::max(turns, 1.0)));
    const MotionKeys keys = motion_keys(run.trajectory, 1.0 / 30, 20000);
    const Drawn worst = drawn(keys, run.trajectory);
    CHECK(worst.off < 1.1e-3);
    CHECK(worst.shortest > 0.998);
    CHECK(keys.times.front() == 0);
    CHECK(keys.times.back() == Approx(0.5));
    CHECK(std::ranges::is_sorted(keys.times));
    CHECK(too_few_keys(keys, "viewer.html").empty());
    // A chord of an arc of angle a is off by 1 - cos(a / 2) = a^2 / 8: no more keys than four times as many.
    const double needed = 2 * M_PI * turns * 0.5 / std::sqrt(8e-3);
    CHECK(static_cast<double>(keys.times.size()) < 4 * needed + 202);
  }
}

TEST_CASE("a run much shorter than a frame of the film has keys, too") {
  const Simulation run = run_scene(spun(1, 1e-3, 1e-6));
  CHECK(motion_keys(run.trajectory, 1.0 / 30, 20000).times.size() == 201);  // of 1001 states
  const Simulation few = run_scene(spun(1, 1e-3, 2.5e-4));
  CHECK(motion_keys(few.trajectory, 1.0 / 30, 20000).times.size() == 5);  // of as many states, hardly curved
}

TEST_CASE("where keys must not be as many as they should, a warning says what that costs") {
  const Simulation run = run_scene(spun(20, 1, 0.0025));
  const MotionKeys keys = motion_keys(run.trajectory, 1.0 / 30, 100);
  CHECK(keys.times.size() == 100);
  const std::string warning = too_few_keys(keys, "animation.glb");
  CHECK(warning.starts_with("animation.glb has 100 poses, too few for this motion: "));
  // A fifth of a turn between two keys: off by 1 - cos(pi / 5) = 0.19 m where they are even.
  CHECK(keys.off > 100);
}

TEST_CASE("what rests has its start and its end") {
  const Simulation run = run_scene(spun(0, 1, 0.5));
  const MotionKeys keys = motion_keys(run.trajectory, 0.25, 20000);
  CHECK(keys.times.size() == 5);
  CHECK(keys.off == 0);
}

TEST_CASE("keys are at different times in single precision wherever the run ends") {
  // glTF asks for it. A multiple of the frames' interval, and what rounding or somebody's last digit adds.
  for (const double more : {0.0, 1e-15, 1e-12, 3e-10, 1e-8, 1e-7, 1e-6, 1e-5, -1e-9})
    for (const double frames : {1.0, 15.0, 120.0}) {
      const std::string end = "solver.end_time=" + number(frames / 30 * (1 + more));
      INFO(end);
      const Simulation run = run_scene(spun(0, 1, 0.01), {end});
      const MotionKeys keys = motion_keys(run.trajectory, 1.0 / 30, 20000);
      CHECK(keys.times.back() == run.trajectory.end_time());
      for (std::size_t k = 1; k < keys.times.size(); ++k) {
        CHECK(static_cast<float>(keys.times[k - 1]) < static_cast<float>(keys.times[k]));
        CHECK(keys.times[k] - keys.times[k - 1] < 1.001 / 30);
      }
    }
}

TEST_CASE("keys are added at the states at which values leave straight lines and at no others") {
  const Simulation run = run_scene(spun(0, 1, 0.001));
  const MotionKeys of_motion = motion_keys(run.trajectory, 0.25, 20000);
  // A peak of one state, a ramp that is a straight line, a step of 3 per cent, and what is not known.
  MatrixXd values = MatrixXd::Zero(static_cast<Index>(run.trajectory.size()), 4);
  values(437, 0) = 100;
  for (Index i = 0; i < values.rows(); ++i)
    values(i, 1) = 50 * run.trajectory.time(static_cast<std::size_t>(i));
  values.col(2).tail(300).setConstant(3);
  values.col(3).tail(200).setConstant(std::nan(""));
  MotionKeys keys = of_motion;
  CHECK(add_value_keys(run.trajectory, values, 2, 20000, keys) < 2);
  // Three of the peak, two of the step, but where a key of the motion is there already.
  CHECK(keys.times.size() > of_motion.times.size());
  CHECK(keys.times.size() <= of_motion.times.size() + 5);
  CHECK(keys.poses.size() == keys.times.size());
  for (std::size_t k = 0; k + 1 < keys.times.size(); ++k) {
    REQUIRE(keys.times[k] < keys.times[k + 1]);
    CHECK((keys.poses[k] - run.trajectory.positions_at(keys.times[k])).norm() == 0);
  }
  const auto key = std::ranges::find(keys.times, run.trajectory.time(437));
  REQUIRE(key != keys.times.end());
  CHECK(values_at(run.trajectory, values, *key)[0] == 100);
  // Half a step before it, by a straight line; where it is not known it is what is known next to it.
  CHECK(values_at(run.trajectory, values, *key - 0.0005)[0] == Approx(50));
  CHECK(values_at(run.trajectory, values, run.trajectory.time(800) + 0.0005)[3] == 0);
  CHECK(std::isnan(values_at(run.trajectory, values, 0.95)[3]));
  MotionKeys few = of_motion;
  CHECK(add_value_keys(run.trajectory, values, 2, of_motion.times.size() + 1, few) > 50);
  CHECK(few.times.size() == of_motion.times.size() + 1);
}

// From 0.5 s on a ramp that bends once more, at a state: straight lines need a key there and no other.
TEST_CASE("values that bend late in a run have one key more") {
  const Simulation run = run_scene(spun(0, 1, 0.001));
  const MotionKeys of_motion = motion_keys(run.trajectory, 0.25, 20000);
  const double bend = run.trajectory.time(733);
  MatrixXd values(static_cast<Index>(run.trajectory.size()), 1);
  for (Index i = 0; i < values.rows(); ++i) {
    const double t = run.trajectory.time(static_cast<std::size_t>(i));
    values(i, 0) = 400 - 170 * t + 90000 * std::max(0.0, t - bend);
  }
  MotionKeys keys = of_motion;
  CHECK(add_value_keys(run.trajectory, values, 2, 20000, keys) < 2);
  const bool there = std::ranges::find(of_motion.times, bend) != of_motion.times.end();
  CHECK(keys.times.size() == of_motion.times.size() + (there ? 0 : 1));
  CHECK(std::ranges::find(keys.times, bend) != keys.times.end());
}

// In flight: g (dt)^2 / 8 is what a straight line is off by in the middle, a thousandth of its way at
// most.
TEST_CASE("one node that flies has keys that tell its way") {
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0.3, 0.1, 2], velocity = [1.3, 0, 4], "
      "mass "
      "= 1}]\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nstep = 0.2\nend_time = 1.2\n");
  REQUIRE(run.status == RunStatus::completed);
  const MotionKeys keys = motion_keys(run.trajectory, 0.5, 20000);
  CHECK(keys.off <= 1);
  const double top = 0.5 * 16 / 9.81, end = 4 * 1.2 - 0.5 * 9.81 * 1.44,
               way = std::hypot(1.3 * 1.2, top - end);
  for (std::size_t k = 1; k < keys.times.size(); ++k) {
    const double dt = keys.times[k] - keys.times[k - 1];
    CHECK(9.81 * dt * dt / 8 < 1e-3 * way);
  }
}

}  // namespace motion_keys_test
