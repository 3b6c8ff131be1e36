// SPDX-License-Identifier: BSD-3-Clause
// Which rod bears most, and when, by forces that are given.
#include "core/diagnostics/rod_peaks.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace rod_peaks_test {

namespace {

using States = std::vector<std::size_t>;

// A force that rises to a top and falls, as a parabola does.
struct Hump {
  double top, at, bend;
  double operator()(double t) const { return top - bend * (t - at) * (t - at); }
};

// A star of rods whose forces are such humps at the states of a run: those of a push are their mirror images.
struct Humps {
  std::vector<double> times{0.1, 0.25, 0.55, 0.7, 0.95, 1.3, 1.42, 1.8, 2.1};
  std::vector<Hump> rods;
  std::size_t hidden = 99;       // a rod that is not shown
  std::size_t singular = 99;     // a state at a singular pose
  std::size_t other_model = 99;  // the first state of another model

  States found() const {
    std::string text =
        "structure.kind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n";
    for (std::size_t r = 0; r < rods.size(); ++r)
      text += "[[structure.nodes]]\nname = 'P" + std::to_string(r) + "'\nposition = [" +
              std::to_string(r + 1) + ", 0.3, 0]\nmass = 1\n[[structure.rods]]\nnodes = ['O', 'P" +
              std::to_string(r) + "']\nmass = 0.2\n";
    const auto model = testing::model_of(text + "[solver]\nend_time = 1\n");
    Trajectory run(model);
    Diagnostics pulls, pushes;
    const auto n = static_cast<Index>(rods.size());
    pulls.axial_force.resize(static_cast<Index>(times.size()), n);
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (i == other_model) run.change_model(testing::model_of(text + "[solver]\nend_time = 2\n"));
      State state;
      state.t = times[i];
      StepReport report;
      report.singular_event = i == singular;
      run.append(std::move(state), report);
      for (std::size_t r = 0; r < rods.size(); ++r)
        pulls.axial_force(static_cast<Index>(i), static_cast<Index>(r)) = rods[r](times[i]);
    }
    pulls.rod_shown.assign(rods.size(), 1);
    if (hidden < rods.size()) pulls.rod_shown[hidden] = 0;
    pushes = pulls;
    pushes.axial_force = -pulls.axial_force;
    States out = rod_humps(run, pulls, "axial_force_max_N", 1.0);
    CHECK(rod_humps(run, pushes, "axial_force_min_N", -1.0) == out);
    return out;
  }
};

constexpr double g = 9.81, degree = pi / 180;
enum Rods : Index { swing, hang, over, strut };

// A pendulum swings from rest through its lowest point, one stands on its bar and goes over it. Beside each
// is a rod at rest that bears 0.01 N less than the most that the other does, and more than that at any state.
struct TwoSwings {
  double angle = 67 * degree, l = 0.9, m = 1.3, beside = 35 * degree, bar = 0.7, bob = 0.8, rate2 = 2;
  double pull() const { return m * g * (3 - 2 * std::cos(angle)); }
  double push() const { return bob * (g - rate2 / bar); }  // rate2: the square of its speed on top [m^2/s^2]

