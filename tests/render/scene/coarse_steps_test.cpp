// SPDX-License-Identifier: BSD-3-Clause
// What steps lead past between two states is in the picture, too: a rod that turns once a second keeps its
// speed, so a step of any length leads to its circle, and pictures of few states must be those of many.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/clearance.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "render/scene/camera_path.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/pose_times.hpp"
#include "render/scene/view.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace coarse_steps_test {

namespace {

const std::string turning = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0], mass = 1, velocity = [0, 0, 6.283185307179586]}]
rods = [{nodes = ["A", "B"], mass = 0.2}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[solver]
stages = 8
end_time = 1
)";

Simulation turned(const std::string& step, const std::string& model = "motion") {
  std::vector<std::string> changes{"solver.step=" + step};
  if (model != "motion") changes.push_back("solver.model=\"" + model + "\"");
  return testing::run_scene(turning, changes);
}

FrameBuilder pictures(const Simulation& run, bool follow = false) {
  FrameStyle style;
  style.width = 640, style.height = 360;
  style.trails = {1};
  style.options.camera = "front";
  style.options.follow = follow;
  return {run.trajectory, style};
}

// A pendulum that swings by 60 degrees to either side, so many times in so many steps along its path.
Simulation swinging(int swings, int steps) {
  const std::string bob = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true},
         {name = "B", position = [0.8660254037844386, 0, -0.5], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0}]
constraints = [{kind = "plane", nodes = ["B"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
)";
  const double period = 4 / std::sqrt(9.81) * std::comp_ellint_1(0.5);
  const std::vector<std::string> changes{"solver.end_time=" + testing::number(swings * period),
                                         "solver.step=" + testing::number(swings * period / steps)};
  const Scene scene = read_scene_text(bob, "s.toml", changes);
  return simulate_on_path(build_model(scene), scene.solver);
}

// How far the motion leaves the straight lines from moment to moment, at 50 times within each step [m].
double left_out(const Trajectory& run, const PosedMoments& moments) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < run.size(); ++i)
    for (int k = 1; k < 50; ++k) {
      const double t = run.time(i) + k / 50.0 * (run.time(i + 1) - run.time(i));
      const auto behind = std::ranges::upper_bound(moments.times, t) - moments.times.begin();
      const auto m = static_cast<std::size_t>(behind);
      const VectorXd pose = run.positions_at(t);
      for (Index n = 0; n < pose.size(); n += 3) {
        const Vec3 at = pose.segment<3>(n);
        worst = std::max(worst, segment_distance(at, at, moments.poses[m - 1].segment<3>(n),
                                                 moments.poses[m].segment<3>(n)));
      }
    }
  return worst;
}

}  // namespace

// Moments are off by a thousandth of the structure's size, here 1 m, and of them a trail leaves out what is
// off by a thousandth of the motion's: 2.5 mm with what lies at their ends.
TEST_CASE("the trail of a circle is a circle at any step") {
  const auto [step, model] =
      GENERATE(std::pair<std::string, std::string>{"0.25", "motion"}, std::pair{"0.5", "motion"},
               std::pair{"1", "motion"}, std::pair{"0.5", "path"}, std::pair{"1", "auto"});
  CAPTURE(step, model);
  const Simulation run = turned(step, model);
  REQUIRE(run.trajectory.size() < 6);
  const DrawList list = pictures(run).build(1);
  double way = 0;
  for (const Tube& line : list.ghosts)
    for (const float u : {0.0f, 0.5f, 1.0f}) {
      const Vec3f at = line.a + u * (line.b - line.a);
      CHECK(std::abs(at.norm() - 1) < 2.5e-3f);
      if (u == 1) way += static_cast<double>((line.b - line.a).norm());
    }
  CHECK(way == Approx(2 * pi).epsilon(2.5e-3));  // it is shorter than the circle by less than that
}

// A thousandth of the motion's size at either edge moves the camera by few thousandths of its distance. One
// that follows has room for up to a moment (here 1/64 s) more at both ends of its windows of 12/63 s, which
// then reach farther by an eighth of that way and less.
TEST_CASE("coarse steps have the camera and floor of fine ones") {
  const bool follow = GENERATE(false, true);
  const Simulation fine = turned("0.002");
  const FrameBuilder right = pictures(fine, follow);
  for (const std::string step : {"0.25", "0.5", "1"}) {
    CAPTURE(step, follow);
    const Simulation run = turned(step);
    const FrameBuilder frames = pictures(run, follow);
    for (const double t : {0.0, 0.17, 0.33, 0.67, 0.9, 1.0}) {
      const DrawList list = frames.build(t), wanted = right.build(t);
      CHECK((list.camera.eye - wanted.camera.eye).norm() <
            (follow ? 0.04f : 0.005f) * wanted.camera.eye.norm());
      CHECK(list.ground.z == Approx(wanted.ground.z).margin(3e-3));
      for (const Ball& ball : list.balls) {
        CHECK(ball.center.z() - ball.radius > list.ground.z);
        const Vec3f p = project(list.camera, 640, 360, ball.center);
        CHECK(std::min({p.x(), 640 - p.x(), p.y(), 360 - p.y()}) > 10);
      }
    }
  }
}

