// SPDX-License-Identifier: BSD-3-Clause
// Small and large, light and heavy, fast and slow: scenes in other units of length, mass and time. A limit
// without a unit would tell a mechanism of a millimetre from one of a metre.
#include "tests/support/other_units.hpp"

#include "core/diagnostics/clearance.hpp"
#include "core/integrators/integrator.hpp"
#include "core/scene/library.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace other_units_test {

namespace {

constexpr OtherUnits all_units[] = {{-10, 0, 0}, {0, -20, 0}, {0, 0, -7}, {7, 20, 5}, {-17, -40, -12}};

// A scene of the library with changes, and the units of keys that have one or another.
struct Case {
  const char* scene;
  std::vector<std::string> changes;
  UnitsOfKeys more = {};
};

}  // namespace

TEST_CASE("every scene of the library moves alike in other units, to the last bit") {
  for (const LibraryScene& entry : library_scenes()) {
    INFO(entry.name);
    Scene scene = read_scene_file(entry.path, {});
    scene.solver.end_time = std::min(scene.solver.end_time, 120 * scene.solver.step);
    for (const OtherUnits& units : all_units) check_other_units(scene, units);
  }
}

// The drive has its full rate, which is low, as it passes the flat pose: of a millimetre, 5e-10 m in a step.
TEST_CASE("a drive passes a flat pose in structures of any size alike, to the last bit") {
  const Scene scene = read_scene_text(R"toml([structure]
kind = "custom"
nodes = [{name = "A0", position = [0, 0, 0], fixed = true}, {name = "B0", position = ["=cos(pi/1000)", 0, "=-sin(pi/1000)"]},
  {name = "A1", position = [2, 0, 0], fixed = true}, {name = "B1", position = ["=2+cos(pi/1000)", 0, "=-sin(pi/1000)"]}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["B0", "B1"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
name = "m"
nodes = ["A1", "A0", "B0"]
axis = [0, -1, 0]
motion = "rate"
rate = 0.36
ramp = 1
[solver]
stages = 4
step = 0.01
end_time = 1.2
)toml",
                                      "s.toml");
  for (const OtherUnits& units : all_units) check_other_units(scene, units);
}

TEST_CASE("every method moves alike in other units, to the last bit") {
  for (const Method& method : methods())
    for (const char* name : {"double_pendulum", "hoop6_sector"}) {
      INFO(method.name << ", " << name);
      Scene scene = read_scene_file(find_scene(name), {"solver.method=\"" + std::string(method.name) + "\""});
      scene.solver.end_time = 40 * scene.solver.step;
      for (const OtherUnits& units : all_units) check_other_units(scene, units);
    }
}

TEST_CASE("events come at the same times in other units, to the last bit") {
  const std::string elbow = R"(nodes=["pivot","elbow","tip"])";
  const Case cases[] = {
      {"hoop6", {}},
      {"hoop6_sector", {R"(solver.at_deployed="latch")"}},
      {"hoop6_sector", {"solver.adaptive=true", "solver.step=0.1"}},
      {"scissor_mast", {}},
      {"double_pendulum",
       {"constraints[0]={kind=\"angle_stop\"," + elbow + ",min=60,max=120,restitution=0.5}",
        "solver.end_time=2"}},
      {"double_pendulum",
       {"constraints[0]={kind=\"angle_stop\"," + elbow + ",max=110,rest_speed=100,restitution=0.3}",
        "forces[0]={kind=\"friction\"," + elbow + ",kinetic=1.5,static=2}", "solver.end_time=2"},
       {{"kinetic", "N m"}, {"static", "N m"}}},
      {"double_pendulum",
       {R"(constraints[0]={kind="length_stop",nodes=["pivot","tip"],max=1.45,restitution=0.7})",
        R"(constraints[1]={kind="coordinate_stop",nodes=["elbow"],direction=[0,0,1],min=-0.9,restitution=0})",
        "solver.end_time=2"}},
      {"double_pendulum",
       {R"(forces[0]={kind="spring",nodes=["pivot","tip"],stiffness=300,free_length=1.4,tension_only=true})",
        R"(forces[1]={kind="drag",nodes=["tip"],damping=0.4})",
        R"(forces[2]={kind="load_over_time",nodes=["elbow"],force=[3,-2,5],times=[0.113,0.127,0.141],values=[0,9,0]})",
        "solver.end_time=2"}},
      {"four_bar",
       {R"(constraints[0]={kind="length_stop",nodes=["B","D"],max=3.5,restitution=0.7})",
        "solver.end_time=2"}},
      {"pendulum",
       {R"(forces[0]={kind="friction",nodes=["bob"],direction=[1,0,0],kinetic=4,static=30})",
        "solver.end_time=3"},
       {{"kinetic", "N"}, {"static", "N"}}},
  };
  for (const Case& one : cases) {
    INFO(one.scene << " " << (one.changes.empty() ? "" : one.changes.front()));
    const Scene scene = read_scene_file(find_scene(one.scene), one.changes);
    CHECK(static_cast<int>(simulate(build_model(scene), scene.solver).events.size()) > 0);
    for (const OtherUnits& units : all_units) check_other_units(scene, units, 0, one.more);
  }
}

// Its limit is a torque, and what the structure holds elsewhere are forces.
TEST_CASE("friction of a hinge lets go at its limit in structures of a nanometre, to the last bit") {
  const std::string crank = R"(nodes=["D","A","B"],axis=[0,1,0])";
  const Scene scene = read_scene_file(
      find_scene("four_bar"),
      {"forces[0]={kind=\"friction\"," + crank + ",kinetic=8,static=11}",
       "forces[1]={kind=\"torsion_spring\"," + crank + ",stiffness=20,damping=1,free_angle=-120}",
       R"(forces[2]={kind="load_over_time",nodes=["C"],force=[40,0,0],times=[0,0.5,0.5,0.9],values=[0,1,-1,0.5]})",
       "solver.end_time=2"});
  CHECK(simulate(build_model(scene), scene.solver).events.size() >= 2);
  for (const OtherUnits& units : {OtherUnits{-30, 0, 0}, OtherUnits{20, 0, 0}})
    check_other_units(scene, units, 0, {{"kinetic", "N m"}, {"static", "N m"}});
}

// What a controller sums up is no length, and nothing moves with it: however slow and small the mechanism is,
// its energy and its steps are those of what moves. Among lengths the sum weighs as much as its unit says, in
// what counts as converged: to 1e-9 of the largest.
TEST_CASE("a motor with an integral moves slow and small mechanisms alike") {
  const std::string arm = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0.1], mass = 0.2},
  {name = "C", position = [1.4, 0.9, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 0.5}]
