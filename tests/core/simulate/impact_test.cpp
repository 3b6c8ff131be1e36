// SPDX-License-Identifier: BSD-3-Clause
// Blows that follow one another at one time: a body between a wall and another one.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/integrators/integrator.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace impact_test {

using testing::number;
using testing::run_scene;

namespace {

struct Body {
  double mass, velocity;
};

// Bodies in a row along x, half a metre apart and free to go apart, the first of them on a wall or by `gap`
// off it and each as much farther from the one before.
std::string row(const std::vector<Body>& bodies, double gap, double restitution, double end) {
  std::string nodes, names, stops;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const std::string name = "P" + std::to_string(k), comma = k > 0 ? ", " : "";
    nodes += comma + "{name = \"" + name + "\", position = [" +
             number(1 + 0.5 * static_cast<double>(k) + gap * static_cast<double>(k + 1)) +
             ", 0, 0], mass = " + number(bodies[k].mass) + ", velocity = [" + number(bodies[k].velocity) +
             ", 0, 0]}";
    names += comma + "\"" + name + "\"";
    stops += "[[constraints]]\n";
    stops += k == 0 ? "kind = \"coordinate_stop\"\nnodes = [\"P0\"]\ndirection = [1, 0, 0]\nmin = 1\n"
                    : "kind = \"length_stop\"\nnodes = [\"P" + std::to_string(k - 1) + "\", \"" + name +
                          "\"]\nmin = 0.5\n";
    stops += "restitution = " + number(restitution) + "\n";
  }
  return "[structure]\nkind = \"custom\"\nnodes = [" + nodes +
         "]\n[[structure.constraints]]\nkind = \"line\"\nnodes = [" + names + "]\ndirection = [1, 0, 0]\n" +
         stops + "[solver]\nstep = 0.01\nend_time = " + number(end) + "\n";
}

double kinetic(const Diagnostics& d) {
  return d.at("kinetic_energy_J").values.back();
}
double speed(const Simulation& run, Index body) {
  return run.trajectory.node_velocities(run.trajectory.size() - 1)[3 * body];
}

// Of two or three bodies whose gaps are too small to be anything: what is approached strikes, whichever
// first, until nothing is.
std::vector<double> one_after_the_other(std::vector<Body> bodies, double e) {
  for (bool struck = true; struck;) {
    struck = false;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      Body& b = bodies[k];
      const double closing = (k > 0 ? bodies[k - 1].velocity : 0.0) - b.velocity;
      if (!(closing > 0)) continue;
      struck = true;
      const double against = k > 0 ? bodies[k - 1].mass : HUGE_VAL;
      const double reduced = std::isinf(against) ? b.mass : b.mass * against / (b.mass + against);
      const double impulse = (1 + e) * closing * reduced;
      b.velocity += impulse / b.mass;
      if (k > 0) bodies[k - 1].velocity -= impulse / against;
    }
  }
  std::vector<double> out;
  for (const Body& b : bodies) out.push_back(b.velocity);
  return out;
}

}  // namespace

// It leaves the wall at 1 m/s while another comes at 2: thrown back, to the wall, and on behind the other.
TEST_CASE("what is being left is struck by the next blow, not pushed along") {
  for (const double e : {1.0, 0.8, 0.5, 0.3}) {
    INFO(e);
    const std::vector<Body> bodies{{1, 1}, {1, -2}};
    const std::vector<double> wanted = one_after_the_other(bodies, e);
    const Simulation run = run_scene(row(bodies, 0, e, 0.1));
    REQUIRE(run.status == RunStatus::completed);
    for (const Index k : {0, 1})
      CHECK(speed(run, k) == Approx(wanted[static_cast<std::size_t>(k)]).epsilon(1e-12));
    const Diagnostics d = diagnose(run);
    double told = 0;
    for (const Event& event : run.events) told += event.energy_lost;
    CHECK(told == Approx(2.5 - kinetic(d)).epsilon(0).margin(1e-12));
    CHECK(d.at("impact_loss_J").values.back() == Approx(2.5 - kinetic(d)).epsilon(0).margin(1e-12));
  }
}

// 1 mg between a wall and 10 kg, without loss: some 31 000 blows turn the heavy one round, at its own speed
// but for the share of the light one, a millionth.
TEST_CASE("as many blows follow one another as masses of ten million to one take") {
  const Simulation run = run_scene(row({{1e-6, -3}, {10, -1}}, 0, 1, 0.02));
  REQUIRE(run.status == RunStatus::completed);
  CHECK(kinetic(diagnose(run)) == Approx(5 + 4.5e-6).epsilon(1e-8));
  CHECK(speed(run, 1) == Approx(1).epsilon(1e-5));
}

