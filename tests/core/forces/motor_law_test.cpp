// SPDX-License-Identifier: BSD-3-Clause
// A motor's law where voltage, controller and current cut it, against those cuts written down.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/forces/motor.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/system/mass_matrix.hpp"
#include "tests/support/table_structure.hpp"

using namespace unfurl;

namespace motor_law_test {

namespace {

constexpr double t = 0.7;

// On x of node d, behind a gear that turns the other way; its error is summed up in x of node a.
Force motor_with(Motor::Control control) {
  Force f;
  f.kind = "motor";
  f.measure = {MeasureKind::coordinate, {3}, Vec3::UnitX(), 0.0, {}};
  Motor& m = f.motor;
  m.stall = 0.4, m.no_load_speed = 12, m.gear_ratio = -2.5, m.limit = 0.31;
  m.control = control;
  m.command.kind = TimeFunction::Kind::rate;
  m.command.offset = 0.3, m.command.rate = -0.2;
  if (control == Motor::Control::none) m.command = TimeFunction(), m.command.offset = -0.8;
  m.proportional = 0.9, m.integral = 0.35, m.derivative = control == Motor::Control::position ? 0.12 : 0.0;
  if (control == Motor::Control::position) m.integrator = 0;
  return f;
}

double effort_of(const Motor& m, double value, double rate, double sum) {
  const auto full = [&](double share) { return m.stall * (share - m.gear_ratio * rate / m.no_load_speed); };
  const double e = m.command(t) - value, e_rate = m.command.derivative(1, t) - rate;
  double torque = full(m.command(t));
  if (m.control != Motor::Control::none) {
    const double asked = m.control == Motor::Control::position
                             ? m.proportional * e + m.integral * sum + m.derivative * e_rate
                             : m.proportional * e_rate + m.integral * e;
    torque = std::clamp(asked / m.gear_ratio, full(-1), full(1));
  }
  return m.gear_ratio * std::clamp(torque, -m.limit, m.limit);
}

}  // namespace

TEST_CASE(
    "a motor gives what is asked, cut to its voltage and then to its current, and its derivatives are of "
    "that") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const auto control : {Motor::Control::none, Motor::Control::position, Motor::Control::rate}) {
    Structure structure = testing::table_structure();
    structure.forces = {motor_with(control)};
    const Force& f = structure.forces.front();
    const MeasureFunction measure(f.measure, structure.deployment);
    int cut = 0, uncut = 0;
    for (int k = 0; k < 200; ++k) {
      VectorXd q = VectorXd::Zero(12), v = VectorXd::Zero(12);
      q[9] = 2 * uniform(random), v[9] = 4 * uniform(random), q[0] = uniform(random), v[0] = uniform(random);
      VectorXd g(static_cast<Index>(measure.stencil().size()));
      const MotorState s = motor_state(f, measure, -1, t, q.data(), v.data(), g.data());
      const auto effort = [&](double by_q, double by_v, double by_z) {
        return effort_of(f.motor, q[9] + by_q, v[9] + by_v, q[0] + by_z);
      };
      CHECK((s.value == q[9] && s.rate == v[9]));
      CHECK(s.effort == Approx(effort(0, 0, 0)).epsilon(0).margin(1e-14));
      // Its parts are linear: differences are right to round-off, and where they agree on both sides no bend
      // is near.
      const double h = 1e-5;
      const auto slope = [&](double a, double b, double c, double found) {
        const double up = (effort(h * a, h * b, h * c) - effort(0, 0, 0)) / h,
                     down = (effort(0, 0, 0) - effort(-h * a, -h * b, -h * c)) / h;
        if (std::abs(up - down) < 1e-9) CHECK(found == Approx(up).epsilon(0).margin(1e-9));
      };
      slope(1, 0, 0, s.by_value), slope(0, 1, 0, s.by_rate), slope(0, 0, 1, s.by_integral);
      ++(std::abs(s.effort) == std::abs(f.motor.gear_ratio * f.motor.limit) ? cut : uncut);
    }
    CHECK(std::min(cut, uncut) > 20);
  }
}

// The parts of clamp(clamp(asked, backward, forward), -limit, limit), told apart by what the clamps do.
TEST_CASE("the part of a motor's law that holds is the one that has room, and no other has") {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::array<int, 5> held{};
  for (const auto control : {Motor::Control::position, Motor::Control::rate}) {
    Structure structure = testing::table_structure();
    structure.forces = {motor_with(control)};
    const Force& f = structure.forces.front();
    const Motor& m = f.motor;
    const MeasureFunction measure(f.measure, structure.deployment);
    for (int k = 0; k < 2000; ++k) {
      VectorXd q = VectorXd::Zero(12), v = VectorXd::Zero(12);
      q[9] = 2 * uniform(random), v[9] = 6 * uniform(random), q[0] = uniform(random), v[0] = uniform(random);
      VectorXd g(static_cast<Index>(measure.stencil().size()));
      const MotorRooms rooms = motor_rooms(f, measure, -1, t, q.data(), v.data(), g.data());
      const auto full = [&](double share) {
        return m.stall * (share - m.gear_ratio * v[9] / m.no_load_speed);
      };
      const double torque = effort_of(m, q[9], v[9], q[0]) / m.gear_ratio;
      // But for the gear's rounding.
      const auto is = [&](double cut) { return std::abs(torque - cut) < 1e-14; };
      std::size_t part = 0;
      if (is(m.limit))
        part = 3;
      else if (is(-m.limit))
        part = 4;
      else if (is(full(1)))
        part = 1;
      else if (is(full(-1)))
        part = 2;
      ++held[part];
      for (std::size_t other = 0; other < rooms.size(); ++other) {
        INFO(other << " where " << part << " holds");
        CHECK((rooms[other] > 0) == (other == part));
      }
    }
  }
  for (const int times : held) CHECK(times > 20);
}

