// SPDX-License-Identifier: BSD-3-Clause
// End stops: impacts, rest and release against closed forms.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/path/path_run.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace stop_test {

namespace {

using testing::end_positions, testing::number, testing::run_scene;

// A ball of 2 kg that falls 5 m at 10 m/s^2: one second to the floor.
const std::string ball = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 5], mass = 2}]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["A"]
direction = [0, 0, 1]
min = 0
restitution = 0.5
[gravity]
acceleration = [0, 0, -10]
[solver]
step = 0.03
end_time = 2.5
)";

}  // namespace

TEST_CASE("a ball bounces on a stop as its restitution says") {
  const Simulation run = run_scene(ball);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() >= 2);
  // Impacts at 1 s with 10 m/s, 1 s later with 5 m/s, 0.5 s later with 2.5 m/s: the flight is a parabola,
  // which the method follows exactly; contact is located to 1e-13 m.
  CHECK(run.events[0].name == "stop floor");
  CHECK(run.events[0].t == Approx(1).epsilon(1e-12));
  CHECK(run.events[1].t == Approx(2).epsilon(1e-12));
  CHECK(run.events[0].energy_lost == Approx(75).epsilon(1e-12));  // (1 - 1/4) of 100 J
  CHECK(run.events[1].energy_lost == Approx(18.75).epsilon(1e-12));
  const Diagnostics d = diagnose(run);
  for (const double x : d.at("energy_balance_J").values) CHECK(std::abs(x) <= 1e-10);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) CHECK(run.trajectory.positions(i)[2] >= -1e-10);
}

// Impacts that follow each other within 1e-4 of a step have accumulated: of a step that is taken, whatever
// solver.step says.
TEST_CASE("a ball bounces in runs that are shorter than a step") {
  const std::string guided =
      ball + "[[structure.constraints]]\nkind = \"line\"\nnodes = [\"A\"]\ndirection = [0, 0, 1]\n";
  for (const std::string model : {"full", "path"}) {
    const Scene scene = read_scene_text(
        guided, "s.toml",
        {"solver.step=1e5", "solver.end_time=2.3", "solver.model=" + model, "constraints[0].rest_speed=0"});
    const auto built = build_model(scene);
    const Simulation run =
        model == "path" ? simulate_on_path(built, scene.solver) : simulate(built, scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    // Thrown up at 2 s with 2.5 m/s.
    CHECK(end_positions(run)[2] == Approx(2.5 * 0.3 - 5 * 0.09).epsilon(1e-9));
  }
}

TEST_CASE("on its path, too, a ball bounces as its restitution says, in steps longer than its bounces") {
  for (const char* step : {"0.03", "0.7", "2.6"}) {
    INFO(step);
    // On a guide, so that it has one freedom.
    const Scene scene = read_scene_text(
        ball + "[[structure.constraints]]\nkind = \"line\"\nnodes = [\"A\"]\ndirection = [0, 0, 1]\n",
        "s.toml", {std::string("solver.step=") + step, "solver.end_time=2.6"});
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() == 3);
    CHECK(run.events[0].t == Approx(1).epsilon(1e-12));
    CHECK(run.events[1].t == Approx(2).epsilon(1e-12));
    CHECK(run.events[2].t == Approx(2.5).epsilon(1e-12));
    // Off again at 1.25 m/s.
    CHECK(end_positions(run)[2] == Approx(0.125 - 0.05).epsilon(1e-11));
  }
}

