// SPDX-License-Identifier: BSD-3-Clause
// What is said of a run, word by word, of books whose errors are known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/diagnostics/good_part.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace judgement_test {

namespace {

using Values = std::vector<double>;

struct Judged {
  Simulation run;
  Diagnostics d;

  void set(std::string_view name, const Values& values) {
    for (Series& column : d.columns)
      if (column.name == name) column.values = values;
  }
};

// A mass on a spring; its books are replaced by six states of 60 J turned over: most between the largest and
// the smallest potential energy.
Judged six_states() {
  Judged j{testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0.4, 0.1, -0.3], fixed = true},
         {name = "P", position = [1.6, 0.1, -0.3], mass = 1.3}]
[[structure.constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["O", "P"]
stiffness = 50
damping = 0.3
free_length = 1.0
[solver]
step = 0.01
end_time = 0.05
)"),
           {}};
  j.d = diagnose(j.run);
  REQUIRE(j.d.t.size() == 6);
  for (Series& column : j.d.columns)
    if (column.unit == "J") column.values.assign(6, 0.0);
  j.set("kinetic_energy_J", {3, 20, 50, 30, 10, 40});
  j.set("potential_energy_J", {-7, -40, -67, -35, -12, -45});
  j.set("dissipated_J", {0, 1, 2, 5, 9, 11});
  return j;
}

std::vector<std::string> warnings(const Judged& j) {
  return accuracy_warnings(j.run, j.d);
}

using Texts = std::vector<std::string>;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("an energy balance that is off is told with its size, its share and its cure") {
  for (const double sign : {1.0, -1.0}) {
    Judged j = six_states();
    CHECK(energy_turned_over(j.d) == 60);
    const auto off_by = [&](double most) {
      j.set("energy_balance_J", {0, 0.2 * sign * most, sign * most, -0.9 * sign * most, 0, 0.1 * most});
    };
    off_by(0.0599);
    CHECK(warnings(j).empty());
    off_by(0.75);
    const std::string what = "the energy balance is off by 0.75 J, 1.25 % of the energy turned over";
    CHECK(warnings(j) == Texts{what + ": take a smaller solver.step or more solver.stages"});
    j.run.options.method = "rk4";  // whose order is 4 whatever the stages
    CHECK(warnings(j) == Texts{what + ": take a smaller solver.step"});
    j.run.options.method = "dvm";
    off_by(61);
    CHECK(warnings(j) == Texts{"the energy balance is off by 61 J, more than all of the energy turned over: "
                               "take a smaller solver.step or more solver.stages"});
    j.set("energy_balance_J", {0, 0, nan_value, 0, 0, 0});
    CHECK(warnings(j).size() == 1);
  }
}

TEST_CASE("what a damping method takes on purpose is lost, what it adds is off") {
  Judged j = six_states();
  j.run.options.method = "generalized_alpha";
  j.run.options.rho_inf = 0.7;
  j.set("energy_balance_J", {0, -0.1, -0.3, -0.5, -0.7, -0.75});
  CHECK(warnings(j) ==
        Texts{"what the steps do not resolve has lost 0.75 J, 1.25 % of the energy turned over, as "
              "solver.rho_inf means it to: a smaller solver.step loses less"});
  CHECK(mistrust(j.run, j.d).empty());
  j.set("energy_balance_J", {0, -30, -33, -35, -40, -45});  // whatever it loses
  CHECK(mistrust(j.run, j.d).empty());
  // Half of it gained again from the lowest on: off.
  j.set("energy_balance_J", {0, -0.1, -0.75, -0.5, -0.4, -0.37});
  CHECK(warnings(j) == Texts{"the energy balance is off by 0.75 J, 1.25 % of the energy turned over: take a "
                             "smaller solver.step"});
  j.set("energy_balance_J", {0, -0.1, -0.75, -0.5, -0.4, -0.38});
  CHECK(warnings(j).front().starts_with("what the steps do not resolve has lost"));
}

TEST_CASE("constraints that are violated are told in percent of a rod") {
  Judged j = six_states();
  j.set("constraint_relative_max", {0, 1e-4, 9.9e-4, 1e-5, 0, 0});
  CHECK(warnings(j).empty());
  j.set("constraint_relative_max", {0, 1e-4, 0.0025, 1e-5, 0, 0});
  CHECK(warnings(j) ==
        Texts{"constraints are violated by 0.25 % of a rod's length: take a smaller solver.step"});
  j.run.options.method = "rk4";
  j.set("energy_balance_J", {0, 0, 0, 0, 0, -3});
  CHECK(
      warnings(j) ==
      Texts{
          "the energy balance is off by 3 J, 5 % of the energy turned over: take a smaller solver.step",
          "constraints are violated by 0.25 % of a rod's length: take a smaller solver.step, or method dvm, "
          "which holds them"});
}