// A thousandth of the 2 m that the legs of a double pendulum span is allowed; 1.6 of it where a step bends
// both ways and neither of its ends nor its middle tells.
TEST_CASE("between posed moments the motion is straight") {
  const std::string pendulum = R"(
gravity.acceleration = [0, 0, -9.81]
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1},
         {name = "C", position = [2, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.2}, {nodes = ["B", "C"], mass = 0.2}]
[solver]
stages = 6
end_time = 3
)";
  const std::string step = GENERATE("0.2", "0.1", "0.05", "0.001");
  const Simulation run = testing::run_scene(pendulum, {"solver.step=" + step});
  const PosedMoments moments = posed_moments(run.trajectory);
  CAPTURE(step, moments.times.size());
  CHECK(std::ranges::is_sorted(moments.times));
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    CHECK(std::ranges::binary_search(moments.times, run.trajectory.time(i)));
  CHECK(left_out(run.trajectory, moments) < 1.6e-3 * 2);
  if (step == "0.001") CHECK(moments.times.size() == run.trajectory.size());
}

// At its turning points a pendulum rests: half a swing is an arc between two states without velocities, which
// look like a line, a whole one a place.
TEST_CASE("what swings from rest to rest within a step is seen") {
  const auto [swings, steps] = GENERATE(std::pair{2, 4}, std::pair{4, 4}, std::pair{4, 8});
  CAPTURE(swings, steps);
  const Simulation run = swinging(swings, steps);
  REQUIRE(run.trajectory.size() == static_cast<std::size_t>(steps) + 1);
  CHECK(left_out(run.trajectory, posed_moments(run.trajectory)) < 1.6e-3);
}

// Each frame shows an equal share of the arc; a thousandth of the film is for what rests, and between two
// moments, at most 10 degrees of 480 apart, time goes evenly.
TEST_CASE("an even pace is even within steps of whole swings") {
  const int steps = GENERATE(2, 4, 400);
  CAPTURE(steps);
  const Simulation run = swinging(2, steps);
  RenderOptions options;
  options.pace = "even";
  options.hold = 0;
  const std::vector<Shot> shots = film_shots(run.trajectory, options);
  std::vector<double> way{0};
  constexpr std::size_t fine = 2000;
  VectorXd last = run.trajectory.positions(0);
  for (std::size_t k = 1; k <= fine; ++k) {
    const VectorXd pose =
        run.trajectory.positions_at(run.trajectory.end_time() * static_cast<double>(k) / fine);
    way.push_back(way.back() + (pose - last).norm());
    last = pose;
  }
  CHECK(way.back() == Approx(8 * pi / 3).epsilon(1e-4));
  for (std::size_t k = 0; k < shots.size(); ++k) {
    const auto at = static_cast<std::size_t>(std::lround(shots[k].t / run.trajectory.end_time() * fine));
    CHECK(way[at] / way.back() ==
          Approx(static_cast<double>(k) / static_cast<double>(shots.size() - 1)).margin(0.01));
  }
}

TEST_CASE("moments between states are no more than a picture can wait for and none where all goes straight") {
  const Simulation spinning = testing::run_scene(turning, {"solver.step=0.25", "solver.end_time=500"});
  const std::size_t states = spinning.trajectory.size();
  const std::size_t posed = posed_moments(spinning.trajectory).times.size();
  CHECK(posed > states + 1000);
  CHECK(posed <= states + 2000);

  const Simulation falling = testing::run_scene(R"(
gravity.acceleration = [0, 0, -9.81]
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1}, {name = "B", position = [1, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.2}]
[solver]
step = 0.5
end_time = 2
)");
  CHECK(posed_moments(falling.trajectory).times.size() == falling.trajectory.size());

  const Simulation resting = testing::run_scene(turning, {"structure.nodes[1].velocity=[0,0,0]"});
  CHECK(posed_moments(resting.trajectory).times.size() == resting.trajectory.size());
}

}  // namespace coarse_steps_test