TEST_CASE("a stop that is touched and left within one step is not missed") {
  // Thrown down at 6 m/s from 0.3 m, and drawn up at 20 m/s^2: the parabola 0.3 - 6 t + 10 t^2 would be below
  // the floor from 0.0551 s to 0.5449 s; steps of 0.6 s see it above at both ends.
  const Simulation run =
      run_scene(ball, {"structure.nodes.A.position=[0,0,0.3]", "structure.nodes.A.velocity=[0,0,-6]",
                       "gravity.acceleration=[0,0,20]", "solver.step=0.6", "solver.end_time=0.6"});
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() == 1);
  const double touch = (6 - std::sqrt(36 - 12.0)) / 20;
  CHECK(run.events[0].t == Approx(touch).epsilon(1e-12));
  // Off again at half of the approach speed, sqrt(24) m/s.
  const double left = 0.6 - touch;
  CHECK(end_positions(run)[2] == Approx(0.5 * std::sqrt(24.0) * left + 10 * left * left).epsilon(1e-10));
  // A parabola that stays 1 mm above the floor touches nothing.
  const Simulation above =
      run_scene(ball, {"structure.nodes.A.position=[0,0,0.901]", "structure.nodes.A.velocity=[0,0,-6]",
                       "gravity.acceleration=[0,0,20]", "solver.step=0.6", "solver.end_time=0.6"});
  CHECK(above.status == RunStatus::completed);
  CHECK(above.events.empty());
}

// 1 kg between a wall and 10^6 kg that come at 1 m/s: 3141 hits, the first digits of pi, most within 0.01 s.
TEST_CASE("rebounds that lose nothing are all told, however many come in a step") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", mass = 1, position = [1, 0, 0]},
         {name = "B", mass = 1e6, position = [2, 0, 0], velocity = [-1, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["A", "B"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["A"]
direction = [1, 0, 0]
min = 0
restitution = 1
rest_speed = 0
[[constraints]]
kind = "coordinate_stop"
nodes = ["A", "B"]
direction = [1, 0, 0]
min = 0
restitution = 1
rest_speed = 0
[solver]
step = 0.01
end_time = 4
)");
  CHECK(run.warnings.empty());
  CHECK(run.events.size() == 3141);
  // Velocities times the root of the mass turn by 2 atan(1e-3) with each of the 1571 hits of both; what
  // rounding leaves of each turn adds up to some 1e-13, and is 1000 times that of the light one's.
  const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
  const double turned = 2 * 1571 * std::atan(1e-3);
  CHECK(v[3] == Approx(-std::cos(turned)).epsilon(1e-11));
  CHECK(v[0] == Approx(-1000 * std::sin(turned)).epsilon(1e-8));
}

// Two kilograms meet it at 1 m/s as the run begins: m v^2 / 2 (1 - e^2) are lost, once, and the state before
// stays; friction that holds nothing, that slips, or none.
TEST_CASE("an impact at the start is told once, with friction or without") {
  for (const double e : {0.0, 0.5})
    for (const char* direction : {"", "[1, 0, 0]", "[0, 1, 0]"}) {
      std::string text = R"(
[structure]
kind = "custom"
nodes = [{name = "A", mass = 1, position = [0, 0, 0], velocity = [-1, 0, 0]},
         {name = "B", mass = 1, position = [1, 0, 0], velocity = [-1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 0}]
[[constraints]]
kind = "line"
nodes = ["A", "B"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["A"]
direction = [1, 0, 0]
min = 0
restitution = )" + std::to_string(e) +
                         "\n[solver]\nend_time = 0.1\n";
      if (*direction)
        text += "[[forces]]\nkind = \"friction\"\nnodes = [\"B\"]\nkinetic = 1\ndirection = " +
                std::string(direction) + "\n";
      INFO("restitution " << e << ", friction along " << direction);
      const Simulation run = run_scene(text);
      REQUIRE(run.status == RunStatus::completed);
      REQUIRE(run.events.size() == 1);
      CHECK(run.events[0].t == 0);
      CHECK(run.events[0].energy_lost == Approx(1 - e * e).epsilon(1e-14));
      CHECK(run.trajectory.node_velocities(0)[0] == -1);
      CHECK(run.trajectory.time(1) == 0);
      CHECK(run.trajectory.node_velocities(1)[0] == Approx(e).epsilon(0).margin(1e-14));
      const Diagnostics d = diagnose(run);
      CHECK(d.at("impact_loss_J").values.back() == Approx(1 - e * e).epsilon(1e-13));
      CHECK(testing::largest(d, "energy_balance_J") <= 1e-14);
    }
}

TEST_CASE("bounces come to rest after their geometric series, and the stop then carries the weight") {
  const Simulation run = run_scene(ball, {"solver.end_time=4"});
  REQUIRE(run.status == RunStatus::completed);
  // 1 + 2 (0.5 + 0.25 + ...) = 3 s, up to the rest speed of 1 mm/s: 0.2 ms.
  CHECK(run.events.back().name == "rests on stop floor");
  CHECK(run.events.back().t == Approx(3).epsilon(0).margin(5e-4));
  CHECK(std::abs(end_positions(run)[2]) <= 1e-10);
  CHECK(std::abs(run.trajectory.velocities(run.trajectory.size() - 1)[2]) <= 1e-12);
  double lost = 0;
  for (const Event& event : run.events) lost += event.energy_lost;
  CHECK(lost == Approx(100).epsilon(1e-9));
}

// Flights of 2 s / 2^k, up to the first that ends within 1e-4 of a step: the 22nd, which rises by 3e-13 m. A
// height that is rounded to 1e-15 m tells the time to 1e-9 s at the last speeds. (The time loop takes heights
// of 1e-11 m for none.)
TEST_CASE("on its path every bounce comes down again before the last, however low it is") {
  const Scene scene = read_scene_text(
      ball + "[[structure.constraints]]\nkind = \"line\"\nnodes = [\"A\"]\ndirection = [0, 0, 1]\n", "s.toml",
      {"solver.step=0.005", "solver.end_time=3.1", "constraints[0].rest_speed=0"});
  const Simulation run = simulate_on_path(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() == 23);
  double t = 1;
  for (std::size_t k = 0; k < run.events.size(); ++k) {
    INFO(k);
    if (k > 0) t += std::ldexp(2.0, -static_cast<int>(k));
    CHECK(run.events[k].t == Approx(t).epsilon(0).margin(1e-8));
    CHECK(run.events[k].name == (k == 22 ? "rests on stop floor" : "stop floor"));
  }
}

TEST_CASE("a stop lets go when it would have to pull") {
  const Simulation run = run_scene(ball + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [0, 0, 40]
times = [1.2, 2.2]
values = [0, 1]
)",
                                   {"constraints[0].restitution=0", "solver.step=0.001"});
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() == 2);
  CHECK(run.events[0].name == "rests on stop floor");
  CHECK(run.events[0].energy_lost == Approx(100).epsilon(1e-10));  // free fall is exact; a thousand roundings
  CHECK(run.events[1].name == "leaves stop floor");
  // 40 N (t - 1.2) = 20 N; then z'' = 20 (t - 1.7) m/s^2 until 2.2 s.
  CHECK(run.events[1].t == Approx(1.7).epsilon(1e-10));
  CHECK(run.trajectory.positions_at(2.2)[2] == Approx(20.0 / 6 * 0.125).epsilon(1e-9));
}

