// SPDX-License-Identifier: BSD-3-Clause
// Forces that a controller sets where friction, a stop or a cable gives way to them, or does not.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "core/integrators/index1.hpp"
#include "core/simulate/stepper.hpp"
#include "tests/support/models.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pushed_sides_test {

namespace {

using testing::dvm_options, testing::model_of, testing::number;

constexpr double mass = 1.7, gravity = 9.81, kinetic = 6, holding = 10;

// A mass on a line along x.
const std::string mass_on_a_line =
    "gravity = {acceleration = [0, 0, -9.81]}\n[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = "
    "'P'\n"
    "position = [0.2, 0, 0]\nmass = 1.7\n[[structure.nodes]]\nname = 'H'\nposition = [0.2, 0, 1.3]\nfixed = "
    "true\n";
const std::string friction =
    "[[constraints]]\nkind = 'line'\nnodes = ['P']\ndirection = [1, 0, 0]\n[[forces]]\nkind = "
    "'friction'\nname "
    "= 'guide'\nnodes = ['P']\ndirection = [1, 0, 0]\nkinetic = 6\nstatic = 10\n";
const std::string upright = "[[constraints]]\nkind = 'line'\nnodes = ['P']\ndirection = [0, 0, 1]\n";
const std::string floor_below = upright +
                                "[[constraints]]\nkind = 'coordinate_stop'\nname = 'floor'\nnodes = ['P']\n"
                                "direction = [0, 0, 1]\nmin = 0\n";
const std::string cable = upright + "[[constraints]]\nkind = 'cable'\nname = 'rope'\nnodes = ['P', 'H']\n";

// Of the only coordinate that moves, as the model of the last state has it there.
double acceleration(const Stepper& stepper) {
  const State& state = stepper.state();
  const System system = stepper.model().system.at(state);
  VectorXd a(state.z.size()), lambda = state.lambda, q(system.coordinates());
  REQUIRE(Index1(system).evaluate(state, a, lambda));
  system.expand_rate(a, q);
  return q[0] + q[1] + q[2];
}
std::size_t states_now(const Stepper& stepper) {
  const Trajectory& all = stepper.run().trajectory;
  std::size_t n = 0;
  while (n < all.size() && all.time(all.size() - 1 - n) == stepper.time()) ++n;
  return n;
}
long count(const Stepper& stepper, const std::string& kind) {
  return std::ranges::count(stepper.run().events, kind, &Event::kind);
}

struct Case {
  const char* what;
  std::string scene;
  Vec3 held, beyond;  // it holds against the first, gives way to the second
  double accelerates;
  std::string event;
};
const Case cases[] = {
    {"friction", friction, {4, 0, 0}, {12.3, 0, 0}, (12.3 - kinetic) / mass, "slip"},
    {"friction the other way", friction, {-9.9, 0, 0}, {-10.2, 0, 0}, (-10.2 + kinetic) / mass, "slip"},
    {"stop", floor_below, {0, 0, 5}, {0, 0, 21.5}, 21.5 / mass - gravity, "free"},
    {"cable", cable, {0, 0, 9}, {0, 0, 18.1}, 18.1 / mass - gravity, "slack"}};

}  // namespace

// Newton's law right after the change: a = (F - friction) / m, or F / m - g, to rounding. The state that has
// the new force and still the hold never was: at the time there are the state before the change and that
// after it.
TEST_CASE("what gives way to a force that is set has given way in the state of that time") {
  for (const Case& c : cases)
    for (const bool at_start : {true, false}) {
      INFO(c.what << (at_start ? " at the start" : ""));
      Stepper stepper(model_of(mass_on_a_line + c.scene), dvm_options(4, 0.05, 1.0));
      if (!at_start) {
        stepper.set_force(0, c.held);
        REQUIRE(stepper.step());
        REQUIRE(stepper.step());
        CHECK(std::abs(acceleration(stepper)) <= 1e-12);
      }
      const long told = count(stepper, c.event);
      // However often it is set anew at that time.
      for (int k = 30; k >= 0; --k)
        stepper.set_force(0, c.held), stepper.set_force(0, (1 + 0.1 * k) * c.beyond);
      CHECK(states_now(stepper) == (at_start ? 1 : 2));
      CHECK(std::abs(acceleration(stepper) - c.accelerates) <= 1e-12 * std::abs(c.accelerates));
      CHECK(count(stepper, c.event) == told + 1);
      const double t0 = stepper.time();
      while (stepper.step()) {
      }
      // A parabola from there: forces are constant, which the method has to rounding.
      const double t = stepper.time() - t0;
      CHECK(
          std::abs(stepper.run().trajectory.velocities(stepper.run().trajectory.size() - 1).head<3>().sum() -
                   c.accelerates * t) <= 1e-12);
      CHECK(count(stepper, c.event) == told + 1);
      const Diagnostics books = diagnose(stepper.run());
      for (const double balance : books.at("energy_balance_J").values) CHECK(std::abs(balance) <= 1e-12);
    }
}

// All forces of one time act at once, whatever was set before them then.
TEST_CASE("what would have given way to a force that was replaced at once holds on") {
  for (const Case& c : cases)
    for (const bool at_start : {true, false}) {
      INFO(c.what << (at_start ? " at the start" : ""));
      Stepper stepper(model_of(mass_on_a_line + c.scene), dvm_options(4, 0.05, 1.0));
      if (!at_start) {
        stepper.set_force(0, Vec3(0.1 * c.held));
        REQUIRE(stepper.step());
      }
      const std::size_t events = stepper.run().events.size(), warnings = stepper.run().warnings.size();
      for (int k = 0; k < 3; ++k)
        stepper.set_force(0, (1 + 0.1 * k) * c.beyond), stepper.set_force(0, c.held);
      CHECK(states_now(stepper) == (at_start ? 1 : 2));
      CHECK(std::abs(acceleration(stepper)) <= 1e-12);
      while (stepper.step()) {
      }
      CHECK(stepper.run().events.size() == events);
      CHECK(stepper.run().warnings.size() == warnings);
      CHECK(stepper.state().w.lpNorm<Eigen::Infinity>() <= 1e-12);
      CHECK(stepper.run().status == RunStatus::completed);
    }
}

// Two masses on one line, joined by a rod: the friction of one bears both forces, which cancel.
TEST_CASE("friction that two forces of one time pass by between them does not slip") {
  Stepper stepper(
      model_of(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, 0, 0], mass = 1}, {name = "
          "'Q', position = [1, 0, 0], mass = 1}]\nrods = [{nodes = ['P', 'Q'], mass = 0}]\n"
          "[[constraints]]\nkind = 'line'\nnodes = ['P', 'Q']\ndirection = [1, 0, 0]\n[[forces]]\nkind = "
          "'friction'\nnodes = ['P']\ndirection = [1, 0, 0]\nkinetic = " +
          number(kinetic) + "\nstatic = " + number(holding) + "\n"),
      dvm_options(4, 0.05, 1.0));
  for (int k = 0; k < 20; ++k) {
    const double force = k % 2 == 0 ? 31.0 : -17.0;
    stepper.set_force(0, Vec3(force, 0, 0));
    stepper.set_force(1, Vec3(-force, 0, 0));
    REQUIRE(stepper.step());
  }
  CHECK(stepper.run().events.empty());
  CHECK(stepper.run().trajectory.size() == 1 + 2 * 19 + 1);
  CHECK(stepper.state().w.lpNorm<Eigen::Infinity>() <= 1e-12);
}

}  // namespace pushed_sides_test
