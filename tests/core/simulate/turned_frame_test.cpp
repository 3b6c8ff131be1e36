// SPDX-License-Identifier: BSD-3-Clause
// Structures that turn in space, or whose parts are not deployed together: what is said of it.
#include "core/simulate/turned_frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "core/scene/library.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace turned_frame_test {

namespace {

Simulation run_library(const char* scene, const std::vector<std::string>& changes) {
  const Scene s = read_scene_file(find_scene(scene), changes);
  return simulate(build_model(s), s.solver);
}

long told(const std::vector<std::string>& warnings, const char* what) {
  return std::ranges::count_if(warnings,
                               [&](const std::string& w) { return w.find(what) != std::string::npos; });
}

const std::vector<std::string> ring_of_joints = {"structure.model=joints", "solver.step=0.02",
                                                 "solver.end_time=1.5"};

}  // namespace

// A ring turned by x as a whole: A = R(x) S with S symmetric, from a bundle 20 times as high as wide.
TEST_CASE("a turn of the whole is seen from a degree on, deploying is not") {
  const Scene scene = read_scene_file(find_scene("hoop6"), ring_of_joints);
  const auto model = build_model(scene);
  const Simulation run = simulate(model, scene.solver);
  const State& unfolded = run.trajectory.state(run.trajectory.size() - 1);
  const auto seen = [&](const Vec3& axis, double degrees) {
    State state = unfolded;
    VectorXd q(model->system.coordinates());
    model->system.expand(state.z, q);
    const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, axis);
    for (Index k = 0; k < q.size(); k += 3) q.segment<3>(k) = turn * Vec3(q.segment<3>(k)) + Vec3(5, -3, 2);
    state.z = model->system.reduce(q);
    return !TurnedFrame(model->structure).at(model->system, state).empty();
  };
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.6, 0.0, 0.8)}) {
    CHECK_FALSE(seen(axis, 0.0));
    CHECK_FALSE(seen(axis, 0.1));
    for (const double x : {2.0, -3.0, 45.0, 120.0}) {
      INFO(axis.transpose() << " by " << x);
      CHECK(seen(axis, x));
    }
  }
}

TEST_CASE("the error of a surface is about the axis of the start, too") {
  const auto said = [](const char* scene) {
    const auto model = build_model(read_scene_file(find_scene(scene), {"structure.fold_angle=60"}));
    VectorXd q = node_positions(model->structure);
    for (Index k = 0; k < q.size(); k += 3)
      q.segment<3>(k) = Eigen::AngleAxisd(0.05, Vec3::UnitX()) * Vec3(q.segment<3>(k));
    State state;
    state.z = model->system.reduce(q);
    return TurnedFrame(model->structure).at(model->system, state);
  };
  CHECK(said("mesh_reflector").ends_with("counts as deployed, and surface_rms_m"));
  CHECK(said("cable_ring").ends_with("counts as deployed"));
}

TEST_CASE("a floating ring that its loads turn says that its fold angle is off, once") {
  auto spun = ring_of_joints;
  for (int k = 0; k < 6; ++k)  // along the hoop at every corner
    spun.push_back("loads[" + std::to_string(k) + "]={nodes=[\"B" + std::to_string(k) + "\"], force=[" +
                   std::to_string(-200 * std::sin(k * std::numbers::pi / 3)) + ", " +
                   std::to_string(200 * std::cos(k * std::numbers::pi / 3)) + ", 0]}");
  CHECK(told(run_library("hoop6", spun).warnings, "turns in space") == 1);
  // A support that leaves the spin free says nothing against it: a plane across the axis, or a node on it.
  auto on_plane = spun, on_foot = spun;
  on_plane.push_back("constraints[0]={kind=\"plane\", nodes=[\"B0\"], normal=[0, 0, 1]}");
  on_foot.push_back("constraints[0]={kind=\"fixed\", nodes=[\"B0\"]}");
  CHECK(told(run_library("hoop6", on_plane).warnings, "turns in space") == 1);
  CHECK(told(run_library("hoop6", on_foot).warnings, "turns in space") == 1);
  CHECK(told(run_library("hoop6", ring_of_joints).warnings, "turns in space") == 0);
  for (const char* scene : {"hoop_arc", "hoberman", "scissor_ring", "bricard", "cable_ring"}) {
    INFO(scene);
    CHECK(told(run_library(scene, {}).warnings, "turns in space") == 0);
  }
}

// What a motor's rotor has turned by is no place in space. An open ring that its fold angle's motor drives
// deploys evenly beside the origin, where the rotor's number would stand.
TEST_CASE("a rotor that turns is no turn of the structure") {
  const std::string arc = R"(
[structure]
kind = "hoop"
units = 6
model = "joints"
closed = false
fold_angle = 80
hinge_force = 0
chord_rod_length = 0.15
post_length = 0.06
section_area = 1e-5
[[forces]]
kind = "motor"
fold_angle = true
stall_torque = 0.02
no_load_speed = 20000
gear_ratio = 2000
inertia = 1e-8
[solver]
end_time = 0.5
step = 0.01
)";
  const Simulation run = testing::run_scene(arc);
  // It turns by nothing: what A would have of a turn is rounding.
  const Index n = space_coordinates(run.trajectory.structure());
  const auto about_centre = [n](const VectorXd& q) {
    Eigen::Matrix3Xd x = Eigen::Map<const Eigen::Matrix3Xd>(q.data(), 3, n / 3);
    x.colwise() -= Vec3(x.rowwise().mean());
    return x;
  };
  const Eigen::Matrix3d A =
      about_centre(testing::end_positions(run)) * about_centre(run.trajectory.node_positions(0)).transpose();
  REQUIRE((A - A.transpose()).norm() < 1e-9 * A.norm());
  CHECK(told(run.warnings, "turns in space") == 0);
}

TEST_CASE("an arc whose units unfold unlike each other is deployed on the mean alone, and no latch closes") {
  const std::vector<std::string> uneven = {"structure.perturbed_force=100", "solver.end_time=1.6"};
  const Simulation stopped = run_library("hoop_arc", uneven);
  REQUIRE(stopped.status == RunStatus::deployed);
  CHECK(told(stopped.warnings, "deployed on the mean alone") == 1);
  // The heights of the hinges in their chords: their sum is zero, they are not.
  const VectorXd q = stopped.trajectory.node_positions(stopped.trajectory.size() - 1);
  double sum = 0, largest = 0;
  for (const LinearForm& part : stopped.trajectory.structure().deployment.parts) {
    const bool top = part.nodes.front() % 2 == 1;
    sum += (top ? -1 : 1) * part(q);
    largest = std::max(largest, std::abs(part(q)));
  }
  CHECK(std::abs(sum) <= 1e-9);
  CHECK(largest > 0.1);
  auto latched = uneven;
  latched.push_back("solver.at_deployed=latch");
  const Simulation refused = run_library("hoop_arc", latched);
  CHECK(refused.status == RunStatus::failed);
  CHECK(refused.message.find("latches that close at once") != std::string::npos);
  const Simulation even = run_library("hoop6", {"structure.model=joints", "solver.at_deployed=latch"});
  CHECK(even.status == RunStatus::completed);
  CHECK(told(even.warnings, "on the mean") == 0);
}

}  // namespace turned_frame_test