// 1 kg on a stop, with nothing but one load that falls from 3 N through zero: where that is located it is
// rounding, of which no share says what is zero. x'' = -k (t - t0).
TEST_CASE("a stop whose whole load passes through zero is left there") {
  const std::string slider = R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["P"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate_stop"
name = "end"
nodes = ["P"]
direction = [1, 0, 0]
max = 0
)";
  for (const char* step : {"0.1", "0.01"})
    for (int i = 0; i < 30; ++i) {
      const double last = -4 - 0.0137 * i, T = 1.7, k = (3 - last) / T, t0 = 3 / k;
      CAPTURE(step, last);
      const Simulation run = run_scene(slider + R"([[forces]]
kind = "load_over_time"
nodes = ["P"]
force = [1, 0, 0]
times = [0, 1.7]
values = [3, )" + number(last) +
                                       "]\n[solver]\nend_time = 1.7\nstep = " + step + "\n");
      CHECK(run.warnings.empty());
      REQUIRE(run.events.size() == 2);
      CHECK(run.events[1].name == "leaves stop end");
      CHECK(run.events[1].t == Approx(t0).epsilon(1e-12));
      CHECK(end_positions(run)[0] == Approx(-k / 6 * std::pow(T - t0, 3)).epsilon(1e-10));
    }
}

