// SPDX-License-Identifier: BSD-3-Clause
// Cables where a stop or a latch stops the motion on the path, against closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "core/diagnostics/peaks.hpp"
#include "core/path/path_run.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::end_positions, unfurl::testing::number;

namespace path_jumps_test {

namespace {

Simulation run_on_path(const std::string& text, const std::vector<std::string>& changes = {}) {
  const Scene scene = read_scene_text(text, "s.toml", changes);
  return simulate_on_path(build_model(scene), scene.solver);
}

// 1 kg on a line along x.
std::string slider(double x, double speed, const std::string& more) {
  return R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", mass = 1, position = [)" +
         number(x) + ", 0, 0], velocity = [" + number(speed) + R"(, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
)" + more;
}

// Slack while it shortens at more than 0.1 m/s and more, k (x - 1) = 5 N where it is stopped at 1.5 m.
const std::string cable = R"(
[[forces]]
kind = "spring"
name = "cab"
nodes = ["O", "P"]
stiffness = 10
damping = 50
free_length = 1
tension_only = true
)";
const std::string stop = R"(
[[constraints]]
kind = "coordinate_stop"
name = "st"
nodes = ["P"]
direction = [1, 0, 0]
min = 1.5
restitution = 0
)";

std::string load(const std::string& times, const std::string& values) {
  return "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"P\"]\nforce = [1, 0, 0]\ntimes = " + times +
         "\nvalues = " + values + "\n";
}

