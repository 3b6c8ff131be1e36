// SPDX-License-Identifier: BSD-3-Clause
// Cables and stops switch at located times and at full order, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/stepper.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace one_sided_test {

namespace {

using testing::end_positions, testing::run_scene;

// 1 kg at 1 m/s on a cable of 100 N/m with 0.3 m of slack: it pulls from 0.3 s for half a period of 10 rad/s.
const std::string cable = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0.7, 0, 0], velocity = [1, 0, 0], mass = 1}]
[[forces]]
kind = "spring"
name = "cable"
nodes = ["O", "A"]
stiffness = 100
free_length = 1
tension_only = true
[solver]
stages = 4
step = 0.01
end_time = 1
)";

std::vector<std::string> solver(std::string_view method, int stages, double step, bool adaptive = false) {
  return {"solver.method=" + std::string(method), "solver.stages=" + std::to_string(stages),
          "solver.step=" + std::to_string(step),
          std::string("solver.adaptive=") + (adaptive ? "true" : "false")};
}

const std::string ball = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 2}]
[[constraints]]
kind = "coordinate_stop"
name = "stop"
nodes = ["A"]
direction = [0, 0, 1]
restitution = 0.5
[gravity]
acceleration = [0, 0, 0]
[solver]
stages = 4
step = 0.02
end_time = 1
)";

// The ball at `height` above its stop, which lies at `limit`; down is the way to it, -1 or +1 along z.
std::vector<std::string> placed(double limit, double height, int down) {
  return {std::string("constraints[0].") + (down < 0 ? "min=" : "max=") + std::to_string(limit),
          "structure.nodes.A.position=[0,0," + std::to_string(limit - down * height) + "]",
          "gravity.acceleration=[0,0," + std::to_string(10 * down) + "]"};
}

}  // namespace

TEST_CASE("a cable goes taut and slack at full order") {
  // x(1) = 0.7 + 0.3 + pi/10 - ... = 1 - (1 - 0.3 - pi/10): out, half a swing, and back at 1 m/s.
  const double exact = 0.3 + pi / 10;
  const Simulation fine = run_scene(cable);
  CHECK(end_positions(fine)[3] == Approx(exact).epsilon(0).margin(1e-10));
  CHECK(fine.steps < 150);
  REQUIRE(fine.events.size() == 2);
  CHECK(fine.events[0].name == "cable pulls");
  CHECK(fine.events[0].t == Approx(0.3).epsilon(1e-11));
  CHECK(fine.events[1].name == "cable is slack");
  CHECK(fine.events[1].t == Approx(0.3 + pi / 10).epsilon(1e-9));
  // Orders 2s - 2 from steps of 0.08 and 0.04 s, that divide neither time; the last part of the swing is
  // shorter than a step, by another share for each, which blurs the order by some tenths.
  for (const int stages : {2, 3, 4}) {
    const double coarse = std::abs(end_positions(run_scene(cable, solver("dvm", stages, 0.032)))[3] - exact);
    const double half = std::abs(end_positions(run_scene(cable, solver("dvm", stages, 0.008)))[3] - exact);
    INFO(stages << " stages: " << coarse << ", " << half);
    CHECK(0.5 * std::log2(coarse / half) >= 2 * stages - 2 - 0.5);
  }
  // Every method at its order: (omega h)^p of the swing of 0.1 m, over some ten.
  for (const Method& method : methods())
    for (const bool adaptive : {false, true}) {
      INFO(method.name << (adaptive ? " adaptive" : ""));
      const Simulation run = run_scene(cable, solver(method.name, 4, 0.01, adaptive));
      const double tolerance = method.name == "dvm"                 ? 1e-10
                               : method.name == "generalized_alpha" ? 2e-3
                                                                    : 1e-6;
      CHECK(end_positions(run)[3] == Approx(exact).epsilon(0).margin(tolerance));
      CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 10 * tolerance);
    }
}