// The ghost that sums up the error, m (f' - s') on it, is part of the motor's derivatives, not of its power:
// it has no energy.
// A rotor, a drum and a controller's integral are numbers of their own: no name of the scene, and no "*".
TEST_CASE("names of nodes never mean what a motor or a winch has besides") {
  const std::string linkage =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
      "{name = 'G', position = [0, -1, 0], fixed = true}, {name = 'B', position = [0, 1, 0], mass = 1},\n"
      "{name = 'C', position = [0, 1.5, 0.5], mass = 1}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}]\n";
  const std::vector<std::string> drives = {
      "[[forces]]\nkind = 'motor'\nnodes = ['G', 'A', 'B']\naxis = [1, 0, 0]\nstall_torque = 1\n"
      "no_load_speed = 1000\ninertia = 0.1\n",
      "[[forces]]\nkind = 'motor'\nnodes = ['G', 'A', 'B']\naxis = [1, 0, 0]\nstall_torque = 1\n"
      "no_load_speed = 1000\ncontrol = 'position'\nmotion = 'rate'\nrate = 20\nproportional = 5\nintegral = "
      "10\n"};
  for (const std::string& drive : drives)
    for (const char* held : {"kind = 'plane'\nnormal = [1, 0, 0]", "kind = 'equal'\ndirection = [1, 0, 0]"}) {
      INFO(drive << held);
      std::vector<VectorXd> ends;
      for (const char* names : {"'*'", "'?'", "'A', 'G', 'B', 'C'"}) {
        const Scene scene = read_scene_text(linkage + drive + "[[constraints]]\n" + held + "\nnodes = [" +
                                                names + "]\n[solver]\nend_time = 0.5\nstep = 0.05\n",
                                            "names.toml");
        const Simulation run = simulate(build_model(scene), scene.solver);
        ends.push_back(run.trajectory.node_positions(run.trajectory.size() - 1));
        CHECK(std::abs(ends.back()[8]) > 1e-4);  // B goes up: driven
        CHECK(ends.back() == ends.front());
      }
    }
  CHECK_THROWS_WITH(build_model(read_scene_text(linkage + drives[0] +
                                                    "[[constraints]]\nkind = 'plane'\nnormal = [1, 0, 0]\n"
                                                    "nodes = ['rotor of motor 1']\n",
                                                "rotor.toml")),
                    Catch::Contains("there is no node"));
}

TEST_CASE("a motor and the ghost of its controller: power and derivatives agree with the force") {
  Structure structure = testing::table_structure();
  structure.forces = {motor_with(Motor::Control::position)};
  structure.forces[0].motor.limit = 1e3, structure.forces[0].motor.stall = 1e3;
  structure.forces[0].measure = {MeasureKind::length, {1, 3}, Vec3::Zero(), 0.0, {}};  // bends
  structure.nodes[0].mass = 3e-6;
  const auto block = motor_block(structure, node_mass_matrix(structure));
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VectorXd q(12), v(12);
  for (VectorXd* x : {&q, &v})
    for (double& one : *x) one = uniform(random);
  const auto force = [&](const VectorXd& at, const VectorXd& rate) {
    VectorXd f = VectorXd::Zero(12);
    block->add(t, at.data(), rate.data(), 1.0, f.data());
    return f;
  };
  const Vec3 d = q.segment<3>(9) - q.segment<3>(3), w = v.segment<3>(9) - v.segment<3>(3);
  const Vec3 along = d.normalized();
  const double rate = along.dot(w), command_rate = -0.2, mass = 3e-6;
  const double effort = effort_of(structure.forces[0].motor, d.norm(), rate, q[0]);
  VectorXd wanted = VectorXd::Zero(12);
  wanted.segment<3>(3) = -effort * along, wanted.segment<3>(9) = effort * along;
  wanted[0] = mass * (command_rate - rate);
  CHECK((force(q, v) - wanted).cwiseAbs().maxCoeff() <= 1e-14);
  CHECK(block->power(t, q.data(), v.data()) == Approx(wanted.tail<9>().dot(v.tail<9>())).epsilon(1e-13));
  ForceDerivative by_q, by_v;
  block->derivatives(t, q.data(), v.data(), by_q, by_v);
  SparseRows K(12, 12), D(12, 12);
  K.setFromTriplets(by_q.begin(), by_q.end());
  D.setFromTriplets(by_v.begin(), by_v.end());
  const double h = 1e-5;
  for (Index i = 0; i < 12; ++i) {
    const VectorXd unit = h * VectorXd::Unit(12, i);
    const VectorXd k = (force(q + unit, v) - force(q - unit, v)) / (2 * h),
                   c = (force(q, v + unit) - force(q, v - unit)) / (2 * h);
    for (Index r = 0; r < 12;
         ++r) {  // h^2 times third derivatives of order 10, 1e-16 / h; the ghost's by its mass
      const double near = r == 0 ? mass * 1e-7 : 1e-8;
      CHECK(MatrixXd(K)(r, i) == Approx(k[r]).epsilon(0).margin(near));
      CHECK(MatrixXd(D)(r, i) == Approx(c[r]).epsilon(0).margin(near));
    }
  }
}

}  // namespace motor_law_test
