// SPDX-License-Identifier: BSD-3-Clause
// What acts on one side only is in its mode behind an archive, wherever that was made.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/simulate/stepper.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace archived_sides_test {

namespace {

// A motor of little current turns a crank back and forth, by a controller, against friction that its pin's
// force makes; a block on a wire slides with the crank's tip by a spring, sticks and slips, and stands beside
// another one; a cable that is drawn in lifts a weight off its stop; a slack rope throws a mass.
const std::string scene = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true}, {name = "E", position = [1, 0, 0], fixed = true},
  {name = "T", position = [0.3, 0.4, 0], mass = 0.7},
  {name = "B", position = [0.9, -0.3, 0], mass = 0.4}, {name = "C", position = [1.35, -0.3, 0], mass = 0.3},
  {name = "W", position = [3, 0, 0], mass = 0.8}, {name = "H", position = [3, 0, 1.3], fixed = true},
  {name = "R", position = [4, 0, 0.1], velocity = [0, 0, -0.7], mass = 0.5},
  {name = "K", position = [4, 0, 0.6], fixed = true}]
rods = [{nodes = ["O", "T"], mass = 0.2}]
[[structure.constraints]]
kind = "plane"
nodes = ["T"]
normal = [0, 0, 1]
[[structure.constraints]]
kind = "line"
nodes = ["B", "C"]
direction = [1, 0, 0]
[[structure.constraints]]
kind = "line"
nodes = ["W", "R"]
direction = [0, 0, 1]
[[forces]]
kind = "motor"
name = "motor"
nodes = ["E", "O", "T"]
axis = [0, 0, 1]
stall_torque = 0.03
no_load_speed = 3000
gear_ratio = 20
current_limit = 2
torque_constant = 0.005
control = "position"
motion = "smooth"
to = 160
duration = 0.8
proportional = 4
derivative = 0.3
[[forces]]
kind = "spring"
name = "pull"
nodes = ["T", "B"]
stiffness = 9
free_length = 0.5
[[forces]]
kind = "friction"
name = "rub"
nodes = ["B"]
direction = [1, 0, 0]
kinetic = 1.1
static = 1.5
[[forces]]
kind = "friction"
name = "rest"
nodes = ["C"]
direction = [1, 0, 0]
kinetic = 0.4
static = 0.6
[[forces]]
kind = "friction"
name = "pin"
nodes = ["T", "O", "E"]
axis = [0, 0, 1]
kinetic = 0.01
pin_friction = 0.2
pin_radius = 0.02
[[constraints]]
kind = "length_stop"
name = "bumper"
nodes = ["B", "C"]
min = 0.4
max = 0.6
restitution = 0.4
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["W"]
direction = [0, 0, 1]
min = -0.1
restitution = 0.3
[[constraints]]
kind = "cable"
name = "reel"
nodes = ["H", "W"]
motion = "smooth"
to = 0.9
start = 0.4
duration = 0.7
[[forces]]
kind = "spring"
name = "rope"
nodes = ["K", "R"]
stiffness = 60
damping = 0.4
free_length = 0.65
tension_only = true
[gravity]
acceleration = [0, 0, -2]
[solver]
stages = 4
step = 0.02
end_time = 1.6
)";

}  // namespace

TEST_CASE("what acts on one side goes on from an archive as it would have") {
  const Scene read = read_scene_text(scene, "s.toml");
  const auto model = build_model(read);
  Stepper plain(model, read.solver);
  std::vector<std::string> archives;
  std::size_t events = 0;  // behind each of them, and from time to time
  do
    if (plain.run().events.size() > events || plain.run().steps % 20 == 0) {
      events = plain.run().events.size();
      Archive out;
      plain.archive(out);
      archives.push_back(out.bytes());
    }
  while (plain.step());
  const Simulation whole = plain.take();
  REQUIRE(whole.status == RunStatus::completed);
  for (const char* kind : {"contact", "taut", "slack", "slip", "stick", "saturated"}) {
    INFO(kind);
    CHECK(std::ranges::count(whole.events, kind, &Event::kind) > 0);
  }
  for (const Event& event : whole.events) {
    CHECK_FALSE(event.element.empty());
    CHECK(event.name.find(event.element) != std::string::npos);
  }
  for (const std::string& bytes : archives) {
    Archive in(bytes);
    Stepper second(model, read.solver, in);
    INFO("archived at " << second.time() << " s");
    for (int k = 0; k < 3; ++k) second.step();
    const Simulation part = second.take();
    const double t = part.trajectory.end_time();
    std::size_t i = whole.trajectory.size() - 1;
    while (whole.trajectory.time(i) > t + 1e-9) --i;
    REQUIRE(std::abs(whole.trajectory.time(i) - t) <= 1e-9);
    // Iterations begin anew behind an archive: round-off, of accelerations of some 10 m/s^2 too.
    const std::size_t last = part.trajectory.size() - 1;
    CHECK((part.trajectory.node_positions(last) - whole.trajectory.node_positions(i)).cwiseAbs().maxCoeff() <=
          1e-11);
    CHECK(
        (part.trajectory.node_velocities(last) - whole.trajectory.node_velocities(i)).cwiseAbs().maxCoeff() <=
        1e-9);
    REQUIRE(part.events.size() <= whole.events.size());
    for (std::size_t k = 0; k < whole.events.size(); ++k) {
      if (k >= part.events.size()) {
        CHECK(whole.events[k].t >= t - 1e-9);
        continue;
      }
      CHECK(part.events[k].name == whole.events[k].name);
      CHECK(part.events[k].element == whole.events[k].element);
      CHECK(part.events[k].t == Approx(whole.events[k].t).epsilon(0).margin(1e-9));
    }
  }
}

}  // namespace archived_sides_test