// 10 g between a wall and 10 kg that come at 1 m/s: at a restitution of 0.9 the light one cannot give back
// what it takes, and both end at the wall, whatever the gaps were, which nothing has a length to compare
// with.
TEST_CASE("a light body between a wall and a heavy one stops it, in whatever gap") {
  for (const double gap : {0.0, 1e-9, 1e-7, 1e-5, 1e-3, 0.1}) {
    INFO(gap);
    const Simulation run = run_scene(row({{0.01, -3}, {10, -1}}, gap, 0.9, 0.5));
    REQUIRE(run.status == RunStatus::completed);
    CHECK(kinetic(diagnose(run)) < 1e-9);
  }
}

// Gaps of zero, velocities, masses and restitutions at random: no impact gives energy, what bodies are left
// with approaches nothing, and where two bodies are struck one after the other they move as one blow after
// the other has it.
TEST_CASE("impacts of bodies in a row give no energy") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t count = 2 + static_cast<std::size_t>(trial % 3);
    std::vector<Body> bodies;
    double before = 0;
    for (std::size_t k = 0; k < count; ++k) {
      bodies.push_back({std::pow(10.0, any(random)), 3 * any(random)});
      before += 0.5 * bodies[k].mass * bodies[k].velocity * bodies[k].velocity;
    }
    const double e = 0.6 + 0.4 * any(random);
    INFO("trial " << trial << ", e = " << e);
    const Simulation run = run_scene(row(bodies, 0, e, 0.02));
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    CHECK(kinetic(d) <= before * (1 + 1e-12));
    CHECK(d.at("impact_loss_J").values.back() ==
          Approx(before - kinetic(d)).epsilon(0).margin(1e-12 * before));
    double last = 0;
    for (std::size_t k = 0; k < count; ++k) {
      CHECK(speed(run, static_cast<Index>(k)) >= last - 1e-6);
      last = speed(run, static_cast<Index>(k));
    }
  }
}

// A point in the corner of two to four frictionless walls that lean over each other, thrown at some of them
// while it leaves others: what no wall takes is left, all of it without loss, and no wall is approached then.
TEST_CASE("impacts in a corner of several walls give no energy") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (int trial = 0; trial < 120; ++trial) {
    const double e = trial % 2 == 0 ? 1.0 : 0.2 + 0.7 * any(random), way = 6.2 * any(random);
    const double vx = 2 * std::cos(way), vy = 2 * std::sin(way);
    std::string walls;
    std::vector<std::array<double, 2>> normals;
    for (int k = 0; k < 2 + trial % 3; ++k) {
      const double turn = 0.2 + 2.7 * any(random);
      normals.push_back({std::cos(turn), std::sin(turn)});
      walls += "[[constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"P\"]\nmin = 0\ndirection = [" +
               number(normals.back()[0]) + ", " + number(normals.back()[1]) +
               ", 0]\nrest_speed = 0\nrestitution = " + number(e) + "\n";
    }
    INFO("trial " << trial << ", e = " << e << "\n" << walls << "velocity " << vx << ", " << vy);
    const Simulation run = run_scene(
        "[structure]\nkind = \"custom\"\nnodes = [{name = \"P\", position = [0, 0, 0], mass = 1, velocity = "
        "[" +
        number(vx) + ", " + number(vy) +
        ", 0]}]\n[[structure.constraints]]\nkind = \"plane\"\nnodes = [\"P\"]\nnormal = [0, 0, 1]\n" + walls +
        "[solver]\nstep = 0.01\nend_time = 0.02\n");
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const double left = kinetic(d);
    CHECK(left <= 2 * (1 + 1e-12));
    if (e == 1.0) CHECK(left == Approx(2).epsilon(1e-12));
    CHECK(d.at("impact_loss_J").values.back() == Approx(2 - left).epsilon(0).margin(1e-12));
    const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
    for (const auto& [nx, ny] : normals) CHECK(nx * v[0] + ny * v[1] >= -1e-9);
  }
}

