// SPDX-License-Identifier: BSD-3-Clause
// Frictions that stops, guides and other frictions hold still, and what must not switch by rounding there.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace held_friction_test {

namespace {

using testing::end_positions, testing::number, testing::run_scene;

std::string node(const std::string& name, double x, double z, const std::string& more) {
  return "[[structure.nodes]]\nname = \"" + name + "\"\nposition = [" + number(x) + ", 0, " + number(z) +
         "]\n" + more + "\n";
}
std::string rod(const std::string& a, const std::string& b, double mass) {
  return "[[structure.rods]]\nnodes = [\"" + a + "\", \"" + b + "\"]\nmass = " + number(mass) + "\n";
}
std::string hinge(const std::string& a, const std::string& b, const std::string& c, double kinetic,
                  double holding) {
  return "[[forces]]\nkind = \"friction\"\nname = \"hinge " + b + "\"\nnodes = [\"" + a + "\", \"" + b +
         "\", \"" + c + "\"]\nkinetic = " + number(kinetic) + "\nstatic = " + number(holding) +
         "\naxis = [0, 1, 0]\n";
}
std::string guide(const std::string& at, double kinetic) {
  return "[[forces]]\nkind = \"friction\"\nname = \"guide\"\nnodes = [\"" + at +
         "\"]\ndirection = [0, 0, 1]\nkinetic = " + number(kinetic) + "\n";
}
const std::string begin = "[structure]\nkind = \"custom\"\n" + node("g", -1, 0, "fixed = true") +
                          node("n0", 0, 0, "fixed = true") + rod("g", "n0", 0.1);
const std::string in_plane =
    "[[structure.constraints]]\nkind = \"plane\"\nnodes = [\"n*\"]\nnormal = [0, 1, 0]\n";

long count(const Simulation& run, const std::string& kind) {
  return std::ranges::count(run.events, kind, &Event::kind);
}

std::string load(const std::string& at, const std::string& force, const std::string& table) {
  return "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"" + at + "\"]\nforce = " + force + "\n" + table;
}
const std::string gravity = "[gravity]\nacceleration = [0, 0, -9.81]\n";

// Two rods on a stop that a hinge holds as well, until its friction gives way towards the stop.
const std::string onto_the_stop =
    begin + node("n1", 0.04668, 0.4564, "mass = 0.5339") + node("n2", 0.4698, 0.8282, "mass = 0.7869") +
    rod("n0", "n1", 0.4001) + rod("n1", "n2", 0.6408) + in_plane + gravity +
    hinge("g", "n0", "n1", 1.444, 1.444) + hinge("n0", "n1", "n2", 0.7392, 0.7392) +
    "[[structure.constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"n1\"]\ndirection = [0, 0, 1]\n"
    "min = 0.4564\nrestitution = 0.3\n";
// A loop of five links that rests on a stop while a hinge elsewhere turns round.
const std::string loop_on_a_stop =
    begin + node("n1", 0.086, 0.64, "mass = 0.68") + node("n2", 0.46, 1.16, "mass = 1.56") +
    node("n3", 0.81, 1.37, "mass = 1.82") + node("n4", 1.21, 1.09, "mass = 1.98") +
    node("n5", 1.33, 0.095, "fixed = true") + rod("n0", "n1", 1.32) + rod("n1", "n2", 0.19) +
    rod("n2", "n3", 1.02) + rod("n3", "n4", 0.76) + rod("n4", "n5", 1.41) + gravity +
    hinge("g", "n0", "n1", 1.18, 1.54) + hinge("n1", "n2", "n3", 0.5, 0.65) +
    hinge("n3", "n4", "n5", 1.58, 1.58) + hinge("n4", "n5", "n0", 2.75, 2.75) +
    "[[structure.constraints]]\nkind = \"length_stop\"\nnodes = [\"n2\", \"n4\"]\nmin = 0.67\n";
// A guide that turns round where its node moves across it, beside nodes that others' friction holds.
const std::string across_the_guide =
    begin + node("n1", 0.47, 0.79, "mass = 0.71") + node("n2", 0.89, 1.04, "mass = 0.56") +
    node("n3", 1.27, 0.88, "mass = 1.82") + node("n4", 1.63, 0.45, "mass = 0.61") + rod("n0", "n1", 0.4) +
    gravity + hinge("g", "n0", "n1", 1.24, 1.61) + hinge("n2", "n3", "n4", 1.87, 1.87) +
    "[[forces]]\nkind = \"friction\"\nnodes = [\"n1\"]\nkinetic = 2.25\ndirection = [1, 0, 0.88]\n" +
    load("n4", "[3.15, 0, 0.5]", "times = [0, 0.46, 0.62, 1.08]\nvalues = [0, 0.71, 0.062, 0.32]\n") +
    "[[structure.constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"n2\"]\ndirection = [1, 0, 0]\nmax = "
    "0.93\n";
// A hinge that gives way on the side of a stop at which it stands without a force.
const std::string beside_the_stop =
    begin + node("n1", 0.264, 0.993, "mass = 0.261") + node("n2", 1.1, 1.5, "mass = 1.9") +
    node("n3", 1.84, 1.4, "mass = 1.09") + rod("n0", "n1", 1.08) + rod("n1", "n2", 0.802) +
    rod("n2", "n3", 0.239) + gravity + hinge("n0", "n1", "n2", 0.766, 0.996) +
    hinge("n1", "n2", "n3", 2.94, 2.94) +
    "[[forces]]\nkind = \"friction\"\nnodes = [\"n1\"]\nkinetic = 2.04\ndirection = [1, 0, 0.292]\n" +
    load("n3", "[-6.3, 0, -8.84]", "times = [0, 0.104, 0.755, 0.827]\nvalues = [0, 0.372, 0.0621, 0.156]\n") +
    "[[structure.constraints]]\nkind = \"length_stop\"\nnodes = [\"n3\", \"n1\"]\nmin = 1.56\n"
    "[[forces]]\nkind = \"spring\"\nnodes = [\"n1\", \"n3\"]\nstiffness = 1468.67\nfree_length = 1.62\n"
    "tension_only = true\n";

}  // namespace

