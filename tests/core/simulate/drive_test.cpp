// SPDX-License-Identifier: BSD-3-Clause
// Driven and held measures, relations by name: motions with closed forms, power in and out.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/integrators/integrator.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace drive_test {

namespace {

using testing::end_positions, testing::error_of, testing::largest, testing::run_scene;

// A crank of 3 kg and 2 m in the plane z = 0 under gravity, turned by a motor.
const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [1, 0, 0], fixed = true},
  {name = "A", position = [0, 2, 0]}]
rods = [{name = "crank", nodes = ["O", "A"], mass = 3}]
constraints = [
  {kind = "plane", nodes = ["A"], normal = [0, 0, 1]},
  {kind = "angle", name = "motor", nodes = ["P", "O", "A"], axis = [0, 0, 1], motion = "smooth", to = 270, duration = 2}]
[gravity]
acceleration = [0, -10, 0]
[solver]
stages = 4
step = 0.02
end_time = 2.5
)";

}  // namespace

TEST_CASE("a motor turns a crank and reports the torque and power it gives") {
  for (const char* method : {"dvm", "rk4"}) {
    const Simulation run = run_scene(crank, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const auto &torque = d.at("motor.torque_N_m").values, &power = d.at("motor.power_W").values;
    const bool drifts = std::string(method) == "rk4";  // like h^4
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      const double u = std::min(d.t[i] / 2, 1.0), v = 1 - u;
      const double theta = pi / 2 + pi * u * u * u * (10 + u * (-15 + 6 * u));
      const double rate = pi / 2 * 30 * u * u * v * v, bend = pi / 4 * 60 * u * v * (v - u);
      // I theta'' + m g l / 2 cos(theta)
      const double wanted = 4 * bend + 30 * std::cos(theta);
      CHECK(torque[i] == Approx(wanted).epsilon(0).margin(drifts ? 1e-3 : 1e-9));
      CHECK(power[i] == Approx(wanted * rate).epsilon(0).margin(drifts ? 1e-3 : 1e-9));
      const VectorXd x = run.trajectory.positions(i);
      CHECK(x[6] == Approx(2 * std::cos(theta)).epsilon(0).margin(drifts ? 1e-5 : 1e-12));
    }
    // From 90 to 270 degrees the weight falls by 2 m: 60 J come back through the motor.
    CHECK(d.at("drive_work_J").values.back() == Approx(-60).epsilon(1e-6));
    CHECK(largest(d, "energy_balance_J") <= (drifts ? 1e-3 : 2e-7));  // of 60 J, order 6
    if (!drifts) {
      CHECK(largest(d, "constraint_relative_max") <= 1e-14);
      CHECK(largest(d, "constraint_velocity_max_m_s") <= 1e-13);
    }
  }
}

// It is at the stop with hardly any speed: no impact says that it cannot go on.
TEST_CASE("a drive that sets off into a stop or a cable that it touches ends there") {
  const std::string begin = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate"
nodes = ["A"]
direction = [1, 0, 0]
motion = "rate"
rate = 0.3
ramp = 0.2
start = 0.0133
[solver]
step = 0.003
end_time = 0.4
[[constraints]]
)";
  for (const auto& [held_by, told] :
       {std::pair{"kind = 'coordinate_stop'\nname = 'wall'\nnodes = ['A']\ndirection = [1, 0, 0]\n"
                  "max = 1.00000000002\n",
                  "a drive pushes against the stop wall"},
        {"kind = 'cable'\nname = 'rope'\nnodes = ['O', 'A']\nlength = 1.00000000002\n",
         "a drive pulls at the cable rope"}}) {
    const Simulation run = run_scene(begin + held_by);
    INFO(told << " | " << run.message);
    REQUIRE(run.status == RunStatus::failed);
    CHECK(run.message.find(told) != std::string::npos);
    // The ramp begins with 22.5 t^2 m/s, which is 2e-11 m after 1.4e-4 s.
    CHECK(run.trajectory.end_time() == Approx(0.0133 + std::cbrt(2e-11 / 7.5)).epsilon(0).margin(1e-5));
    CHECK(run.warnings.empty());
  }
}