// A bob on a taut string of 1 m swings from rest against a wall that takes nothing: the string holds before
// and behind it, so that it leaves with all of its speed. By heights that is v = 2.81 m/s; a method of order
// 2 has it to h^2 times a jerk of v^3 / l^2 + 3 g v / l = 105 m/s^3, and the string's own rate drifts by as
// much.
TEST_CASE("what holds keeps out of an impact whatever a method leaves of its rate") {
  const std::string held_by[] = {"kind = 'cable'\nnodes = ['O', 'B']\n",
                                 "kind = 'length_stop'\nnodes = ['O', 'B']\nmax = 1\nrestitution = 0\n"};
  const double g = 9.81, low = std::sqrt(1 - 0.7 * 0.7), high = std::sqrt(1 - 0.95 * 0.95),
               speed = std::sqrt(2 * g * (low - high));
  for (const std::string& holds : held_by) {
    const std::string scene =
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = "
        "'B', "
        "position = [-0.95, 0, " +
        number(-high) +
        "], mass = 1}]\n[gravity]\nacceleration = [0, 0, -9.81]\n[[constraints]]\nkind = 'plane'\nnodes = "
        "['B']\nnormal = [0, 1, 0]\n[[constraints]]\n" +
        holds +
        "[[constraints]]\nkind = 'coordinate_stop'\nname = 'wall'\nnodes = ['B']\ndirection = [1, 0, 0]\nmax "
        "= -0.7\nrestitution = 1\n[solver]\nend_time = 0.5\n";
    for (const Method& method : methods())
      for (const double rho : {0.0, 0.5, 0.9, 1.0})
        for (const double h : {0.01, 0.004, 0.001, 0.00025}) {
          if (method.name != "generalized_alpha" && rho > 0) continue;
          INFO(holds << method.name << ", rho_inf = " << rho << ", h = " << h);
          const Simulation run =
              run_scene(scene, {"solver.method=" + std::string(method.name), "solver.rho_inf=" + number(rho),
                                "solver.step=" + number(h)});
          REQUIRE(run.status == RunStatus::completed);
          const auto wall = std::ranges::find(run.events, "stop wall", &Event::name);
          REQUIRE(wall != run.events.end());
          CHECK(wall->energy_lost == Approx(0).epsilon(0).margin(105 * speed * h * h));
          std::size_t behind = 0;
          while (run.trajectory.time(behind) <= wall->t) ++behind;
          const VectorXd v = run.trajectory.node_velocities(behind - 1);
          CHECK(v[3] == Approx(-speed * low).epsilon(0).margin(105 * h * h + 1e-7));
          CHECK(v[5] == Approx(speed * 0.7).epsilon(0).margin(105 * h * h + 1e-7));
          CHECK(std::ranges::count(run.events, "wall", &Event::element) == 1);
        }
  }
}

// Two bodies of which one goes twice as fast as the other, each at its own wall: one freedom meets both, and
// the least impulses, of unit work each, take as much at either wall, whatever the bodies weigh. A third body
// has nothing to do with them and meets its wall at the same time. What throws back as it came loses nothing,
// nor a negative rounding.
TEST_CASE("walls that meet one freedom at once share what is lost") {
  for (const double e : {0.0, 0.5, 1.0})
    for (const bool turned : {false, true}) {
      std::array<std::string, 2> walls;
      for (const int k : {0, 1})
        walls[static_cast<std::size_t>(k)] =
            "[[constraints]]\nkind = 'coordinate_stop'\nname = '" + std::string(k == 0 ? "a" : "b") +
            "'\nnodes = ['" + (k == 0 ? "A" : "B") +
            "']\ndirection = [1, 0, 0]\nmax = " + number(k == 0 ? 0.3 : 0.6) +
            "\nrestitution = " + number(e) + "\n";
      const Simulation run = run_scene(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], mass = 0.7, velocity = "
          "[1.5, 0, 0]}, {name = 'B', position = [0, 1, 0], mass = 3.1, velocity = [3, 0, 0]}, {name = 'C', "
          "position = [0, 2, 0], mass = 2.3, velocity = [-1.5, 0, 0]}]\nconstraints = [{kind = 'line', nodes "
          "= ['A', 'B', 'C'], direction = [1, 0, 0]}]\n[solver]\nend_time = 0.25\n[[constraints]]\nkind = "
          "'combination'\nterms = ['2 coordinate A along 1 0 0', '-1 coordinate B along 1 0 0']\n" +
          walls[turned ? 1 : 0] + walls[turned ? 0 : 1] +
          "[[constraints]]\nkind = 'coordinate_stop'\nname = 'c'\nnodes = ['C']\ndirection = [1, 0, 0]\n"
          "min = -0.3\nrestitution = " +
          number(e) + "\n");
      INFO(e << " | " << turned << " | " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const auto lost = [&](const char* wall) {
        const auto event = std::ranges::find(run.events, wall, &Event::element);
        REQUIRE(event != run.events.end());
        return event->energy_lost;
      };
      const double of_pair = 0.5 * (0.7 * 1.5 * 1.5 + 3.1 * 3 * 3) * (1 - e * e),
                   of_third = 0.5 * 2.3 * 1.5 * 1.5 * (1 - e * e);
      // 1e-10 is the square of the cost of impulses, 1e-11 what rounding leaves of a system of that cost.
      CHECK(lost("a") == Approx(0.5 * of_pair).epsilon(1e-9).margin(0));
      CHECK(lost("b") == Approx(0.5 * of_pair).epsilon(1e-9).margin(0));
      CHECK(lost("c") == Approx(of_third).epsilon(1e-9).margin(0));
      CHECK(lost("a") + lost("b") + lost("c") == Approx(of_pair + of_third).epsilon(1e-13).margin(0));
    }
}