TEST_CASE("a guide's friction turns round at the top of a circle, and a hinge that sticks there sticks on") {
  // Both rods turn as one about n0, with the moment of inertia I. The guide takes its force times the way
  // along z, up to 1 m and down again.
  const double v = 3, start = 0.8;
  const std::string scene = begin + node("n1", std::cos(start), std::sin(start), "mass = 1") +
                            node("n2", 1.3 * std::cos(start), 1.3 * std::sin(start), "mass = 0.5") +
                            rod("n0", "n1", 0.01) + rod("n1", "n2", 0.01) + in_plane +
                            hinge("n0", "n1", "n2", 20, 20) + guide("n1", 1.5) +
                            "[solver]\nstages = 4\nstep = 0.01\nend_time = 0.4\n";
  for (const char* method : {"dvm", "rk4"}) {
    const Simulation run =
        run_scene(scene, {std::string("solver.method=") + method, "solver.step=0.002",
                          "structure.nodes[2].velocity=[" + number(-v * std::sin(start)) + ",0," +
                              number(v * std::cos(start)) + "]",
                          "structure.nodes[3].velocity=[" + number(-1.3 * v * std::sin(start)) + ",0," +
                              number(1.3 * v * std::cos(start)) + "]"});
    INFO(method << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.warnings.empty());
    CHECK(count(run, "reversal") == 1);
    CHECK(count(run, "slip") == 0);
    const VectorXd q = end_positions(run);
    const Eigen::Vector2d first(q[6], q[8]), second(q[9], q[11]);
    // A constraint on the angle keeps it to what rk4 drifts in 200 steps.
    CHECK((second - 1.3 * first).norm() <= 1e-9);
    const double way = 2 - std::sin(start) - first[1];
    const Diagnostics d = diagnose(run);
    const auto& energy = d.at("kinetic_energy_J").values;
    CHECK(first[1] < 0.95);
    // rk4's h^4 of turns of 3 rad/s.
    CHECK(energy.front() - energy.back() == Approx(1.5 * way).epsilon(1e-8));
  }
}

