// SPDX-License-Identifier: BSD-3-Clause
// Rows of blocks at rest, with friction, stops between them and walls: when they set out, and what is told of
// it, against statics.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace row_at_rest_test {

namespace {

using testing::number, testing::run_scene;

constexpr double unbounded = std::numeric_limits<double>::infinity();

// Blocks 1 m apart. What pushes or pulls between neighbours, and at the walls at both ends, is in [least,
// most]: 0 or unbounded, without play.
struct Row {
  struct Link {
    double least, most;  // of the push [N]
  };
  std::vector<double> F, G, holding, kinetic, mass;
  std::vector<Link> links;  // one more than blocks: the first and the last are walls

  // Is there a push for each link and a force within its limit for each friction, such that all rest? What
  // pushes block i to the right is what it gives on, but for its load and friction: an interval of values.
  bool holds(double t) const {
    double low = links[0].least, high = links[0].most;
    for (std::size_t i = 0; i < F.size(); ++i) {
      const double load = F[i] + G[i] * t;
      low = std::max(links[i + 1].least, low + load - holding[i]);
      high = std::min(links[i + 1].most, high + load + holding[i]);
      if (high < low) return false;
    }
    return true;
  }

  // Times at which it holds are an interval, as loads are linear in time.
  double sets_out(double end) const {
    double a = 0, b = end;
    for (int k = 0; k < 60; ++k) (holds((a + b) / 2) ? a : b) = (a + b) / 2;
    return b;
  }

  // `along`: the direction of the line, a unit vector.
  std::string scene(const Vec3& along) const {
    std::string text = "[structure]\nkind = 'custom'\nrods = []\n", rest;
    const auto vector = [&](double size) {
      return "[" + number(size * along.x()) + ", " + number(size * along.y()) + ", " +
             number(size * along.z()) + "]";
    };
    const std::string direction = "direction = " + vector(1) + "\n";
    const auto stop = [&](const std::string& kind, const char* bound, double at) {
      rest += "[[constraints]]\nkind = " + kind + "\n" + bound + " = " + number(at) + "\n";
    };
    for (std::size_t i = 0; i <= F.size(); ++i) {
      const bool first = i == 0, last = i == F.size();
      const double at = first ? 0.0 : last ? static_cast<double>(i - 1) : 1.0;
      const std::string kind =
          first || last
              ? "'coordinate_stop'\nnodes = ['P" + std::to_string(last ? i - 1 : 0) + "']\n" + direction
              : "'length_stop'\nnodes = ['P" + std::to_string(i - 1) + "', 'P" + std::to_string(i) + "']\n";
      if (links[i].most > 0) stop(kind, last ? "max" : "min", at);
      if (links[i].least < 0) stop(kind, last ? "min" : "max", at);
      if (last) break;
      const std::string name = "'P" + std::to_string(i) + "'", nodes = "nodes = [" + name + "]\n";
      text += "[[structure.nodes]]\nname = " + name + "\nposition = " + vector(static_cast<double>(i)) +
              "\nmass = " + number(mass[i]) + "\n";
      rest += "[[forces]]\nkind = 'friction'\nname = " + name + "\n" + nodes + direction +
              "kinetic = " + number(kinetic[i]) + "\nstatic = " + number(holding[i]) +
              "\n[[forces]]\nkind = 'load_over_time'\n" + nodes + "force = " + vector(1) +
              "\ntimes = [0, 5]\nvalues = [" + number(F[i]) + ", " + number(F[i] + 5 * G[i]) + "]\n";
    }
    return text + "[[constraints]]\nkind = 'line'\nnodes = ['P*']\n" + direction + rest;
  }
};

// Rests at first, and not for good.
Row random_row(std::mt19937& random, std::size_t blocks) {
  const auto in = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (;;) {
    Row row;
    for (std::size_t i = 0; i <= blocks; ++i) {
      const bool wall = i == 0 || i == blocks;
      row.links.push_back({in(0, 1) < (wall ? 0.2 : 0.3) ? -unbounded : 0.0,
                           in(0, 1) < (wall ? 0.3 : 0.85) ? unbounded : 0.0});
      if (i == blocks) break;
      row.F.push_back(in(-5, 5));
      row.G.push_back(in(-4, 4));
      row.holding.push_back(in(1, 4));
      row.kinetic.push_back(row.holding.back() * in(0.6, 1));
      row.mass.push_back(in(0.5, 2));
    }
    if (row.holds(0) && !row.holds(3)) return row;
  }
}

}  // namespace

