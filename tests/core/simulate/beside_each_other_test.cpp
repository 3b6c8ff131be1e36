// SPDX-License-Identifier: BSD-3-Clause
// What moves beside other things without touching them moves as it does alone, and so do its events.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace beside_each_other_test {

namespace {

using testing::number;

std::string node(const std::string& name, const Vec3& at, const std::string& more) {
  return "[[structure.nodes]]\nname = '" + name + "'\nposition = [" + number(at[0]) + ", " + number(at[1]) +
         ", " + number(at[2]) + "]\n" + more + "\n";
}

std::string guide(const std::string& name, const char* direction) {
  return "[[structure.constraints]]\nkind = 'line'\nnodes = ['" + name + "']\ndirection = " + direction +
         "\n";
}

// A ball over a floor.
std::string ball(const std::string& name, double height, double mass, double restitution) {
  return node(name, {0.3, 0.1, height}, "mass = " + number(mass)) +
         "[[constraints]]\nkind = 'coordinate_stop'\nname = '" + name + "_floor'\nnodes = ['" + name +
         "']\ndirection = [0, 0, 1]\nmin = 0.05\nrestitution = " + number(restitution) + "\n";
}

// A block on a spring that rubs.
std::string block(const std::string& name, double stiffness, double mass, double kinetic) {
  return node(name + "_wall", {0, 1, 0}, "fixed = true") + node(name, {1.4, 1, 0}, "mass = " + number(mass)) +
         guide(name, "[1, 0, 0]") + "[[forces]]\nkind = 'spring'\nnodes = ['" + name + "_wall', '" + name +
         "']\nfree_length = 1\nstiffness = " + number(stiffness) +
         "\n[[forces]]\nkind = 'friction'\nname = '" + name + "_pad'\nnodes = ['" + name +
         "']\ndirection = [1, 0, 0]\nkinetic = " + number(kinetic) + "\n";
}

// A weight that falls into its cable.
std::string weight(const std::string& name, double length, double mass, double stiffness) {
  return node(name + "_top", {0.2, 2, 3}, "fixed = true") +
         node(name, {0.2, 2, 2.9}, "mass = " + number(mass)) + guide(name, "[0, 0, 1]") +
         "[[forces]]\nkind = 'spring'\nname = '" + name + "_cable'\nnodes = ['" + name + "_top', '" + name +
         "']\ntension_only = true\nfree_length = " + number(length) + "\nstiffness = " + number(stiffness) +
         "\ndamping = " + number(0.002 * stiffness) + "\n";
}

// An arm in a level plane that a controller turns, at full voltage for a while.
std::string arm(const std::string& name, double mass, double rate, double proportional) {
  const std::string hinge = name + "_hinge", way = name + "_way";
  return node(hinge, {0, 3, 0}, "fixed = true") + node(way, {1, 3, 0}, "fixed = true") +
         node(name, {0.3, 3.4, 0}, "mass = " + number(mass)) + "[[structure.rods]]\nnodes = ['" + hinge +
         "', '" + name + "']\nmass = 0\n[[structure.constraints]]\nkind = 'plane'\nnodes = ['" + name +
         "']\nnormal = [0, 0, 1]\n[[forces]]\nkind = 'motor'\nname = '" + name + "_motor'\nnodes = ['" + way +
         "', '" + hinge + "', '" + name +
         "']\naxis = [0, 0, 1]\nstall_torque = 0.03\nno_load_speed = 3000\ngear_ratio = 20\ncontrol = "
         "'rate'\nmotion = 'rate'\nrate = " +
         number(rate) + "\nproportional = " + number(proportional) + "\n";
}

Simulation run_of(const std::vector<std::string>& units) {
  std::string text = "structure.kind = 'custom'\n";
  for (const std::string& unit : units) text += unit;
  return testing::run_scene(
      text + "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nstep = 0.005\nend_time = 0.9\n");
}

// Of nodes alone, one unit after the other, and all events in the order of time.
void check(const std::vector<std::string>& units) {
  const Simulation all = run_of(units);
  REQUIRE(all.status == RunStatus::completed);
  const VectorXd together = testing::end_positions(all);
  std::vector<Event> events;
  Index first = 0;
  for (const std::string& unit : units) {
    INFO(unit);
    const Simulation alone = run_of({unit});
    REQUIRE(alone.status == RunStatus::completed);
    const VectorXd end = testing::end_positions(alone);
    CHECK((together.segment(first, end.size()) - end).lpNorm<Eigen::Infinity>() <= 1e-8);
    first += end.size();
    events.insert(events.end(), alone.events.begin(), alone.events.end());
  }
  CHECK(first == together.size());
  std::ranges::stable_sort(events, {}, &Event::t);
  REQUIRE(all.events.size() == events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    CHECK(all.events[i].name == events[i].name);
    CHECK(all.events[i].t == Approx(events[i].t).epsilon(0).margin(1e-8));
    CHECK(all.events[i].energy_lost == Approx(events[i].energy_lost).epsilon(0).margin(1e-7));
  }
}

}  // namespace

