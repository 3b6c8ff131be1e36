// SPDX-License-Identifier: BSD-3-Clause
// A rod that turns about its end by more than a turn, on its path: angles are counted on.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/path/path_run.hpp"
#include "core/path/path_time.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/structure/node_positions.hpp"
#include "core/study/table.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/runs_apart.hpp"

using namespace unfurl;

namespace path_turns_test {

namespace {

constexpr double length = 0.8, degrees = pi / 180;

// P at 40 degrees from OX about y, which tells angles upside down, turning with `rate`; X to the right of O.
Scene rod(const std::string& more, double rate, double end, double at = 40) {
  const double a = at * degrees;
  const auto three = [](double x, double z) {
    return "[" + exact_number(x) + ", 0, " + exact_number(z) + "]";
  };
  return read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'X', position = [1, 0, 0], fixed = true}, {name = 'O', "
      "position = [0, 0, 0], fixed = true}, {name = 'P', position = " +
          three(length * std::cos(a), -length * std::sin(a)) +
          ", velocity = " + three(-rate * length * std::sin(a), -rate * length * std::cos(a)) +
          "}]\nrods = [{nodes = ['O', 'P'], mass = 1.7}]\n[[structure.constraints]]\nkind = 'plane'\nnodes = "
          "['P']\nnormal = [0, 1, 0]\n[solver]\nstep = 0.02\nend_time = " +
          exact_number(end) + "\n" + more,
      "rod.toml", {});
}

double angle_at(const Simulation& run, double t) {  // in (-pi, pi]
  VectorXd q(9);
  const System& system = run.trajectory.model(run.trajectory.state_before(t)).system;
  system.expand(run.trajectory.state_at(t).z, q);
  return std::atan2(-q[8], q[6]);
}

double off_turns(double angle) {
  return std::abs(std::remainder(angle, 2 * pi));
}

}  // namespace

// Between stops at -310 and 475 degrees with e = 0.7: 435 degrees one way, 785 back, at 4 and 2.8 rad/s and
// so on; a stop at 600 is not met.
TEST_CASE("a rod bounces between stops that are turns apart where their angles say") {
  const double low = -310 * degrees, high = 475 * degrees, start = 40 * degrees, rate = 4, e = 0.7;
  const auto stop = [](const char* name, double min, double max) {
    return std::string("[[constraints]]\nkind = 'angle_stop'\nname = '") + name +
           "'\nnodes = ['X', 'O', 'P']\naxis = [0, 1, 0]\nrestitution = 0.7\n" +
           (min != 0 ? "min = " + exact_number(min) + "\n" : "") +
           (max != 0 ? "max = " + exact_number(max) + "\n" : "");
  };
  const double first = (high - start) / rate, second = first + (high - low) / (rate * e),
               third = second + (high - low) / (rate * e * e);
  for (const bool far_first : {false, true}) {
    const std::string near = stop("upper", 0, 475), lower = stop("lower", -310, 0), far = stop("far", 0, 600);
    const Scene scene = rod((far_first ? far + lower + near : near + far + lower), rate, third + 0.3);
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    REQUIRE(run.events.size() == 3);
    const double times[] = {first, second, third};
    const char* names[] = {"upper", "lower", "upper"};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(run.events[i].element == names[i]);
      CHECK(run.events[i].t == Approx(times[i]).epsilon(1e-11));
    }
    for (const double t : {0.4, first + 0.37, second - 0.11, second + 0.7, third + 0.2}) {
      const double truth = t < first    ? start + rate * t
                           : t < second ? high - rate * e * (t - first)
                           : t < third  ? low + rate * e * e * (t - second)
                                        : high - rate * e * e * e * (t - third);
      CHECK(off_turns(angle_at(run, t) - truth) < 1e-10);
    }
  }
}

