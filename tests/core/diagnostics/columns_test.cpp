// SPDX-License-Identifier: BSD-3-Clause
// Every column of a series, worked out anew from what a run says of its nodes.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/library.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace columns_test {

namespace {

Vec3 at(const VectorXd& x, int node) {
  return x.segment<3>(3 * node);
}

// Two rods that swing from a fixed node with all kinds of forces on them; one of them is much stronger.
const std::string swing = R"(
[structure]
kind = "custom"
section = "round"
nodes = [{name = "O", position = [0.1, 0.2, 0], fixed = true},
         {name = "A", position = [1.1, 0.4, 0.3], mass = 0.4},
         {name = "B", position = [1.6, 1.3, -0.2], velocity = [0.3, 0.2, -0.1], mass = 0.6}]
rods = [{nodes = ["O", "A"], mass = 1.2, area = 3e-5, youngs_modulus = 7e10, strength = 4e6},
        {nodes = ["A", "B"], mass = 0.9, area = 1e-5, youngs_modulus = 2e11, strength = 9e6}]
[[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 35
free_length = 1.3
[[forces]]
kind = "drag"
nodes = ["B"]
damping = 0.35
[[loads]]
nodes = ["A"]
force = [1.5, -0.5, 0.25]
[gravity]
acceleration = [0.4, 1.5, -9]
[solver]
stages = 4
step = 0.01
end_time = 1.2
)";

}  // namespace

TEST_CASE("every column of a swinging linkage is that of its nodes") {
  for (const char* method : {"dvm", "rk4"}) {
    const Simulation run = testing::run_scene(swing, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const Trajectory& trajectory = run.trajectory;
    REQUIRE(d.t.size() == trajectory.size());
    const struct {
      int a, b;
      double mass, area, modulus, strength;
    } rods[] = {{0, 1, 1.2, 3e-5, 7e10, 4e6}, {1, 2, 0.9, 1e-5, 2e11, 9e6}};
    const VectorXd start = trajectory.node_positions(0);
    const Vec3 gravity(0.4, 1.5, -9), load(1.5, -0.5, 0.25);
    double first = 0, drag = 0, speed_before = 0;
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      const VectorXd q = trajectory.node_positions(i), v = trajectory.node_velocities(i);
      const auto value = [&](const char* column) { return d.at(column).values[i]; };
      CAPTURE(method, i);
      double kinetic = 0.2 * at(v, 1).squaredNorm() + 0.3 * at(v, 2).squaredNorm();
      double potential = -gravity.dot(0.4 * at(q, 1) + 0.6 * at(q, 2)), off = 0, share = 0, drift = 0;
      double most = -1e300, least = 1e300, stress = -1e300, squeeze = 1e300, strength = 0, buckling = 0;
      for (int r = 0; r < 2; ++r) {
        const auto& rod = rods[r];
        kinetic += rod.mass / 6 *
                   (at(v, rod.a).squaredNorm() + at(v, rod.b).squaredNorm() + at(v, rod.a).dot(at(v, rod.b)));
        potential -= gravity.dot(at(q, rod.a) + at(q, rod.b)) * rod.mass / 2;
        const Vec3 along = at(q, rod.b) - at(q, rod.a);
        const double length = (at(start, rod.b) - at(start, rod.a)).norm();
        // A row of a rod is (|d|^2 - l^2) / 2 l, its stretch as far as that is small.
        off = std::max(off, std::abs(along.squaredNorm() - length * length) / (2 * length));
        share = std::max(share, std::abs(along.squaredNorm() - length * length) / (2 * length * length));
        drift = std::max(drift, std::abs(along.dot(at(v, rod.b) - at(v, rod.a))) / length);
        const double force = d.axial_force(static_cast<Index>(i), r);
        const double euler = std::acos(-1.0) * rod.modulus * rod.area * rod.area / (4 * length * length);
        most = std::max(most, force), least = std::min(least, force);
        stress = std::max(stress, force / rod.area), squeeze = std::min(squeeze, force / rod.area);
        strength = std::max(strength, std::abs(force) / rod.area / rod.strength);
        buckling = std::max(buckling, -force / euler);
      }
      const double stretch = (at(q, 2) - at(q, 0)).norm() - 1.3;
      potential += 0.5 * 35 * stretch * stretch;
      const double work = load.dot(at(q, 1) - at(start, 1)), speed = at(v, 2).squaredNorm();
      if (i > 0) drag += 0.35 * 0.5 * (speed + speed_before) * (d.t[i] - d.t[i - 1]);
      speed_before = speed;
      CHECK(value("kinetic_energy_J") == Approx(kinetic).epsilon(1e-12));
      CHECK(value("potential_energy_J") == Approx(potential).epsilon(1e-12).margin(1e-12));
      CHECK(value("work_J") == Approx(work).epsilon(1e-12).margin(1e-13));
      // Trapezia of 10 ms: 1e-6 / 12 of twice the squared acceleration, some 300, in each of 120 steps.
      CHECK(value("dissipated_J") == Approx(drag).epsilon(0).margin(5e-3));
      if (i == 0) first = kinetic + potential;
      CHECK(value("energy_balance_J") ==
            Approx(kinetic + potential - first - work + value("dissipated_J")).epsilon(0).margin(1e-11));
      CHECK(std::abs(value("energy_balance_J")) < 5e-5);  // RK4 has (w h)^5 of it in each step
      CHECK(value("constraint_max_m") == Approx(off).epsilon(1e-6).margin(1e-15));
      CHECK(value("constraint_relative_max") == Approx(share).epsilon(1e-6).margin(1e-15));
      CHECK(value("constraint_round_off_max") ==
            Approx(share / 2.220446049250313e-16).epsilon(1e-6).margin(8));
      CHECK(value("constraint_velocity_max_m_s") == Approx(drift).epsilon(1e-6).margin(1e-14));
      CHECK(value("axial_force_max_N") == most);
      CHECK(value("axial_force_min_N") == least);
      CHECK(value("axial_stress_max_Pa") == Approx(stress).epsilon(1e-14));
      CHECK(value("axial_stress_min_Pa") == Approx(squeeze).epsilon(1e-14));
      CHECK(value("stress_ratio_max") == Approx(strength).epsilon(1e-14));
      CHECK(value("buckling_ratio_max") == Approx(buckling).epsilon(1e-12));
      CHECK(value("step_s") == (i == 0 ? 0.0 : d.t[i] - d.t[i - 1]));
      CHECK(value("newton_iterations") == trajectory.report(i).newton_iterations);
    }
    CHECK(drag > 0.1);
    for (const char* none : {"fold_angle_rad", "deployed_fraction", "drive_work_J", "impact_loss_J"})
      CHECK(d.find(none) == nullptr);
    CHECK_THROWS_AS(d.at("drive_work_J"), std::out_of_range);
  }
}

TEST_CASE("a ring's fold angle, its rate and its share are one and the same motion") {
  const Scene scene = read_scene_file(find_scene("hoop6"), {"solver.step=0.02", "solver.stages=5"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::deployed);
  const Diagnostics d = diagnose(run);
  const double start = d.at("fold_angle_rad").values[0], degree = std::acos(-1.0) / 180;
  CHECK(start == Approx(89.34053637766085 * degree).epsilon(1e-12));
  for (std::size_t i = 0; i + 1 < d.t.size(); ++i) {
    const auto value = [&](const char* column) { return d.at(column).values[i]; };
    const double angle = value("fold_angle_rad");
    CHECK(value("fold_angle_deg") == Approx(angle / degree).epsilon(1e-14));
    CHECK(value("fold_rate_deg_s") == Approx(value("fold_rate_rad_s") / degree).epsilon(1e-14));
    CHECK(value("deployed_fraction") ==
          Approx((std::cos(angle) - std::cos(start)) / (1 - std::cos(start))).epsilon(0).margin(1e-12));
    if (i == 0 || d.t[i + 1] > 4.5) continue;
    // Between its neighbours to the second order: (fold angle)''' h^2 / 6, some 5 of it here.
    const auto& angles = d.at("fold_angle_rad").values;
    CHECK(value("fold_rate_rad_s") ==
          Approx((angles[i + 1] - angles[i - 1]) / (d.t[i + 1] - d.t[i - 1])).epsilon(0).margin(2e-3));
  }
  CHECK(d.at("deployed_fraction").values.back() == Approx(1).epsilon(1e-9));
}

// Two wheels that have nothing to do with each other, each turned by its motor more than once round.
TEST_CASE("motors turn what is theirs alone or beside each other") {
  const auto wheel = [](const std::string& name, double at, double radius, double torque, double speed) {
    const auto text = [](double x) { return std::to_string(x); };
    return std::pair{
        "{name = 'O" + name + "', position = [" + text(at) + ", 0, 0], fixed = true}, {name = 'E" + name +
            "', position = [" + text(at + 1) + ", 0, 0], fixed = true}, {name = 'T" + name +
            "', position = [" + text(at) + ", " + text(radius) + ", 0], mass = 0.7}",
        "[[structure.rods]]\nnodes = ['O" + name + "', 'T" + name +
            "']\nmass = 0\n[[constraints]]\nkind = 'plane'\nnodes = ['T" + name +
            "']\nnormal = [0, 0, 1]\n[[forces]]\nkind = 'motor'\nname = '" + name + "'\nnodes = ['E" + name +
            "', 'O" + name + "', 'T" + name + "']\naxis = [0, 0, " + text(speed) + "]\nstall_torque = " +
            text(torque) + "\nno_load_speed = " + text(std::abs(speed)) + "\ninertia = 0\n"};
  };
  const auto solved = [](const std::string& nodes, const std::string& rest) {
    const Simulation run = testing::run_scene("[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\n" +
                                              rest + "[solver]\nstages = 4\nstep = 0.02\nend_time = 2\n");
    return diagnose(run);
  };
  const auto [nodes_a, a] = wheel("a", 0, 0.3, 0.9, 800);
  const auto [nodes_b, b] = wheel("b", 5, 0.4, 0.5, -700);
  const auto [nodes_c, c] = wheel("c", -7, 0.2, 0.2, 900);
  const Diagnostics all = solved(nodes_a + ", " + nodes_b + ", " + nodes_c, a + b + c);
  for (const auto& [name, alone] : {std::pair{std::string("a"), solved(nodes_a, a)},
                                    {"b", solved(nodes_b, b)},
                                    {"c", solved(nodes_c, c)}}) {
    CHECK(std::abs(alone.at(name + ".angle_rad").values.back() -
                   alone.at(name + ".angle_rad").values.front()) > 7);
    for (const char* column : {".angle_rad", ".torque_N_m", ".power_W", ".energy_J"})
      for (std::size_t i = 0; i < all.t.size(); ++i)
        CHECK(all.at(name + column).values[i] ==
              Approx(alone.at(name + column).values[i]).epsilon(1e-9).margin(1e-9));
  }
}

}  // namespace columns_test
