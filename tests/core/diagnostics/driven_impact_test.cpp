// SPDX-License-Identifier: BSD-3-Clause
// What drives put in where something strikes what they lead: the impulse times the rate they hold.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/library.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace driven_impact_test {

namespace {

double last(const Diagnostics& d, const char* column) {
  return d.at(column).values.back();
}

const char* const on_a_line = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "D", position = [0, 0, 1], fixed = true},
         {name = "B", position = [1, 0, 0], mass = 2}]
rods = [{nodes = ["A", "D"], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[solver]
end_time = 1
step = 0.01
)";

}  // namespace

// 2 kg at rest take the 0.5 m/s of the winch at once: P = 1 N s, of whose work, 0.5 J, one half is lost.
TEST_CASE("a winch that draws a slack cable taut does the work of the jerk") {
  const Simulation run = testing::run_scene(
      on_a_line,
      {R"(constraints[1]={kind="cable",name="w",nodes=["A","B"],length=1.2,motion="rate",rate=-0.5})"});
  const Diagnostics d = diagnose(run);
  CHECK(last(d, "impact_loss_J") == Approx(0.25).epsilon(1e-9));
  CHECK(last(d, "drive_work_J") == Approx(0.5).epsilon(1e-9));
  CHECK(last(d, "w.energy_J") == Approx(0.5).epsilon(1e-9));
  REQUIRE(run.events.size() >= 1);
  CHECK(run.events[0].energy_lost == Approx(0.25).epsilon(1e-9));
}

// A slider led at v = 0.5 m/s strikes m = 1 kg at rest, which leaves it at (1 + e) v: the drive gives
// m (1 + e) v^2, of which m v^2 (1 + e)^2 / 2 stays.
TEST_CASE("a drive does the work of what its slider strikes, whatever the restitution") {
  for (const double e : {0.0, 0.3, 1.0}) {
    const Simulation run = testing::run_scene(
        on_a_line, {R"(structure.nodes[3]={name="C",position=[2,0,0],mass=1})",
                    "structure.nodes.B.velocity=[0.5,0,0]", R"(constraints[0].nodes=["B","C"])",
                    R"(constraints[1]={kind="length",name="w",nodes=["A","B"],motion="rate",rate=0.5})",
                    R"(constraints[2]={kind="length_stop",name="s",nodes=["B","C"],min=0.71,restitution=)" +
                        std::to_string(e) + "}"});
    const Diagnostics d = diagnose(run);
    CHECK(last(d, "drive_work_J") == Approx((1 + e) * 0.25).epsilon(1e-9));
    CHECK(last(d, "w.energy_J") == Approx((1 + e) * 0.25).epsilon(1e-9));
    CHECK(last(d, "impact_loss_J") == Approx((1 - e * e) * 0.125).epsilon(0).margin(1e-9));
    REQUIRE(run.events.size() >= 1);
    CHECK(run.events[0].energy_lost == Approx((1 - e * e) * 0.125).epsilon(0).margin(1e-9));
  }
}

// From rest to 0.5 m/s at once, an impulse at half that rate on average: nothing is lost.
TEST_CASE("a drive whose velocity jumps puts in what moves then, by its own name too") {
  const Simulation run = testing::run_scene(
      on_a_line,
      {R"(constraints[1]={kind="length",name="w",nodes=["A","B"],motion="rate",rate=0.5,start=0.305})"});
  const Diagnostics d = diagnose(run);
  CHECK(last(d, "drive_work_J") == Approx(0.25).epsilon(1e-9));
  CHECK(last(d, "w.energy_J") == Approx(0.25).epsilon(1e-9));
}

// The library's ring: the cable draws it open, is overtaken, pulls with a jerk and is stopped by the latch.
// What the winch gave is what the gears' dampers took and what both impacts lost, as the events say; nothing
// moves at the end.
TEST_CASE("all that a winch gives a ring has gone into its dampers and impacts at the end") {
  const Scene scene = read_scene_file(find_scene("cable_ring"));
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics d = diagnose(run);
  double lost = 0;
  for (const Event& event : run.events) lost += event.energy_lost;
  CHECK(lost > 0.05);
  CHECK(last(d, "impact_loss_J") == Approx(lost).epsilon(1e-9));
  CHECK(last(d, "cable.energy_J") == Approx(last(d, "dissipated_J") + lost).epsilon(1e-9));
}

