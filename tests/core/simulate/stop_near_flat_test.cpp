// SPDX-License-Identifier: BSD-3-Clause
// Stops that a ring meets next to its flat pose, in which the constraints lose rank and no step can end.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/diagnostics/diagnostics.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/reference.hpp"

using namespace unfurl;

namespace stop_near_flat_test {

namespace {

// A ring that is flat at 0.160662 s; a load begins where a step ends, at 0.16 s, 0.134 degrees before.
Scene ring(const std::vector<std::string>& changes) {
  return read_scene_text(R"(
[structure]
kind = "hoop"
units = 6
post_length = 0.6655206096817609
fold_angle = 14.185800626033622
hinge_force = 414.4792355160152
[solver]
end_time = 0.2
step = 0.01
stages = 7
[[constraints]]
kind = "angle_stop"
name = "s"
fold_angle = true
min = 0
[[forces]]
kind = "load_over_time"
nodes = ["B3"]
force = [-19, -28, -16]
times = [0, 0.16, 0.26]
values = [0, 0, 1]
)",
                         "ring.toml", changes);
}

std::string key(const char* name, double value) {
  return name + std::to_string(value);
}

}  // namespace

namespace {

// The path knows nothing of steps: it passes flat poses like any other. Where a step did not end, the state
// at the stop is on a polynomial through 9 of other lengths, known to some 1e-12 of the motion; behind a stop
// at 1e-3 degrees the motion of 200 degrees/s has 1e-9 of that from round-off next to the pose.
void check_against_path(const char* at_deployed) {
  int contacts = 0;
  for (const double restitution : {0.0, 0.5, 1.0})
    for (const double least : {0.3, 0.134, 0.1, 0.05, 0.001, -0.05, -0.3, -1.0})
      for (const bool edge : {true, false}) {
        if (!edge && (restitution == 0.5 || least < 0)) continue;  // flat again next to the end of a step
        CAPTURE(at_deployed, restitution, least, edge);
        const Scene scene =
            ring({std::string("solver.at_deployed=") + at_deployed, key("constraints[0].min=", least),
                  key("constraints[0].restitution=", restitution),
                  edge ? "forces[0].values=[0,0,1]" : "forces[0].times=[0,0.1637,0.26]"});
        const auto model = build_model(scene);
        const Simulation full = simulate(model, scene.solver);
        const Simulation path = simulate_on_path(model, scene.solver);
        CHECK(full.status == path.status);
        REQUIRE(full.events.size() == path.events.size());
        for (std::size_t e = 0; e < full.events.size(); ++e) {
          CHECK(full.events[e].kind == path.events[e].kind);
          CHECK(std::abs(full.events[e].t - path.events[e].t) <= 1e-9);
          contacts += full.events[e].kind == "contact" ? 1 : 0;
        }
        CHECK(node_distance(full.trajectory.positions(full.trajectory.size() - 1),
                            path.trajectory.positions(path.trajectory.size() - 1)) <= 1e-8);
      }
  CHECK(contacts >= 20);
}

}  // namespace

TEST_CASE("a stop next to the flat pose is met when the path meets it") {
  check_against_path("stop");
}
TEST_CASE("a stop next to the flat pose that latches is met when the path meets it") {
  check_against_path("latch");
}
TEST_CASE("a stop next to the flat pose that is passed is met when the path meets it") {
  check_against_path("pass");
}