// A rebound slower than `rest_speed`, 1 mm/s unless a scene says otherwise, rests on a stop; a drive does
// not, however slow it is.
TEST_CASE("a drive slower than what rests on a stop does not go through it") {
  for (const double rate : {1e-3, 5e-4, 2e-6})
    for (const std::string method : {"dvm", "rk4", "generalized_alpha"}) {
      const double gap = 1.5 * rate;
      const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate"
nodes = ["A"]
direction = [1, 0, 0]
motion = "rate"
rate = )" + std::to_string(rate) + R"(
[[constraints]]
kind = "coordinate_stop"
name = "wall"
nodes = ["A"]
direction = [1, 0, 0]
max = )" + std::to_string(gap) + R"(
[solver]
step = 0.02
end_time = 4
method = ")" + method + '"');
      INFO(method << " | " << rate << " | " << run.message);
      REQUIRE(run.status == RunStatus::failed);
      CHECK(run.message.find("a drive pushes against the stop wall") != std::string::npos);
      // What counts as touching, 1e-11 of the length of 1 m that a point has, takes it 5e-6 s at 2e-6 m/s.
      CHECK(run.trajectory.end_time() == Approx(1.5).epsilon(0).margin(1e-5));
      CHECK(run.warnings.empty());
    }
}

// From A over B to C there are 1 + sqrt(5) / 2 = 2.1180 m, which two rods keep: as built, or taken in by then
// with 2.15 m, 0.1 m/s and half a ramp of 0.1 s.
TEST_CASE("a cable that is drawn in along what keeps its length says so") {
  for (const auto& [length, end] :
       {std::pair{"", 0.0}, {"length = 2.15", 0.05 + (1.15 - std::sqrt(1.25)) / 0.1}}) {
    const Simulation run = run_scene(std::string(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]},
         {name = "C", position = [1.5, 1, 0]}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}]
[solver]
end_time = 1
[[constraints]]
kind = "cable"
name = "rope"
nodes = ["A", "B", "C"]
motion = "rate"
rate = -0.1
ramp = 0.1
)") + length);
    REQUIRE(run.status == RunStatus::failed);
    INFO(run.message);
    CHECK(run.message.find("the cable rope is drawn in further than what it runs along gives way") !=
          std::string::npos);
    CHECK(run.trajectory.end_time() == Approx(end).margin(1e-9));
  }
}

// 2 kg on a line, a rod of 1.5 kg on it and on a slider beside: from rest to 0.3 m/s, whatever a ramp does
// that no step tells from none. Imposed: round-off of some metres. What begins within 1e-9 of a step of t = 0
// begins there. The drive's work is that of the jump, of a ramp of 6 ns to the rounding of places in 6 ns.
TEST_CASE("ramps down to round-off of time lead to the rate without one") {
  const std::string slider = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], mass = 2}, {name = "B", position = [1.3, 0.4, 0]}]
rods = [{nodes = ["A", "B"], mass = 1.5}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]}, {kind = "line", nodes = ["B"], direction = [1, 0, 0]}]
[[constraints]]
name = "drive"
kind = "coordinate"
nodes = ["A"]
direction = [1, 0, 0]
motion = "rate"
rate = 0.3
[solver]
step = 0.05
end_time = 1
)";
  for (const double start : {0.0, 5e-12, 0.5, 0.4871})
    for (const char* ramp : {"0", "1e-30", "1e-16", "1e-13", "1e-12", "1e-11", "1e-10", "1e-9", "4e-9",
                             "6e-9", "1e-8", "1e-7", "1e-6"}) {
      CAPTURE(start, ramp);
      const double begins = start + 0.5 * std::stod(ramp);
      const bool at_once = begins <= 5.01e-11;
      const Simulation run = run_scene(slider, {"constraints[drive].start=" + testing::number(start),
                                                "constraints[drive].ramp=" + std::string(ramp)});
      CHECK(run.status == RunStatus::completed);
      CHECK((run.warnings.empty() || at_once));  // a jump at the start is told
      CHECK(end_positions(run)[0] == Approx(1 + 0.3 * (at_once ? 1 : 1 - begins)).epsilon(0).margin(1e-13));
      const Diagnostics d = diagnose(run);
      CHECK(testing::largest(d, "energy_balance_J") <= (std::stod(ramp) < 5e-9 ? 1e-12 : 3e-4));
      CHECK(d.at("kinetic_energy_J").values.back() == Approx(0.5 * 3.5 * 0.3 * 0.3).epsilon(1e-9));
    }
}