TEST_CASE("a run is good up to where its books are off for good, and says why") {
  Judged j = six_states();
  const auto part = [&] { return good_part(j.run, j.d); };
  const auto at = [&](std::size_t i) {
    std::ostringstream text;
    text << "from t = " << j.d.t[i] << " s on ";
    return text.str();
  };
  CHECK(part().states == 6);
  CHECK(part().text(j.d).empty());
  // 6.5 J: too much of the 60 J up to then, and of what is turned over later.
  j.set("energy_balance_J", {0, 0.1, 0, -6.5, 0, 0});
  CHECK(part().states == 3);
  CHECK(mistrust(j.run, j.d) ==
        at(3) + "the energy balance is off by 6.5 J, 10.8 % of the energy turned over");
  // 66 J by the end are enough for them.
  j.set("potential_energy_J", {-7, -40, -67, -35, -12, -1});
  CHECK(part().states == 6);
  // 4 J are too much of the 33 J after one step.
  j.set("energy_balance_J", {0, 4, 0, 0, 0, 0});
  CHECK(part().states == 6);
  j.set("kinetic_energy_J", {3, 20, 20, 20, 20, 20});
  j.set("potential_energy_J", {-7, -40, -12, -12, -12, -12});
  CHECK(part().states == 1);
  CHECK(mistrust(j.run, j.d) == at(1) + "the energy balance is off by 4 J, 12.1 % of the energy turned over");
  j = six_states();
  j.set("constraint_relative_max", {0, 0.01, 0.05, 0.0999, 0.11, 0.12});
  CHECK(part().states == 4);
  CHECK(mistrust(j.run, j.d) == at(4) + "constraints are violated by 11 % of a rod's length");
  j.set("constraint_relative_max", {0, 0.01, 0.05, 0.0999, nan_value, 0.12});
  CHECK(part().states == 4);
  CHECK(mistrust(j.run, j.d) == at(4) + "the state is not finite any more");
  j = six_states();
  j.set("dissipated_J", {0, 0, nan_value, 0, 0, 0});
  CHECK(mistrust(j.run, j.d) == at(2) + "the state is not finite any more");
  j.set("dissipated_J", {nan_value, 0, 0, 0, 0, 0});
  CHECK(part().states == 1);  // what is kept is never nothing
  // What was not looked at is not judged.
  j = six_states();
  j.d.left_open = 2;
  j.set("energy_balance_J", {0, 0, 0, 0, nan_value, nan_value});
  CHECK(part().states == 4);
  CHECK(mistrust(j.run, j.d).empty());
  std::ostringstream open;
  open << "interrupted: the run was judged up to t = " << j.d.t[3]
       << " s only: what follows may be nan in series and rod forces, and measures of the whole run are";
  CHECK(warnings(j) == Texts{open.str()});
}

TEST_CASE("what rests at the origin is right, whatever rounding leaves of its energy") {
  for (const char* method : {"dvm", "rk4", "rk4_projected", "generalized_alpha"}) {
    Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "M", position = [0, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["M"]
direction = [0, 0, 1]
[[constraints]]
kind = "coordinate_stop"
nodes = ["M"]
direction = [0, 0, 1]
min = 0
[gravity]
acceleration = [0, 0, -10]
[solver]
end_time = 0.1
)",
                                        {std::string("solver.method=") + method});
    INFO(method);
    const std::size_t states = run.trajectory.size();
    judge(run);
    CHECK(run.status == RunStatus::completed);
    CHECK(run.trajectory.size() == states);
    CHECK(run.trajectory.positions(states - 1).lpNorm<Eigen::Infinity>() <= 1e-20);
  }
}