  Simulation run(double step, const std::vector<std::string>& more = {}) const {
    const double speed = std::sqrt(rate2 + 2 * g * bar * (1 - std::cos(beside)));
    std::vector<std::string> changes{"solver.step=" + testing::number(step)};
    const auto give = [&](const char* name, double value) {
      changes.push_back(std::string("variables.") + name + "=" + testing::number(value));
    };
    give("x", l * std::sin(angle)), give("z", -l * std::cos(angle)), give("m", m);
    give("hung", (pull() - 0.01) / g), give("stands", (push() - 0.01) / g), give("bob", bob);
    give("u", -bar * std::sin(beside)), give("w", bar * std::cos(beside));
    give("du", speed * std::cos(beside)), give("dw", speed * std::sin(beside));
    changes.insert(changes.end(), more.begin(), more.end());
    return testing::run_scene(R"(
variables = {x = 0, z = 0, m = 0, hung = 0, stands = 0, bob = 0, u = 0, w = 0, du = 0, dw = 0}
[structure]
kind = "custom"
youngs_modulus = 2e11
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = ["=x", 0, "=z"], mass = "=m"},
  {name = "P", position = [0, 1, 0], fixed = true}, {name = "B", position = [0, 1, -0.8], mass = "=hung"},
  {name = "Q", position = [0, 2, 0], fixed = true},
  {name = "C", position = ["=u", 2, "=w"], velocity = ["=du", 0, "=dw"], mass = "=bob"},
  {name = "R", position = [0, 3, 0], fixed = true}, {name = "D", position = [0, 3, 0.7], mass = "=stands"}]
rods = [{name = "swing", nodes = ["O", "A"], mass = 0, area = 1.1e-6, strength = 3e8, second_moment = 5e-12},
        {name = "hang", nodes = ["P", "B"], mass = 0, area = 1.1e-6, strength = 3e8, second_moment = 5e-12},
        {name = "over", nodes = ["Q", "C"], mass = 0, area = 2.3e-6, strength = 1e8, second_moment = 7e-13},
        {name = "strut", nodes = ["R", "D"], mass = 0, area = 2.3e-6, strength = 1e8, second_moment = 7e-13}]
constraints = [{kind = "plane", nodes = ["A", "B", "C"], normal = [0, 1, 0]},
               {kind = "line", nodes = ["D"], direction = [0, 0, 1]}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 6
end_time = 0.6
)",
                              changes);
  }
};

// How far aside of its pivot the bob of a rod is at a time [m].
double aside(const Simulation& run, Index rod, double t) {
  return run.trajectory.positions_at(t)[3 * (2 * rod + 1)];
}

}  // namespace

// A rod bears 10 N all the time. Beside it a hump may top that where its parabola, as far above its highest
// state again, does: top + bend (t_k - at)^2 > 10.
TEST_CASE("humps of single rods that may top all forces are found, the highest first") {
  const Hump level{10, 0, 0}, high{9.99, 0.6, 8}, beside{9.98, 0.53, 100}, second{9.97, 1.375, 30},
      third{9.96, 1.7, 5}, low{9.94, 0.9, 20}, first{9.955, 0.28, 60};
  CHECK(Humps{.rods = {level}}.found().empty());
  CHECK(Humps{.rods = {level, high}}.found() == States{2});
  CHECK(Humps{.rods = {level, low}}.found().empty());
  CHECK(Humps{.rods = {first, level}}.found() == States{1});
  CHECK(Humps{.rods = {third, level}}.found() == States{7});
  // Three at the most, of one state once.
  CHECK(Humps{.rods = {low, first, third, beside, level, second, high}}.found() == States{2, 6, 7});
  CHECK(Humps{.rods = {low, first, beside, level, second, high}}.found() == States{2, 6, 1});
  // The humps of rods that are not shown are none, and what such a rod bears does not hide others.
  const Hump largest{30, 1.0, 3};
  CHECK(Humps{.rods = {first, level, largest, third}}.found() == States{4});
  CHECK(Humps{.rods = {first, level, largest, third}, .hidden = 2}.found() == States{7, 1});
}

TEST_CASE("a hump of a rod is one of a smooth motion through three states") {
  const std::vector<Hump> rods{
      {10, 0, 0}, {9.99, 0.6, 8}, {9.97, 1.375, 30}, {9.96, 1.7, 5}, {9.955, 0.28, 60}};
  REQUIRE(Humps{.rods = rods}.found() == States{2, 6, 7});
  // Where the step from state 6 to 7 is none: into a singular pose, to another model, of no length.
  CHECK(Humps{.rods = rods, .singular = 7}.found() == States{2, 1});
  CHECK(Humps{.rods = rods, .other_model = 7}.found() == States{2, 1});
  CHECK(Humps{.times = {0.1, 0.25, 0.55, 0.7, 0.95, 1.3, 1.42, 1.42, 2.1}, .rods = rods}.found() ==
        States{2, 1});
  CHECK(Humps{.rods = rods, .singular = 3}.found() == States{6, 7, 1});
  CHECK(Humps{.rods = rods, .singular = 2}.found() == States{6, 7});  // of states 1 and 2
}