// Of 10 m/s; an angle is known to some 1e-10 next to the pose, and what that takes of a rate to a hundred
// times as much.
TEST_CASE("a load that begins shortly before the flat pose leaves a ring the speed that the path knows") {
  for (const char* begin : {"0.158", "0.16", "0.1605", "0.16065"})
    for (const double step : {0.01, 0.004}) {
      CAPTURE(begin, step);
      const Scene scene = ring({key("constraints[0].min=", -1.0), key("solver.step=", step),
                                std::string("forces[0].times=[0,") + begin + ",0.26]"});
      const auto model = build_model(scene);
      const Simulation full = simulate(model, scene.solver), path = simulate_on_path(model, scene.solver);
      REQUIRE(full.status == RunStatus::deployed);
      REQUIRE(path.status == RunStatus::deployed);
      const std::size_t end = full.trajectory.size() - 1;
      CHECK(full.trajectory.end_time() == Approx(path.trajectory.end_time()).epsilon(0).margin(1e-11));
      CHECK((full.trajectory.velocities(end) - path.trajectory.velocities(path.trajectory.size() - 1))
                .lpNorm<Eigen::Infinity>() < 1e-7);
    }
}

TEST_CASE("a stop next to the flat pose is met when the path meets it where a load begins right behind it") {
  for (const double least : {0.001, 0.0005}) {
    CAPTURE(least);
    const Scene scene = ring({"forces[0].times=[0,0.16068,0.26]", key("constraints[0].min=", least)});
    const auto model = build_model(scene);
    const Simulation full = simulate(model, scene.solver), path = simulate_on_path(model, scene.solver);
    CHECK(full.warnings.empty());
    REQUIRE(full.events.size() == path.events.size());
    for (std::size_t e = 0; e < full.events.size(); ++e)
      CHECK(std::abs(full.events[e].t - path.events[e].t) <= 1e-9);
  }
}

// Opposite nodes of the flat ring are 12 m apart. Next to the pose lengths are known to some 1e-15 m, and
// 1e-5 m of them to 1e-10.
TEST_CASE(
    "a stay that goes taut shortly before the flat pose and slack behind it does so when the path says") {
  for (const double step : {0.01, 0.003}) {
    CAPTURE(step);
    const Scene scene = ring(
        {key("constraints[0].min=", -30.0), key("solver.step=", step), "solver.at_deployed=pass",
         "solver.end_time=0.165", "forces[0].values=[0,0,0]",
         R"(forces[1]={kind="spring",nodes=["B0","B3"],tension_only=true,stiffness=2e4,free_length=11.99999})"});
    const auto model = build_model(scene);
    const Simulation full = simulate(model, scene.solver), path = simulate_on_path(model, scene.solver);
    CHECK(full.status == RunStatus::completed);
    const auto times = [](const Simulation& run) {
      std::vector<double> out;
      for (const char* kind : {"taut", "deployed", "slack"})
        for (const Event& event : run.events)
          if (event.kind == kind) out.push_back(event.t);
      return out;
    };
    REQUIRE(times(full).size() == 3);
    REQUIRE(times(path).size() == 3);
    for (const std::size_t i : {0, 1, 2})
      CHECK(times(full)[i] == Approx(times(path)[i]).epsilon(0).margin(1e-10));
  }
}

// Rounding would say which is met first: the deployed pose is. The run ends there, or locks; one that passes
// it is thrown back all the same.
TEST_CASE("a stop in the deployed pose is met with it, which comes first") {
  for (const char* scene_name : {"scissor_mast", "scissor_ring", "hoberman"})
    for (const char* at_deployed : {"stop", "latch", "pass"})
      for (const double step : {0.01, 0.007, 0.002}) {
        CAPTURE(scene_name, at_deployed, step);
        const Scene scene = read_scene_file(
            find_scene(scene_name),
            {"structure.deployed_angle=12.5", std::string("solver.at_deployed=") + at_deployed,
             "solver.end_time=1.5", key("solver.step=", step),
             R"(constraints[0]={kind="angle_stop",name="s",fold_angle=true,min=12.5,restitution=1})"});
        const auto model = build_model(scene);
        for (const Simulation& run : {simulate(model, scene.solver), simulate_on_path(model, scene.solver)}) {
          REQUIRE(run.events.size() >= 1);
          CHECK(run.events[0].kind == "deployed");
          const bool passes = at_deployed == std::string("pass"),
                     latches = at_deployed == std::string("latch");
          CHECK(run.status == (passes || latches ? RunStatus::completed : RunStatus::deployed));
          if (passes || latches) REQUIRE(run.events.size() >= 2);
          if (passes || latches) CHECK(run.events[1].kind == (passes ? "contact" : "latch"));
          for (std::size_t e = 1; e < run.events.size(); ++e) CHECK(run.events[e].t >= run.events[e - 1].t);
          // What counts as touching is 1e-9 of the structure.
          if (passes) CHECK(run.events[1].t == Approx(run.events[0].t).epsilon(1e-8));
        }
      }
}