TEST_CASE("a crank at a constant rate goes round and round") {
  const Simulation run =
      run_scene(crank, {"structure.constraints.motor.motion=rate", "structure.constraints.motor.rate=720",
                        "structure.constraints.motor.ramp=0.5"});
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd x = end_positions(run);
  const double theta = pi / 2 + 4 * pi * (2.5 - 0.25);
  // The place is imposed, whatever the step: round-off of an angle of 30 rad, times 2 m, a hundredfold.
  CHECK(x[6] == Approx(2 * std::cos(theta)).epsilon(0).margin(1e-11));
  CHECK(x[7] == Approx(2 * std::sin(theta)).epsilon(0).margin(1e-11));
}

TEST_CASE("a table is followed through its points, one that begins elsewhere is refused") {
  const std::vector<std::string> table = {"structure.constraints.motor.motion=table",
                                          "structure.constraints.motor.times=[0, 1, 2]",
                                          "structure.constraints.motor.values=[90, 120, 100]"};
  const Simulation run = run_scene(crank, table);
  REQUIRE(run.status == RunStatus::completed);
  // Imposed too: round-off of 2 m, a thousandfold.
  CHECK(run.trajectory.positions(50)[6] ==
        Approx(2 * std::cos(120 * radians_per_degree)).epsilon(0).margin(1e-12));
  CHECK(run.trajectory.positions(100)[6] ==
        Approx(2 * std::cos(100 * radians_per_degree)).epsilon(0).margin(1e-12));
  auto wrong = table;
  wrong[2] = "structure.constraints.motor.values=[91, 120, 100]";
  CHECK(error_of(crank, wrong).find("the table is at 91 when t = 0, the structure at 90: they must agree") !=
        std::string::npos);
}

TEST_CASE("an actuator changes a length as told") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], mass = 1},
  {name = "B", position = [1, 0, 0], mass = 3}]
[[constraints]]
kind = "length"
name = "actuator"
nodes = ["A", "B"]
motion = "smooth"
to = 3
duration = 1
[solver]
end_time = 1
step = 0.01
stages = 4
)");
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd x = end_positions(run);
  CHECK(x[0] == Approx(-1.5).epsilon(1e-10));  // the centre of mass stays
  CHECK(x[3] == Approx(1.5).epsilon(1e-10));
  const Diagnostics d = diagnose(run);
  // Reduced mass 3/4 kg; s'' at u = 1/4: 2 * 60 * (1/4)(3/4)(1/2).
  CHECK(d.at("actuator.force_N").values[25] == Approx(0.75 * 11.25).epsilon(1e-9));
  CHECK(std::abs(d.at("drive_work_J").values.back()) <= 1e-8);  // at rest before and after
  CHECK(largest(d, "energy_balance_J") <= 1e-8);
}

TEST_CASE("mirror, equal, relation, collinear, coplanar hold by name") {
  const std::string free = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [1, 0, 0], velocity = [1, 2, 3], mass = 1},
  {name = "B", position = [-1, 0, 0], mass = 2},
  {name = "C", position = [0, 0, 0], velocity = [0, 1, -1], mass = 1},
  {name = "D", position = [0, 1, 0], velocity = [1, 0, 2], mass = 1}]