// Of six stages steps of 0.08 s leave 1e-9 of forces; a time at which one is flat is known to the root of
// that.
TEST_CASE("the rod that bears most within a step only is named, with its force and its time") {
  const TwoSwings two;
  for (const double step : {0.08, 0.07}) {
    INFO(step);
    const Simulation run = two.run(step);
    const Diagnostics d = diagnose(run);
    const auto check = [&](const PeakForce& peak, Index rod, double force) {
      CHECK(peak.rod == rod);
      CHECK(peak.force_N == Approx(force).epsilon(1e-7));
      CHECK(aside(run, rod, peak.t) == Approx(0).margin(1e-3));
      CHECK(peak.unique);
    };
    REQUIRE(peak_rod_force(d, Pull::tension).rod == hang);
    REQUIRE(peak_rod_force(d, Pull::compression).rod == strut);
    check(peak_rod_force(run, d, Pull::either), swing, two.pull());
    check(peak_rod_force(run, d, Pull::tension), swing, two.pull());
    check(peak_rod_force(run, d, Pull::compression), over, -two.push());
  }
}

// Stresses of two bars of one section are as their forces; which of pull and push is the worse their areas
// say.
TEST_CASE("the rod with the worst stress or nearest to buckling within a step only is named") {
  const TwoSwings two;
  const Simulation run = two.run(0.08),
                   thin = two.run(0.08, {"structure.rods[2].area=2.1e-7", "structure.rods[3].area=2.1e-7"});
  const Diagnostics d = diagnose(run), d_thin = diagnose(thin);
  const auto check = [](const Simulation& of, const Diagnostics& known, auto quantity, Index rod,
                        double value) {
    const WorstRod worst = worst_rod(of, known, quantity);
    CHECK(worst.rod == rod);
    CHECK(worst.value == Approx(value).epsilon(1e-7));
    CHECK(aside(of, rod, worst.t) == Approx(0).margin(1e-3));
    CHECK(worst.unique);
  };
  const double euler = pi * pi * 2e11 * 7e-13 / (two.bar * two.bar);
  REQUIRE(worst_rod(run.trajectory.structure(), d, axial_stress).rod == hang);
  REQUIRE(worst_rod(thin.trajectory.structure(), d_thin, axial_stress).rod == strut);
  check(run, d, axial_stress, swing, two.pull() / 1.1e-6);
  check(run, d, stress_ratio, swing, two.pull() / 1.1e-6 / 3e8);
  check(run, d, buckling_ratio, over, two.push() / euler);
  check(thin, d_thin, axial_stress, over, -two.push() / 2.1e-7);
  check(thin, d_thin, stress_ratio, over, two.push() / 2.1e-7 / 1e8);
}

TEST_CASE("a peak within a step is unique where its force is at both ends of the step") {
  const Simulation run = TwoSwings().run(0.08);
  const Diagnostics d = diagnose(run);
  const auto after = static_cast<Index>(run.trajectory.state_before(peak_rod_force(run, d).t)) + 1;
  REQUIRE(after >= 2);
  for (Index i = after - 2; i <= after + 1; ++i) {
    INFO(i - after);
    Diagnostics other = d;
    other.force_unique(i, swing) = false;
    const bool at_an_end = i == after || i == after - 1;
    CHECK(peak_rod_force(run, other).unique != at_an_end);
    CHECK(worst_rod(run, other, axial_stress).unique != at_an_end);
    other = d;
    other.axial_force(i, over) = std::nan("");  // may be larger
    CHECK_FALSE(worst_rod(run, other, axial_stress).unique);
  }
}

}  // namespace rod_peaks_test
