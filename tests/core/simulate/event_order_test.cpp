// SPDX-License-Identifier: BSD-3-Clause
// Every kind of switch is passed at the order of the method, and a tolerance is met through it for the price
// of a smooth motion.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/study/tolerance.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace event_order_test {

namespace {

using testing::end_positions, testing::run_scene;

// 1 kg on a spring of 100 N/m about x = 2 m: 10 rad/s.
const std::string oscillator = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [2.4, 0, 0], mass = 1}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 100
free_length = 2
)";

// The same mass, dragged by the spring's other end at 0.3 m/s.
const std::string dragged = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [1, 0, 0], mass = 1},
  {name = "D", position = [3, 0, 0], mass = 1}]
[[constraints]]
kind = "coordinate"
nodes = ["D"]
direction = [1, 0, 0]
motion = "rate"
rate = 0.3
[[forces]]
kind = "spring"
nodes = ["A", "D"]
stiffness = 100
)";

std::string stop(double min, double restitution) {
  return "[[constraints]]\nkind = 'coordinate_stop'\nname = 'stop'\nnodes = ['A']\ndirection = [1, 0, "
         "0]\nmin = " +
         std::to_string(min) + "\nrestitution = " + std::to_string(restitution) + "\n";
}
std::string friction(double kinetic, double holding) {
  return "[[forces]]\nkind = 'friction'\nname = 'floor'\nnodes = ['A']\ndirection = [1, 0, 0]\nkinetic = " +
         std::to_string(kinetic) + "\nstatic = " + std::to_string(holding) + "\n";
}

struct Switch {
  std::string what, scene;
  double end, exact;               // x of A at the end [m]
  std::vector<std::string> kinds;  // of the events
};

double from_rest(double t) {  // what a drag at 0.3 m/s has moved from rest
  return 0.3 * t - 0.03 * std::sin(10 * t);
}

std::vector<Switch> switches() {
  const double hit = 2 * pi / 30, speed = 4 * std::sin(2 * pi / 3);
  const double slides = (2 * pi - 2 * std::atan(1.5 * 10 / 30)) / 10;
  const double way = 0.3 * slides + 0.015 * (1 - std::cos(10 * slides)) - 0.03 * std::sin(10 * slides);
  return {
      {"a rebound",
       oscillator + stop(1.8, 0.5),
       0.4,
       2 - 0.2 * std::cos(10 * (0.4 - hit)) + 0.05 * speed * std::sin(10 * (0.4 - hit)),
       {"contact"}},
      {"an impact without rebound",
       oscillator + stop(1.8, 0),
       0.4,
       2 - 0.2 * std::cos(10 * (0.4 - hit)),
       {"contact"}},
      {"a stop that lets go",
       dragged + stop(1, 0) + "[[loads]]\nnodes = ['A']\nforce = [-4, 0, 0]\n",
       0.55,
       1 + from_rest(0.55 - 4.0 / 30),
       {"contact", "free"}},
      {"from sticking to slipping", dragged + friction(4, 4), 0.55, 1 + from_rest(0.55 - 4.0 / 30), {"slip"}},
      {"to sticking again", dragged + friction(2.5, 4), 4.0 / 30 + slides + 0.05, 1 + way, {"slip", "stick"}},
      {"from slipping to slipping back",
       oscillator + friction(1, 1),
       0.5,
       2 - 0.01 - 0.37 * std::cos(10 * (0.5 - pi / 10)),
       {"reversal"}},
  };
}

}  // namespace

TEST_CASE("every kind of switch is passed at full order") {
  for (const Switch& s : switches()) {
    const auto error = [&](int stages, double step) {
      const Simulation run =
          run_scene(s.scene + "[solver]\nend_time = " + std::to_string(s.end) + "\n",
                    {"solver.stages=" + std::to_string(stages), "solver.step=" + std::to_string(step)});
      INFO(s.what << ", " << stages << " stages, h = " << step << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      std::vector<std::string> kinds;
      for (const Event& event : run.events) kinds.push_back(event.kind);
      CHECK(kinds == s.kinds);
      const Index at = s.scene.starts_with(dragged) ? 0 : 3;
      return std::abs(end_positions(run)[at] - s.exact);
    };
    // Steps of 0.3 and 0.08 rad divide none of the times; the parts of steps before and behind a switch are
    // other shares of a step for each, which blurs the order by some tenths. Six digits of the end time.
    for (const int stages : {2, 3, 4}) {
      const double coarse = error(stages, 0.032), fine = error(stages, 0.008);
      INFO(s.what << ", " << stages << " stages: " << coarse << " m, " << fine << " m");
      CHECK((0.5 * std::log2(coarse / fine) >= 2 * stages - 2 - 0.5 || fine <= 1e-12));
    }
  }
}

TEST_CASE("a tolerance is met through switches for the price of a smooth motion") {
  const std::string cable = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0.7, 0, 0], velocity = [1, 0, 0], mass = 1}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 100
free_length = 1
tension_only = true
[solver]
end_time = 1
tolerance = 1e-8
)";
  const auto picked = [](const std::string& text, const std::vector<std::string>& changes = {}) {
    const Scene scene = read_scene_text(text, "s.toml", changes);
    return simulate_as_asked(build_model(scene), scene.solver);
  };
  const Simulation with = picked(cable), smooth = picked(cable, {"forces[0].tension_only=false"});
  CHECK(end_positions(with)[3] == Approx(0.3 + pi / 10).epsilon(0).margin(1e-8));
  CHECK(with.steps <= 2 * smooth.steps + 10);
  CHECK(with.factorisations <= 4 * smooth.factorisations + 100);
}

}  // namespace event_order_test
