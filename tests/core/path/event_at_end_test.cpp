// SPDX-License-Identifier: BSD-3-Clause
// Runs that end where something happens, on the path and by the full model.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"

using namespace unfurl;

namespace event_at_end_test {

namespace {

struct Case {
  std::string scene;
  std::vector<std::string> changes;
};

const std::vector<Case> cases{
    {"hoop6_sector", {"solver.at_deployed=pass"}},
    {"hoop6_sector", {"solver.at_deployed=latch"}},
    {"hoop6_sector", {}},
    {"scissor_mast", {"solver.at_deployed=pass"}},
    {"scissor_ring", {"solver.at_deployed=pass"}},
    {"hoop6", {R"(constraints[0]={kind="angle_stop",name="s",fold_angle=true,min=40,restitution=0.6})"}},
    {"hoop6", {R"(constraints[0]={kind="angle_stop",name="s",fold_angle=true,min=40,restitution=0})"}},
    {"hoop6",
     {R"(forces[0]={kind="load_over_time",nodes=["B0"],force=[0,0,-400],times=[0,1.5,1.6],values=[0,0,1]})",
      R"(constraints[0]={kind="angle_stop",name="s",fold_angle=true,min=40,restitution=0})"}},
    {"four_bar", {R"(constraints[0]={kind="length_stop",nodes=["B","D"],max=3.5,restitution=0.7})"}},
    {"four_bar", {R"(constraints[0]={kind="length_stop",nodes=["B","D"],max=3.5,restitution=0})"}},
    {"four_bar",
     {R"(forces[0]={kind="spring",nodes=["B","D"],stiffness=400,damping=5,tension_only=true,free_length=3.3})"}},
    {"four_bar",
     {R"(forces[0]={kind="friction",rods=["crank","coupler"],axis=[0,1,0],kinetic=14,static=19})"}},
};

}  // namespace

// An event at the end, or as near to it as numbers of that size come: nothing is left out of the run, and
// nothing is refused. Times of events are known to 1e-13 of a run, which may be behind its end by that.
// Between events the motion is smooth, so that runs that end as near to each other end alike, to what
// interpolation between states adds.
TEST_CASE("a run ends where something happens, and steps do, by rounding") {
  int tried = 0;
  for (const Case& one : cases) {
    CAPTURE(one.scene, one.changes);
    const Scene scene = read_scene_file(find_scene(one.scene), one.changes);
    const auto model = build_model(scene);
    for (const bool on_path : {true, false}) {
      CAPTURE(on_path);
      const auto run_to = [&](double end, double step) {
        SolverOptions options = scene.solver;
        options.end_time = end;
        options.step = step;
        return on_path ? simulate_on_path(model, options) : simulate(model, options);
      };
      const Simulation longer = run_to(8.0, scene.solver.step);
      REQUIRE(!longer.events.empty());
      for (std::size_t e = 0; e < std::min<std::size_t>(longer.events.size(), 4); ++e) {
        const double at = longer.events[e].t, unit = std::nextafter(at, 1e9) - at;
        if (!(at > 0)) continue;
        for (const double units : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
          const double parts = std::ceil(at / scene.solver.step);
          CAPTURE(longer.events[e].name, at, units);
          const Trajectory run = run_to(at + 5.5 * scene.solver.step, (at + units * unit) / parts).trajectory;
          for (std::size_t i = 1; i < run.size(); ++i) CHECK(run.time(i) >= run.time(i - 1));
          CHECK(node_distance(run.positions(run.size() - 1),
                              longer.trajectory.positions_at(run.end_time())) <= 1e-5);
        }
        for (const double units : {-400.0, -30.0, -5.0, -2.0, -1.0, 0.0, 1.0, 2.0, 5.0, 30.0, 400.0}) {
          CAPTURE(longer.events[e].name, at, units);
          const double end = at + units * unit;
          const Simulation run = run_to(end, scene.solver.step);
          ++tried;
          CHECK(run.status != RunStatus::failed);
          CHECK(run.trajectory.end_time() == Approx(end).epsilon(1e-12));
          const std::size_t last = run.trajectory.size() - 1;
          CHECK(node_distance(run.trajectory.positions(last), longer.trajectory.positions_at(end)) <= 1e-6);
        }
      }
    }
  }
  CHECK(tried >= 300);
}

// A bob that swings into a stop which it touches at the start, in whatever direction its coordinate is taken:
// rounding puts some a little before the stop. It turns back at t = 0 (restitution 1), and keeps its energy:
// m v^2 / 2 and what it falls by. Nothing is faster than sqrt(v^2 + 2 g (1 + z0)), at the lowest point.
TEST_CASE("what strikes a stop that it touches at the start strikes it at once") {
  const double m = 1.5, g = 9.81, v = 0.8;
  for (int k = 0; k < 40; ++k) {
    const double a = 0.3 + 0.061 * k, tilt = a + 0.4 * std::sin(7.0 * k);  // from the vertical
    const double x = std::sin(a), z = -std::cos(a), dx = -std::cos(tilt), dz = -std::sin(tilt);
    CAPTURE(k);
    const auto vec = [](double a_x, double a_z) {
      return "[" + exact_number(a_x) + ", 0, " + exact_number(a_z) + "]";
    };
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
        "[[structure.nodes]]\nname = 'P'\nmass = " +
            exact_number(m) + "\nposition = " + vec(x, z) +
            "\nvelocity = " + vec(-v * std::cos(a), -v * std::sin(a)) +
            "\n[[structure.rods]]\nnodes = ['O', 'P']\nmass = 0\n[[constraints]]\nkind = 'plane'\nnodes = "
            "['P']\nnormal = [0, 1, 0]\n[[constraints]]\nkind = 'coordinate_stop'\nname = 's'\nnodes = "
            "['P']\nrestitution = 1\ndirection = " +
            vec(dx, dz) + "\nmax = " + exact_number((dx * x + dz * z) / std::hypot(dx, dz)) +
            "\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 0.3\nstep = 0.01\n",
        "bob.toml");
    Simulation run = simulate_on_path(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() >= 1);
    CHECK(run.events.front().t == 0.0);
    const Diagnostics d = judge(run);
    const double top = std::sqrt(v * v + 2 * g * (1 + z));
    CHECK(find_measure("peak_speed").value(run, d) <= top * (1 + 1e-9));
    CHECK(find_measure("peak_energy").value(run, d) <= 0.5 * m * top * top * (1 + 1e-9));
    CHECK(find_measure("peak_rod_force").value(run, d) <= m * (g + top * top) * (1 + 1e-9));
  }
}

