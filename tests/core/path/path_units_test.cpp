// SPDX-License-Identifier: BSD-3-Clause
// Paths, margins and sectors of small and large, light and heavy structures: s has the unit m kg^1/2, which
// is 1e-12 of one for a mechanism of 10 um and 1 ug, and 1e10 for one of 10 km and 1e6 t.
#include "core/path/margin.hpp"
#include "core/path/path_run.hpp"
#include "core/path/sector.hpp"
#include "core/scene/library.hpp"
#include "tests/support/other_units.hpp"
#include "tests/support/runs_apart.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace path_units_test {

namespace {

// A metre is 1e5, 1e-4 of the other units, and so on, of 1e15 to 1e-12 of those of mass.
constexpr OtherUnits all_units[] = {{-17, -50, 0}, {13, 14, 0},     {0, 0, 13},
                                    {0, 0, -13},   {-17, -50, -13}, {13, 14, 5}};

Simulation on_path(const std::shared_ptr<const Model>& model, const SolverOptions& options) {
  return simulate_on_path(model, options);
}
Simulation on_sector(const std::shared_ptr<const Model>& model, const SolverOptions& options) {
  return simulate_sector(model, options, solved_in_full);
}

struct Case {
  const char* scene;
  std::vector<std::string> changes;
  UnitsOfKeys more = {};
};

const std::string crank = R"(nodes=["D","A","B"],axis=[0,1,0])";
const Case path_cases[] = {
    // Driven: smoothly, at a rate, along a length.
    {"four_bar", {"constraints[0]={kind=\"angle\"," + crank + ",motion=\"smooth\",to=-150,duration=0.8}"}},
    {"four_bar",
     {"constraints[0]={kind=\"angle\"," + crank + ",motion=\"rate\",rate=-40,ramp=0.3}"},
     {{"rate", "deg/s"}}},
    {"four_bar",
     {R"(constraints[0]={kind="length",nodes=["B","D"],motion="smooth",to=3.5,duration=1})"},
     {{"to", "m"}}},
    // On springs and dampers, with a load over time and a cable.
    {"four_bar",
     {R"(forces[0]={kind="spring",nodes=["B","D"],stiffness=40,damping=3})",
      "forces[1]={kind=\"torsion_spring\"," + crank + ",stiffness=20,damping=1,free_angle=-120}",
      R"(forces[2]={kind="load_over_time",nodes=["C"],force=[40,0,0],times=[0,0.5,0.5,0.9],values=[0,1,-1,0.5]})",
      R"(forces[3]={kind="spring",nodes=["D","B"],stiffness=30,damping=0.5,tension_only=true,free_length=3.1})"}},
    // Between stops, which throw back and hold.
    {"four_bar",
     {R"(constraints[0]={kind="coordinate_stop",nodes=["B"],direction=[0,0,1],min=-0.8,restitution=0.5})",
      R"(constraints[1]={kind="length_stop",nodes=["B","D"],max=3.5,restitution=0.7})"}},
    // With friction, which holds, slips and turns round.
    {"four_bar",
     {"forces[0]={kind=\"friction\"," + crank + ",kinetic=8,static=11}",
      "forces[1]={kind=\"torsion_spring\"," + crank + ",stiffness=20,damping=1,free_angle=-120}",
      R"(forces[2]={kind="load_over_time",nodes=["C"],force=[40,0,0],times=[0,0.5,0.5,0.9],values=[0,1,-1,0.5]})"},
     {{"kinetic", "N m"}, {"static", "N m"}}},
    // To a deployed pose, and latched there.
    {"hoop6_sector", {}},
    {"hoop6_sector", {R"(solver.at_deployed="latch")"}},
    {"scissor_mast", {}},
    {"hoberman", {}},
    {"reentrant_sheet", {}},
    {"ladder", {}},
};

Scene scene_of(const Case& one) {
  std::vector<std::string> changes = one.changes;
  if (std::string_view(one.scene) == "four_bar") {
    if (changes.front().find("motion=") != std::string::npos)  // from rest
      changes.insert(changes.end(),
                     {"structure.nodes[1].velocity=[0,0,0]", "structure.nodes[2].velocity=[0,0,0]"});
    changes.push_back("solver.step=0.01");
    changes.push_back("solver.end_time=2");
  }
  return read_scene_file(find_scene(one.scene), changes);
}

}  // namespace

