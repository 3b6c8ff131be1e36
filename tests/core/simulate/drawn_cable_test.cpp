// SPDX-License-Identifier: BSD-3-Clause
// When a damped cable that is drawn in or paid out begins and ceases to pull and what it loses, against an
// integration of its own.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>

#include "core/study/table.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace drawn_cable_test {

namespace {

constexpr double mass = 3, stiffness = 3000, damping = 30, start_length = 2.3, ramp = 0.2;

struct Case {
  double rate, velocity;  // of the cable's length behind the ramp; of the mass at first
};

// A mass on a line away from a support, at 2 m first, and a cable between, whose rate grows evenly to its
// own.
std::string scene(const Case& c) {
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = "
         "'B', "
         "position = [2, 0, 0], velocity = [" +
         exact_number(c.velocity) +
         ", 0, 0], mass = 3}]\nrods = []\n[[forces]]\nkind = 'cable'\nname = 'c'\nnodes = ['A', 'B']\n"
         "axial_stiffness = 3000\ndamping = 30\nlength = 2.3\nmotion = 'rate'\nramp = 0.2\nrate = " +
         exact_number(c.rate) + "\n[solver]\nstages = 5\nstep = 0.002\nend_time = 0.7\n";
}

double length(const Case& c, double t) {
  return start_length + c.rate * (t < ramp ? t * t / (2 * ramp) : t - ramp / 2);
}
double pull(const Case& c, double t, double x, double v) {
  const double l = length(c, t), way = c.rate * std::min(t / ramp, 1.0);
  return stiffness * (x / l - 1) + damping * (v - way);
}

struct Times {
  double taut, slack, velocity, lost;  // lost: by the damper, then by the cable that lets go
};

// What is stored in the cable goes from where it lets go on, at x with the velocity v: to the nothing where
// it comes to its length. By the middles of parts of 1e-6 s.
double lost_by_slack(const Case& c, double t, double x, double v) {
  double lost = 0;
  for (const double h = 1e-6; x > length(c, t); t += h, x += v * h) {
    const double l = length(c, t + h / 2), e = x + v * h / 2 - l;
    lost -= h * stiffness / l * e * (v - c.rate);
  }
  return lost;
}

// Straight on to where it draws taut, then by RK4 until it would push.
Times exact(const Case& c) {
  double low = 0, high = 0.7;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (2 + c.velocity * t < length(c, t) ? low : high) = t;
  }
  const double taut = low, h = 1e-5;
  using Pair = std::array<double, 3>;
  const auto rate = [&](double t, const Pair& y) {
    const double stretching = y[1] - c.rate * std::min(t / ramp, 1.0);
    return Pair{y[1], -pull(c, t, y[0], y[1]) / mass, damping * stretching * stretching};
  };
  const auto plus = [](const Pair& y, double f, const Pair& k) {
    return Pair{y[0] + f * k[0], y[1] + f * k[1], y[2] + f * k[2]};
  };
  Pair y{2 + c.velocity * taut, c.velocity, 0};
  for (double t = taut;; t += h) {
    const Pair k1 = rate(t, y), k2 = rate(t + h / 2, plus(y, h / 2, k1)),
               k3 = rate(t + h / 2, plus(y, h / 2, k2)), k4 = rate(t + h, plus(y, h, k3));
    Pair next;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = y[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    const double before = pull(c, t, y[0], y[1]), after = pull(c, t + h, next[0], next[1]);
    if (after < 0) {
      const double part = before / (before - after), slack = t + h * part, x = y[0] + part * (next[0] - y[0]);
      return {taut, slack, next[1], y[2] + part * (next[2] - y[2]) + lost_by_slack(c, slack, x, next[1])};
    }
    y = next;
  }
}

}  // namespace

TEST_CASE("a damped cable that is drawn in or paid out pulls from drawing taut until it would push") {
  for (const Case& c : {Case{-0.8, 0.3}, {0.4, 1.5}, {-1.3, -0.2}}) {
    INFO("rate " << c.rate << " m/s");
    const Times truth = exact(c);
    REQUIRE(truth.taut > ramp);  // times before it are corners of the law
    const Simulation run = run_scene(scene(c));
    REQUIRE(run.status == RunStatus::completed);
    std::vector<Event> events;
    for (const Event& event : run.events)
      if (event.kind == "taut" || event.kind == "slack") events.push_back(event);
    REQUIRE(events.size() >= 2);
    CHECK(events[0].kind == "taut");
    CHECK(events[0].name == "c pulls");
    CHECK(events[0].t == Approx(truth.taut).epsilon(1e-10));
    CHECK(events[1].kind == "slack");
    CHECK(events[1].name == "c is slack");
    // Chords of 1e-5 s on a pull whose bend is some 1e5 of it: 1e-9 of a swing of 0.14 s.
    CHECK(events[1].t == Approx(truth.slack).epsilon(0).margin(1e-9));
    CHECK(run.trajectory.velocities_at(events[1].t)[3] == Approx(truth.velocity).epsilon(1e-6));
    REQUIRE(events.size() == 2);
    const Diagnostics d = diagnose(run);
    // As the velocity, and parts of 1e-6 s of some ms.
    CHECK(d.at("dissipated_J").values.back() == Approx(truth.lost).epsilon(1e-6));
    CHECK(std::abs(d.at("energy_balance_J").values.back()) < 1e-8 * truth.lost);
  }
}

