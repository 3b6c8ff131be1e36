// SPDX-License-Identifier: BSD-3-Clause
// Bodies that are pressed so hard on a stop that all of their bounces end within a step, or a part of one.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pressed_stop_test {

using testing::number;
using testing::run_scene;

namespace {

struct Bounces {
  double press, restitution, step, rest_speed;  // 1 kg, from 1 cm above the stop
  double fall() const { return std::sqrt(2 * 0.01 / press); }
  // The series of flights: T + 2 T (e + e^2 + ...).
  double over() const { return fall() * (1 + restitution) / (1 - restitution); }
  double end() const { return std::max(3 * step, 1.2 * over()); }
};

std::string solved(const Bounces& b, const std::string& model) {
  return "[solver]\nmodel = \"" + model + "\"\nstep = " + number(b.step) + "\nend_time = " + number(b.end()) +
         "\n";
}
std::string restitution(const Bounces& b) {
  return "restitution = " + number(b.restitution) + "\nrest_speed = " + number(b.rest_speed) + "\n";
}

// One body, or two that fall beside each other from unlike heights.
std::string falling(const Bounces& b, const std::string& model, bool two = false) {
  std::string scene =
      "[structure]\nkind = \"custom\"\nnodes = [{name = \"B\", position = [0, 0, 0.01], mass = 1}";
  if (two) scene += ", {name = \"C\", position = [1, 0, 0.0073], mass = 3}";
  scene += "]\n";
  for (const char* name : {"B", "C"})
    if (two || *name == 'B')
      scene += std::string("[[structure.constraints]]\nkind = \"line\"\nnodes = [\"") + name +
               "\"]\ndirection = [0, 0, 1]\n[[constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"" + name +
               "\"]\ndirection = [0, 0, 1]\nmin = 0\n" + restitution(b);
  return scene + "[gravity]\nacceleration = [0, 0, " + number(-b.press) + "]\n" + solved(b, model);
}

// The distance to a fixed node, 1 m at the most, that a load makes longer.
std::string drawn(const Bounces& b, const std::string& model) {
  return "[structure]\nkind = \"custom\"\nnodes = [{name = \"O\", position = [0, 0, 0], fixed = true}, "
         "{name = \"B\", position = [0.6, 0, 0.79], mass = 1}]\n[[structure.constraints]]\nkind = \"line\"\n"
         "nodes = [\"B\"]\ndirection = [0, 0, 1]\n[[loads]]\nnodes = [\"B\"]\nforce = [0, 0, " +
         number(b.press) + "]\n[[constraints]]\nkind = \"length_stop\"\nnodes = [\"O\", \"B\"]\nmax = 1\n" +
         restitution(b) + solved(b, model);
}

void rests_in_time(const Simulation& run, const Bounces& b, Index body, double at, double lost) {
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const VectorXd x = testing::end_positions(run),
                 v = run.trajectory.node_velocities(run.trajectory.size() - 1);
  CHECK(x[body] == Approx(at).epsilon(0).margin(1e-9));
  CHECK(std::abs(v[body]) < 1e-9);
  CHECK(d.at("impact_loss_J").values.back() == Approx(lost).epsilon(1e-8));
  REQUIRE(!run.events.empty());
  // Flights of less than 1e-4 of a step are left out, and what is slower than rest_speed: with the rest of
  // their series 1 / (1 - e) times as long.
  const double left_out = (1e-4 * b.step + 2 * b.rest_speed / b.press) / (1 - b.restitution);
  CHECK(run.events.back().t <= b.over() * (1 + 1e-8));
  CHECK(run.events.back().t >= b.over() * (1 - 1e-8) - left_out);
}

}  // namespace

// Whatever the press, the step and the rest speed are: behind the series of its bounces it rests on the stop,
// and all it fell has been lost.
TEST_CASE("what is pressed hard on a stop rests there behind its bounces") {
  for (double press = 1; press < 2e7; press *= 10)
    for (const double step : {1e-4, 1e-3, 0.01, 0.1})
      for (const double e : {0.0, 0.01, 0.3, 0.5, 0.7, 0.9, 0.95})
        for (const double rest_speed : {0.0, 0.001}) {
          const Bounces b{press, e, step, rest_speed};
          if (b.end() > 300 * step) continue;
          INFO("press " << press << ", step " << step << ", e = " << e << ", rest speed " << rest_speed);
          rests_in_time(run_scene(falling(b, "full")), b, 2, 0, 0.01 * press);
          rests_in_time(run_scene(falling(b, "path")), b, 2, 0, 0.01 * press);
        }
}

TEST_CASE("two bodies that are pressed hard on stops rest there behind their own bounces") {
  for (const double press : {100.0, 1e5, 1e6, 1e7})
    for (const double step : {0.01, 0.1})
      for (const double e : {0.3, 0.7, 0.9}) {
        const Bounces b{press, e, step, 0};
        if (b.end() > 300 * step) continue;
        INFO("press " << press << ", step " << step << ", e = " << e);
        const Simulation run = run_scene(falling(b, "full", true));
        rests_in_time(run, b, 2, 0, press * (0.01 + 3 * 0.0073));
        CHECK(std::abs(testing::end_positions(run)[5]) < 1e-9);
      }
}

