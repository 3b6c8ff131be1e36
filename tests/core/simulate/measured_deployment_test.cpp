// SPDX-License-Identifier: BSD-3-Clause
// [deployment] of structures without a fold angle: fraction, event and latch by a measure; and what drives
// lead to the deployed pose.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/measures.hpp"
#include "core/integrators/integrator.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/library.hpp"
#include "core/study/table.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace measured_deployment_test {

namespace {

using testing::error_of, testing::run_scene;

// Two masses on a line, 3 kg and 5 kg, pushed apart by 12 N from 0.4 m: s = 0.4 + (12/3 + 12/5) t^2 / 2.
const std::string pushed = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 3}, {name = "B", position = [0.4, 0, 0], mass = 5}]
[[loads]]
nodes = ["A"]
force = [-12, 0, 0]
[[loads]]
nodes = ["B"]
force = [12, 0, 0]
[deployment]
measure = "length A B"
deployed = 1.9
[solver]
stages = 3
step = 0.07
)";

double time_of(const Simulation& run, const char* name) {
  for (const Event& event : run.events)
    if (event.name == name) return event.t;
  return -1;
}

}  // namespace

TEST_CASE("a structure is deployed when its measure says so") {
  const double t = std::sqrt(2 * 1.5 / (12.0 / 3 + 12.0 / 5));
  const Simulation run = run_scene(pushed);  // no end_time
  CHECK(run.status == RunStatus::deployed);
  CHECK(time_of(run, "deployed") == Approx(t).epsilon(1e-12));
  const Diagnostics d = diagnose(run);
  CHECK(d.at("deployed_fraction").values.front() == Approx(0).epsilon(0).margin(1e-15));
  CHECK(d.at("deployed_fraction").values.back() == Approx(1).epsilon(0).margin(1e-11));
  CHECK(!d.find("fold_angle_rad"));
  CHECK(find_measure("deploy_time").value(run, d) == Approx(t).epsilon(1e-12));
  // A swept stowed value is a scale of the fraction, not of the motion.
  const Simulation half = run_scene(pushed, {"deployment.stowed=-1.1"});
  CHECK(diagnose(half).at("deployed_fraction").values.front() == Approx(0.5).epsilon(1e-13));
}

// An arm O-B swings through the line of O and A, where an angle without an axis turns back: from `first` to
// `angle` [rad] at the rate 3 rad/s and under the gravity g that acts along the line.
double swing_time(double first, double angle, double g) {
  const auto rate = [&](double turned) {
    return std::sqrt(9 + 2 * g * (std::cos(first) - std::cos(turned)));
  };
  constexpr int parts = 4000;  // Simpson's rule, off by (half a turn / 4000)^4 / 180 times some ten, 1e-14
  const double h = (angle - first) / parts;
  double sum = 1 / rate(first) + 1 / rate(angle);
  for (int i = 1; i < parts; ++i) sum += (i % 2 == 1 ? 4 : 2) / rate(first + i * h);
  return sum * h / 3;
}

TEST_CASE("a measure that turns back at the deployed pose has been there") {
  constexpr double first = 100 * radians_per_degree;
  const std::string arm = R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0], fixed = true},
  {name = "B", position = ["=cos(100*deg)", 0, "=sin(100*deg)"], mass = 2, velocity = ["=-3*sin(100*deg)", 0, "=3*cos(100*deg)"]}]