// A second mass lies against the first: neither does anything to the other then, nor do two stops switch in
// turn by what is left of the load.
TEST_CASE("what touches a stop beside one that is left is not pressed on by rounding") {
  for (int i = 0; i < 40; ++i) {
    const double last = -1.7 - 0.0137 * i, first = 0.438893, t0 = 0.125 + 0.375 * first / (first - last);
    CAPTURE(last);
    const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [1, 0, 0], mass = 1.7033}, {name = "Q", position = [1.8, 0, 0], mass = 1.09753}]
constraints = [{kind = "line", nodes = ["P", "Q"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate_stop"
name = "end"
nodes = ["P"]
direction = [1, 0, 0]
max = 1
[[constraints]]
kind = "length_stop"
name = "between"
nodes = ["P", "Q"]
min = 0.8
[[forces]]
kind = "load_over_time"
nodes = ["P"]
force = [1, 0, 0]
times = [0.125, 0.5]
values = [0.438893, )" + number(last) +
                                     "]\n[solver]\nend_time = 0.5\n");
    CHECK(run.warnings.empty());
    REQUIRE(run.events.size() == 2);
    CHECK(run.events[1].name == "leaves stop end");
    CHECK(run.events[1].t == Approx(t0).epsilon(1e-12));
    CHECK(end_positions(run)[3] == 1.8);
  }
}

// A blow into a stop that would throw it against another, which it touches as well.
TEST_CASE("what two stops leave no room comes to rest, whatever their restitution") {
  for (const double e : {0.0, 0.5, 1.0}) {
    const std::string ends = "\nrestitution = " + number(e) + "\nmin = ";
    const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [1, 0, 0], mass = 1.4, velocity = [0.41, 0, 0]}]
constraints = [{kind = "line", nodes = ["P"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate_stop"
nodes = ["P"]
direction = [1, 0, 0])" + ends + "1\n[[constraints]]\nkind = \"length_stop\"\nnodes = [\"O\", \"P\"]" +
                                     ends + "0.5\nmax = 1\n[solver]\nend_time = 0.1\n");
    INFO(run.message);
    REQUIRE(run.status == RunStatus::completed);
    double lost = 0;
    for (const Event& event : run.events) lost += event.energy_lost;
    CHECK(lost == Approx(0.7 * 0.41 * 0.41).epsilon(1e-12));
    CHECK(std::abs(end_positions(run)[3] - 1) <= 1e-14);
  }
}

// The same of a spring whose other end is drawn past the balance at u: x = u tau - u / w sin w tau.
TEST_CASE("a stop is left where the only spring that presses on it slackens") {
  for (const char* step : {"0.1", "0.01"})
    for (int i = 0; i < 30; ++i) {
      const double u = 0.3 + 0.0137 * i, w = std::sqrt(7.0);
      CAPTURE(step, u);
      const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], mass = 1},
  {name = "R", position = [-0.8, 0, 0], mass = 2, velocity = [)" +
                                       number(-u) +
                                       R"(, 0, 0]}, {name = "Q", position = [-5, 0, 0], fixed = true}]
constraints = [{kind = "line", nodes = ["P"], direction = [1, 0, 0]}, {kind = "line", nodes = ["R"], direction = [1, 0, 0]}]
[[constraints]]
kind = "length"
nodes = ["Q", "R"]
motion = "rate"
rate = )" + number(-u) + R"(
[[constraints]]
kind = "coordinate_stop"
name = "end"
nodes = ["P"]
direction = [1, 0, 0]
max = 0
[[forces]]
kind = "spring"
nodes = ["P", "R"]
stiffness = 7
free_length = 1
[solver]
stages = 6
end_time = 1.5
step = )" + std::string(step) + "\n");
      CHECK(run.warnings.empty());
      REQUIRE(run.events.size() == 2);
      CHECK(run.events[1].name == "leaves stop end");
      const double t0 = 0.2 / u, tau = 1.5 - t0;
      CHECK(run.events[1].t == Approx(t0).epsilon(1e-11));
      CHECK(end_positions(run)[0] == Approx(-u * tau + u / w * std::sin(w * tau)).epsilon(1e-9));
    }
}

