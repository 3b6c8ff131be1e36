// SPDX-License-Identifier: BSD-3-Clause
// Forces of pins with couples at their hinges, among rods that give, against the balance of a rod without
// mass.
#include "core/forces/pin_loads.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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

}  // namespace pin_loads_test
