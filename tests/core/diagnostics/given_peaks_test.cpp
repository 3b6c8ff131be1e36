// SPDX-License-Identifier: BSD-3-Clause
// Largest values of a motion by functions of time that are given: their tops are known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/peaks.hpp"
#include "core/study/table.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace given_peaks_test {

namespace {

using OfTime = std::function<double(double)>;

// A free mass that flies on, or swings on a spring of this rate [rad/s], with states at times that are given.
struct Flight {
  double rate = 0;
  double step = 0.1;

  Simulation run(const std::vector<double>& times) const {
    const auto model = testing::model_of(
        "structure.kind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
        "[[structure.nodes]]\nname = 'P'\nposition = [0.7, 0, 0]\nmass = 1.3\n" +
        (rate > 0 ? "[[forces]]\nkind = 'spring'\nnodes = ['O', 'P']\nfree_length = 0.5\nstiffness = " +
                        std::to_string(1.3 * rate * rate) + "\n"
                  : std::string()) +
        "[solver]\nend_time = 1\n");
    SolverOptions options;
    options.step = step, options.stages = 8;
    Simulation out{.trajectory = Trajectory(model, options), .options = options};
    for (const double t : times) {
      State state;
      state.t = t;
      const double x = rate > 0 ? 0.5 + 0.2 * std::cos(rate * t) : 0.7 + 0.4 * t;
      const double v = rate > 0 ? -0.2 * rate * std::sin(rate * t) : 0.4;
      state.z = Vec3(x, 0, 0), state.w = Vec3(v, 0, 0);
      out.trajectory.append(std::move(state), StepReport{});
    }
    return out;
  }
};

PeakInMotion top_of(const Simulation& run, const OfTime& f, std::size_t* asked = nullptr) {
  const auto values = [&](const Simulation& piece) {
    std::vector<double> out;
    if (asked && &piece != &run) *asked += piece.trajectory.size();
    for (std::size_t i = 0; i < piece.trajectory.size(); ++i) out.push_back(f(piece.trajectory.time(i)));
    return out;
  };
  return top_of_motion(run, values(run), values);
}

}  // namespace

// Parabolas between states of a smooth motion: their tops to rounding of 9 values around them.
TEST_CASE("the top of a value between states is found whichever step it lies in") {
  const Simulation run = Flight().run({0, 0.11, 0.19, 0.31, 0.4, 0.52, 0.6});
  for (const double at : {0.04, 0.09, 0.15, 0.27, 0.36, 0.44, 0.5, 0.57})
    for (const double most : {7.3, -7.3}) {  // the latter as the least value of a column that is positive
      CAPTURE(at, most);
      const PeakInMotion top = top_of(run, [&](double t) { return most - 31 * (t - at) * (t - at); });
      CHECK(top.value == Approx(most).epsilon(1e-12));
      CHECK(top.t == Approx(at).epsilon(0).margin(1e-6));
    }
  CHECK(top_of(run, [](double t) { return 2.3 + t; }).t == 0.6);
  CHECK(top_of(run, [](double t) { return 2.3 - t; }).t == 0.0);
}