// 1 kg that moves away at v from where its cable is just straight, and is pushed back by F: it pulls from the
// start until s = 0 once more (with damping until the force is zero), and is then free. Steps are longer than
// that by far.
TEST_CASE("a cable that is just straight at the start pulls from there on however long steps are") {
  struct Start {
    double stiffness, damping, speed, push, end;
  };
  for (const Start& c : {Start{2000, 0, 0.2, 20, 0.2}, {2000, 100, 1, 100, 0.2}, {5e4, 0, 1, 200, 0.05}}) {
    // s'' = -F - k s - c s' by steps of Runge's and Kutta's formula, until the tension is zero.
    double s = 0, u = c.speed, t = 0;
    const auto tension = [&](double x, double v) { return c.stiffness * x + c.damping * v; };
    const auto pulled = [&](double h) {
      const auto a = [&](double x, double v) { return -c.push - tension(x, v); };
      const double a1 = a(s, u), u2 = u + h / 2 * a1, a2 = a(s + h / 2 * u, u2), u3 = u + h / 2 * a2,
                   a3 = a(s + h / 2 * u2, u3), u4 = u + h * a3, a4 = a(s + h * u3, u4);
      return std::pair{s + h / 6 * (u + 2 * u2 + 2 * u3 + u4), u + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)};
    };
    for (double h = 1e-6; h > 1e-15;) {
      const auto [s1, u1] = pulled(h);
      if (tension(s1, u1) > 0)
        s = s1, u = u1, t += h;
      else
        h /= 2;
    }
    const double left = c.end - t, exact = 1 + s + u * left - c.push / 2 * left * left;
    for (const int stages : {5, 8})
      for (const double share : {1.0, 0.5, 0.25}) {
        CAPTURE(c.stiffness, c.damping, stages, share, t, exact);
        const Simulation run = run_scene(
            "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name "
            "= "
            "'B', position = [1, 0, 0], mass = 1, velocity = [" +
            number(c.speed) +
            ", 0, 0]}]\n[[constraints]]\nkind = 'line'\nnodes = ['B']\ndirection = [1, 0, "
            "0]\n[[loads]]\nnodes = "
            "['B']\nforce = [" +
            number(-c.push) +
            ", 0, 0]\n[[forces]]\nkind = 'cable'\nname = 'c'\nnodes = ['O', "
            "'B']\naxial_stiffness = " +
            number(c.stiffness) + "\ndamping = " + number(c.damping) +
            "\n[solver]\nend_time = " + number(c.end) + "\nstep = " + number(share * c.end) +
            "\nstages = " + std::to_string(stages) + "\n");
        REQUIRE(run.status == RunStatus::completed);
        // The pull is one step, omega t of it 0.8 to 1.7: five stages are of order 8, and have it to (omega
        // t)^8 of some 1e-8 of the way; eight are of order 14.
        const double of_order_8 = std::max(1e-10, 3.1e-9 * std::pow(std::sqrt(c.stiffness) * t, 8));
        CHECK(end_positions(run)[3] == Approx(exact).epsilon(0).margin(stages == 5 ? of_order_8 : 1e-10));
        CHECK(std::ranges::count(run.events, "slack", &Event::kind) == 1);
      }
  }
}

// 2 kg run into a cable that does not stretch and is drawn in, and into that of a winch whose drum stands: at
// 1 + 3 t = 1.3 - 0.5 t, and by the drum's path behind 0.1 s. Both jerks are those of cables, not of stops.
TEST_CASE("cables that do not stretch draw taut by that kind of event") {
  const Simulation run = testing::run_scene(
      "[structure]\nkind = \"custom\"\nnodes = [{name = \"X\", position = [0, 0, 0], fixed = true}, "
      "{name = \"M\", position = [1, 0, 0], mass = 2, velocity = [3, 0, 0]}, {name = \"N\", position = [1, "
      "1, "
      "0], mass = 2, velocity = [3, 0, 0]}, {name = \"Z\", position = [0, 1, 0], fixed = true}]\n"
      "[[constraints]]\nkind = \"line\"\nnodes = [\"M\", \"N\"]\ndirection = [1, 0, 0]\n"
      "[[constraints]]\nkind = \"cable\"\nname = \"c\"\nnodes = [\"X\", \"M\"]\nlength = 1.3\n"
      "motion = \"rate\"\nrate = -0.5\n"
      "[[forces]]\nkind = \"winch\"\nname = \"w\"\nnodes = [\"Z\", \"N\"]\nlength = 1.3\nstall_torque = "
      "1e-9\n"
      "no_load_speed = 1e9\ndrum_radius = 0.1\ngear_ratio = 2\ninertia = 1e-3\nvoltage = 0\n"
      "[solver]\nstep = 0.01\nstages = 4\nend_time = 0.5\n");
  REQUIRE(run.events.size() >= 2);
  CHECK(run.events[0].element == "c");
  CHECK(run.events[0].t == Approx(0.3 / 3.5).epsilon(1e-9));
  CHECK(run.events[1].element == "w cable");
  CHECK(run.events[1].t == Approx(0.1).epsilon(1e-6));
  for (const Event& event : run.events) {
    INFO(event.name);
    CHECK(event.kind == (event.name.ends_with(" pulls") ? "taut" : "slack"));
  }
  CHECK(run.events[0].energy_lost > 0);
}

}  // namespace drawn_cable_test
