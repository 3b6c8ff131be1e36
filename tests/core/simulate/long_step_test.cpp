// SPDX-License-Identifier: BSD-3-Clause
// Steps that cover half a swing and more, which many stages follow: what acts on one side within them,
// against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace long_step_test {

namespace {

using testing::run_scene;

constexpr double speed = 0.5;  // at x = 1, and the amplitude at 1 rad/s

// 1 kg on a spring of 1 N/m, on a line.
std::string swing(const std::string& more) {
  return R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "P", position = [1, 0, 0], velocity = [0.5, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["O", "P"]
stiffness = 1
free_length = 1
)" + more +
         "[solver]\nend_time = 1\n";
}

std::string stop_at(double x) {
  return "[[constraints]]\nkind = \"coordinate_stop\"\nname = \"wall\"\nnodes = [\"P\"]\ndirection = [1, 0, "
         "0]\nmax = " +
         std::to_string(x) + "\nrestitution = 1\n";
}

const std::string cable = R"([[forces]]
kind = "spring"
name = "cable"
nodes = ["O", "P"]
stiffness = 3
free_length = 1.27
tension_only = true
)";

// Between hits the sine, cut off at `room` and begun anew on its way back.
double thrown_back(double t, double room) {
  const double up = std::asin(room / speed), period = pi + 2 * up, u = std::fmod(t, period);
  return speed * (u < up ? std::sin(u) : u < 2 * up ? std::sin(2 * up - u) : -std::sin(u - 2 * up));
}

// Beyond a = 0.27 the motion is a swing of 4 rad^2/s^2 about 3 a / 4; `hits`: how often it has begun.
double on_cable(double t, int& hits) {
  const double a = 0.27, fast = 2, middle = 3 * a / 4;
  const double up = std::asin(a / speed), rate = std::sqrt(speed * speed - a * a);
  const double half = (pi / 2 - std::atan2((a - middle) * fast, rate)) / fast;  // to the top
  const double period = pi + 2 * up + 2 * half, u = std::fmod(t, period);
  hits = static_cast<int>(t / period) + (u > up ? 1 : 0);
  if (u < up) return speed * std::sin(u);
  if (u < up + 2 * half)
    return middle + std::hypot(a - middle, rate / fast) * std::cos(fast * (u - up - half));
  return speed * std::sin(up - (u - up - 2 * half));
}

struct Case {
  int stages;
  double step;
};

std::vector<std::string> changes(const Case& c, int steps) {
  return {"solver.stages=" + std::to_string(c.stages), "solver.step=" + std::to_string(c.step),
          "solver.end_time=" + std::to_string(c.step * steps)};
}

// Largest distance of P from x(t) + 1, of the amplitude.
template <class X>
double off(const Simulation& run, const X& x) {
  double most = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    most = std::max(most, std::abs(run.trajectory.positions(i)[3] - 1 - x(run.trajectory.time(i))) / speed);
  return most;
}

constexpr Case cases[] = {{5, 3}, {5, 3.5}, {6, 3}, {6, 3.5}, {7, 3}, {7, 4.5}, {8, 3}, {8, 4.5}, {8, 6}};

}  // namespace

// A step from event to event is a part of a step and no less accurate: errors are those of the same motion
// without events, but for what a phase error makes of the times of some hits (ten times is room for eight
// steps).
TEST_CASE("a stop is struck where a step covers half a swing or a whole one") {
  for (const double room : {0.45, 0.31, 0.496})
    for (const Case& c : cases) {
      INFO(c.stages << " stages, step " << c.step << " s, room " << room);
      const double free =
          off(run_scene(swing(""), changes(c, 8)), [](double t) { return speed * std::sin(t); });
      const Simulation run = run_scene(swing(stop_at(1 + room)), changes(c, 8));
      REQUIRE(run.status == RunStatus::completed);
      CHECK(run.warnings.empty());
      const double up = std::asin(room / speed);
      const int hits = 1 + static_cast<int>((8 * c.step - up) / (pi + 2 * up));
      CHECK(std::ranges::count(run.events, "contact", &Event::kind) == hits);
      CHECK(off(run, [&](double t) { return thrown_back(t, room); }) <= 10 * free + 1e-9);
    }
}