// A cable that is drawn in as fast as what hangs on it comes along does not stretch, but for the 0.5 mm/s by
// which it gets stiffer: its damper has nothing to do. 20 N s/m of drag at 0.5 m/s.
TEST_CASE("a damped cable that tows at a steady speed is not damped") {
  for (const double damping : {0.0, 300.0}) {
    const Simulation run = testing::run_scene(
        on_a_line,
        {"structure.nodes.B.velocity=[-0.5,0,0]", "structure.nodes.B.position=[2,0,0]",
         R"(forces[0]={kind="cable",name="w",nodes=["A","B"],axial_stiffness=1e4,motion="rate",rate=-0.5,damping=)" +
             std::to_string(damping) + "}",
         R"(forces[1]={kind="drag",nodes=["B"],damping=20})", "solver.end_time=2"});
    const Diagnostics d = diagnose(run);
    CHECK(last(d, "w.force_N") == Approx(-10).epsilon(3e-3));
    CHECK(last(d, "w.power_W") == Approx(5).epsilon(3e-3));
    CHECK(std::abs(last(d, "energy_balance_J")) < 1e-6);
  }
}

// Drawn along x at 1 m/s on the arc of a taut cable, 2 kg meet a floor and are thrown back, the cable slack:
// neither the drive nor the cable gives an impulse, the floor takes 3/4 of what the motion across was. Events
// are located to 1e-12 s.
TEST_CASE("a cable that goes slack in an impact gives nothing, and a drive across it neither") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "D", position = [0, 0, 0], fixed = true},
         {name = "B", position = [-0.8, 0, -0.6], mass = 2, velocity = [1, 0, -1.3333333333333333]}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "coordinate"
name = "draw"
nodes = ["B"]
direction = [1, 0, 0]
motion = "rate"
rate = 1
[[constraints]]
kind = "cable"
nodes = ["D", "B"]
length = 1
[[constraints]]
kind = "coordinate_stop"
nodes = ["B"]
direction = [0, 0, 1]
min = -0.9
restitution = 0.5
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.4
)");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const double x = -std::sqrt(1 - 0.81), across = x / 0.9, lost = across * across * 0.75;
  CHECK(last(d, "impact_loss_J") == Approx(lost).epsilon(1e-8));
  const auto& work = d.at("draw.energy_J").values;
  for (std::size_t i = 1; i < work.size(); ++i)
    if (run.trajectory.time(i) - run.trajectory.time(i - 1) < 1e-12)
      CHECK(work[i] == Approx(work[i - 1]).epsilon(0).margin(1e-8));
}

// What hangs on a cable is taken along at once by a reel that begins with its rate: m r^2 / 2 more, which the
// reel has given. Nothing is lost, and nothing begins to pull.
TEST_CASE("a reel that begins with a jump is no impact of the cable that pulls already") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "D", position = [0, 0, 0], fixed = true}, {name = "B", position = [0, 0, -1], mass = 2}]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [0, 0, 1]
[[constraints]]
kind = "cable"
name = "rope"
nodes = ["D", "B"]
motion = "rate"
rate = -0.2
start = 0.1
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.3
)");
  const Diagnostics d = diagnose(run);
  REQUIRE(run.events.size() == 1);
  CHECK(run.events[0].t == 0);
  CHECK(last(d, "impact_loss_J") == Approx(0).epsilon(0).margin(1e-12));
  CHECK(last(d, "rope.energy_J") == Approx(2 * (0.02 + 9.81 * 0.04)).epsilon(1e-9));
}