TEST_CASE("of frictions that hold one rod together only those slip that can move") {
  // A load F = t at n2. It bends the hinge n1 with 0.5 F, which holds 1 N m; about n0 it is 1.5 F, which a
  // hinge of 1 N m and a guide of 4 N at 1 m hold up to F = 3.33 N.
  const std::string scene =
      begin + node("n1", 1, 0, "mass = 1") + node("n2", 1.5, 0, "mass = 1") + rod("n0", "n1", 0.1) +
      rod("n1", "n2", 0.1) + in_plane + hinge("g", "n0", "n1", 1, 1) + guide("n1", 4) +
      hinge("n0", "n1", "n2", 1, 1) +
      "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"n2\"]\nforce = [0, 0, -1]\n"
      "times = [0, 3]\nvalues = [0, 3]\n[solver]\nstages = 4\nstep = 0.01\nend_time = 2.5\n";
  for (const char* method : {"dvm", "rk4"}) {
    const Simulation run = run_scene(scene, {std::string("solver.method=") + method});
    INFO(method << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.warnings.empty());
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].element == "hinge n1");
    CHECK(run.events[0].t == Approx(2.0).epsilon(1e-8));  // as in friction_hold_test.cpp
    CHECK(end_positions(run).segment<3>(6).isApprox(Vec3(1, 0, 0), 1e-12));
  }
}

TEST_CASE("frictions beside stops that share their freedom switch as often by every method, and to an end") {
  for (const std::string& scene : {onto_the_stop, loop_on_a_stop, across_the_guide, beside_the_stop}) {
    const std::string text = scene + "[solver]\nend_time = 1.5\n";
    const Simulation run = run_scene(text, {"solver.step=0.002", "solver.stages=4"}),
                     other = run_scene(text, {"solver.step=0.003", "solver.stages=5"}),
                     by_rk4 = run_scene(text, {"solver.step=0.0005", "solver.method=rk4"});
    for (const Simulation* r : {&run, &other, &by_rk4}) {
      INFO(r->message << (r->warnings.empty() ? "" : r->warnings.front()));
      CHECK(r->status == RunStatus::completed);
      CHECK(r->warnings.empty());
      CHECK(r->events.size() == run.events.size());
    }
    // Turns of some 10 rad/s: (10 h)^4 over some hundreds in rk4, twice that order in the others, in motions
    // that part by some tens where they slip.
    CHECK((end_positions(run) - end_positions(other)).lpNorm<Eigen::Infinity>() <= 1e-8);
    CHECK((end_positions(run) - end_positions(by_rk4)).lpNorm<Eigen::Infinity>() <= 1e-6);
  }
}

TEST_CASE("contacts that push one another off come to rest together") {
  // What strikes the stop drives the pin off the rim of its hole, and the rim what rests on the stop: a
  // series without end in a finite time.
  const std::string scene =
      "[structure]\nkind = \"custom\"\n" + node("g", -1, 0, "fixed = true") +
      node("n2", 1.353, 0.7097, "mass = 0.8358") + node("p", 1.357, 0.7097, "mass = 0.3") +
      load("n2", "[4.483, 0, 6.135]",
           "times = [0, 0.3208, 0.3825, 1.301]\nvalues = [0, -0.7829, 0.006183, 0.9436]\n") +
      "[[structure.constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"n2\"]\ndirection = [1, 0, 0]\n"
      "min = 1.353\nrestitution = 0.8\n"
      "[[structure.constraints]]\nkind = \"clearance\"\nnodes = [\"n2\", \"p\"]\nclearance = 0.01974\n"
      "[[forces]]\nkind = \"spring\"\nnodes = [\"p\", \"g\"]\nstiffness = 26.91\ndamping = 2\n"
      "[solver]\nend_time = 1.5\n";
  const Simulation run = run_scene(scene, {"solver.step=0.002", "solver.stages=4"}),
                   other = run_scene(scene, {"solver.step=0.003", "solver.stages=5"}),
                   by_rk4 = run_scene(scene, {"solver.step=0.0005", "solver.method=rk4"});
  for (const Simulation* r : {&run, &other, &by_rk4}) {
    INFO(r->message << (r->warnings.empty() ? "" : r->warnings.front()));
    CHECK(r->status == RunStatus::completed);
    CHECK(r->warnings.empty());
  }
  // Nodes that move at 10 /s against each other; where a series ends depends on what counts as zero, 2e-11 m.
  CHECK((end_positions(run) - end_positions(other)).lpNorm<Eigen::Infinity>() <= 1e-7);
  CHECK((end_positions(run) - end_positions(by_rk4)).lpNorm<Eigen::Infinity>() <= 1e-6);
}