TEST_CASE("a cable with damping pulls from the moment it is stretched and never pushes") {
  // From x = 0 at 1 m/s: x'' = -100 x - 4 x', until the tension 100 x + 4 x' is zero; then on at that speed.
  const Simulation run = run_scene(cable, {"forces[0].damping=4", "solver.step=0.02"});
  const double gamma = 2, omega = std::sqrt(96.0);
  // x = exp(-gamma t) sin(omega t) / omega; x'' = 0 where tan(omega t) = 2 gamma omega / (gamma^2 - omega^2)
  // ...
  const double let_go = (pi - std::atan2(2 * gamma * omega, omega * omega - gamma * gamma)) / omega;
  const double e = std::exp(-gamma * let_go), s = std::sin(omega * let_go), c = std::cos(omega * let_go);
  const double x = e * s / omega, v = e * (c - gamma * s / omega);
  REQUIRE(std::abs(100 * x + 4 * v) <= 1e-12);
  CHECK(end_positions(run)[3] == Approx(1 + x + v * (1 - 0.3 - let_go)).epsilon(0).margin(1e-9));
  REQUIRE(run.events.size() == 2);
  CHECK(run.events[1].t == Approx(0.3 + let_go).epsilon(1e-9));
  // Of 0.5 J; what is dissipated is a quadrature of order 6 on steps of omega h = 0.2.
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 0.5 * std::pow(0.2, 6));
}

TEST_CASE("every method keeps its order where a damped cable goes taut with a jump of its force") {
  // The force goes from 0 to 4 v where the step ends, 60 cm to 75 cm from the support, on the side that
  // rounding says: felt in that step, the jump would cost 4 h / 6 of the speed of 1 m/s, whatever the order.
  const double gamma = 2, omega = std::sqrt(96.0);
  const double let_go = (pi - std::atan2(2 * gamma * omega, omega * omega - gamma * gamma)) / omega;
  const double e = std::exp(-gamma * let_go), s = std::sin(omega * let_go), c = std::cos(omega * let_go);
  const double x = e * s / omega, v = e * (c - gamma * s / omega);
  const auto off = [&](const Method& method, double slack, double step) {
    std::vector<std::string> settings = solver(method.name, 4, step);
    settings.insert(settings.end(),
                    {"forces[0].damping=4", "forces[0].free_length=" + std::to_string(0.7 + slack)});
    const Simulation run = run_scene(cable, settings);
    REQUIRE(run.status == RunStatus::completed);
    return std::abs(end_positions(run)[3] - (0.7 + slack + x + v * (1 - slack - let_go)));
  };
  for (const Method& method : methods()) {
    // Of orders 6, 4 and 2 a swing of 0.1 m with omega h = 0.1 keeps 1e-8, 1e-5 and 1e-3 m.
    const double order = method.name == "dvm" ? 6 : method.name == "generalized_alpha" ? 2 : 4;
    double coarse = 0, fine = 0;
    for (const double slack : {0.3, 0.311, 0.3237, 0.34821, 0.3513, 0.3671, 0.3789}) {
      coarse = std::max(coarse, off(method, slack, 0.01));
      fine = std::max(fine, off(method, slack, 0.0025));
    }
    INFO(method.name << ": " << coarse << ", " << fine);
    CHECK(coarse <= 0.1 * std::pow(0.1, order));
    // Parts of steps before and after events blur the order; from 1e-12 m on rounding is all there is.
    CHECK((fine < 1e-12 || 0.5 * std::log2(coarse / fine) >= order - 0.7));
  }
}

TEST_CASE("a weight that is let go on a cable of its own length hangs on it at once") {
  // At rest, neither slack nor stretched: x = g / omega^2 (1 - cos(omega t)), down again and again.
  const Simulation run =
      run_scene(cable, {"structure.nodes.A.position=[1,0,0]", "structure.nodes.A.velocity=[0,0,0]",
                        "gravity.acceleration=[9,0,0]"});
  CHECK(end_positions(run)[3] == Approx(1 + 0.09 * (1 - std::cos(10.0))).epsilon(0).margin(1e-9));
}

TEST_CASE("many cables that switch together or one shortly after the other stay robust") {
  std::string scene = "[structure]\nkind = \"custom\"\n", forces;
  constexpr int count = 60;
  for (int k = 0; k < count; ++k) {
    const std::string y = std::to_string(k), name = std::to_string(k);
    scene += "[[structure.nodes]]\nname = \"O" + name + "\"\nposition = [0, " + y + ", 0]\nfixed = true\n";
    scene += "[[structure.nodes]]\nname = \"A" + name + "\"\nposition = [0.7, " + y +
             ", 0]\nvelocity = [1, 0, 0]\nmass = 1\n";
    forces += "[[forces]]\nkind = \"spring\"\nnodes = [\"O" + name + "\", \"A" + name +
              "\"]\nstiffness = 100\nfree_length = " + (k < count / 2 ? "1" : std::to_string(1 + 1e-4 * k)) +
              "\ntension_only = true\n";
  }
  scene += forces + "[solver]\nstages = 4\nstep = 0.01\nend_time = 1\n";
  const Simulation run = run_scene(scene);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings.empty());
  CHECK(run.events.size() == 2 * count);
  for (int k = 0; k < count; ++k) {
    const double slack = k < count / 2 ? 0.3 : 0.3 + 1e-4 * k;
    CHECK(end_positions(run)[6 * k + 3] ==
          Approx(0.7 + slack - (1 - slack - pi / 10)).epsilon(0).margin(1e-9));
  }
}