// 1 kg beside its stop under a - b t newtons: it leaves by 2/27 a t^2 at most and is back at t = 3 a / b, at
// a t / 2; thrown back with half of that, for the second time after sqrt(3/2) - 1 of t. However long steps
// are beside that, of motions that they hold exactly.
TEST_CASE("a flight from a stop that is much shorter than a step ends when it ends") {
  const double a = 0.7;
  for (const double side : {1.0, -1.0})
    for (const double back : {3e-2, 2e-3, 1.3e-4}) {
      CAPTURE(side, back);
      const Scene scene = read_scene_text(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0.37, 0, 0], mass = 1}]\n"
          "[[constraints]]\nkind = 'line'\nnodes = ['P']\ndirection = [1, 0, 0]\n[[constraints]]\nkind = "
          "'coordinate_stop'\nname = 's'\nnodes = ['P']\ndirection = [" +
              exact_number(side) + ", 0, 0]\nmin = " + exact_number(0.37 * side) +
              "\nrestitution = 0.5\nrest_speed = 1e-9\n[[forces]]\nkind = 'load_over_time'\nnodes = "
              "['P']\nforce = [" +
              exact_number(side) + ", 0, 0]\ntimes = [0, 1]\nvalues = [0.7, " +
              exact_number(a - 3 * a / back) + "]\n[solver]\nend_time = 1\nstep = 0.01\n",
          "flight.toml");
      const Simulation run = simulate_on_path(build_model(scene), scene.solver);
      REQUIRE(run.events.size() >= 2);
      const double speed = 0.5 * a * back, rounding = 1e-15 / speed;  // of the gap, over its rate
      CHECK(run.events[0].name == "stop s");
      CHECK(run.events[0].t == Approx(back).epsilon(1e-13).margin(rounding));
      CHECK(run.events[0].energy_lost ==
            Approx(0.375 * speed * speed).epsilon(1e-11 + 4 * a * rounding / speed));
      CHECK(run.events[1].t == Approx(std::sqrt(1.5) * back).epsilon(1e-13).margin(4 * rounding));
    }
}

}  // namespace event_at_end_test
