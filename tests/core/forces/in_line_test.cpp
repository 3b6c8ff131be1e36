// SPDX-License-Identifier: BSD-3-Clause
// Hinges without an axis whose rods pass each other in line: what acts there is what acts beside it.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/reactions.hpp"
#include "core/diagnostics/vibration.hpp"
#include "core/forces/friction.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace in_line_test {

using testing::number;

namespace {

std::string triple(const Vec3& x) {
  return "[" + number(x.x()) + ", " + number(x.y()) + ", " + number(x.z()) + "]";
}

// Two rods from a pin at O, straight (or folded onto each other) along u at t = 0, the outer one turning with
// the rate w against the inner one, about n across both; A is held on its circle by a plane, so is B.
std::string crank(const Vec3& u, const Vec3& n, double side, double w, const std::string& force) {
  const Vec3 across = n.cross(u);
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = "
         "'A', position = " +
         triple(u) + ", mass = 0.4}, {name = 'B', position = " + triple((1 + 0.5 * side) * u) +
         ", velocity = " + triple(0.5 * side * w * across) +
         ", mass = 0.3}]\nrods = [{nodes = ['O', 'A'], mass = 0.2}, {nodes = ['A', 'B'], mass = 0.1}]\n" +
         force + "\n[solver]\nstages = 4\nstep = 0.001\nend_time = 0.003\n";
}

}  // namespace

// c = 0.7 N m s/rad at 1.5 rad/s: the reaction across the rods has c w / 1 m in it. With the axis that the
// rods turn about a hinge is never without one: the same, but for the rounding of some newtons.
TEST_CASE("a damper of a hinge without an axis acts in line as one with its axis does") {
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 12; ++trial)
    for (const char* kind : {"torsion_spring", "joint_damping"}) {
      const bool plain = trial % 3 == 0;  // exactly in line, or by rounding
      const Vec3 u = plain ? Vec3::UnitX() : Vec3(any(dice), any(dice), any(dice)).normalized(),
                 n = plain ? Vec3::UnitZ() : u.cross(Vec3(any(dice), any(dice), any(dice))).normalized();
      const double side = trial % 2 == 0 ? 1 : -1;
      const std::string nodes = kind[0] == 't' ? "['O', 'A', 'B']" : "['A']";
      const auto run = [&](const std::string& how, const std::string& axis) {
        return testing::run_scene(crank(u, n, side, 1.5,
                                        "[[forces]]\nkind = '" + how +
                                            "'\nnodes = " + (how[0] == 't' ? "['O', 'A', 'B']" : nodes) +
                                            "\ndamping = 0.7\n" + axis));
      };
      const Simulation without = run(kind, ""), with = run("torsion_spring", "axis = " + triple(n) + "\n");
      CAPTURE(trial, kind);
      const Diagnostics a = diagnose(without), b = diagnose(with);
      for (std::size_t i = 0; i < a.t.size(); ++i) {
        Vec3 off, all;
        for (int k = 0; k < 3; ++k) {
          const std::string column = std::string("O.reaction_") + "xyz"[k] + "_N";
          off[k] = a.at(column).values[i] - b.at(column).values[i], all[k] = b.at(column).values[i];
        }
        CHECK(all.norm() > 0.5);
        CHECK(off.norm() < 1e-9 * all.norm());
      }
      CHECK(a.at("dissipated_J").values.back() == Approx(b.at("dissipated_J").values.back()).epsilon(1e-9));
    }
}

