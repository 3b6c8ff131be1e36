// SPDX-License-Identifier: BSD-3-Clause
// Forces of pins with couples at their hinges, among rods that give, against the balance of a rod without
// mass.
#include "core/forces/pin_loads.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/forces/friction.hpp"
#include "core/integrators/index1.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/system/mass_matrix.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pin_loads_test {

namespace {

using testing::model_of;

// Two pendulums: P-A rigid, with a spring, a motor and other friction in its hinge; Q-C gives. Rods of
// others, one that gives, come first.
const std::string pendulums = R"(
[structure]
kind = "custom"
nodes = [
  {name = "X", position = [5, 0, 0], fixed = true}, {name = "Y", position = [5.4, 0, -0.3], mass = 0.4},
  {name = "Z", position = [5.9, 0, -0.9], mass = 0.3},
  {name = "P", position = [0, 0, 0], fixed = true}, {name = "B", position = [0, 0, -1], fixed = true},
  {name = "A", position = [0.48, 0, -0.64], mass = 1.3},
  {name = "Q", position = [2, 0, 0], fixed = true}, {name = "D", position = [2, 0, -1], fixed = true},
  {name = "C", position = [1.5, 0, -1.2], mass = 0.9}]
rods = [
  {nodes = ["X", "Y"], mass = 0.2, area = 1e-4, elastic = true, youngs_modulus = 1e8},
  {nodes = ["Y", "Z"], mass = 0.1},
  {nodes = ["Q", "C"], mass = 0, area = 1e-4, elastic = true, youngs_modulus = 2e8, free_length = 1.2987},
  {nodes = ["P", "A"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["A", "C", "Y", "Z"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "torsion_spring"  # the same angle, told from its other side
nodes = ["B", "P", "A"]
axis = [0, -1, 0]
stiffness = 3.7
free_angle = 20
[[forces]]
kind = "motor"
name = "motor"
nodes = ["A", "P", "B"]
axis = [0, 1, 0]
stall_torque = 0.4
no_load_speed = 900
gear_ratio = 3
voltage = 0.6
[[forces]]
kind = "friction"
name = "rigid"
nodes = ["A", "P", "B"]
axis = [0, 1, 0]
kinetic = 0.21
pin_friction = 0.3
pin_radius = 0.08
[[forces]]
kind = "friction"
name = "giving"
nodes = ["C", "Q", "D"]
axis = [0, 1, 0]
kinetic = 0.13
pin_friction = 0.2
pin_radius = 0.05
)";

// |F| = sqrt(N^2 + (T / l)^2), T = T_0 - slip (kinetic + arm |F|): the positive root of
// (1 - (arm / l)^2) F^2 + 2 (slip T_0 - kinetic) (arm / l^2) F - N^2 - (T_0 - slip kinetic)^2 / l^2 = 0.
double force_of(double N, double T0, double kinetic, double arm, int slip, double l) {
  const double a = 1 - arm * arm / (l * l), b = (slip * T0 - kinetic) * arm / (l * l),
               c = -N * N - (T0 - slip * kinetic) * (T0 - slip * kinetic) / (l * l);
  return (-b + std::sqrt(b * b - a * c)) / a;
}

}  // namespace

TEST_CASE("a pin pulls its rod with the rod's force along and with all couples at the hinge across") {
  const auto model = model_of(pendulums);
  Structure structure = model->structure;
  const Vec3 d = structure.nodes[5].position, along = d.normalized(), across(-along[2], 0, along[0]);
  const double l = 0.8, g = 9.81, speed = 0.7;  // m/s of A, across
  VectorXd q(27), v = VectorXd::Zero(27);
  for (Index i = 0; i < 9; ++i) q.segment<3>(3 * i) = structure.nodes[static_cast<std::size_t>(i)].position;
  v.segment<3>(15) = speed * across;
  for (const int slip : {1, -1}) {
    for (Force& f : structure.forces)
      if (f.kind == "friction") f.slip = slip;
    const PinLoads::Loads loads =
        PinLoads(structure, node_mass_matrix(structure)).evaluate(0.0, q.data(), v.data());
    // Of the measure's value and rate, whichever way it counts.
    const MeasureFunction angle(structure.forces[2].measure, structure.deployment);
    VectorXd gradient(static_cast<Index>(angle.stencil().size()));
    const double s = angle.value_and_gradient(q.data(), gradient.data()),
                 rate = angle.rate(gradient.data(), v.data());
    CHECK(std::abs(rate) == Approx(speed / l).epsilon(1e-14));
    const double T0 = -3.7 * (s - 20 * pi / 180) + 3 * 0.4 * (0.6 - 3 * rate / (900 * pi / 180));
    const double N = 1.3 * (speed * speed / l - g * along[2]);
    CHECK(loads.size[2] == Approx(force_of(N, T0, 0.21, 0.024, slip, l)).epsilon(1e-12));
    const double pull = 2e4 * (1.3 - 1.2987) / 1.2987;
    const double F = force_of(pull, 0, 0.13, 0.01, slip, 1.3);
    CHECK(loads.size[3] == Approx(F).epsilon(1e-11));  // of 1e-16 m in 1.3e-3 m of strain
    CHECK(loads.by_tension[3] == Approx(pull / F).epsilon(1e-11));
    CHECK(loads.by_tension[2] == 0.0);
    CHECK((loads.size[0] == 0.0 && loads.size[1] == 0.0));
  }
}

// Newton's matrix of a pin's friction on a rod that gives, by differences: what it leaves out is mu r = 0.01
// m over the rod's 1.3 m, twice as both nodes turn it; of 1e4 N/m, beside which differences are exact.
TEST_CASE("the derivatives of a giving rod's pin friction are of its stretch") {
  const auto model = model_of(pendulums, {"structure.damping_time=0.004"});
  Structure structure = model->structure;
  std::erase_if(structure.forces, [](const Force& f) { return f.name != "giving"; });
  const SparseRows mass = node_mass_matrix(structure);
  VectorXd q(27), v = VectorXd::Zero(27);
  for (Index i = 0; i < 9; ++i) q.segment<3>(3 * i) = structure.nodes[static_cast<std::size_t>(i)].position;
  v.segment<3>(24) << 0.3, 0, 0.4;
  for (const int slip : {1, -1}) {
    structure.forces[0].slip = slip;
    const auto block = friction_block(structure, mass);
    const auto force = [&](const Moment& at, const VectorXd& x, const VectorXd& w) {
      VectorXd f = VectorXd::Zero(27);
      block->add(at, x.data(), w.data(), 1.0, f.data());
      return f;
    };
    ForceDerivative by_q, by_v, by_n;
    block->derivatives(0.0, q.data(), v.data(), by_q, by_v);
    MatrixXd K = MatrixXd::Zero(27, 27), D = K, found_K = K, found_D = K;
    for (const auto& e : by_q) K(e.row(), e.col()) += e.value();
    for (const auto& e : by_v) D(e.row(), e.col()) += e.value();
    for (Index i = 0; i < 27; ++i) {
      const VectorXd unit = 1e-7 * VectorXd::Unit(27, i);
      found_K.col(i) = (force(0.0, q + unit, v) - force(0.0, q - unit, v)) / 2e-7;
      found_D.col(i) = (force(0.0, q, v + unit) - force(0.0, q, v - unit)) / 2e-7;
    }
    CHECK(found_K.norm() > 50);  // k mu r / l of 1.5e4 N/m
    CHECK(found_D.norm() > 0.2);
    CHECK((K - found_K).norm() <= 0.03 * found_K.norm());
    CHECK((D - found_D).norm() <= 0.03 * found_D.norm());
    // By the force itself, of both rods that give; the load of the pin is linear in it but for its direction.
    CHECK(block->by_tension());
    std::vector<double> pull = {13.0, 41.0};
    Moment at(0.0);
    at.tension = pull.data();
    block->tension_derivatives(at, q.data(), v.data(), by_n);
    for (int rod = 0; rod < 2; ++rod) {
      VectorXd told = VectorXd::Zero(27);
      for (const auto& e : by_n)
        if (e.col() == rod) told[e.row()] += e.value();
      const auto with = [&](double by) {
        pull[static_cast<std::size_t>(rod)] += by;
        const VectorXd f = force(at, q, v);
        pull[static_cast<std::size_t>(rod)] -= by;
        return f;
      };
      const VectorXd found = (with(1e-3) - with(-1e-3)) / 2e-3;
      CHECK((told - found).norm() <= 0.03 * 0.01);
      CHECK((found.norm() > 0.005) == (rod == 1));
      // At given forces no length says anything of them.
      by_q.clear(), by_v.clear();
      block->derivatives(at, q.data(), v.data(), by_q, by_v);
      for (const auto& e : by_q) CHECK(std::abs(e.value()) < 10);  // mu r N / l^2
      CHECK(by_v.empty());
    }
  }
}

namespace {

// Two rods in space, H-B and B-C, with couples at both ends of the first, to the ground and to a geared rod.
const std::string in_space = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [-1, 0.2, 0.3], fixed = true}, {name = "H", position = [0, 0, 0], fixed = true},
  {name = "B", position = [0.7, 0.4, -0.2], velocity = [3, -5, 4]},
  {name = "C", position = [1.1, -0.3, 0.5], velocity = [-2, 7, 1], mass = 0.3},
  {name = "E", position = [-1, 0.3, 5.1], fixed = true}, {name = "K", position = [0, 0, 5], fixed = true},
  {name = "D", position = [0.5, 0.3, 5.2], velocity = [1, 2, 3], mass = 2}]
rods = [{name = "a", nodes = ["A", "H"], mass = 1}, {name = "b", nodes = ["H", "B"], mass = 1.2},
        {name = "c", nodes = ["B", "C"], mass = 0.7}, {name = "d", nodes = ["K", "D"], mass = 0.4}]
[gravity]
acceleration = [1.5, -3, -5]
[[forces]]
kind = "friction"
name = "pin"
nodes = ["B", "H", "A"]
axis = [0.2, 1, 0.3]
kinetic = 0.05
pin_friction = 0.2
pin_radius = 0.5
[[forces]]
kind = "friction"
name = "outer"
nodes = ["C", "B", "H"]
axis = [0.1, 0.4, 1]
kinetic = 0.02
pin_friction = 0.1
pin_radius = 0.3
[[forces]]
kind = "torsion_spring"
nodes = ["H", "B", "C"]
stiffness = 3
damping = 0.4
free_angle = 20
[[forces]]
kind = "joint_damping"
nodes = ["H", "B"]
damping = 0.6
[[forces]]
kind = "combination"
terms = ["1 angle A H B", "-0.7 angle C B H about 0 0 1", "2 length A C", "0.3 angle B H A about 1 0 0"]
stiffness = 0.8
free_value = 3
[[forces]]
kind = "motor"
name = "mot"
nodes = ["H", "B", "C"]
axis = [0.3, 0.1, 1]
stall_torque = 0.7
no_load_speed = 900
inertia = 0.2
gear_ratio = 1.5
[[constraints]]
kind = "gear"
nodes = ["A", "H", "B", "E", "K", "D"]
radii = [1, 1.7]
axis = [0, 1, 0.2]
[[constraints]]
kind = "combination"
terms = ["1 angle A H B about 0 0 1", "0.6 angle H B C about 0 1 0", "-0.4 angle E K D about 1 0 0"]
motion = "rate"
rate = 9
)";

// What "2 length A C" puts on C, from outside; joint damping of two nodes comes before that.
Vec3 pull_on_end(const Structure& structure, const VectorXd& q) {
  const Force& spring = structure.forces[5];
  const double s = MeasureFunction(spring.measure, structure.deployment).value(q.data());
  return -2 * spring.stiffness * (s - spring.rest) *
         (node_vector(q.data(), 3) - node_vector(q.data(), 0)).normalized();
}

}  // namespace