// From 1.5 m at rest at t0 on: x'' = L - 10 (x - 1) - 50 x'.
double pulled(const std::function<double(double)>& L, double t0, double t1) {
  constexpr int n = 20000;
  double x = 1.5, v = 0;
  const double h = (t1 - t0) / n;
  const auto a = [&](double t, double at, double speed) { return L(t) - 10 * (at - 1) - 50 * speed; };
  for (int i = 0; i < n; ++i) {
    const double t = t0 + i * h, a1 = a(t, x, v), v2 = v + 0.5 * h * a1;
    const double a2 = a(t + 0.5 * h, x + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
    const double a3 = a(t + 0.5 * h, x + 0.5 * h * v2, v3), v4 = v + h * a3;
    const double a4 = a(t + h, x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

void check_events(const Simulation& run, const std::vector<std::pair<std::string, double>>& events) {
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() == events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    CHECK(run.events[i].name == events[i].first);
    CHECK(run.events[i].t == Approx(events[i].second).epsilon(1e-11));  // located to rounding of places
  }
}

// What the support O bears of the cable, in all states behind the impact and before an end.
void check_pull(const Simulation& run, double from, double to, double size) {
  const Diagnostics diagnostics = diagnose(run);
  const std::vector<double>& x = diagnostics.at("O.reaction_x_N").values;
  int seen = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    if (!(run.trajectory.time(i) > from && run.trajectory.time(i) < to)) continue;
    CHECK(x[i] == Approx(size).epsilon(1e-9));
    ++seen;
  }
  CHECK(seen > 5);
}

}  // namespace

// The impact is at 0.1 s, at 5 m/s; the load reaches 5 N at 0.65 s.
TEST_CASE("a damped cable that was slack pulls again where a stop has stopped the motion") {
  const std::string solver = "[solver]\nstep = 0.01\nend_time = 1\n";
  const Simulation run =
      run_on_path(slider(2, -5, cable + stop + load("[0, 0.3, 1]", "[0, 0, 10]") + solver));
  check_events(run, {{"rests on stop st", 0.1}, {"cab pulls", 0.1}, {"leaves stop st", 0.65}});
  CHECK(run.events[0].energy_lost == Approx(12.5).epsilon(1e-12));
  check_pull(run, 0.1001, 0.65, -5);
  const double end = pulled([](double t) { return 10 * (t - 0.3) / 0.7; }, 0.65, 1);
  CHECK(end_positions(run)[3] == Approx(end).epsilon(1e-10));  // the order 4 of 2e4 steps, rounding of places
  // Without a load it rests for good.
  const Simulation rests = run_on_path(slider(2, -5, cable + stop + solver));
  check_events(rests, {{"rests on stop st", 0.1}, {"cab pulls", 0.1}});
  check_pull(rests, 0.1001, 2, -5);
}

// A load of L pulls it away all the time: less than the cable holds, it rests; more, it goes back at once.
TEST_CASE("whether a stop holds what it has stopped is told with the cables that pull then") {
  for (const double L : {4.0, 8.0}) {
    CAPTURE(L);
    const double speed = std::sqrt(25 - L), t0 = (5 - speed) / L;
    const Simulation run = run_on_path(slider(2, -5, cable + stop) + "[[loads]]\nnodes = [\"P\"]\nforce = [" +
                                       number(L) + ", 0, 0]\n[solver]\nstep = 0.01\nend_time = 0.7\n");
    check_events(run, {{L < 5 ? "rests on stop st" : "stop st", t0}, {"cab pulls", t0}});
    CHECK(run.events[0].energy_lost == Approx(0.5 * (25 - L)).epsilon(1e-11));
    const double end = L < 5 ? 1.5 : pulled([&](double) { return L; }, t0, 0.7);
    CHECK(end_positions(run)[3] == Approx(end).epsilon(1e-10));
  }
}

TEST_CASE("a damped cable that was slack pulls again where a latch has stopped the motion") {
  const Simulation run = run_on_path(slider(2, -5, cable + R"([deployment]
measure = "coordinate P along 1 0 0"
deployed = 1.5
[solver]
step = 0.01
end_time = 0.3
at_deployed = "latch"
)"));
  check_events(run, {{"deployed", 0.1}, {"cab pulls", 0.1}, {"latched", 0.1}});
  check_pull(run, 0.1001, 2, -5);
}

// Within rounding of its free length a damped cable pulls or not, with all of c e' at once: which of the two
// is for no one to say at that pose, and makes no difference to the motion. Both models solve one equation,
// each to 1e-8 of the arm at this step.
TEST_CASE("a damped cable at its free length to the last digit keeps no scene off the path") {
  for (const double x : {1.7, 1.1, 2.3})
    for (const double speed : {1.0, -1.0})
      for (int digits = -2; digits <= 2; ++digits) {
        double rest = std::hypot(x - 0.6, 0.37);
        for (int k = 0; k < std::abs(digits); ++k) rest = std::nextafter(rest, digits > 0 ? 9.0 : 0.0);
        CAPTURE(x, speed, digits);
        const Scene scene = read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "G", fixed = true, position = [)" +
                                                number(x) + R"(, 0, -0.43]},
  {name = "B", mass = 1, position = [0.6, 0, -0.8], velocity = [)" +
                                                number(0.8 * speed) + ", 0, " + number(0.6 * speed) + R"(]}]
rods = [{nodes = ["O", "B"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[forces]]
kind = "spring"
nodes = ["B", "G"]
stiffness = 27
damping = 0.6
tension_only = true
free_length = )" + number(rest) + R"(
[solver]
end_time = 0.3
step = 0.002
stages = 6
)",
                                            "s.toml");
        const VectorXd on_path = end_positions(simulate_on_path(build_model(scene), scene.solver)),
                       full = end_positions(simulate(build_model(scene), scene.solver));
        CHECK((on_path - full).norm() < 1e-8);
      }
}

// At 1 m/s there are step / gap rebounds in a step: 1e5, where the full model counts 24000 and holds, or 1e3,
// after which the speed is what it was.
TEST_CASE("rebounds without end are no motion for the path") {
  const auto run = [](double gap) {
    return run_on_path(slider(1, 1, R"([[constraints]]
kind = "coordinate_stop"
nodes = ["P"]
direction = [1, 0, 0]
min = 1
max = )" + number(1 + gap) + R"(
restitution = 1
[solver]
step = 0.01
end_time = 0.01
)"));
  };
  CHECK_THROWS_AS(run(1e-7), PathRefused);
  const Simulation few = run(1e-5);
  CHECK(few.events.size() >= 999);
  CHECK(few.trajectory.node_velocities(few.trajectory.size() - 1).norm() == Approx(1.0));
}

// At 1.3 m/s into a cable of 4e6 N/m: for pi sqrt(m / k), a sixth of a step, and with v sqrt(k m) at most.
TEST_CASE("a cable that pulls for much less than a step has states meanwhile which know its peak") {
  for (const double k : {4e6, 7e5}) {
    const Simulation run = run_on_path(slider(1.4, 1.3, R"([[forces]]
kind = "spring"
name = "cab"
nodes = ["O", "P"]
tension_only = true
free_length = 1.5
stiffness = )" + number(k) + "\n[solver]\nstep = 0.01\nend_time = 0.2\n"));
    const double taut = 0.1 / 1.3, slack = taut + std::acos(-1.0) / std::sqrt(k);
    check_events(run, {{"cab pulls", taut}, {"cab is slack", slack}});
    for (std::size_t i = 1; i < run.trajectory.size(); ++i)
      CHECK(run.trajectory.time(i) >= run.trajectory.time(i - 1));
    // A sine at 8 of its places and a parabola through the largest ones.
    CHECK(largest_of_column(run, diagnose(run), "O.reaction_N") == Approx(1.3 * std::sqrt(k)).epsilon(1e-3));
  }
}

TEST_CASE("a run on the path tells how far it is and stops when it is asked to") {
  const Scene scene = read_scene_text(slider(2, 0.3,
                                             "[solver]\nstep = 0.01\nend_time = 1\n[gravity]\n"
                                             "acceleration = [0.7, 0, 0]\n"),
                                      "s.toml", {});
  const auto model = build_model(scene);
  SimulationHooks hooks;
  std::vector<double> told;
  int asked = 0, most = 1 << 30;
  hooks.progress = [&](double share) { told.push_back(share); };
  hooks.cancelled = [&] { return ++asked > most; };
  const Simulation whole = simulate_on_path(model, scene.solver, hooks);
  CHECK(whole.status == RunStatus::completed);
  CHECK(std::is_sorted(told.begin(), told.end()));
  CHECK(told.front() == 0);
  CHECK(told.back() == 1);
  REQUIRE(asked >= 3);
  most = asked - 1;
  asked = 0;
  told.clear();
  const Simulation part = simulate_on_path(model, scene.solver, hooks);
  CHECK(part.status == RunStatus::stopped);
  CHECK(told.back() < 1);
  CHECK(part.trajectory.end_time() < 1);
  // What is done is kept, and is as in the whole.
  const double t = part.trajectory.end_time();
  REQUIRE(t > 0);
  CHECK(end_positions(part)[3] == Approx(2 + 0.3 * t + 0.35 * t * t).epsilon(1e-12));
}

}  // namespace path_jumps_test
