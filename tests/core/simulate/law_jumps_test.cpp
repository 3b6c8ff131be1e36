// SPDX-License-Identifier: BSD-3-Clause
// Where rates or commands jump, what motors and cables give is by their laws in every state that is told, the
// first one behind the jump too.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace law_jumps_test {

namespace {

using testing::run_scene;

// A crank of inertia 0.7 * 0.5^2 = 0.175 kg m^2 about z, no gravity; at full voltage the motor gives
// 0.6 N m (1 - rate / (150 deg/s)), the controller asks for far more.
const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true}, {name = "E", position = [1, 0, 0], fixed = true},
  {name = "T", position = [0.5, 0, 0], mass = 0.7}]
rods = [{name = "arm", nodes = ["O", "T"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["T"]
normal = [0, 0, 1]
[[forces]]
kind = "motor"
name = "motor"
nodes = ["E", "O", "T"]
axis = [0, 0, 1]
stall_torque = 0.03
no_load_speed = 3000
gear_ratio = 20
control = "rate"
proportional = 3
motion = "rate"
rate = 140
start = 0.3
[solver]
step = 0.02
end_time = 1
)";

constexpr double inertia = 0.175, stall = 0.6;
const double top = 150 * pi / 180;

// That the torque is no more than a motor with this rate has; rates: of the arm of 0.5 m.
void check_torques(const Simulation& run, double torque_zero) {
  const Diagnostics d = diagnose(run);
  const auto& torque = d.at("motor.torque_N_m").values;
  REQUIRE(torque.size() == run.trajectory.size());
  for (std::size_t i = 0; i < torque.size(); ++i) {
    const VectorXd q = run.trajectory.node_positions(i), v = run.trajectory.node_velocities(i);
    const double rate = (q[6] * v[7] - q[7] * v[6]) / 0.25;
    INFO("state " << i << ", t = " << run.trajectory.time(i) << ", " << torque[i] << " N m");
    CHECK(torque[i] <= stall * (1 - rate / top) + torque_zero);
    CHECK(torque[i] >= stall * (-1 - rate / top) - torque_zero);
  }
}

}  // namespace

// All is closed form: at rest till 0.3 s, then th'' = 0.6 / 0.175 (1 - th' / top). The largest torque is that
// at 0.3 s, 0.6 N m, where 3 * 2.44 = 7.3 N m are asked for; the rod's force is the one of the largest rate.
TEST_CASE("a command that jumps is cut to what the motor has in the first state behind it") {
  for (const char* method : {"dvm", "rk4_projected", "generalized_alpha"}) {
    INFO(method);
    const Simulation run = run_scene(crank, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::completed);
    check_torques(run, 1e-9);
    const Diagnostics d = diagnose(run);
    CHECK(testing::largest(d, "motor.torque_N_m") == Approx(stall).epsilon(1e-9));
    // One state before the jump, one behind it.
    std::size_t there = 0;
    for (std::size_t i = 0; i < run.trajectory.size(); ++i)
      there += std::abs(run.trajectory.time(i) - 0.3) < 1e-9;
    CHECK(there == 2);
    REQUIRE(!run.events.empty());
    CHECK(run.events.front().name == "motor runs at full voltage");
    CHECK(run.events.front().t == Approx(0.3).epsilon(1e-12));
  }
}

// It runs into a stop of its angle as fast as it is asked to and bounces: turning back it could give up to
// stall (1 + e th' / top), and is asked for 3 (1 + e) th'.
TEST_CASE("a motor that an impact turns back gives no more than it has") {
  const std::string stop =
      "[[constraints]]\nkind = \"angle_stop\"\nname = \"stop\"\nnodes = [\"E\", \"O\", \"T\"]\n"
      "axis = [0, 0, 1]\nmax = 20\nrestitution = 0.5\n";
  std::string text = crank;
  text.insert(text.find("[solver]"), stop);
  for (const char* method : {"dvm", "rk4"}) {
    INFO(method);
    const Simulation run = run_scene(text, {std::string("solver.method=") + method, "solver.step=0.005"});
    REQUIRE(run.status == RunStatus::completed);
    check_torques(run, 1e-9);
    const auto hit = std::ranges::find(run.events, "contact", &Event::kind);
    REQUIRE(hit != run.events.end());
    // The time at which it meets the stop: th = top (t - tau (1 - exp(-t / tau))), till the controller,
    // which asks for 3 (140 deg/s - th'), takes over; so fast is it not yet.
    const double tau = inertia * top / stall, t = hit->t - 0.3;
    const double rate = top * (1 - std::exp(-t / tau));
    REQUIRE(3 * (140 * pi / 180 - rate) > stall * (1 - rate / top));
    CHECK(top * (t - tau * (1 - std::exp(-t / tau))) == Approx(20 * pi / 180).epsilon(1e-7));
    CHECK(testing::largest(diagnose(run), "motor.torque_N_m") ==
          Approx(stall * (1 + 0.5 * rate / top)).epsilon(1e-6));
  }
}

// k s + c s' with s' turned round by the stop would push: -2 * 5 * 1 + 40 * 0.1 < 0. It is slack at once.
TEST_CASE("a damped cable that an impact throws back is slack in the first state behind it") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "P", position = [0.9, 0, 0], mass = 2, velocity = [1.5, 0, 0]}]
rods = []
constraints = [{kind = "line", nodes = ["P"], direction = [1, 0, 0]}]
[[forces]]
kind = "cable"
name = "rope"
nodes = ["A", "P"]
length = 1
axial_stiffness = 40
damping = 5
motion = "rate"
rate = -0.01
[[constraints]]
kind = "coordinate_stop"
name = "wall"
nodes = ["P"]
direction = [1, 0, 0]
max = 1.1
restitution = 0.8
[solver]
step = 0.01
end_time = 0.4
)");
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(std::ranges::count(run.events, "contact", &Event::kind) == 1);
  const Diagnostics d = diagnose(run);
  for (const double force : d.at("rope.force_N").values) CHECK(force <= 0);
  CHECK(std::ranges::count(run.events, "slack", &Event::kind) == 1);
}