// A pendulum of two rods hangs on its reel and touches the stop below; its elbow, which weighs on friction
// with (1/2 0.83 + 0.19) 0.40 1.22 = 0.30 of 1.57 N m, sticks. At 0.1 s the reel begins to be paid out, its
// rate and acceleration with nothing: the stop takes over at once, the reel is slack and nothing moves.
TEST_CASE("what begins with nothing lets another hold take over when it begins") {
  const std::string scene = "[structure]\nkind = \"custom\"\n" + node("O", 0, 0, "fixed = true") +
                            node("F", -1, 0, "fixed = true") + node("K", 1.69946, 1.79442, "fixed = true") +
                            node("B", 0.7363882632608356, 0.3038763331179779, "mass = 0.130303") +
                            node("C", 1.1392284532468415, 0.8982832759090208, "mass = 0.191997") +
                            rod("O", "B", 1.16686) + rod("B", "C", 0.831559) +
                            hinge("O", "B", "C", 1.13968, 1.5715) + R"([gravity]
acceleration = [0, 0, -1.2229]
[[constraints]]
kind = "angle_stop"
name = "end"
nodes = ["F", "O", "B"]
axis = [0, 1, 0]
max = 157.57612822905512
restitution = 0
[[constraints]]
kind = "cable"
name = "reel"
nodes = ["K", "C"]
motion = "smooth"
to = 1.2
start = 0.1
duration = 0.5
[solver]
stages = 4
end_time = 0.7
)";
  for (const char* step : {"0.004", "0.002", "0.001", "0.0003"}) {
    INFO(step);
    const Simulation run = run_scene(scene, {std::string("solver.step=") + step});
    CHECK(run.warnings.empty());
    REQUIRE(run.events.size() == 3);
    CHECK(run.events[0].name == "reel pulls");
    CHECK(run.events[1].name == "rests on stop end");
    CHECK(run.events[2].name == "reel is slack");
    CHECK(run.events[1].t == Approx(0.1).epsilon(1e-12));
    CHECK(run.events[2].t == Approx(0.1).epsilon(1e-12));
    // Positions to rounding, and twice what counts as touching.
    CHECK((end_positions(run) - run.trajectory.node_positions(0)).lpNorm<Eigen::Infinity>() <= 4e-11);
  }
}

// A node on two rods from a line turns about that line, along which no force moves it: what rubs along it
// rests, and gives nothing, whatever rounding leaves of its acceleration.
TEST_CASE("friction along what cannot move does not slip by rounding") {
  for (const double along : {0.2, 0.6822, 1.0})
    for (const double load : {-19.3389, 3.0, 4e3}) {
      CAPTURE(along, load);
      const std::string scene =
          "[structure]\nkind = 'custom'\n" + node("P0", 0, 0, "fixed = true") +
          node("D", 1.2, 0, "fixed = true") + node("P1", along, 0.5164, "mass = 1\nvelocity = [0, 0.3, 0]") +
          rod("P0", "P1", 0.7) + rod("D", "P1", 0.5) + "[[loads]]\nnodes = ['P1']\nforce = [" + number(load) +
          ", 0, 0]\n[gravity]\nacceleration = [0, 1, -9.81]\n[solver]\nend_time = 0.1\n";
      const Diagnostics without = diagnose(run_scene(scene)),
                        with = diagnose(run_scene(
                            scene, {"forces[0]={kind='friction',nodes=['P1'],direction=[1,0,0],kinetic=5}"}));
      CHECK((with.axial_force - without.axial_force).cwiseAbs().maxCoeff() <=
            1e-9 * without.axial_force.cwiseAbs().maxCoeff());
    }
}