TEST_CASE("what is kept of a run is its beginning, in all that belongs to it") {
  Judged j = six_states();
  const double t2 = j.d.t[2];
  j.run.events = {{"early", 0.5 * t2}, {"at the end", t2}, {"late", 1.01 * t2}};
  keep_states(3, j.run, j.d);
  CHECK(j.run.trajectory.size() == 3);
  CHECK(j.d.t.size() == 3);
  for (const Series& column : j.d.columns) CHECK(column.values.size() == 3);
  CHECK(j.d.at("kinetic_energy_J").values == Values{3, 20, 50});
  CHECK(j.d.axial_force.rows() == 3);
  CHECK(j.d.force_unique.rows() == 3);
  REQUIRE(j.run.events.size() == 2);
  CHECK(j.run.events[1].name == "at the end");
  REQUIRE(j.run.status == RunStatus::completed);
  fail_for("from t = 2 s on it rains", j.run);
  CHECK(j.run.status == RunStatus::failed);
  CHECK(j.run.message == "from t = 2 s on it rains: what follows is left out");
  fail_for("it snows", j.run);
  CHECK(j.run.message ==
        "from t = 2 s on it rains: what follows is left out; it snows: what follows is left out");
}

TEST_CASE("energies are turned over by the largest of their spans, or by motion") {
  const Values first{5, -2, 1}, second{4, 9, 1}, third{-3, 2, 1.5};
  EnergyTurnedOver turned;
  CHECK(turned.value() == 0);
  turned.add(0.5, first);
  CHECK(turned.value() == 0.5);
  turned.add(0.25, second);
  CHECK(turned.value() == 11);
  turned.add(0.125, third);
  CHECK(turned.value() == 11);
  turned.add(12, third);
  CHECK(turned.value() == 12);
  turned.add(1, Values{10, 0, 1});
  CHECK(turned.value() == 13);
}

// What was not looked at turns over nothing, and hides nothing of the rest.
TEST_CASE("energies of an interrupted diagnosis are those of the states that were looked at") {
  Judged j = six_states();
  j.d.left_open = 2;
  for (Series& column : j.d.columns)
    if (column.unit == "J") column.values[4] = column.values[5] = nan_value;
  CHECK(energy_turned_over(j.d) == 60);  // from -7 J to -67 J
  j.d.left_open = 4;
  CHECK(energy_turned_over(j.d) == 33);
}

TEST_CASE("a run whose judgement is interrupted has not failed for that") {
  Judged j = six_states();
  const RunStatus status = j.run.status;
  int asked = 0;
  j.d = judge(j.run, [&] { return ++asked > 3; });
  CHECK(j.d.left_open == 3);
  CHECK(j.run.status == status);
  CHECK(j.run.message.empty());
  CHECK(j.run.trajectory.size() == 6);
  CHECK(j.d.t.size() == 6);
}

// Of books without any energy, off by what rounding can have done until the end, or by more.
TEST_CASE("what rounding can do to a balance grows until the end of a run") {
  Judged j = six_states();
  for (Series& column : j.d.columns)
    if (column.unit == "J") column.values.assign(6, 0.0);
  const std::vector<double> noise = energy_round_off(j.run);
  REQUIRE(noise.front() < 0.9 * noise.back());
  j.set("energy_balance_J", {0, 0, 0, 0, 0, 0.95 * noise.back()});
  REQUIRE(warnings(j).size() == 1);
  CHECK(warnings(j)[0].find("rounding alone") != std::string::npos);
  j.set("energy_balance_J", {0, 0, 0, 0, 0, 1.05 * noise.back()});
  REQUIRE(warnings(j).size() == 1);
  CHECK(warnings(j)[0].find("take a smaller solver.step") != std::string::npos);
}

TEST_CASE("states that are shown without what rods give are told once and by themselves") {
  Judged j{testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [0.6, 0, -0.8], mass = 1.3}]
rods = [{nodes = ["O", "P"], mass = 1, area = 1e-4, youngs_modulus = 7e10}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.05
)"),
           {}};
  j.d = diagnose(j.run);
  REQUIRE(j.d.t.size() == 6);
  CHECK(first_unstretched(j.run, j.d) == 6);
  for (std::size_t i = 0; i < 6; ++i)
    j.run.trajectory.add_stretch(i, VectorXd::Constant(6, i < 3 ? 1e-6 : 0.0));
  CHECK(first_unstretched(j.run, j.d) == 3);
  REQUIRE(warnings(j).size() == 1);
  const std::string told = warnings(j)[0];
  CHECK(told.starts_with("near t = 0.03 s"));
  j.set("energy_balance_J", {0, 0, 0, 0, 0, -3});
  j.set("constraint_relative_max", {0, 0, 0, 0, 0, 0.0025});
  REQUIRE(warnings(j).size() == 3);
  CHECK(warnings(j)[0].starts_with("the energy balance is off by 3 J"));
  CHECK(warnings(j)[1].starts_with("constraints are violated by 0.25 %"));
  CHECK(warnings(j)[2] == told);
  j.d.axial_force.row(3).setZero();  // a rod that bears nothing has nothing to give
  CHECK(first_unstretched(j.run, j.d) == 4);
}