rods = [{nodes = ["O", "B"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[deployment]
measure = "angle A O B"
[solver]
step = 0.01
end_time = 1
)toml";
  for (const double g : {0.0, 2.0, -2.0})  // the arm bends neither way, or either
    for (const std::string method : {"dvm", "rk4", "generalized_alpha"})
      for (const double deployed : {180.0, 179.99999, 179.9, 150.0}) {
        INFO(g << " " << method << " " << deployed);
        const Simulation run =
            run_scene(arm, {"gravity.acceleration=[" + exact_number(-g) + ",0,0]", "solver.method=" + method,
                            "solver.stages=" + std::string(method == "dvm" ? "5" : "2"), "solver.step=0.002",
                            "deployment.deployed=" + exact_number(deployed)});
        CHECK(run.status == RunStatus::deployed);
        // generalized_alpha is of second order: some h^2 = 4e-6 s at most; dvm ends where rounding of 1e-12
        // of the fraction is left.
        CHECK(time_of(run, "deployed") == Approx(swing_time(first, deployed * radians_per_degree, g))
                                              .margin(method == "generalized_alpha" ? 4e-6 : 1e-10));
      }
  // Latched it stays there, about an axis: without one the angle has no gradient there to be held by.
  const Simulation latched = run_scene(arm, {"deployment.measure=[\"angle A O B about 0 -1 0\"]",
                                             "deployment.deployed=180", "solver.at_deployed=latch"});
  CHECK(latched.status == RunStatus::completed);
  CHECK(testing::end_positions(latched)[6] == Approx(-1).epsilon(1e-12));
  // A point that flies through another one: length 0.
  const Simulation met = run_scene(pushed, {"loads=[]", "structure.nodes.B.velocity=[-0.7,0,0]",
                                            "deployment.deployed=0", "solver.end_time=2"});
  CHECK(time_of(met, "deployed") == Approx(0.4 / 0.7).epsilon(1e-11));
}

TEST_CASE("a measured deployment latches and stays") {
  const Simulation run = run_scene(pushed, {"solver.at_deployed=latch", "solver.end_time=2"});
  CHECK(run.status == RunStatus::completed);
  REQUIRE(time_of(run, "latched") > 0);
  const VectorXd end = testing::end_positions(run);
  CHECK(end[3] - end[0] == Approx(1.9).epsilon(0).margin(1e-11));
  // What the latch takes: both go with the velocity of their centre, which is zero.
  const double rate = (12.0 / 3 + 12.0 / 5) * time_of(run, "deployed"), reduced = 3 * 5 / 8.0;
  CHECK(run.events.back().energy_lost == Approx(0.5 * reduced * rate * rate).epsilon(1e-10));
}

// From s = 1.9 on with the rate v the spring alone is against the 12 N: m x'' = 12 - k x of the reduced mass
// m.
TEST_CASE("a latch that gives holds a measured deployment by its spring") {
  const double k = 2300, m = 3 * 5 / 8.0, v = std::sqrt(2 * 1.5 * 12 / m), w = std::sqrt(k / m);
  const Simulation run =
      run_scene(pushed, {"solver.at_deployed=latch", "solver.end_time=1.1", "solver.stages=4",
                         "solver.step=0.002", "forces=[{kind=\"latch\", stiffness=2300}]"});
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(time_of(run, "latched") > 0);
  const double t = 1.1 - time_of(run, "latched");
  const VectorXd end = testing::end_positions(run);
  CHECK(end[3] - end[0] ==
        Approx(1.9 + 12 / k * (1 - std::cos(w * t)) + v / w * std::sin(w * t)).epsilon(0).margin(1e-9));
  // The peak between states: half a step of the swing away at most.
  const Diagnostics d = diagnose(run);
  CHECK(testing::largest(d, "latch_force_max_N") ==
        Approx(12 + std::sqrt(144 + k * m * v * v)).epsilon(1e-3));
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-9);
}

// An arm of inertia I that turns freely arrives at the rate w: the peak is w sqrt(I k), at the angle w sqrt(I
// / k) beyond.
TEST_CASE("a latch that gives holds an angle by its torque") {
  const double w = 7.3, I = 0.9 * 0.8 * 0.8 / 3, k = 140;
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "R", position = [1, 0, 0], fixed = true},
         {name = "A", position = [0.8, 0, 0], velocity = [0, 5.84, 0]}]
rods = [{nodes = ["O", "A"], mass = 0.9}]
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 0, 1]
[[forces]]
kind = "latch"
stiffness = 140
damping = 0
[deployment]
measure = "2 angle R O A about 0 0 1"
deployed = 300
[solver]
stages = 4
step = 0.001
end_time = 0.61
at_deployed = "latch"
)");
  REQUIRE(run.status == RunStatus::completed);
  CHECK(time_of(run, "latched") == Approx(150 * pi / 180 / w).epsilon(1e-9));
  // The measure is twice the angle: k / 2 (2 x)^2.
  const double t = 0.61 - 150 * pi / 180 / w, swing = std::sqrt(4 * k / I);
  const double angle = 150 * pi / 180 + w / swing * std::sin(swing * t);
  const VectorXd end = testing::end_positions(run);
  CHECK(end[6] == Approx(0.8 * std::cos(angle)).epsilon(0).margin(1e-8));
  CHECK(end[7] == Approx(0.8 * std::sin(angle)).epsilon(0).margin(1e-8));
  CHECK(testing::largest(diagnose(run), "latch_torque_max_N_m") ==
        Approx(w * std::sqrt(I * k)).epsilon(1e-3));
}