// Nine times of the step tell; a corner in the last eighth of it is looked for as ever.
TEST_CASE("what rises to an end or stays the same is not looked at any closer") {
  const Simulation run = Flight().run({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  std::size_t asked = 0;
  const PeakInMotion last = top_of(
      run, [](double t) { return 2.3 + t - 0.4 * t * t; }, &asked);
  CHECK(last.t == 0.6);
  CHECK(asked == 9);
  asked = 0;
  const PeakInMotion first = top_of(
      run, [](double t) { return std::exp(-3 * t); }, &asked);
  CHECK(first.t == 0.0);
  CHECK(asked == 9);
  asked = 0;
  const PeakInMotion same = top_of(
      run, [](double t) { return 7 + 1e-11 * std::cos(1e5 * t); }, &asked);
  CHECK(same.value == Approx(7).epsilon(0).margin(2e-11));
  CHECK(asked <= 27);  // around three states at most
  const double corner = 0.597;
  const PeakInMotion bent = top_of(run, [&](double t) { return 1 + t - 1.3 * std::max(t - corner, 0.0); });
  CHECK(bent.value == Approx(1 + corner).epsilon(0).margin(1e-9));
}

// Of 60 bells in a row, each between two states of one value, one is the highest.
TEST_CASE("of many tops within steps the highest is found") {
  std::vector<double> times;
  for (int k = 0; k <= 180; ++k) times.push_back(0.01 * k + 0.001 * (k % 3 == 1));
  const Simulation run = Flight{.step = 0.01}.run(times);
  for (const int highest : {0, 7, 31, 59}) {
    const auto f = [&](double t) {
      double sum = 0;
      for (int k = 0; k < 60; ++k) {
        const double u = (t - 0.03 * k - 0.0157) / 0.006;
        sum += (k == highest ? 1.31 : 1 + 0.004 * (k * 7 % 60)) * std::exp(-u * u);
      }
      return sum;
    };
    const double at = 0.03 * highest + 0.0157;
    INFO(highest);
    const PeakInMotion top = top_of(run, f);
    CHECK(top.value == Approx(1.31).epsilon(1e-6));
    CHECK(top.t == Approx(at).epsilon(0).margin(1e-5));
  }
}

// Between two blows within a step, of which each has two states at its time, the value is the same.
TEST_CASE("a value that rises between two events within a step only has its top there") {
  for (const double from : {0.13, 0.31, 0.55}) {
    const double to = from + 0.031;
    std::vector<double> times;
    for (const double t : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
      times.push_back(t);
      if (t < from && from < t + 0.1) times.insert(times.end(), {from, from, to, to});
    }
    INFO(from);
    const PeakInMotion top = top_of(Flight().run(times), [&](double t) {
      return from <= t && t <= to ? 1.7 + 900 * (t - from) * (to - t) : 1.9 - 0.1 * t;
    });
    CHECK(top.value == Approx(1.7 + 900 * 0.0155 * 0.0155).epsilon(1e-9));
    CHECK(top.t == Approx(from + 0.0155).epsilon(0).margin(1e-6));
  }
}

// Steps of a third of a swing and more: what is between two states of one value is looked for in each. 40 of
// them, in all but one a lower one.
TEST_CASE("the top within a long step is found among those of many") {
  const double h = 0.21;
  std::vector<double> times;
  for (int k = 0; k <= 40; ++k) times.push_back(h * k);
  const Simulation run = Flight{.rate = 11, .step = h}.run(times);
  for (const int highest : {0, 5, 33, 39}) {
    INFO(highest);
    const PeakInMotion top = top_of(run, [&](double t) {
      const int k = std::min(39, static_cast<int>(t / h));
      const double u = t / h - k;
      return (k == highest ? 0.9 : 0.2 + 0.01 * (k * 7 % 40)) * 16 * u * u * (1 - u) * (1 - u);
    });
    CHECK(top.value == Approx(0.9).epsilon(1e-6));
    CHECK(top.t == Approx(h * (highest + 0.5)).epsilon(0).margin(1e-4));
  }
}

// A mass of 1.3 kg led 0.4 m smoothly within 1 s, 10 u^3 - 15 u^4 + 6 u^5 of the way: its energy is largest
// at its largest speed, of 15/8 m/s a metre, at half the time, where its power changes sign and no state is.
// The cubic through energies and powers is off by h^4 / 384 of its fourth derivative, 1900 times itself
// there.
TEST_CASE("what a drive has put in is largest within a step") {
  const double most = 0.5 * 1.3 * std::pow(0.4 * 15 / 8, 2);
  double before = 0;
  for (const double h : {0.09, 0.05 * 0.9}) {
    const Simulation run = testing::run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1.3}]
[[constraints]]
kind = "coordinate"
name = "lift"
nodes = ["A"]
direction = [0, 0, 1]
motion = "smooth"
to = 0.4
duration = 1
[solver]
stages = 4
end_time = 1.1
step = )" + exact_number(h));
    REQUIRE(run.status == RunStatus::completed);
    const double off = std::abs(largest_of_column(run, diagnose(run), "lift.energy_J") - most);
    CHECK(off <= 2 * 1900 * std::pow(h, 4) / 384 * most);
    if (before > 0) CHECK(off < before / 8);
    before = off;
  }
}

// Power that jumps from 3 W to -2 W at a state: no energy is above that of the state.
TEST_CASE("what a drive has put in is largest where its power jumps") {
  const Simulation run = testing::run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1.3}]
[[constraints]]
kind = "coordinate"
name = "lift"
nodes = ["A"]
direction = [0, 0, 1]
motion = "rate"
rate = 0.5
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [0, 0, 1]
times = [0, 0.47, 0.47, 1]
values = [-6, -6, 4, 4]
[solver]
stages = 4
end_time = 1
step = 0.1
)");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  CHECK(largest_of_column(run, d, "lift.energy_J") == Approx(6 * 0.5 * 0.47).epsilon(1e-9));
}

}  // namespace given_peaks_test