TEST_CASE("paths are followed alike in other units, to the last bit") {
  for (const Case& one : path_cases) {
    INFO(one.scene << " " << (one.changes.empty() ? "" : one.changes.front()));
    for (const OtherUnits& units : all_units) check_other_units(scene_of(one), units, 0, one.more, on_path);
  }
}

// 0.01 s are 1 / 80 of the drive's way: by seven stages, of order 12, the full model is at round-off, of
// poses that are known to some 1e-15 of the structure and carried over 80 steps.
TEST_CASE("a driven path is that of the full model, however small or large") {
  for (const OtherUnits& units : all_units) {
    INFO(units.length << " " << units.mass << " " << units.time);
    const std::string text = in_other_units(scene_of(path_cases[0]), units, {});
    Scene scene = read_scene_text(text, "s.toml", {"solver.stages=7"});
    const auto model = build_model(scene);
    const Simulation path = on_path(model, scene.solver), full = simulate(model, scene.solver);
    REQUIRE(path.trajectory.size() == full.trajectory.size());
    double apart = 0;
    for (std::size_t i = 0; i < path.trajectory.size(); ++i)
      apart = std::max(apart, node_distance(path.trajectory.positions(i), full.trajectory.positions(i)));
    CHECK(apart <= 1e-13 * units.factor("m"));
  }
}

// A slider on a spring and no rod: nothing but the way between its nodes tells its size.
TEST_CASE("what no rod holds has a path in other units, to the last bit") {
  const Scene slider = read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 5.3], mass = 1}, {name = "Q", position = [1, 0, 5], fixed = true}]
[[structure.constraints]]
kind = "line"
nodes = ["P"]
direction = [0, 0, 1]
[gravity]
acceleration = [0, 0, -10]
[[forces]]
kind = "spring"
nodes = ["P", "Q"]
stiffness = 100
free_length = 0.6
[solver]
step = 0.05
end_time = 2
)",
                                       "s.toml", {});
  for (const OtherUnits& units : all_units) check_other_units(slider, units, 0, {}, on_path);
}

TEST_CASE("margins are those of other units, to the last bit") {
  for (const char* name : {"hoop6", "scissor_mast"}) {
    const Scene scene = read_scene_file(
        find_scene(name),
        {R"(forces[0]={kind="load_over_time",nodes=["*"],force=[0,0,1e-3],times=[0,1],values=[1,2]})"});
    const auto margin = [&](const OtherUnits& units) {
      const Scene other = read_scene_text(in_other_units(scene, units, {}), "s.toml");
      return margin_of(build_model(other), other.solver);
    };
    const Margin here = margin({});
    CHECK(here.motion.size() > 10);
    for (const OtherUnits& units : all_units) {
      INFO(name << " " << units.length << " " << units.mass << " " << units.time);
      const Margin there = margin(units);
      CHECK(there.worst.margin == here.worst.margin);
      CHECK(there.dynamic_min == here.dynamic_min);
      CHECK(there.end == here.end);
      REQUIRE(there.motion.size() == here.motion.size());
      CHECK(there.motion.back().t == here.motion.back().t * units.factor("s"));
    }
  }
}

TEST_CASE("sectors stand for their rings in other units, to the last bit") {
  for (const char* name : {"hoop6", "hoop12"}) {
    Scene scene = read_scene_file(find_scene(name), {});
    scene.solver.end_time = std::min(scene.solver.end_time, 30 * scene.solver.step);
    for (const OtherUnits& units : all_units) check_other_units(scene, units, 0, {}, on_sector);
  }
}

}  // namespace path_units_test