// A cable that lifts 2 kg by 0.35 m, beside a drive elsewhere whose name, in the other table, is as good.
TEST_CASE("a reeled cable of the name of a drive has its own force and work") {
  const std::string scene = R"(
[structure]
kind = "custom"
nodes = [{name = "D", position = [0, 0, 2], fixed = true}, {name = "B", position = [0, 0, 1], mass = 2},
  {name = "C", position = [1, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["B", "C"]
direction = [0, 0, 1]
[[constraints]]
kind = "coordinate"
name = "hoist"
nodes = ["C"]
direction = [0, 0, 1]
motion = "rate"
rate = 0.3
ramp = 0.1
[[forces]]
kind = "cable"
name = "NAME"
nodes = ["D", "B"]
length = 1.0
motion = "rate"
rate = -0.5
ramp = 0.4
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.9
)";
  const auto named = [&](const std::string& name) {
    return diagnose(testing::run_scene(std::string(scene).replace(scene.find("NAME"), 4, name)));
  };
  const Diagnostics own = named("rope"), same = named("hoist");
  for (const char* column : {".value_m", ".force_N", ".power_W", ".energy_J", ".force_unique"})
    CHECK(same.at(std::string("hoist (2)") + column).values == own.at(std::string("rope") + column).values);
  CHECK(same.at("hoist.energy_J").values == own.at("hoist.energy_J").values);
  // A ramp of 0.4 s and half a second: 0.35 m up, and the kinetic energy of 0.5 m/s.
  CHECK(last(same, "hoist (2).energy_J") == Approx(2 * (9.81 * 0.35 + 0.125)).epsilon(1e-9));
}

// A beam and a ball among stops, cables and a drive: what each impact is told to lose is what the books have,
// which work it out from the states before and behind it. Also where a stop goes on holding what it stops, at
// a rate of rounding.
TEST_CASE("what impacts lose in the books is what their events say") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "D", position = [0, 0, 0], fixed = true},
  {name = "E", position = [1.5, 0, 0.2], fixed = true},
  {name = "B0", position = [-0.3465, 0.0, -1.0286], mass = 1.8008, velocity = [-1.8412, 0.0, -1.3202]},
  {name = "B1", position = [1.3775, 0.0, -1.0796], mass = 0.8234, velocity = [0.5987, 0.0, -1.5541]},
  {name = "B2", position = [-0.3146, 0.0, -1.0235], mass = 1.4859, velocity = [0.6091, 0.0, 0.7479]}]
rods = [
  {name = "r0", nodes = ["B0", "B1"], mass = 0.647}]
[[constraints]]
kind = "plane"
name = "pl"
nodes = ["B0", "B1", "B2"]
normal = [0, 1, 0]
[[constraints]]
kind = "coordinate_stop"
name = "s1"
nodes = ["B0"]
direction = [0, 0, 1]
restitution = 0.1739
rest_speed = 0.05
min = -1.3612
max = -0.7046
[[constraints]]
kind = "cable"
name = "cB0"
nodes = ["E", "B0"]
length = 2.2323
[[constraints]]
kind = "coordinate_stop"
name = "s2"
nodes = ["B1"]
direction = [1, 0, 0]
restitution = 0.0
rest_speed = 0.05
min = 1.2333
[[constraints]]
kind = "coordinate_stop"
name = "s3"
nodes = ["B2"]
direction = [0, 0, 1]
restitution = 0.4366
rest_speed = 0.05
min = -1.3931
[[constraints]]
kind = "cable"
name = "cB2"
nodes = ["D", "B2"]
length = 1.1157
[[constraints]]
kind = "coordinate"
name = "drv"
nodes = ["B0"]
direction = [1, 0, 0.5]
motion = "rate"
rate = 0.2554
start = 0.0996
ramp = 0.1
[gravity]
acceleration = [0.7577, 0, -9.81]
[solver]
step = 0.005
end_time = 0.8
stages = 4
)");
  REQUIRE(run.status == RunStatus::completed);
  double lost = 0;
  for (const Event& event : run.events) lost += event.energy_lost;
  CHECK(lost > 1);
  CHECK(last(diagnose(run), "impact_loss_J") == Approx(lost).epsilon(1e-9));
}

// 2 kg rest on a floor and are drawn along (2, 0, -1) from 0.1 s on, at once: m v^2 / 2 of 5/4 m/s more,
// which the drive gives, and no impact of the floor.
TEST_CASE("a drive that begins with a jump is no impact of the stop that holds already") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
rods = []
nodes = [{name = "B", position = [0, 0, 0], mass = 2}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["B"]
direction = [0, 0, 1]
min = 0
[[constraints]]
kind = "coordinate"
name = "draw"
nodes = ["B"]
direction = [1, 0, -0.5]
motion = "rate"
rate = 1
start = 0.1
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.3
)");
  REQUIRE(run.status == RunStatus::completed);
  for (const Event& event : run.events) CHECK(event.energy_lost == Approx(0).epsilon(0).margin(1e-12));
  const Diagnostics d = diagnose(run);
  CHECK(last(d, "impact_loss_J") == Approx(0).epsilon(0).margin(1e-12));
  CHECK(last(d, "drive_work_J") == Approx(last(d, "kinetic_energy_J")).epsilon(1e-9));
}

}  // namespace driven_impact_test