[solver]
stages = 4
step = 0.02
end_time = 0.5
)";
  const auto positions = [&](const std::string& constraint) {
    const Simulation run = run_scene(free + "[[constraints]]\n" + constraint);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(largest(diagnose(run), "energy_balance_J") <= 1e-9);  // ideal constraints do no work
    const VectorXd x = end_positions(run);
    return std::array<Vec3, 4>{x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9)};
  };
  auto p = positions("kind = 'mirror'\nnodes = ['A', 'B']\nnormal = [1, 0, 0]");
  CHECK((p[1] - Vec3(-p[0][0], p[0][1], p[0][2])).norm() <= 1e-13);
  CHECK(p[0][1] == Approx(2.0 / 3.0 * 0.5));  // momentum shared by 1 + 2 kg
  p = positions("kind = 'equal'\nnodes = ['A', 'B', 'C']\ndirection = [0, 0, 2]");
  CHECK(std::abs(p[0][2] - p[1][2]) + std::abs(p[0][2] - p[2][2]) <= 1e-13);
  CHECK(p[0][2] == Approx((3.0 - 1.0) / 4 * 0.5));
  p = positions("kind = 'relation'\nnodes = ['A', 'B']\ncoefficients = [1, 0, 0, 2, 0, 0]");
  CHECK(p[0][0] + 2 * p[1][0] == Approx(-1).epsilon(1e-13));
  p = positions("kind = 'collinear'\nnodes = ['A', 'B', 'C']");
  CHECK((p[1] - p[0]).cross(p[2] - p[0]).norm() <= 1e-13);
  CHECK(std::abs(p[2][1] - 0.5) > 1e-3);  // it was not flying free
  p = positions("kind = 'coplanar'\nnodes = ['A', 'B', 'C', 'D']");
  CHECK(std::abs((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0])) <= 1e-13);
}

TEST_CASE("impossible scenes are refused by the names of their members") {
  CHECK(
      error_of(crank +
               "[[constraints]]\nkind = 'angle'\nname = 'lock'\nnodes = ['P', 'O', 'A']\naxis = [0, 0, 1]\n")
          .find(
              "the drive motor moves what other constraints hold: lock; remove the drive, or one of these") !=
      std::string::npos);
  const std::vector<std::string> hold = {"structure.constraints.motor.motion=hold"};
  CHECK(error_of(crank, hold).find("nothing can move: ") != std::string::npos);
  CHECK(error_of(crank, hold).find("motor") != std::string::npos);
  CHECK(
      error_of(crank +
               "[[constraints]]\nkind = 'equal'\nname = 'level'\nnodes = ['A', 'P']\ndirection = [0, 1, 0]\n")
          .find("the structure cannot be assembled as given: level (A, P) is violated at t = 0, by up to 2 "
                "m") != std::string::npos);
  CHECK(error_of(crank, {"structure.constraints.motor.nodes=['P', 'O', 'B']"}).find("there is no node 'B'") !=
        std::string::npos);
}

// A pendulum of 1 m whose pivot is drawn along x. A ramp is a jump in its middle but for what moves
// meanwhile: of 1e-6 s in half a second some 1e-6 m.
TEST_CASE("a ramp of any shortness is followed, wherever its ends are rounded") {
  const std::string pendulum = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], mass = 1}, {name = "P", position = [0, 0, -1], mass = 1},
  {name = "D", position = [3, 0, 0], fixed = true}]
rods = [{nodes = ["A", "P"], mass = 0}]
constraints = [
  {kind = "plane", nodes = ["P"], normal = [0, 1, 0]}, {kind = "line", nodes = ["A"], direction = [1, 0, 0]},
  {kind = "coordinate", name = "drive", nodes = ["A"], direction = [1, 0, 0], motion = "rate", rate = 1}]
[solver]
step = 0.01
end_time = 0.5
)";
  const auto run = [&](double start, double ramp) {
    return run_scene(pendulum, {"structure.constraints[2].start=" + testing::number(start),
                                "structure.constraints[2].ramp=" + testing::number(ramp)});
  };
  for (const double start : {0.1, 0.3, 0.07, 0.29, 0.4})
    for (const double ramp : {9.9e-10, 1e-9, 1.02e-9, 1.1e-9, 1.3e-9, 1e-8, 1e-7, 1e-6}) {
      Simulation ramped = run(start, ramp);
      const Simulation at_once = run(start + 0.5 * ramp, 0);
      judge(ramped);
      INFO(start << " s, " << ramp << " s: " << ramped.message);
      REQUIRE(ramped.status == RunStatus::completed);
      CHECK(ramped.warnings.empty());
      CHECK((end_positions(ramped) - end_positions(at_once)).lpNorm<Eigen::Infinity>() < 1e-9 + 10 * ramp);
    }
}

}  // namespace drive_test
