// SPDX-License-Identifier: BSD-3-Clause
// A poster has as many poses as were asked for, equal steps of the way apart.
#include "render/scene/pose_times.hpp"

#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pose_times_test {

namespace {

// A stone that falls from rest, in three steps alone; its way is g t^2 / 2.
std::string stone(const std::string& gravity) {
  return "gravity.acceleration = [0, 0, " + gravity +
         "]\n[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nmass = 1\n"
         "[[structure.nodes]]\nname = 'O'\nposition = [5, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'P'\nposition = [6, 0, 0]\nfixed = true\n"
         "[[structure.rods]]\nnodes = ['O', 'P']\nmass = 1\n[solver]\nstep = 0.5\nend_time = 1.5\n";
}

}  // namespace

TEST_CASE("poses are as many as asked for, all at different times, and the end once") {
  const Simulation run = testing::run_scene(stone("-9.81"));
  REQUIRE(run.trajectory.size() == 4);
  for (const std::size_t count : {1U, 2U, 3U, 7U, 20U}) {
    const std::vector<double> times = pose_times(run.trajectory, count);
    REQUIRE(times.size() == count);
    CHECK(times.back() == 1.5);
    if (count > 1) CHECK(times.front() == 0.0);
    for (std::size_t k = 1; k < count; ++k) CHECK(times[k] > times[k - 1]);
  }
  // Half of the way to 1.5 s lies between the states at 1 and at 1.5 s, of 4/9 and all of it: a tenth of the
  // rest there, taken as even.
  CHECK(pose_times(run.trajectory, 3)[1] == Approx(1.05).epsilon(1e-9));
}

TEST_CASE("of what rests, poses are equal times apart") {
  const std::vector<double> times = pose_times(testing::run_scene(stone("0")).trajectory, 4);
  REQUIRE(times.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) CHECK(times[k] == Approx(0.5 * static_cast<double>(k)));
}

}  // namespace pose_times_test