// A motor that takes the hinge through the straight pose: N along the angle, which it tells from 0 to 180
// degrees. At the state in line it is that of the state before.
TEST_CASE("a motor of a hinge without an axis gives in line what it gives just before") {
  for (const double side : {1.0, -1.0}) {
    const MeasureFunction angle({MeasureKind::angle, {1, 0, 1, 2}, Vec3::Zero(), 0, {}}, Deployment{});
    const Vec3 u = Vec3(0.48, 0.6, 0.64), n = u.cross(Vec3::UnitX()).normalized(), across = n.cross(u);
    VectorXd in_line(9), v(9), g(12), before(12);
    in_line << Vec3::Zero(), u, (1 + 0.5 * side) * u;
    v << Vec3::Zero(), 0.3 * across, 0.9 * across;
    const Moment at(1.0);
    CHECK(angle.value_and_gradient(in_line.data(), v.data(), g.data(), at, -1) ==
          Approx(side > 0 ? pi : 0).epsilon(0).margin(1e-15));
    CHECK(g.norm() > 1);
    const VectorXd q = in_line - 1e-7 * v;
    angle.value_and_gradient(q.data(), before.data(), at, -1);
    CHECK((g - before).norm() < 1e-6 * g.norm());
    // Where the motion begins nothing was before: as it is going to be.
    VectorXd behind(before.size());
    angle.value_and_gradient(in_line.data(), v.data(), g.data(), Moment(0.0), -1);
    const VectorXd soon = in_line + 1e-7 * v;
    angle.value_and_gradient(soon.data(), behind.data(), at, -1);
    CHECK((g - behind).norm() < 1e-6 * g.norm());
    // What turns as one, or rests, has no axis.
    v << Vec3::Zero(), across, (1 + 0.5 * side) * across;
    angle.value_and_gradient(in_line.data(), v.data(), g.data(), at, -1);
    CHECK(g.norm() < 1e-15);
    v.setZero();
    angle.value_and_gradient(in_line.data(), v.data(), g.data(), at, -1);
    CHECK(g.norm() < 1e-15);
  }
}

// A strut that is folded flat, with a nudge, and a spring that opens it: th = pi - pi cos t + 0.1 sin t, from
// pi N m at the start. Methods that ask for the forces of the start itself keep their order.
TEST_CASE("a spring opens a strut from its folded pose by the side that it sets out to") {
  const auto opened = [](const std::string& solver) {
    return testing::run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], fixed = true},
         {name = "C", position = [0, 0, 0], velocity = [0, 0.1, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0}, {nodes = ["B", "C"], mass = 0}]
constraints = [{kind = "plane", nodes = ["C"], normal = [0, 0, 1]}]
[[forces]]
kind = "torsion_spring"
nodes = ["A", "B", "C"]
stiffness = 1
free_angle = 180
[solver]
end_time = 1
)" + solver);
  };
  const double rate = pi * std::sin(1.0) + 0.1 * std::cos(1.0), wanted = 0.5 * rate * rate;
  const auto off = [&](const std::string& step) {
    const Simulation run = opened("method = 'rk4'\nstep = " + step + "\n");
    return std::abs(diagnose(run).at("kinetic_energy_J").values.back() - wanted);
  };
  // Fourth order: a sixteenth with half of the step; a first stage without its torque left a half.
  const double coarse = off("0.05"), fine = off("0.025");
  CHECK(coarse < 1e-4);
  CHECK(fine < coarse / 12);
  const Diagnostics d = diagnose(opened("step = 0.05\n"));
  CHECK(d.at("A.reaction_y_N").values.front() == Approx(pi).epsilon(1e-9));
}