// P cannot move between a and b, which it is thrown at; R is joined to nothing and meets its own stop at that
// time, with restitution 1: back it goes as fast, whatever rubs between both.
TEST_CASE("a blow between two stops without room is none of another stop's that is met then") {
  for (const auto& [speed, friction] : {std::pair("0", 0.0), {"0.41", 0.0}, {"0.41", 1e-6}}) {
    CAPTURE(speed, friction);
    const Simulation run = testing::run_scene(R"([structure]
kind = "custom"
rods = []
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [1, 0, 0], mass = 1.4, velocity = [)" +
                                              std::string(speed) + R"(, 0, 0]},
  {name = "R", position = [5, 0, 0], mass = 1, velocity = [-1, 0, 0]}]
constraints = [{kind = "line", nodes = ["P", "R"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate_stop"
name = "a"
nodes = ["P"]
direction = [1, 0, 0]
restitution = 1
min = 1
[[constraints]]
kind = "length_stop"
name = "b"
nodes = ["O", "P"]
restitution = 1
min = 0.5
max = 1
[[constraints]]
kind = "coordinate_stop"
name = "r"
nodes = ["R"]
direction = [1, 0, 0]
restitution = 1
min = 5
[[forces]]
kind = "friction"
nodes = ["P", "R"]
kinetic = )" + number(friction) + R"(
[solver]
end_time = 0.1
step = 0.01
)");
    REQUIRE(run.status == RunStatus::completed);
    const VectorXd x = testing::end_positions(run);
    CHECK(x[3] == Approx(1).epsilon(0).margin(1e-12));
    // P stands: the friction of their distance holds R back, 1 kg that leaves at 1 m/s.
    CHECK(x[6] == Approx(5.1 - friction * 0.1 * 0.1 / 2).epsilon(0).margin(1e-12));
  }
}

// Four beads on a line fall on each other. Whatever is pushed in an impact, all that it takes is told once:
// by the events, and by the kinetic energy before and after.
TEST_CASE("what events lose in impacts is what the motion loses, also where a stop is pushed back onto") {
  std::string text =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [5, 0, -1], fixed = true}, "
      "{name = 'W', position = [0, 0, -1], fixed = true}";
  const std::array<const char*, 4> heights{"0.3782089527552109", "0.6501090039228181", "0.8501090039228181",
                                           "1.3362843506811743"},
      masses{"2.0600294188979573", "1.2261345690586174", "2.299845509502136", "1.3021523026032744"},
      velocities{"-1.4654385601661282", "-1.142077118635198", "0", "-0.9799377305445218"},
      bounces{"0", "0", "0.3", "0"};
  std::string stops;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string m = "M" + std::to_string(k);
    text += ", {name = '" + m + "', position = [0, 0, " + heights[k] + "], mass = " + masses[k] +
            ", velocity = [0, 0, " + velocities[k] + "]}";
    stops += "[[structure.constraints]]\nkind = 'line'\nnodes = ['" + m +
             "']\ndirection = [0, 0, 1]\n[[constraints]]\nkind = 'coordinate_stop'\nname = 's" +
             std::to_string(k) + "'\nnodes = [" + (k > 0 ? "'M" + std::to_string(k - 1) + "', " : "") + "'" +
             m + "']\ndirection = [0, 0, 1]\nmin = " + (k > 0 ? "0.2" : "0") +
             "\nrestitution = " + bounces[k] + "\n";
  }
  const Simulation run = testing::run_scene(
      text + "]\nrods = [{nodes = ['O', 'W'], mass = 1}]\n" + stops +
      "[[forces]]\nkind = 'load_over_time'\nnodes = ['M3']\nforce = [0, 0, 8.297512479588676]\n"
      "times = [0.3, 0.3, 0.6]\nvalues = [0, 1, -1]\n[gravity]\nacceleration = [0, 0, -9.81]\n"
      "[solver]\nstep = 0.005\nend_time = 1\n");
  REQUIRE(run.status == RunStatus::completed);
  double told = 0;
  for (const Event& event : run.events) told += event.energy_lost;
  const Diagnostics d = diagnose(run);
  CHECK(testing::largest(d, "energy_balance_J") < 1e-9);
  CHECK(told == Approx(d.at("impact_loss_J").values.back()).epsilon(1e-9));  // 36 J
}

}  // namespace stop_test