// At rest nothing is accelerated but by rounding, of what the rods bear.
TEST_CASE("friction along what cannot move does not slip by rounding at rest") {
  for (const double along : {0.2, 0.5123, 0.6822, 1.0})
    for (const double load : {-19.3389, 3.0}) {
      CAPTURE(along, load);
      const std::string scene =
          "[structure]\nkind = 'custom'\n" + node("P0", 0, 0, "fixed = true") +
          node("D", 1.2, 0, "fixed = true") + node("P1", along, -0.5, "mass = 1") + rod("P0", "P1", 0.7) +
          rod("D", "P1", 0.5) + "[[loads]]\nnodes = ['P1']\nforce = [" + number(load) +
          ", 0, 0]\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 0.1\n";
      const Diagnostics without = diagnose(run_scene(scene)),
                        with = diagnose(run_scene(
                            scene, {"forces[0]={kind='friction',nodes=['P1'],direction=[1,0,0],kinetic=5}"}));
      CHECK((with.axial_force - without.axial_force).cwiseAbs().maxCoeff() <=
            1e-9 * without.axial_force.cwiseAbs().maxCoeff());
    }
}

// B is led by A, a millionth and less of its way: what holds B holds A, with a million times its force.
TEST_CASE("what rubs at the end of a long lever holds the other end") {
  for (const double lever : {1e-3, 1e-6, 1e-7}) {
    CAPTURE(lever);
    const std::string scene = "[structure]\nkind = 'custom'\nrods = []\n" + node("A", 0, 0, "mass = 1") +
                              node("B", 0, 1, "mass = 1") +
                              "[[constraints]]\nkind = 'line'\nnodes = ['A', 'B']\ndirection = [1, 0, 0]\n"
                              "[[constraints]]\nkind = 'relation'\nnodes = ['A', 'B']\ncoefficients = [" +
                              number(lever) + ", 0, 0, -1, 0, 0]\n";
    const Simulation rests = run_scene(
        scene, {"forces[0]={kind='friction',nodes=['B'],direction=[1,0,0],kinetic=" + number(2 / lever) + "}",
                "loads=[{nodes=['A'],force=[1,0,0]}]", "solver.end_time=1"});
    CHECK(std::abs(end_positions(rests)[0]) <= 1e-12);
    // Thrown back at half of its speed after half a second.
    const Simulation thrown = run_scene(
        scene, {"constraints[2]={kind='coordinate_stop',nodes=['B'],direction=[1,0,0],restitution=0.5,"
                "rest_speed=1e-12,max=" +
                    number(0.5 * lever) + "}",
                "structure.nodes.A.velocity=[1,0,0]",
                "structure.nodes.B.velocity=[" + number(lever) + ",0,0]", "solver.end_time=1"});
    REQUIRE(thrown.status == RunStatus::completed);
    CHECK(end_positions(thrown)[0] ==
          Approx(0.25).epsilon(2e-5));  // of what counts as touching, by the lever
  }
}

// A bead on a wire passes the point that is nearest to D, where their distance turns and no force along it
// moves the bead: friction takes its force times the way of that distance, there and back, and no more. To
// what six stages leave at steps of 0.01 s.
TEST_CASE("friction on a distance lets pass what passes the nearest point") {
  for (int k = 0; k < 24; ++k) {
    const double step = 0.003 + 0.0003 * k, x = 0.1 + 0.017 * k, beside = 0.5 + 0.01 * k;
    CAPTURE(step, x, beside);
    const Simulation run = run_scene("[structure]\nkind = 'custom'\nrods = []\n" +
                                     node("D", x, beside, "fixed = true") +
                                     node("B", -0.57, 0, "mass = 2\nvelocity = [1.3, 0, 0]") + R"(
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[[forces]]
kind = "friction"
name = "f"
nodes = ["D", "B"]
kinetic = 0.5
[solver]
stages = 6
end_time = 1
step = )" + number(step) + "\n");
    REQUIRE(run.status == RunStatus::completed);
    CHECK(count(run, "reversal") == 1);
    CHECK(run.events.size() == 1);
    const double way =
        std::hypot(0.57 + x, beside) + std::hypot(end_positions(run)[3] - x, beside) - 2 * beside;
    CHECK(diagnose(run).at("kinetic_energy_J").values.back() == Approx(1.69 - 0.5 * way).epsilon(1e-8));
  }
}

}  // namespace held_friction_test