// s = sqrt(0.36 + z^2): z rises evenly from 0.79 to 0.8, whatever s does.
TEST_CASE("what is pressed hard on a stop of its distance rests there behind its bounces") {
  for (const double press : {1.0, 1e3, 1e5, 1e7})
    for (const double step : {1e-3, 0.01, 0.1})
      for (const double e : {0.3, 0.7, 0.9}) {
        const Bounces b{press, e, step, 0};
        if (b.end() > 300 * step) continue;
        INFO("press " << press << ", step " << step << ", e = " << e);
        rests_in_time(run_scene(drawn(b, "full")), b, 5, 0.8, 0.01 * press);
      }
}

// A hinge spring closes a panel onto a stop that it presses on with half its torque, in steps that do not
// resolve that.
TEST_CASE("a panel that its spring presses on a stop rests there") {
  for (const double stiffness : {0.5, 5.0, 50.0, 500.0})
    for (const double step : {0.001, 0.003, 0.01})
      for (const double e : {0.0, 0.3, 0.5, 0.7}) {
        INFO("stiffness " << stiffness << ", step " << step << ", e = " << e);
        const Simulation run = run_scene(
            "[structure]\nkind = \"custom\"\nnodes = [{name = \"O\", position = [0, 0, 0], fixed = true}, "
            "{name = \"A\", position = [0.05, 0, 0], fixed = true}, {name = \"B\", position = [0, 0.05, "
            "0]}]\n"
            "rods = [{nodes = [\"O\", \"B\"], mass = 0.02}]\nconstraints = [{kind = \"plane\", nodes = "
            "[\"B\"], normal = [0, 0, 1]}]\n[[forces]]\nkind = \"torsion_spring\"\nnodes = [\"A\", \"O\", "
            "\"B\"]\naxis = [0, 0, 1]\nfree_angle = -30\nstiffness = " +
            number(stiffness) +
            "\n[[constraints]]\nkind = \"angle_stop\"\nnodes = [\"A\", \"O\", \"B\"]\naxis = [0, 0, 1]\n"
            "min = 0\nrestitution = " +
            number(e) + "\n[solver]\nstages = 4\nend_time = 0.3\nstep = " + number(step) + "\n");
        REQUIRE(run.status == RunStatus::completed);
        CHECK(std::abs(testing::end_positions(run)[7]) < 1e-9);
      }
}

// It comes to rest on its stop by itself, 0.45 m from a fixed node at 0.05 s; a cable between them, whose
// length falls evenly, comes to that 0.15 m / 0.1234 m/s after the start. From there on it presses on the
// stop, or (on the other side, to a node at 2.5 m) takes the body off it at once: nothing else
// happens within half a swing of 2 kg on it.
TEST_CASE("a cable that goes taut on what rests on a stop without a force presses on it or takes it off") {
  const std::string stops[] = {
      "kind = \"length_stop\"\nnodes = [\"X\", \"M\"]\nmin = 0.45\n",
      "kind = \"coordinate_stop\"\nnodes = [\"M\"]\ndirection = [1, 0, 0]\nmin = 0.45\n",
      "kind = \"cable\"\nnodes = [\"Y\", \"M\"]\nlength = 2.05\n"};
  for (const std::string& stop : stops)
    for (const bool away : {false, true})
      for (const double stiffness : {0.5, 50.0, 500.0, 5e3})
        for (const double step : {0.1, 0.02, 0.01, 0.001}) {
          INFO(stop << "away " << away << ", stiffness " << stiffness << ", step " << step);
          const Simulation run = run_scene(
              "[structure]\nkind = \"custom\"\nnodes = [{name = \"X\", position = [0, 0, 0], fixed = true}, "
              "{name = \"M\", position = [0.5, 0, 0], mass = 2, velocity = [-1, 0, 0]}, {name = \"Y\", "
              "position = [2.5, 0, 0], fixed = true}]\n[[constraints]]\nkind = \"line\"\nnodes = [\"M\"]\n"
              "direction = [1, 0, 0]\n[[constraints]]\nname = \"s\"\n" +
              stop + "[[forces]]\nkind = \"cable\"\nname = \"c\"\nnodes = [\"" + (away ? "Y" : "X") +
              "\", \"M\"]\nlength = " + (away ? "2.2" : "0.6") + "\naxial_stiffness = " + number(stiffness) +
              "\nmotion = \"rate\"\nrate = -0.1234\n[solver]\nstages = 4\nend_time = 1.25\nstep = " +
              number(step) + "\n");
          REQUIRE(run.status == RunStatus::completed);
          REQUIRE(run.events.size() >= (away ? 3 : 2));
          CHECK(run.events[0].t == Approx(0.05).epsilon(1e-9));
          for (std::size_t i = 1; i < run.events.size(); ++i)
            CHECK(run.events[i].t == Approx(0.15 / 0.1234).epsilon(1e-9));
          CHECK(run.events[1].name == "c pulls");
          CHECK(run.events.size() == (away ? 3 : 2));
          if (!away) CHECK(std::abs(testing::end_positions(run)[3] - 0.45) < 1e-11);
        }
}

}  // namespace pressed_stop_test
