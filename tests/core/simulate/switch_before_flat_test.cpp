// SPDX-License-Identifier: BSD-3-Clause
// What begins, goes taut or strikes shortly before a deployed pose with rods in line.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace switch_before_flat_test {

namespace {

using testing::number;

constexpr double inertia = 5.0 / 3,
                 weight = 2 * 9.81;          // of the angle: two legs and a coupler, 1 m and 1 kg each
const double root = std::sqrt(3.0) / 2;      // sine of the angle at the start
constexpr double flat = 0.5378480610210875;  // [s], from rest under gravity alone

// Two cranks of 1 m with pivots in one line and their coupler, from 60 degrees at rest into one line.
std::string cranks(const std::string& nodes, const std::string& rest) {
  std::string out =
      "[structure]\nkind = \"custom\"\nnodes = [{name = \"X\", position = [9, 0, 0], fixed = true}";
  for (const int i : {0, 1}) {
    const std::string k = std::to_string(i);
    out += ", {name = \"A" + k + "\", position = [" + number(0.7 * i) +
           ", 0, 0], fixed = true}, {name = \"B" + k + "\", position = [" + number(0.7 * i + 0.5) + ", 0, " +
           number(root) + "]}";
  }
  return out + nodes + R"(]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1}]
constraints = [{kind = "plane", nodes = ["B*"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
[solver]
end_time = 2
stages = 5
)" + rest;
}

// B0's velocity in the deployed pose.
double speed(const Simulation& run) {
  REQUIRE(run.status == RunStatus::deployed);
  return run.trajectory.velocities(run.trajectory.size() - 1)[8];
}

struct Flat {
  double t, rate;
};

// When and how fast the angle falls to zero under a load of these values, `apart` from each other: by
// Runge-Kutta's method from point to point, off by less than 1e-13.
Flat fall_under(const std::vector<double>& values, double begin, double apart) {
  using Pair = std::array<double, 2>;
  const auto step = [](const Pair& y, double h, double force, double slope) {
    const auto rate = [&](const Pair& x, double s) {
      return Pair{x[1], (force + slope * s - weight) * std::cos(x[0]) / inertia};
    };
    const auto on = [&](const Pair& k, double s) { return Pair{y[0] + s * k[0], y[1] + s * k[1]}; };
    const Pair a = rate(y, 0), b = rate(on(a, h / 2), h / 2), c = rate(on(b, h / 2), h / 2),
               d = rate(on(c, h), h);
    return Pair{y[0] + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]),
                y[1] + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])};
  };
  constexpr int before = 4000, parts = 20;
  Pair y{std::asin(root), 0};
  for (int i = 0; i < before; ++i) y = step(y, begin / before, 0, 0);
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    const double h = apart / parts, slope = (values[k + 1] - values[k]) / apart;
    for (int i = 0; i < parts; ++i) {
      const double force = values[k] + slope * h * i;
      const Pair next = step(y, h, force, slope);
      if (next[0] > 0) {
        y = next;
        continue;
      }
      double low = 0, high = h;
      for (int j = 0; j < 60; ++j) {
        const double middle = 0.5 * (low + high);
        (step(y, middle, force, slope)[0] > 0 ? low : high) = middle;
      }
      return {begin + apart * static_cast<double>(k) + h * i + high, step(y, high, force, slope)[1]};
    }
  }
  return {};
}

std::string load(const std::string& times, const std::string& values) {
  return "\n[[forces]]\nkind = \"load_over_time\"\nnodes = [\"B0\"]\nforce = [0, 0, 1]\ntimes = [" + times +
         "]\nvalues = [" + values + "]\n";
}

}  // namespace

// I th'' = (F - 2 g) cos th: I th'^2 / 2 falls by F - 2 g times the sine. The sine at which the load begins
// is the run's own, where that has an edge of time.
TEST_CASE("a load that begins shortly before a flat deployed pose acts in what is left") {
  for (const double before : {0.01, 1e-3, 5e-4, 1e-5})
    for (const double force : {-200.0, 250.0})
      for (const char* step : {"0.01", "0.003"}) {
        INFO(before << " s, " << force << " N, step " << step);
        const std::string t = number(flat - before);
        const Simulation run = testing::run_scene(
            cranks("", "step = " + std::string(step) +
                           load(t + ", " + t + ", 9", "0, " + number(force) + ", " + number(force))));
        const double sine = run.trajectory.positions_at(flat - before)[8];
        // Next to the pose rounding, 1e-16 / sine^2, takes digits of rates.
        CHECK(speed(run) ==
              Approx(-std::sqrt(2 * (weight * root - force * sine) / inertia)).epsilon(0).margin(1e-7));
      }
}

TEST_CASE("a load with a point each millisecond leads to a flat deployed pose as its equation does") {
  constexpr double apart = 1e-3, begin = 0.4705;
  for (const double most : {30.0, 100.0}) {
    std::vector<double> values;
    std::string t, v;
    for (int i = 0; i < 100; ++i) {
      values.push_back(i == 0 ? 0.0 : most * std::sin(2.4 * i * i));  // up and down
      t += (i > 0 ? ", " : "") + number(begin + apart * i), v += (i > 0 ? ", " : "") + number(values.back());
    }
    const Flat flat_under = fall_under(values, begin, apart);
    for (const char* step : {"0.01", "0.003", "0.001"}) {
      INFO(most << " N, step " << step);
      const Simulation run = testing::run_scene(cranks("", "step = " + std::string(step) + load(t, v)));
      // Of a pose there the last digits of lengths tell rates to some 1e-8.
      CHECK(speed(run) == Approx(flat_under.rate).epsilon(0).margin(1e-7));
      CHECK(run.trajectory.end_time() == Approx(flat_under.t).epsilon(0).margin(1e-11));
    }
  }
}