// Couples are no force on both rods together: what the pin at H holds is what changes their momentum beside
// their weight and what pulls on C. The accelerations are the solver's own.
TEST_CASE("a pin in space holds by its force what changes the momentum of all that hangs on it") {
  const auto model = model_of(in_space);
  for (const int slip : {1, -1}) {
    Structure structure = model->structure;
    structure.forces[0].slip = slip, structure.forces[1].slip = -slip;
    const System system(structure, false);
    const InitialState start = initial_state(structure, system);
    const State& s = start.state;
    const System followed = system.at(s);
    VectorXd rate(system.solved_coordinates()), lambda(system.constraints()), q(system.coordinates()),
        v(q.size()), a(q.size());
    REQUIRE(Index1(followed).evaluate(0.0, s.z, s.w, rate, lambda));
    system.expand(s.z, q);
    system.expand_rate(s.w, v);
    system.expand_rate(rate, a);
    REQUIRE(v.segment<3>(6).norm() > 0.1);
    const SparseRows mass = node_mass_matrix(structure);
    const PinLoads::Loads loads =
        PinLoads(structure, mass).evaluate(followed.moment(0.0), q.data(), v.data());
    Vec3 F = Vec3::Zero(), F_outer = Vec3::Zero();
    for (std::size_t r : {1U, 2U}) {
      const Rod& rod = structure.rods[r];
      const Vec3 inertia = rod.mass / 2 * (node_vector(a.data(), rod.a) + node_vector(a.data(), rod.b)) -
                           rod.mass * structure.gravity;
      F += inertia;
      if (r == 2) F_outer += inertia;
    }
    const Vec3 end = 0.3 * (node_vector(a.data(), 3) - structure.gravity) - pull_on_end(structure, q);
    F += end, F_outer += end;
    // Round-off, of a saddle-point system.
    CHECK(loads.size[0] == Approx(F.norm()).epsilon(1e-9));
    CHECK(loads.size[1] == Approx(F_outer.norm()).epsilon(1e-9));
  }
}

}  // namespace pin_loads_test