TEST_CASE("bounces, rest and release are the same from either side of a stop") {
  for (const int down : {-1, 1})
    for (const double limit : {0.0, -3.25, 1.375}) {
      INFO("limit " << limit << ", down " << down);
      const auto height = [&](const Simulation& run, std::size_t i) {
        return -down * (run.trajectory.positions(i)[2] - limit);
      };
      // 0.2 m at 10 m/s^2: 0.2 s to the stop, then flights of 0.2, 0.1, 0.05, ... s: at rest after 0.6 s.
      const Simulation run = run_scene(ball, placed(limit, 0.2, down));
      REQUIRE(run.status == RunStatus::completed);
      CHECK(run.events[0].name == "stop stop");
      CHECK(run.events[0].t == Approx(0.2).epsilon(1e-11));
      CHECK(run.events[1].t == Approx(0.4).epsilon(1e-11));
      CHECK(run.events.back().name == "rests on stop stop");
      CHECK(run.events.back().t == Approx(0.6).epsilon(0).margin(5e-4));  // up to the rest speed of 1 mm/s
      CHECK(std::abs(height(run, run.trajectory.size() - 1)) <= 1e-10);
      double lost = 0;
      for (const Event& event : run.events) lost += event.energy_lost;
      CHECK(lost == Approx(2 * 10 * 0.2).epsilon(1e-9));

      // Resting, drawn off by 39.71 N/s from t = 0.13 s: 20 N after 0.5036 s; then z = 39.71 / 2 t^3 / 6.
      const std::string pull = std::string(ball) + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
times = [0.13, 5.13]
values = [0, 198.55]
force = [0, 0, )" + (down < 0 ? "1]\n" : "-1]\n");
      for (const Method& method : methods()) {
        auto changes = placed(limit, 0.0005, down);
        changes.push_back("constraints[0].restitution=0");
        changes.push_back("solver.method=" + std::string(method.name));
        const Simulation off = run_scene(pull, changes);
        INFO(method.name << ": " << off.message);
        REQUIRE(off.status == RunStatus::completed);
        REQUIRE(off.events.size() == 2);
        CHECK(off.events[1].name == "leaves stop stop");
        const double free = 0.13 + 20 / 39.71;
        CHECK(off.events[1].t == Approx(free).epsilon(1e-9));
        // Cubic in time: exact but for generalized_alpha, which leaves a part of z''' h^2 in the speed.
        const double z = 39.71 / 12 * std::pow(1 - free, 3);
        CHECK(height(off, off.trajectory.size() - 1) ==
              Approx(z).epsilon(0).margin(method.name == "generalized_alpha" ? 1e-3 : 1e-10));
        for (std::size_t i = 0; i < off.trajectory.size(); ++i) CHECK(height(off, i) >= -1e-10);
      }
    }
}

TEST_CASE("impacts that accumulate end in rest") {
  // Without a rest speed: flights of 2 * 0.2 s * e^k, after 0.2 s (1 + 2 e / (1 - e)) the ball lies still.
  for (const double restitution : {0.0, 0.5, 0.9}) {
    auto changes = placed(-3.25, 0.2, -1);
    changes.push_back("constraints[0].rest_speed=0");
    changes.push_back("constraints[0].restitution=" + std::to_string(restitution));
    changes.push_back("solver.end_time=4.5");
    const Simulation run = run_scene(ball, changes);
    INFO("restitution " << restitution << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.events.back().name == "rests on stop stop");
    const double rest = 0.2 * (1 + 2 * restitution / (1 - restitution));
    // The last flights are cut at 1e-4 of a step of 0.02 s: what is left of them is e / (1 - e) as long.
    CHECK(run.events.back().t == Approx(rest).epsilon(0).margin(2e-6 / (1 - restitution) + 1e-9));
    CHECK(end_positions(run)[2] == Approx(-3.25).epsilon(0).margin(1e-9));
    CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-8);
  }
}