// From 40 to 860 degrees and back by a spline, whose ends have speeds of their own; by a ramp of a rate.
TEST_CASE("a drive takes a rod through turns to where it says") {
  const std::string drive = "[[constraints]]\nkind = 'angle'\nnodes = ['X', 'O', 'P']\naxis = [0, 1, 0]\n";
  const Scene to = rod(drive + "motion = 'smooth'\nto = 860\nstart = 0.1\nduration = 1.3\n", 0, 1.7);
  const Simulation there = simulate_on_path(build_model(to), to.solver);
  CHECK(off_turns(angle_at(there, 1.6) - 860 * degrees) < 1e-11);
  CHECK(off_turns(angle_at(there, 0.1) - 40 * degrees) < 1e-11);
  // Half of the way in half of the time.
  CHECK(off_turns(angle_at(there, 0.75) - 450 * degrees) < 1e-10);
  for (const double rate : {700.0, -900.0}) {
    const Scene on = rod(drive + "motion = 'rate'\nrate = " + exact_number(rate) + "\nramp = 0.4\n", 0, 2.3);
    const Simulation run = simulate_on_path(build_model(on), on.solver);
    for (const double t : {0.9, 1.7, 2.3})
      CHECK(off_turns(angle_at(run, t) - (40 + rate * (t - 0.2)) * degrees) < 1e-10);
    const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
    CHECK(v.tail<3>().norm() == Approx(std::abs(rate) * degrees * length).epsilon(1e-11));
  }
}

// What is deployed by an angle is so when it has turned that far, not a turn before.
TEST_CASE("a deployed pose turns away is that of the angle as it is counted on") {
  const auto model = build_model(rod("", 0, 1));
  const Path path(std::shared_ptr<const System>(model, &model->system),
                  model->system.reduce(node_positions(model->structure)));
  Deployment d;
  d.measured = true;
  d.measure = {MeasureKind::angle, {1, 0, 1, 2}, Vec3::UnitY(), 40 * degrees, {}};
  d.stowed = 40 * degrees;
  const double per_angle = std::sqrt(1.7 * length * length / 3);
  for (const double deployed : {75.0, 390.0, 500.0, 955.0, -310.0, -700.0, -25.0}) {
    CAPTURE(deployed);
    d.deployed = deployed * degrees;
    const auto ahead = deployed_pose(path, d, true, 200), behind = deployed_pose(path, d, false, 200);
    REQUIRE(ahead.has_value() != behind.has_value());
    CHECK(std::abs(ahead ? *ahead : *behind) ==
          Approx(per_angle * std::abs(deployed - 40) * degrees).epsilon(1e-11));
  }
}

// A spring about the hinge that is at rest 500 degrees on: x = 500 - 460 cos(omega t).
TEST_CASE("a hinge's spring pulls a rod through turns as it is counted on") {
  const double inertia = 1.7 * length * length / 3, k = 2.9, omega = std::sqrt(k / inertia);
  const Scene scene =
      rod("[[forces]]\nkind = 'torsion_spring'\nnodes = ['X', 'O', 'P']\naxis = [0, 1, 0]\nfree_angle = "
          "500\nstiffness = " +
              exact_number(k) + "\n",
          0, 3.1);
  const Simulation run = simulate_on_path(build_model(scene), scene.solver);
  for (const double t : {0.31, 0.9, 1.6, 2.2, 3.1})
    CHECK(off_turns(angle_at(run, t) - (500 - 460 * std::cos(omega * t)) * degrees) < 1e-9);
}

// Scissors, whose pins lie within rods, and dampers of unlike strength at them and at the ends.
TEST_CASE("dampers of pins within rods act on the path as on the full model") {
  const auto text = [](const char* model) {
    return read_scene_text(
        std::string("[structure]\nkind = 'scissor_mast'\ncells = 2\nrod_length = 1.3\nfold_angle = 74\n"
                    "tip_force = 37\n[[forces]]\nkind = 'joint_damping'\nnodes = ['*']\ndamping = 3.1\n"
                    "[solver]\nstages = 6\nstep = 0.01\nend_time = 0.2\nmodel = '") +
            model + "'\n",
        "scissor.toml", {});
  };
  const Scene full = text("full"), path = text("path");
  const Simulation a = simulate_as_asked(build_model(path), path.solver),
                   b = simulate_as_asked(build_model(full), full.solver);
  REQUIRE(a.trajectory.size() == b.trajectory.size());
  CHECK(testing::runs_apart(a, b) < 1e-10);
  // They damp: without them it is farther.
  CHECK(node_distance(b.trajectory.positions(b.trajectory.size() - 1), b.trajectory.positions(0)) > 1e-3);
}

}  // namespace path_turns_test