// Tolerance: a margin is located to 1e-9 of the forces, which change by some N per second.
TEST_CASE("rows of blocks set out when statics knows no way and not before") {
  std::mt19937 random(2411);
  const Vec3 directions[] = {Vec3::UnitX(), Vec3(1, 2, -2) / 3};
  for (std::size_t trial = 0; trial < 40; ++trial) {
    const Row row = random_row(random, 2 + trial % 4);
    const double at = row.sets_out(3);
    const std::string text =
        row.scene(directions[trial / 4 % 2]) + "[solver]\nstep = 0.05\nend_time = " + number(at + 0.1) + "\n";
    for (const char* method : {"dvm", "rk4_projected"}) {
      const Simulation run = run_scene(text, {std::string("solver.method=") + method});
      CAPTURE(trial, method, at, run.message);
      for (const Event& event : run.events) UNSCOPED_INFO(event.name << " at " << event.t);
      CHECK(run.status == RunStatus::completed);
      CHECK(run.warnings == std::vector<std::string>{});
      CHECK(run.events.size() < 5 * row.F.size());
      double slips = unbounded, moves = unbounded;
      for (const Event& event : run.events)
        if (event.kind == "slip") slips = std::min(slips, event.t);
      for (std::size_t i = run.trajectory.size(); i-- > 0;)
        if (run.trajectory.node_velocities(i).cwiseAbs().maxCoeff() > 1e-9) moves = run.trajectory.time(i);
      CHECK(slips == Approx(at).epsilon(0).margin(1e-7));
      CHECK(moves >= at - 1e-7);
      CHECK(moves < unbounded);
    }
  }
}

// B is pushed at constant rate beside A, which slides: the push between them is mass[B] a - load and changes
// its sign once, where it changes over from one stop to the other one.
TEST_CASE("the push between blocks that slide changes over once between opposite stops without play") {
  constexpr double mass[] = {1.5, 0.7}, kinetic = 1.9, F[] = {-4, -3}, G = 5;
  // a (m_A + m_B) = F_A + F_B + G t + kinetic, as both go to the left; m_B a = F_B + G t there
  const double share = mass[1] / (mass[0] + mass[1]);
  const double at = (share * (F[0] + F[1] + kinetic) - F[1]) / (G * (1 - share));
  const std::string text =
      "[structure]\nkind = 'custom'\nrods = []\n[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nmass "
      "= 1.5\n[[structure.nodes]]\nname = 'B'\nposition = [1, 0, 0]\nmass = 0.7\n[[constraints]]\nkind = "
      "'line'\nnodes = ['A', 'B']\ndirection = [1, 0, 0]\n[[constraints]]\nkind = 'length_stop'\nname = "
      "'near'\nnodes = ['A', 'B']\nmin = 1\n[[constraints]]\nkind = 'length_stop'\nname = 'far'\nnodes = "
      "['A', 'B']\nmax = 1\n[[forces]]\nkind = 'friction'\nname = 'f'\nnodes = ['A']\ndirection = [1, 0, "
      "0]\nkinetic = 1.9\n[[loads]]\nnodes = ['A']\nforce = [-4, 0, 0]\n[[forces]]\nkind = "
      "'load_over_time'\nnodes = ['B']\nforce = [1, 0, 0]\ntimes = [0, 1]\nvalues = [-3, 2]\n"
      "[solver]\nend_time = 0.5\n";
  for (const char* method : {"dvm", "rk4", "rk4_projected", "generalized_alpha"}) {
    const Simulation run = run_scene(text, {std::string("solver.method=") + method});
    CAPTURE(method, run.message);
    for (const Event& event : run.events) UNSCOPED_INFO(event.name << " at " << event.t);
    CHECK(run.warnings == std::vector<std::string>{});
    REQUIRE(run.events.size() == 3);
    CHECK(run.events[0].name == "rests on stop near");
    CHECK(run.events[1].name == "leaves stop near");
    CHECK(run.events[2].name == "rests on stop far");
    for (const std::size_t i : {1U, 2U}) CHECK(run.events[i].t == Approx(at).epsilon(1e-4));
  }
}

}  // namespace row_at_rest_test