TEST_CASE("impacts without end are cut by a limit that is said") {
  // 20 nm between two stops that lose nothing: 1.5e8 impacts in a second.
  const Simulation run =
      run_scene(ball, {"constraints[0].min=-1e-8", "constraints[0].max=1e-8", "constraints[0].restitution=1",
                       "structure.nodes.A.velocity=[0,0,3]"});
  CHECK(run.status == RunStatus::completed);
  REQUIRE(run.warnings.size() == 1);
  CHECK(run.warnings[0].find("impacts without end") != std::string::npos);
  CHECK(std::abs(end_positions(run)[2]) <= 1.1e-8);
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-8);
}

TEST_CASE("two stops that are touched at one time throw back together") {
  // A bar of 2 kg falls flat by 0.2 m at 10 m/s^2 on a stop at each end: one after the other they would turn
  // it. Each end goes back with its own restitution.
  const std::string bar = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0.2]},
  {name = "B", position = [1.3, 0, 0.2]}]
rods = [{nodes = ["A", "B"], mass = 2}]
[[constraints]]
kind = "coordinate_stop"
name = "left"
nodes = ["A"]
direction = [0, 0, 1]
min = 0
restitution = 0.5
[[constraints]]
kind = "coordinate_stop"
name = "right"
nodes = ["B"]
direction = [0, 0, 1]
min = 0
restitution = 0.5
[gravity]
acceleration = [0, 0, -10]
[solver]
stages = 4
step = 0.03
end_time = 1
)";
  const Simulation run = run_scene(bar);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings.empty());
  REQUIRE(run.events.size() >= 4);
  for (const std::size_t i : {0U, 1U}) {
    CHECK(run.events[i].kind == "contact");
    CHECK(run.events[i].t == Approx(0.2).epsilon(1e-11));
    CHECK(run.events[i].energy_lost == Approx(0.5 * 0.75 * 0.5 * 2 * 4).epsilon(1e-9));
    CHECK(run.events[i + 2].t == Approx(0.4).epsilon(1e-10));
  }
  const VectorXd end = end_positions(run);
  CHECK(end[2] == Approx(0).epsilon(0).margin(1e-9));
  CHECK(end[5] == Approx(0).epsilon(0).margin(1e-9));
  CHECK(end[0] == Approx(0).epsilon(0).margin(1e-9));
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-9);
  const Simulation just_after = run_scene(
      bar, {"constraints[0].restitution=0.8", "constraints[1].restitution=0.3", "solver.end_time=0.201"});
  REQUIRE(just_after.status == RunStatus::completed);
  const VectorXd v = just_after.trajectory.node_velocities(just_after.trajectory.size() - 1);
  CHECK(v[2] == Approx(0.8 * 2 - 0.01).epsilon(0).margin(2e-3));  // and what turning takes in a millisecond
  CHECK(v[5] == Approx(0.3 * 2 - 0.01).epsilon(0).margin(2e-3));
}

TEST_CASE("a start that has no answer ends the run with a reason") {
  // A cable that pulls at t = 0, and an angle about an axis that one of its lines is along: no equations.
  const auto at_start = [](const Vec3& tip) {
    Structure s;
    s.nodes = {{"O", {0, 0, 0}, Vec3::Zero(), 1.0},
               {"P", {1, 0, 0}, Vec3::Zero(), 1.0},
               {"A", tip, Vec3::Zero(), 1.0},
               {"B", {0, 1, 1}, Vec3::Zero(), 1.0}};
    s.constraints.push_back(
        {"measure", "hinge", {}, {}, 0.0, {MeasureKind::angle, {0, 1, 0, 2}, Vec3::UnitZ(), 0.0, {}}, {}});
    Force rope;
    rope.kind = "spring";
    rope.name = "cable";
    rope.measure = {MeasureKind::length, {0, 3}, Vec3::Zero(), 0.0, {}};
    rope.stiffness = 10;
    rope.rest = 1;
    rope.one_sided = true;
    s.forces.push_back(rope);
    show_as_solved(s);
    System system(s, true);
    return std::make_shared<const Model>(Model{std::move(s), std::move(system)});
  };
  SolverOptions options;
  options.end_time = 0.1;
  const auto singular = at_start({0, 0, 1}), regular = at_start({0.8, 0.1, 1});
  Stepper stepper(singular, options);
  CHECK_FALSE(stepper.step());
  CHECK(stepper.run().status == RunStatus::failed);
  CHECK(stepper.run().message.find("cannot be factorised") != std::string::npos);
  CHECK_THROWS_AS(hand_over(*regular, initial_state(singular->structure, singular->system).state, *singular),
                  CannotFactorise);
}

}  // namespace one_sided_test