// Newton's law for both: no speed is less than each stop's share of the one before, so that the harder throws
// back.
TEST_CASE("of two stops that are met at once the harder throws back") {
  for (const bool harder_first : {true, false}) {
    const std::string first = harder_first ? "0.6" : "0", second = harder_first ? "0" : "0.6";
    const Scene scene = ring(
        {"constraints[0].min=7", "constraints[0].restitution=" + first,
         R"(constraints[1]={kind="angle_stop",name="t",fold_angle=true,min=7,restitution=)" + second + "}"});
    const auto model = build_model(scene);
    const Simulation run = simulate(model, scene.solver);
    const std::vector<double> rate = diagnose(run).at("fold_rate_rad_s").values;
    std::size_t after = 1;
    while (after + 1 < run.trajectory.size() && run.trajectory.time(after) > run.trajectory.time(after - 1))
      ++after;
    CHECK(rate[after] == Approx(-0.6 * rate[after - 1]).epsilon(1e-9));
    REQUIRE(run.events.size() >= 2);
    CHECK(run.events[0].t == run.events[1].t);
    CHECK_THROWS_WITH(simulate_on_path(model, scene.solver), Catch::Contains("two stops are met at once"));
  }
}

// Flat, the rods of a scissor lie on each other and can turn about the base together. Before, one rod of mass
// m has the speeds 0 and V at its ends and the other V and 0; a stop that gives nothing back joins them to
// (0, U), and what pushes at the base has no moment about it: (m/3 + m/6) V = 2 m/3 U. Of m V^2 / 3 there is
// left m U^2 / 3 = 9/16. The path knows of no such way on. The pose is met to 1e-8 of the motion.
TEST_CASE("a stop in the flat pose of a mast sets going what is free there") {
  const Scene scene =
      read_scene_file(find_scene("scissor_mast"),
                      {"structure.cells=1", "structure.tip_mass=0", "solver.stages=7", "solver.step=0.002",
                       "solver.end_time=0.6", "solver.at_deployed=pass",
                       R"(constraints[0]={kind="angle_stop",name="s",fold_angle=true,min=0,restitution=0})"});
  const auto model = build_model(scene);
  const Simulation run = simulate(model, scene.solver);
  REQUIRE(run.events.size() >= 2);
  const Event& met = run.events[1];
  REQUIRE(met.kind == "contact");
  const Diagnostics figures = diagnose(run);
  std::size_t before = 0;
  while (run.trajectory.time(before) < met.t) ++before;
  CHECK(met.energy_lost == Approx(7.0 / 16 * figures.at("kinetic_energy_J").values[before]).epsilon(1e-7));
  CHECK_THROWS_WITH(simulate_on_path(model, scene.solver), Catch::Contains("other ways to move"));
}

TEST_CASE("a stop that throws back where there are other ways to move ends the run and says so") {
  const Scene scene = read_scene_file(
      find_scene("scissor_mast"),
      {"structure.cells=2", "solver.end_time=2", "solver.at_deployed=pass",
       R"(constraints[0]={kind="angle_stop",name="s",fold_angle=true,min=0,restitution=0.5})"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(run.status == RunStatus::failed);
  CHECK_THAT(run.message, Catch::Contains("place the stop before it"));
  CHECK_THAT(run.message, !Catch::Contains("solver.step"));
}

}  // namespace stop_near_flat_test