// What hangs on a winch, and a free mass that latches it: 1 kg that 0.5 N pulls outwards is drawn in at 0.2
// m/s until 0.7 s. It goes on when the winch stops, comes back and is caught after 2 v / a.
TEST_CASE("a winch that a latch stops lets its cable go slack and that is told") {
  const std::string scene = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "S", position = [2, 0, 0], mass = 1, velocity = [RATE, 0, 0]},
  {name = "R", position = [0, 1, 0], mass = 1, velocity = [1, 0, 0]}]
constraints = [{kind = "line", nodes = ["S", "R"], direction = [1, 0, 0]}]
[[constraints]]
kind = "cable"
name = "reel"
nodes = ["O", "S"]
motion = "rate"
rate = RATE
[[loads]]
nodes = ["S"]
force = [0.5, 0, 0]
[deployment]
measure = "coordinate R along 1 0 0"
deployed = 0.7
[solver]
step = 0.01
end_time = 2
at_deployed = "latch"
)";
  const auto at_rate = [&](const std::string& rate) {
    std::string text = scene;
    for (std::size_t at; (at = text.find("RATE")) != std::string::npos;) text.replace(at, 4, rate);
    return run_scene(text);
  };
  const auto check = [](const Simulation& run, const std::vector<std::pair<std::string, double>>& events) {
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() == events.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      CHECK(run.events[i].name == events[i].first);
      CHECK(run.events[i].t == Approx(events[i].second).epsilon(1e-10));  // located to rounding
    }
  };
  check(at_rate("-0.2"), {{"reel pulls", 0.0},
                          {"deployed", 0.7},
                          {"reel is slack", 0.7},
                          {"latched", 0.7},
                          {"reel pulls", 0.7 + 0.8}});
  // One that stands still goes on pulling, and nothing of it is told.
  check(at_rate("0"), {{"reel pulls", 0.0}, {"deployed", 0.7}, {"latched", 0.7}});
  // Paid out it is caught there, with its 0.02 J.
  const Simulation caught = at_rate("0.2");
  check(caught, {{"reel pulls", 0.0}, {"deployed", 0.7}, {"reel pulls", 0.7}, {"latched", 0.7}});
  CHECK(caught.events[2].kind == "taut");
  CHECK(caught.events[2].energy_lost == Approx(0.02).epsilon(1e-9));
}

}  // namespace law_jumps_test