// A drive that comes to rest where it is deployed: the measure only just gets there.
TEST_CASE("a drive that ends in the deployed pose deploys") {
  const std::string driven = pushed + R"(
end_time = 3
[[constraints]]
kind = "length"
name = "drive"
nodes = ["A", "B"]
motion = "smooth"
to = 1.9
duration = 1.3
)";
  const Simulation run = run_scene(driven, {"deployment.measure=drive"});
  CHECK(run.status == RunStatus::deployed);
  // 10 (1 - u)^3 = 1e-12 of the way.
  CHECK(time_of(run, "deployed") == Approx(1.3).epsilon(1e-4));
}

// A mass of 2 kg that flies at 1 m/s past the end of its own cable, which is drawn in at 0.5 m/s but slack
// when the mass latches after 1.2 s: 2.4 m of it for 1.8 m of way. From then on the winch stands still, so
// that nothing ever pulls against the latch; drawn on, the cable would be taut at 2.4 s.
TEST_CASE("a structure that latches while a cable is slack stops what draws it in") {
  for (const char* cable : {"", "axial_stiffness = 700\n"}) {
    const Simulation run = run_scene(std::string(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 2},
         {name = "E", position = [3, 0, 0], fixed = true}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 1.2
[solver]
step = 0.07
end_time = 5
at_deployed = "latch"
[[constraints]]
kind = "cable"
name = "rope"
nodes = ["A", "E"]
motion = "rate"
rate = -0.5
)") + cable);
    INFO(cable << run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.trajectory.end_time() == Approx(5));
    CHECK(time_of(run, "latched") == Approx(1.2).epsilon(0).margin(1e-9));
    CHECK(time_of(run, "rope pulls") < 0);
    CHECK(testing::end_positions(run)[0] == Approx(1.2).epsilon(0).margin(1e-9));
    const Diagnostics d = diagnose(run);
    CHECK(d.at("impact_loss_J").values.back() == Approx(1.0).epsilon(1e-9));
    CHECK(d.at("rope.value_m").values.back() ==
          Approx(3 - 0.5 * 1.2).epsilon(0).margin(1e-9));  // as it was drawn by then
    CHECK(testing::largest(d, "potential_energy_J") <= 1e-12);
    CHECK(testing::largest(d, "energy_balance_J") <= 1e-9);
  }
}

// Two links geared 2 : 1, whose second hinge has turned more than half a turn when the first is deployed.
TEST_CASE("a geared structure is deployed where it passes, whatever its hinges have turned by then") {
  const auto geared = [](double deployed, const char* at_deployed) {
    return run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "W", position = [0, -1, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1, 0, 0]}, {name = "B", position = [2, 0, 0]}]
rods = [{nodes = ["O", "A"], mass = 1}, {nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 0, 1]
[[constraints]]
kind = "gear"
nodes = ["W", "O", "A", "O", "A", "B"]
radii = [2, -1]
axis = [0, 0, 1]
[[loads]]
nodes = ["A"]
force = [0, 1, 0]
[deployment]
measure = "angle W O A about 0 0 1"
deployed = 190
[solver]
end_time = 5
)",
                     {"deployment.deployed=" + std::to_string(deployed),
                      std::string("solver.at_deployed=") + at_deployed});
  };
  for (const double deployed : {175.0, 190.0, 210.0}) {
    const double t = time_of(geared(deployed, "pass"), "deployed");
    REQUIRE(t > 0);
    for (const char* at_deployed : {"stop", "latch"}) {
      const Simulation run = geared(deployed, at_deployed);
      INFO(deployed << ", " << at_deployed << ": " << run.message);
      CHECK(run.status == (std::string("stop") == at_deployed ? RunStatus::deployed : RunStatus::completed));
      CHECK(time_of(run, "deployed") == Approx(t).epsilon(1e-8));
      CHECK(testing::largest(diagnose(run), "constraint_max_m") < 1e-10);
    }
  }
}

// A point mass on a rod about O that nothing acts on: it turns evenly, at 1 m/s / (1.01 m), from
// atan(0.1) = 5.7 degrees to the downside.
std::string turning(const std::string& measure, double deployed) {
  return R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "R", position = [1, 0, 0], fixed = true},
         {name = "P", position = [1, 0, 0.1], mass = 1, velocity = [0, 0, -1]}]