[[forces]]
kind = "motor"
name = "m"
nodes = ["A", "B", "C"]
stall_torque = 1
no_load_speed = 300
gear_ratio = 3
control = "position"
proportional = 2
derivative = 0.1
integral = 1
motion = "smooth"
to = 100
duration = 1.5
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.005
end_time = 1.3
)";
  for (const char* change : {"solver.method=\"dvm\"", "solver.adaptive=true",
                             "solver.method=\"generalized_alpha\"", "solver.method=\"rk4_projected\""}) {
    INFO(change);
    const Scene scene = read_scene_text(arm, "s.toml", {change});
    for (const OtherUnits& units : {OtherUnits{-10, 0, 20}, OtherUnits{-20, 0, 20}, OtherUnits{20, 0, -10}})
      check_other_units(scene, units, 1e-9, {{"integral", "N m/rad/s"}});
  }
}

TEST_CASE("the nearest pair of rods is that of other units, to the last bit") {
  const Scene scene = read_scene_file(find_scene("four_bar"), {});
  const auto nearest = [&](const OtherUnits& units) {
    const Scene other = read_scene_text(in_other_units(scene, units, {}), "s.toml");
    const Simulation run = simulate(build_model(other), other.solver);
    return least_clearance(run.trajectory, run.trajectory.size()).value();
  };
  const Clearance here = nearest({});
  CHECK(here.t > 0);  // between states, of a run of 6 s
  for (const OtherUnits& units : all_units) {
    const Clearance there = nearest(units);
    CHECK(there.t == here.t * units.factor("s"));
    CHECK(there.axes == here.axes * units.factor("m"));
  }
}

}  // namespace other_units_test