// What one leg bears and the other does not goes through the coupler, T sin th = half of its moment: without
// bound, unless both bear the same. Behind the last bend there may be no room but on the other side.
TEST_CASE("forces without bound in a flat pose are told however shortly before it a load bends") {
  for (const double before : {0.1, 5e-3, 1e-3, 2e-4})
    for (const bool both : {false, true}) {
      INFO(before << " s, " << (both ? "both legs" : "one leg"));
      const Simulation run = testing::run_scene(
          cranks("", "step = 0.01\n[[forces]]\nkind = \"load_over_time\"\nnodes = [\"B" +
                         std::string(both ? "*" : "0") + "\"]\nforce = [0, 0, 1]\ntimes = [0, " +
                         number(flat - before) + ", 9]\nvalues = [0, 1e-3, 5]\n"));
      REQUIRE(run.status == RunStatus::deployed);
      const Trajectory& path = run.trajectory;
      CHECK(path.state(path.size() - 1).lambda.hasNaN() == !both);
    }
}

// A spring's energy is what the stay takes.
TEST_CASE("a stay that goes taut shortly before a flat deployed pose holds back") {
  for (const auto& [angle, stiffness] :
       {std::array{1e-2, 2e4}, std::array{1.1e-2, 66e3}, std::array{3e-3, 2e4}, std::array{1e-3, 2e4}})
    for (const char* step : {"0.01", "0.002"}) {
      INFO(angle << ", " << stiffness << " N/m, step " << step);
      const double rest = std::hypot(1 - std::cos(angle), 3 - std::sin(angle));
      const Simulation run =
          testing::run_scene(cranks(", {name = \"Y\", position = [1.7, 0, 3], fixed = true}",
                                    "step = " + std::string(step) +
                                        "\n[[forces]]\nkind = \"spring\"\nname = \"stay\"\nnodes = [\"Y\", "
                                        "\"B1\"]\ntension_only = true\nstiffness = " +
                                        number(stiffness) + "\nfree_length = " + number(rest) + "\n"));
      const double taken = 0.5 * stiffness * (3 - rest) * (3 - rest);
      CHECK(speed(run) == Approx(-std::sqrt(2 * (weight * root - taken) / inertia)).epsilon(0).margin(1e-6));
      REQUIRE(run.events.size() >= 2);
      CHECK(run.events[0].kind == "taut");
    }
}

// Both, one before the other. Where a step ends 1e-3 rad off the pose angles are known to some 3e-11, and the
// rates of the pose that states from there on tell to 5e-7.
TEST_CASE("a load and a stay that begin shortly before a flat deployed pose take their energy") {
  constexpr int scenes = 24;
  for (int i = 0; i < scenes; ++i) {
    const auto share = [i](double x) { return std::fmod(x * (i + 1), 1.0); };  // of anything, spread evenly
    const double before = std::pow(10.0, -5 + 3 * share(0.618)), force = 600 * share(0.414) - 300,
                 angle = std::pow(10.0, -3.5 + 1.5 * share(0.732)),
                 stiffness = std::pow(10.0, 2 + 3 * share(0.236)),
                 rest = std::hypot(1 - std::cos(angle), 3 - std::sin(angle));
    INFO(before << " s, " << force << " N, " << angle << ", " << stiffness << " N/m");
    const std::string t = number(flat - before);
    const Simulation run = testing::run_scene(cranks(
        ", {name = \"Y\", position = [1.7, 0, 3], fixed = true}",
        "step = 0.003" + load(t + ", " + t + ", 9", "0, " + number(force) + ", " + number(force)) +
            "[[forces]]\nkind = \"spring\"\nnodes = [\"Y\", \"B1\"]\ntension_only = true\nstiffness = " +
            number(stiffness) + "\nfree_length = " + number(rest) + "\n"));
    const double sine = run.trajectory.positions_at(flat - before)[8],
                 taken = 0.5 * stiffness * (3 - rest) * (3 - rest) + force * sine;
    CHECK(speed(run) == Approx(-std::sqrt(2 * (weight * root - taken) / inertia)).epsilon(0).margin(1e-6));
  }
}

TEST_CASE("what strikes beside a structure before its flat deployed pose takes nothing of that") {
  for (const double before : {2e-3, 1e-4, 1e-6}) {
    INFO(before << " s");
    const double fall = flat - before;
    const Simulation run = testing::run_scene(
        cranks(", {name = \"Q\", position = [5, 0, " + number(0.5 * 9.81 * fall * fall) + "], mass = 1}",
               "step = 0.01\n[[constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"Q\"]\ndirection = [0, "
               "0, 1]\nmin = "
               "0\nrestitution = 0.8\n"));
    CHECK(speed(run) == Approx(-std::sqrt(2 * weight * root / inertia)).epsilon(0).margin(1e-7));
    CHECK(run.trajectory.velocities(run.trajectory.size() - 1)[17] ==
          Approx(9.81 * (0.8 * fall - before)).epsilon(0).margin(1e-9));
    CHECK(run.trajectory.end_time() == Approx(flat).epsilon(0).margin(1e-10));
  }
}

}  // namespace switch_before_flat_test