rods = [{nodes = ["O", "P"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["P"]
normal = [0, 1, 0]
[solver]
end_time = 7
[deployment]
measure = )" +
         measure + "\ndeployed = " + std::to_string(deployed) + "\n";
}

TEST_CASE("a deployment by angles counts turns: what turns the wrong way is never deployed") {
  const double rate = 1 / 1.01, first = std::atan(0.1);
  for (const char* method : {"dvm", "rk4"})
    for (const char* measure : {"'angle R O P about 0 -1 0'", "['1 angle R O P about 0 -1 0']",
                                "['0.5 angle R O P about 0 -1 0', '-0.5 angle R O P about 0 1 0']"}) {
      INFO(method << ", " << measure);
      const Simulation run = run_scene(turning(measure, 90), {std::string("solver.method=") + method});
      CHECK(run.status == RunStatus::completed);
      CHECK(time_of(run, "deployed") < 0);
      const std::vector<double> fraction = diagnose(run).at("deployed_fraction").values;
      for (std::size_t i = 0; i < fraction.size(); ++i)  // to the error of the methods
        CHECK(fraction[i] ==
              Approx(-rate * run.trajectory.time(i) / (pi / 2 - first)).epsilon(0).margin(1e-6));
    }
}

TEST_CASE("sums of angles are deployed where they pass, whatever each has turned by then") {
  const double rate = 1 / 1.01, first = std::atan(0.1), t = (250 * radians_per_degree + first) / rate;
  for (const char* model : {"full", "auto"})
    for (const char* at_deployed : {"stop", "latch"})
      for (const auto& [measure, deployed] :
           {std::pair("'angle R O P about 0 1 0'", 250.0), std::pair("['2 angle R O P about 0 1 0']", 500.0),
            std::pair("['1 angle R O P about 0 1 0', '1 angle R O P about 0 1 0']", 500.0),
            std::pair("['3 angle R O P about 0 1 0', '1 angle R O P about 0 -1 0']", 500.0)}) {
        INFO(measure << ", " << at_deployed << ", " << model);
        const Simulation run = run_scene(
            turning(measure, deployed),
            {std::string("solver.at_deployed=") + at_deployed, std::string("solver.model=") + model});
        CHECK(time_of(run, "deployed") == Approx(t).epsilon(1e-7));
        CHECK(run.status ==
              (std::string("stop") == at_deployed ? RunStatus::deployed : RunStatus::completed));
        CHECK(diagnose(run).at("deployed_fraction").values.back() == Approx(1).epsilon(1e-9));
      }
}

TEST_CASE("a deployment begins on the turn of the values that it is given") {
  // From -5.7 degrees, which is 354.3 of the way from 350 to 420.
  const Simulation run = run_scene(turning("'angle R O P about 0 1 0'", 420), {"deployment.stowed=350"});
  const double first = std::atan(0.1) / radians_per_degree;
  CHECK(diagnose(run).at("deployed_fraction").values.front() == Approx((10 - first) / 70).epsilon(1e-12));
  CHECK(time_of(run, "deployed") == Approx((60 + first) * radians_per_degree * 1.01).epsilon(1e-7));
}

TEST_CASE("a deployment that cannot be says why") {
  // Angles count within a turn: 2 x is deployed at 720 degrees at most.
  CHECK(error_of(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "R", position = [1, 0, 0], fixed = true},
         {name = "A", position = [0.8, 0, 0], velocity = [0, 5, 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0}]
[deployment]
measure = "2 angle R O A about 0 0 1"
deployed = 940
)")
            .find("less than a turn") != std::string::npos);
  CHECK(error_of(pushed, {"deployment.deployed=0.4"}).find("nothing deploys") != std::string::npos);
  CHECK(error_of(pushed, {"deployment.deployed=0.2", "deployment.stowed=1"}) == "");
  CHECK(error_of(pushed, {"deployment.deployed=0.2", "deployment.stowed=0.1"}).find("reached already") !=
        std::string::npos);
  CHECK(error_of(pushed, {"deployment.measure=length A X"}).find("deployment.measure: there is no node") !=
        std::string::npos);
  CHECK(error_of("[structure]\nkind = 'hoop'\n[deployment]\nmeasure = 'length B0 T0'\ndeployed = 1\n")
            .find("is for structures that do not say themselves") != std::string::npos);
}

TEST_CASE("a deployed pose that is met and left again within one step is not missed") {
  // A bob at 1 m, let go from the horizontal; deployed just above the lowest point. t = int_0^f df / sqrt(2 g
  // sin f), with f = u^2.
  const std::string swing = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 2}]