// What slips against c = 0.7 N m or N in stages of a step on both sides of the pose in which rods come into
// line, or nodes meet: it takes c times the rate at which they turn or pass, and turns with the same about
// one axis.
TEST_CASE("friction goes on against the motion through the pose in line and beside it") {
  std::mt19937 dice(4);
  std::uniform_real_distribution<double> any(-1, 1);
  Structure s;
  s.nodes = {{"o", Vec3::Zero()}, {"a", Vec3(1.3, 0, 0)}, {"b", Vec3(0.7, 0.4, 0)}};
  Force rubs;
  rubs.kind = "friction";
  rubs.kinetic = 0.7;
  for (int trial = 0; trial < 12; ++trial)
    for (const bool flat : {true, false})
      for (const double beyond : {-5e-3, -1e-4, -1e-8, 0.0, 1e-8, 1e-4, 5e-3}) {
        CAPTURE(trial, flat, beyond);
        const Vec3 u = Vec3(any(dice), any(dice), any(dice)).normalized(),
                   n = u.cross(Vec3(any(dice), any(dice), any(dice))).normalized(), across = n.cross(u);
        const Vec3 o(any(dice), any(dice), any(dice)), drift(any(dice), any(dice), any(dice));
        // The inner rod turns, or only one of both does.
        const double w = 1.9,
                     inner = trial % 3 == 0   ? 0.4
                             : trial % 3 == 1 ? 0.0
                                              : -w,
                     turn = flat ? beyond : pi + beyond;  // from the way back to where it came from
        const Vec3 out = -std::cos(turn) * u - std::sin(turn) * across,
                   moves = std::sin(turn) * u - std::cos(turn) * across;
        VectorXd q(9), v(9), f = VectorXd::Zero(9);
        q << o, o + 1.3 * u, o + 1.3 * u + 0.6 * out;
        v << drift, drift + inner * 1.3 * across, drift + inner * 1.3 * across + 0.6 * (inner + w) * moves;
        rubs.measure = {MeasureKind::angle, {1, 0, 1, 2}, Vec3::Zero(), 0, {}};
        rubs.slip = flat ? -1 : 1;  // the angle has fallen to 0 or grown to 180 degrees
        s.forces = {rubs};
        friction_block(s, {})->add(1.0, q.data(), v.data(), 1.0, f.data());
        // 1e-12 of directions that two nodes next to a line tell.
        CHECK((f.tail<3>() + 0.7 / 0.6 * moves).norm() < 1e-9);
        CHECK((f.head<3>() + 0.7 / 1.3 * across).norm() < 1e-9);
        CHECK(f.dot(v) == Approx(-0.7 * w).epsilon(1e-9));
        CHECK(friction_block(s, {})->power(1.0, q.data(), v.data()) == Approx(-0.7 * w).epsilon(1e-9));
      }
  rubs.measure = {MeasureKind::length, {1, 2}, Vec3::Zero(), 0, {}};
  rubs.slip = -1;  // they came nearer
  s.forces = {rubs};
  for (const double beyond : {-1e-3, -1e-8, 1e-8}) {
    const Vec3 u(0.48, 0.6, 0.64), o(0.2, -0.3, 0.9), drift(0.3, 0.5, -0.2);
    VectorXd q(9), v(9), f = VectorXd::Zero(9);
    q << Vec3::Zero(), o, o + beyond * u;
    v << Vec3::Zero(), drift, drift + 1.9 * u;
    friction_block(s, {})->add(1.0, q.data(), v.data(), 1.0, f.data());
    CHECK((f.tail<3>() + 0.7 * u).norm() < 1e-7);  // of 1e-16 m in 1e-8 m
    CHECK((f.segment<3>(3) - 0.7 * u).norm() < 1e-7);
    CHECK(friction_block(s, {})->power(1.0, q.data(), v.data()) == Approx(-0.7 * 1.9).epsilon(1e-7));
  }
}

// Light rods of l_1 = 1 and l_2 = 0.5 m, straight or folded (s = -1), and k at their hinge, at rest there:
// the angle is off by |y_B s / l_2 - y_A (1 / l_1 + s / l_2)| in either direction across, so that
//     w^2 = k ((1 / l_1 + s / l_2)^2 / m_A + 1 / (l_2^2 m_B))
// and the two turn as one about O without a force. To rounding but for that of the line, of 1e-16 m.
TEST_CASE("a spring at rest in line of a hinge without an axis has its stiffness in both directions") {
  const Vec3 u = Vec3(0.48, 0.6, 0.64), n = u.cross(Vec3::UnitX()).normalized();
  for (const double side : {1.0, -1.0})
    for (const std::string spring : {"kind = 'torsion_spring'\nnodes = ['O', 'A', 'B']\nstiffness = 3",
                                     "kind = 'combination'\nterms = ['2 angle O A B']\nstiffness = 0.75"}) {
      const auto model = testing::model_of(crank(u, n, side, 0, "[[forces]]\n" + spring),
                                           {"structure.rods[0].mass=0", "structure.rods[1].mass=0"});
      const Vibration found = vibration(*model, initial_state(model->structure, model->system).state);
      const double bend = 1 + side / 0.5, squared = 3 * (bend * bend / 0.4 + 4 / 0.3);
      CAPTURE(side, spring);
      REQUIRE(found.modes.size() == 4);
      for (const int k : {0, 1}) CHECK(found.modes[static_cast<std::size_t>(k)].frequency < 1e-6);
      for (const int k : {2, 3})
        CHECK(found.modes[static_cast<std::size_t>(k)].frequency ==
              Approx(std::sqrt(squared) / (2 * pi)).epsilon(1e-10));
    }
}

}  // namespace in_line_test