// A distance that a stop keeps from below and a cable along a rod from above, in a chain that turns: what the
// rates of a method miss of the rod's row is a rate that neither can give way to. It met a wall then that
// threw nothing back, as no impulses had an answer.
TEST_CASE("what a stop and a cable hold between them is no obstacle to an impact elsewhere") {
  struct Case {
    double turn, wall, step;
  };
  for (const auto& [turn, wall, step] :
       {Case{1, 0.3, 2.5e-4}, {1, 0.05, 5e-4}, {2.3, 0.05, 1.3e-3}, {2.3, 0.05, 1e-4}}) {
    const std::string scene =
        "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], mass = 1}, {name = 'B', "
        "position = [1, 0, 0], mass = 1, velocity = [0, " +
        number(turn) + ", 0]}, {name = 'C', position = [1.6, 0.8, 0], mass = 1, velocity = [" +
        number(-0.8 * turn) + ", " + number(1.6 * turn) +
        ", 0]}]\nrods = [{nodes = ['A', 'B'], mass = 1}]\n[[constraints]]\nkind = 'length_stop'\nnodes = "
        "['B', 'C']\nmin = 1\n[[constraints]]\nkind = 'cable'\nnodes = ['A', 'B', 'C']\n[[constraints]]\n"
        "kind = 'coordinate_stop'\nname = 'wall'\nnodes = ['B']\ndirection = [0, 1, 0]\nmax = " +
        number(wall) + "\nrestitution = 1\n[solver]\nend_time = 0.35\n";
    const Simulation run =
        run_scene(scene, {"solver.method=generalized_alpha", "solver.step=" + number(step)});
    INFO(turn << " | " << wall << " | " << step << " | " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    const auto met = std::ranges::find(run.events, "wall", &Event::element);
    REQUIRE(met != run.events.end());
    CHECK(met->energy_lost == Approx(0).epsilon(0).margin(1e-7));  // impulses of 10 N s, rates off by 1e-9
    const Simulation other = run_scene(scene, {"solver.stages=4", "solver.step=0.002"});
    REQUIRE(other.status == RunStatus::completed);
    // Of order 2, with third derivatives of up to turn^3 times 2 m.
    const VectorXd off = testing::end_positions(run) - testing::end_positions(other);
    CHECK(off.lpNorm<Eigen::Infinity>() <= std::pow(turn, 3) * step * step + 1e-9);
  }
}

// The same bob, and far from it a drive whose velocity jumps: that is nothing to the string.
TEST_CASE("what holds is not left where a drive jumps that has nothing to do with it") {
  const std::string scene =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = 'B', "
      "position = [0, 0, 1], mass = 1, velocity = [7, 0, 0]}, {name = 'C', position = [3, 0, 0], mass = 1}]\n"
      "rods = [{nodes = ['O', 'C'], mass = 0}]\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n[[constraints]]\nkind = 'coordinate'\nnodes = "
      "['C']\ndirection "
      "= [0, 0, 1]\nmotion = 'rate'\nrate = 0.5\nstart = 0.30012\n[[constraints]]\nkind = 'cable'\nnodes = "
      "['O', 'B']\n[solver]\nend_time = 0.4\n";
  for (const Method& method : methods())
    for (const double h : {0.01, 0.004, 0.001}) {
      INFO(method.name << ", h = " << h);
      const Simulation run =
          run_scene(scene, {"solver.method=" + std::string(method.name), "solver.step=" + number(h)});
      REQUIRE(run.status == RunStatus::completed);
      CHECK(run.events.size() == 1);  // the string pulls from the start
    }
}

}  // namespace impact_test