rods = [{nodes = ["A", "B"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "1 coordinate B along 0 0 1"
deployed = -0.9999
[solver]
stages = 5
end_time = 3
)";
  for (const double z : {0.9999, 0.99999}) {
    const double end = std::sqrt(std::asin(z));
    const auto f = [](double u) { return 2 * u / std::sqrt(2 * 9.81 * std::sin(u * u)); };
    constexpr int n = 4000;  // Simpson: h^4 = 1e-14
    double t = std::sqrt(2 / 9.81) + f(end);
    for (int k = 1; k < n; ++k) t += (k % 2 ? 4 : 2) * f(end * k / n);
    t *= end / n / 3;
    for (const char* step : {"0.01", "0.05"})
      for (const char* then : {"stop", "latch", "pass"}) {
        const Simulation run =
            run_scene(swing, {std::string("solver.step=") + step, std::string("solver.at_deployed=") + then,
                              "deployment.deployed=" + std::to_string(-z)});
        INFO(z << " " << step << " " << then);
        // Order 10 in steps of 0.05 s at 4.4 rad/s; the rate there is sqrt(1 - z^2) of the speed, 0.004.
        CHECK(time_of(run, "deployed") == Approx(t).epsilon(1e-7));
      }
  }
}

TEST_CASE("a drive that ends in the deployed pose deploys it then, with every method and on the path") {
  const std::string driven = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "G", position = [1, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
name = "d"
nodes = ["G", "A", "B"]
axis = [0, 1, 0]
motion = "smooth"
to = 90
duration = 0.7
[deployment]
measure = "angle G A B about 0 1 0"
deployed = 90
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 1
)";
  for (const auto& [duration, to] :
       {std::pair(0.7, 90.0), std::pair(0.333, 77.7), std::pair(0.9, 90.0), std::pair(0.45, 141.3)})
    for (const char* then : {"stop", "latch", "pass"}) {
      const std::string angle = std::to_string(to);
      const std::vector<std::string> options = {"constraints[d].duration=" + std::to_string(duration),
                                                "constraints[d].to=" + angle, "deployment.deployed=" + angle,
                                                std::string("solver.at_deployed=") + then};
      INFO(duration << " s to " << to << ", " << then);
      for (const Method& method : methods()) {
        auto all = options;
        all.push_back("solver.method=" + std::string(method.name));
        const Simulation run = run_scene(driven, all);
        INFO(method.name << ": " << run.message);
        CHECK(run.status == (std::string(then) == "stop" ? RunStatus::deployed : RunStatus::completed));
        CHECK(time_of(run, "deployed") == Approx(duration).epsilon(1e-12));
      }
      if (std::string(then) == "latch") continue;  // the path does not do that with a drive
      const Scene scene = read_scene_text(driven, "s.toml", options);
      const Simulation path = simulate_on_path(build_model(scene), scene.solver);
      CHECK(time_of(path, "deployed") == Approx(duration).epsilon(1e-12));
    }
}

// Led there slower and slower, a mast is deployed when the drive has come to its end and no fraction of a
// percent earlier; led on beyond it, when it passes: of smooth motion u^3 (10 - 15 u + 6 u^2) is its share.
TEST_CASE("a family whose drive ends in its deployed fold angle is deployed then, with every method") {
  const auto mast = [](double deployed, double to, const std::vector<std::string>& more) {
    std::vector<std::string> all = {
        "structure.tip_force=0", "structure.deployed_angle=" + std::to_string(deployed), "solver.step=0.05",
        "constraints[0]={kind=\"angle\", name=\"m\", fold_angle=true, motion=\"smooth\", duration=2, to=" +
            std::to_string(to) + "}"};
    all.insert(all.end(), more.begin(), more.end());
    return read_scene_file(find_scene("scissor_mast"), all);
  };
  for (const Method& method : methods())
    for (const char* then : {"stop", "latch", "pass"}) {
      const Scene scene = mast(20, 20,
                               {"solver.method=" + std::string(method.name),
                                std::string("solver.at_deployed=") + then, "solver.end_time=2.5"});
      const Simulation run = simulate(build_model(scene), scene.solver);
      INFO(method.name << ", " << then << ": " << run.message);
      CHECK(run.status == (std::string(then) == "stop" ? RunStatus::deployed : RunStatus::completed));
      CHECK(time_of(run, "deployed") == Approx(2.0).epsilon(1e-12));
    }
  const Scene beyond = mast(25, 10, {});
  const double start = beyond.structure.real("fold_angle"), part = (start - 25) / (start - 10);
  double u = 0.5;
  for (int k = 0; k < 50; ++k)
    u -= (u * u * u * (10 - 15 * u + 6 * u * u) - part) / (30 * u * u * (1 - u) * (1 - u));
  CHECK(time_of(simulate(build_model(beyond), beyond.solver), "deployed") == Approx(2 * u).epsilon(1e-9));
}

}  // namespace measured_deployment_test