// The stiffest cable swings by 0.26 rad in a step, of which four stages leave 1e-10: steps end where others'
// events are.
TEST_CASE("stops and frictions and cables and motors act beside others of their kind as alone") {
  check({ball("a", 0.47, 1.3, 0.7), ball("b", 0.31, 0.4, 0.55), ball("c", 0.62, 0.9, 0.0)});
  check({block("a", 210, 1.3, 9.0), block("b", 140, 0.7, 5.0), block("c", 320, 2.1, 31.0)});
  check({weight("a", 0.4, 1.3, 900), weight("b", 0.6, 0.8, 2100), weight("c", 0.25, 2.2, 1700)});
  check({arm("a", 0.7, 60, 2.5), arm("b", 0.4, 90, 1.7), arm("c", 1.1, -40, 3.1)});
}

TEST_CASE("stops and frictions and cables and motors act beside each other as alone") {
  const std::vector<std::string> units{
      arm("a", 0.7, 60, 2.5),     weight("b", 0.4, 1.3, 900),  ball("c", 0.47, 1.3, 0.7),
      block("d", 210, 1.3, 9.0),  arm("e", 1.1, -40, 3.1),     ball("f", 0.62, 0.9, 0.0),
      block("g", 320, 2.1, 31.0), weight("h", 0.6, 0.8, 2100),
  };
  check(units);
  check({units.rbegin(), units.rend()});
}

// Blocks on guides: some lie at their stops, loads -a + b t press them on and pull them off at a / b; others
// are held by friction until b t is more than that. From then on x = b (t - t_0)^3 / 6 m, less what rubs.
TEST_CASE("of many that rest on stops and frictions each leaves when its own load says") {
  struct Block {
    const char* name;
    double mass, holding, kinetic, rise;  // holding: of a stop as well
    bool stop;
    double leaves() const { return holding / rise; }
  };
  const std::vector<Block> blocks{{"a", 1.3, 7, 0, 13, true}, {"b", 0.7, 5, 3, 8, false},
                                  {"c", 2.1, 9, 0, 11, true}, {"d", 0.9, 4, 1, 19, false},
                                  {"e", 1.7, 2, 0, 6, true},  {"f", 1.1, 6, 2, 7, false}};
  std::string text = "structure.kind = 'custom'\n";
  for (const Block& b : blocks) {
    const std::string name = b.name;
    text += node(name, {0.4, 0.1, 0}, "mass = " + number(b.mass)) + guide(name, "[1, 0, 0]");
    text += b.stop ? "[[constraints]]\nkind = 'coordinate_stop'\nname = '" + name + "'\nnodes = ['" + name +
                         "']\ndirection = [1, 0, 0]\nmin = 0.4\n"
                   : "[[forces]]\nkind = 'friction'\nname = '" + name + "'\nnodes = ['" + name +
                         "']\ndirection = [1, 0, 0]\nkinetic = " + number(b.kinetic) +
                         "\nstatic = " + number(b.holding) + "\n";
    const double from = b.stop ? -b.holding : 0;
    text += "[[forces]]\nkind = 'load_over_time'\nnodes = ['" + name +
            "']\nforce = [1, 0, 0]\ntimes = [0, 2]\nvalues = [" + number(from) + ", " +
            number(from + 2 * b.rise) + "]\n";
  }
  const Simulation run = testing::run_scene(text + "[solver]\nstages = 3\nstep = 0.03\nend_time = 1.1\n");
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd q = testing::end_positions(run);
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const Block& b = blocks[k];
    INFO(b.name);
    const auto leaves = [&](const Event& e) {
      return e.element == b.name && e.kind == (b.stop ? "free" : "slip");
    };
    REQUIRE(std::ranges::count_if(run.events, leaves) == 1);
    CHECK(std::ranges::find_if(run.events, leaves)->t == Approx(b.leaves()).epsilon(0).margin(1e-9));
    // Cubes of time, which three stages have exactly, and squares of what the force jumps by.
    const double t = 1.1 - b.leaves(), jump = b.stop ? 0 : b.holding - b.kinetic;
    CHECK(q[3 * static_cast<Index>(k)] ==
          Approx(0.4 + (b.rise * t * t * t / 6 + jump * t * t / 2) / b.mass).epsilon(0).margin(1e-8));
  }
}

}  // namespace beside_each_other_test