// A mass of 17 g flies freely, so far from where coordinates are counted: its position is rounded by 64
// units in a step, which add up to a velocity along each axis, and what its weight could do over that reach
// is rounded once a step, at random. The one counts close by, the other far away.
TEST_CASE("the round-off of an energy is that of heights and of steps") {
  for (const auto& [reach, begin] : {std::pair(3.1, -0.7), {3.1e12, -0.7}, {3.1e14, -0.7}, {3.1, 0.7}}) {
    const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0.2, 3.1, -0.7], mass = 0.017}]
[gravity]
acceleration = [0, 0, -2.3]
[solver]
step = 0.05
end_time = 0.5
)",
                                              {"structure.nodes.P.position[1]=" + std::to_string(reach),
                                               "structure.nodes.P.position[2]=" + std::to_string(begin)});
    REQUIRE(run.trajectory.size() == 11);
    const std::vector<double> noise = energy_round_off(run);
    REQUIRE(noise.size() == 11);
    const double unit = 64 * 2.220446049250313e-16, weight = 0.017 * 2.3;
    double height = 0;  // the largest so far
    for (std::size_t i = 0; i < noise.size(); ++i) {
      const double t = run.trajectory.time(i), steps = static_cast<double>(i);
      const double drift = i > 0 ? unit * reach * steps / t : 0.0;
      height = std::max(height, std::abs(begin - 0.5 * 2.3 * t * t));
      CHECK(noise[i] ==
            Approx(std::sqrt(steps + 1) * unit * weight * (reach + height) + 3 * 0.017 * drift * drift)
                .epsilon(1e-9));
    }
  }
}

// Two rods, of 2 m and 7e5 N and of 1.5 m and 6e5 N, which pull as their lengths say at the start.
TEST_CASE("what stopped waves can have had is what rods have stored beyond their forces at the start") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
rod_model = "elastic"
nodes = [{name = "A", position = [0, 0, 0], mass = 1}, {name = "B", position = [2, 0, 0], mass = 1},
         {name = "C", position = [2, 1.5, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.1, area = 1e-4, youngs_modulus = 7e9},
        {nodes = ["B", "C"], mass = 0.1, area = 3e-4, youngs_modulus = 2e9, free_length = 1.4999}]
)");
  Simulation run{.trajectory = Trajectory(model)};
  State state = initial_state(model->structure, model->system).state;
  const double stretched = 6e5 / 1.4999 * 1e-4;
  for (const Vec3& n : {Vec3(0, stretched, 0.0), Vec3(30, stretched - 20, 0.1), Vec3(-10, stretched, 0.2)}) {
    state.t = n.z(), state.tension = n.head<2>();
    run.trajectory.append(state, {});
  }
  const std::vector<double> energy = energy_of_stopped_waves(run);
  REQUIRE(energy.size() == 3);
  CHECK(energy[0] <= 1e-12);
  const double most = 4 * 0.5 * (30.0 * 30 * 2 / 7e5 + 20.0 * 20 * 1.4999 / 6e5);
  CHECK(energy[1] == Approx(most).epsilon(1e-9));
  CHECK(energy[2] == Approx(most).epsilon(1e-9));
}

// By explicit steps of 10 ms a spring of 1e10 N/m throws 1 kg a thousand times as far in each: the last
// states before what is not finite have forces whose work no number holds.
TEST_CASE("what an explicit method throws away is no part of a run") {
  for (const char* method : {"rk4", "rk4_projected", "rk4_baumgarte"})
    for (const char* stiffness : {"1e8", "1e9", "1e10", "1e11", "1e12"}) {
      const Scene scene = read_scene_text(
          std::string(
              "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, "
              "{name = 'A', position = [1, 0, 0], mass = 1}]\n[[structure.constraints]]\nkind = 'line'\n"
              "nodes = ['A']\ndirection = [1, 0, 0]\n[[forces]]\nkind = 'spring'\nnodes = ['O', 'A']\n"
              "free_length = 0.99\nstiffness = ") +
              stiffness + "\n[solver]\nstep = 0.01\nend_time = 1\nmethod = '" + method + "'\n",
          "spring.toml", {});
      const Simulation run = simulate(build_model(scene), scene.solver);
      CAPTURE(method, stiffness);
      CHECK(good_part(run, diagnose(run)).states <= 1);
    }
}

}  // namespace judgement_test