// While it pulls the swing is 5.6 times as fast, and a step is resolved so far less; once per swing for 0.6
// s.
TEST_CASE("a cable goes taut where a step covers half a swing or a whole one") {
  for (const Case& c : {Case{7, 2.2}, Case{7, 3}, Case{8, 2.2}, Case{8, 3}}) {
    INFO(c.stages << " stages, step " << c.step << " s");
    const Simulation run = run_scene(swing(cable), changes(c, 8));
    REQUIRE(run.status == RunStatus::completed);
    int hits = 0;
    on_cable(8 * c.step, hits);
    CHECK(std::ranges::count(run.events, "taut", &Event::kind) == hits);
    int ignored = 0;
    CHECK(off(run, [&](double t) { return on_cable(t, ignored); }) <= 0.02);
  }
}

TEST_CASE("a structure is deployed within a step that covers half a swing or a whole one") {
  for (const double room : {0.45, 0.31, 0.496})
    for (const Case& c : cases) {
      INFO(c.stages << " stages, step " << c.step << " s, room " << room);
      const Simulation run = run_scene(
          swing("[deployment]\nmeasure = \"length O P\"\ndeployed = " + std::to_string(1 + room) + "\n"),
          changes(c, 3));
      REQUIRE(run.status == RunStatus::deployed);
      // Deployed within a part of a step of 1.5 s at most, of order 8 and more: five stages are off by 1e-5.
      CHECK(run.events.front().t == Approx(std::asin(room / speed)).epsilon(1e-4));
    }
}

// B swings on a spring to A, which a load of 0.9 of the spring's amplitude presses on a stop: it lets go when
// the spring pulls more, for less than a second in each swing.
TEST_CASE("a stop lets go within a step that covers a swing") {
  const std::string scene = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 2},
         {name = "B", position = [1, 0, 0], velocity = [0.5, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["A", "B"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["A"]
direction = [1, 0, 0]
min = 0
restitution = 0
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 1
free_length = 1
[[loads]]
nodes = ["A"]
force = [-0.45, 0, 0]
[solver]
stages = 8
end_time = 6
)";
  for (const double step : {3.0, 6.0}) {
    const Simulation run = run_scene(scene, {"solver.step=" + std::to_string(step)});
    REQUIRE(run.status == RunStatus::completed);
    const auto free =
        std::ranges::find_if(run.events, [](const Event& e) { return e.name.starts_with("leaves"); });
    REQUIRE(free != run.events.end());
    CHECK(free->t == Approx(std::asin(0.9)).epsilon(1e-6));  // a part of a step: resolved
  }
}

// Not of a method of order 2: its step is a parabola, whatever the motion is, and nothing of that is missed.
TEST_CASE("a step that does not follow the motion towards a stop or cable says so") {
  const auto says = [](const Simulation& run, const std::string& name) {
    return std::ranges::any_of(run.warnings, [&](const std::string& w) {
      return w.find("does not resolve the motion towards " + name) != w.npos;
    });
  };
  for (const std::string method : {"dvm", "rk4"})
    for (const double step : {0.4, 2.6}) {
      INFO(method << ", step " << step << " s");
      const std::vector<std::string> set{"solver.method=" + method, "solver.stages=3",
                                         "solver.step=" + std::to_string(step),
                                         "solver.end_time=" + std::to_string(12 * step)};
      CHECK(says(run_scene(swing(stop_at(1.45)), set), "stop wall") == (step > 1));
      CHECK(says(run_scene(swing(cable), set), "cable") == (step > 1));
      // Out of reach it does not matter.
      CHECK_FALSE(says(run_scene(swing(stop_at(5.3)), set), "stop wall"));
    }
  // A swing and a half in a step of four stages.
  CHECK(says(run_scene(swing(stop_at(1.45)), changes({4, 9}, 8)), "stop wall"));
}

}  // namespace long_step_test
