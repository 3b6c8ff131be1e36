// SPDX-License-Identifier: BSD-3-Clause
// Rod forces of rounding alone are told from small ones that are there.
#include "core/diagnostics/force_round_off.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <tuple>

#include "tests/support/scene_run.hpp"

namespace unfurl::force_round_off_test {

namespace {

// A tetrahedron with edges of about `size` that moves at (1, 0.3, 0.2) `speed`, all nodes alike: its rods
// bear nothing, whatever falls.
std::string drifting(double size, double speed, const std::string& rod, const std::string& rest) {
  std::ostringstream out;
  out.precision(17);
  out << "[structure]\nkind = 'custom'\nnodes = [";
  const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.3, 0.9, 0}, {0.3, 0.3, 0.8}};
  for (int k = 0; k < 4; ++k) {
    out << "{name = '" << static_cast<char>('A' + k) << "', position = [";
    for (int i = 0; i < 3; ++i) out << (i ? ", " : "") << size * corners[k][i];
    out << "], velocity = [" << speed << ", " << 0.3 * speed << ", " << 0.2 * speed << "]}, ";
  }
  out << "]\nrods = [";
  for (const char* pair : {"BC", "AB", "AC", "AD", "BD", "CD"})
    out << "{nodes = ['" << pair[0] << "', '" << pair[1] << "'], mass = 1" << rod << "}, ";
  out << "]\n" << rest;
  return out.str();
}

// Two masses on a rod of length l that turns about its middle at w: the rod, without mass, bears m w^2 l / 2.
std::string turning(double m, double l, double w, const std::string& rest) {
  std::ostringstream out;
  out.precision(17);
  out << "[structure]\nkind = 'custom'\nnodes = [{name = 'A', mass = " << m << ", position = [" << -l / 2
      << ", 0, 0], velocity = [0, " << -w * l / 2 << ", 0]}, {name = 'B', mass = " << m << ", position = ["
      << l / 2 << ", 0, 0], velocity = [0, " << w * l / 2
      << ", 0]}]\nrods = [{nodes = ['A', 'B'], mass = 0}]\n"
      << rest;
  return out.str();
}

double largest_force(const Diagnostics& d) {
  return d.axial_force.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("rods of what moves freely have forces of rounding alone", "[diagnostics]") {
  const std::string solver = "[solver]\nend_time = 2\n", fall = "[gravity]\nacceleration = [0, 0, -9.81]\n";
  const std::string steel = ", youngs_modulus = 2.1e11, area = 1e-4";
  for (const std::string& scene : {drifting(1, 1, "", solver), drifting(1, 1e4, "", solver),
                                   drifting(1e-4, 1e-3, "", solver), drifting(1, 0, "", solver),
                                   drifting(1, 1, "", fall + solver), drifting(1, 1, steel, fall + solver)}) {
    CAPTURE(scene);
    const Simulation run = testing::run_scene(scene);
    const Diagnostics d = diagnose(run);
    CAPTURE(largest_force(d), force_round_off(run));
    CHECK(only_round_off(run, d));
    CHECK(without_round_off(run, d, d.axial_force).cwiseAbs().maxCoeff() == 0.0);
  }
}

TEST_CASE("rods that follow their forces have rounding by their stiffness", "[diagnostics]") {
  const Simulation run =
      testing::run_scene(drifting(1, 1, ", youngs_modulus = 2.1e11, area = 1e-4",
                                  "rod_model = 'elastic'\n[solver]\nend_time = 0.01\nstep = 1e-5\n"));
  const Diagnostics d = diagnose(run);
  CAPTURE(largest_force(d), force_round_off(run));
  CHECK(only_round_off(run, d));
  // Two kilonewtons stretch such a rod by 1e-4: of 1e-6 of that nothing is taken for rounding.
  CHECK(force_round_off(run) < 2e-3);
}

// The forces are known in closed form; a run of few steps errs by far less than 1e-3 of them.
TEST_CASE("small forces are no rounding", "[diagnostics]") {
  struct Case {
    double m, l, w;
  };
  for (const Case& c :
       {Case{1.3, 0.7, 2e-6}, Case{1e-15, 3e-6, 40.0}, Case{2e-9, 1e-4, 0.3}, Case{1e5, 80, 1e-5}}) {
    std::ostringstream solver;
    solver << "[solver]\nstep = " << 0.01 / c.w << "\nend_time = " << 0.5 / c.w << "\n";
    const Simulation run = testing::run_scene(turning(c.m, c.l, c.w, solver.str()));
    const Diagnostics d = diagnose(run);
    CAPTURE(c.m, c.l, c.w, force_round_off(run));
    CHECK(largest_force(d) == Approx(c.m * c.w * c.w * c.l / 2).epsilon(1e-3));
    CHECK_FALSE(only_round_off(run, d));
    CHECK(without_round_off(run, d, d.axial_force) == d.axial_force);
  }
}

// In map coordinates, 5000 km from the origin, a node's place is known to 1 nm: an elastic tie of 2e9 N/m
// that rests under 100 N, alone or beside a rotor, which is at the origin, and one of 0.1 m that 1 N
// accelerates.
TEST_CASE("forces of structures in map coordinates are no rounding", "[diagnostics]") {
  const std::string tie = R"(
nodes = [{name = "A", position = [5e5, 5e6, 0], fixed = true}, {name = "B", position = [500001, 5e6, 0], mass = 10}]
rods = [{nodes = ["A", "B"], area = 0.01, density = 1000, free_length = 0.99999995}]
rod_model = "elastic"
youngs_modulus = 2e11
damping_ratio = 0.1
[[loads]]
nodes = ["B"]
force = [100, 0, 0]
[solver]
end_time = 0.1
step = 0.001
)",
                    rigid = R"(
nodes = [{name = "A", position = [5e5, 5e6, 0], fixed = true},
  {name = "B", position = [500000.125, 5e6, 0], mass = 100}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[loads]]
nodes = ["B"]
force = [1, 0, 0]
[solver]
end_time = 1e-4
step = 1e-6
)";
  const std::string rotor = R"([[forces]]
kind = "motor"
nodes = ["C", "A", "B"]
axis = [0, 0, 1]
stall_torque = 1e-6
no_load_speed = 100
inertia = 0.01
)";
  std::string beside = tie;
  beside.insert(beside.find("]\nrods"), ", {name = \"C\", position = [500000, 5000001, 0], fixed = true}");
  for (const auto& [scene, force] :
       {std::pair(tie, 100.0), std::pair(beside + rotor, 100.0), std::pair(rigid, 1.0)}) {
    const Simulation run = testing::run_scene("[structure]\nkind = 'custom'" + scene);
    const Diagnostics d = diagnose(run);
    CAPTURE(force, force_round_off(run));
    // What 1 nm of 2e9 N/m is, at most, and of 1 N its rounding.
    CHECK(without_round_off(run, d, d.axial_force).minCoeff() == Approx(force).epsilon(0.02));
  }
}

// Beside one that hangs from its end, with half of its weight, one that nothing pulls keeps a zero.
TEST_CASE("what is rounding is judged by the run and taken away one by one", "[diagnostics]") {
  const Simulation run = testing::run_scene(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = 'P', "
      "position = [0, 0, -1]}]\nrods = [{nodes = ['O', 'P'], mass = 1}]\n[gravity]\nacceleration = [0, 0, "
      "-9.81]\n[solver]\nend_time = 0.1\n");
  Diagnostics d = diagnose(run);
  d.axial_force(2, 0) = 3e-15;
  d.axial_force(3, 0) = std::nan("");
  CHECK_FALSE(only_round_off(run, d));
  const MatrixXd kept = without_round_off(run, d, 2 * d.axial_force);
  CHECK(kept(1, 0) == Approx(9.81).epsilon(1e-9));  // twice the mean of a force from 0 to m g
  CHECK(kept(2, 0) == 0.0);
  CHECK(std::isnan(kept(3, 0)));
}

// Of a tetrahedron of 6 kg whose shortest edge is sqrt(0.3^2 + 0.3^2 + 0.8^2) of its size, in steps of 0.02
// s, 0.02 s and 0.01 s: as the header has it, masses as on the diagonal, a third of a rod's at each end.
TEST_CASE("rounding of forces is that of the structure's size and place and speed", "[diagnostics]") {
  const double ulp = std::numeric_limits<double>::epsilon();
  for (const auto& [size, speed, load] :
       {std::tuple(1.0, 1.0, 0.0), {1.0, 1e6, 0.0}, {0.01, 0.0, 0.0}, {1.0, 3.0, 700.0}}) {
    std::string rest = "[solver]\nstep = 0.02\nend_time = 0.05\n";
    if (load > 0)
      for (const char* node : {"A", "B", "C", "D"})
        rest += "[[loads]]\nnodes = ['" + std::string(node) + "']\nforce = [0, 0, 700]\n";
    const Simulation run = testing::run_scene(drifting(size, speed, "", rest));
    REQUIRE(run.trajectory.size() == 4);
    const double rise = 0.5 * load * 4 / 6 * 0.05 * 0.05,
                 fastest = std::max(speed, 0.2 * speed + load * 4 / 6 * 0.05);
    const double reach = std::max(size + 0.05 * speed, 0.8 * size + 0.2 * 0.05 * speed + rise);
    const double off = 64 * ulp * size + 8 * ulp * reach;
    const double around = 64 * ulp * fastest + off / (0.05 / 3);
    const double expected =
        1e-12 * load + 4 * around * around / (size * std::sqrt(0.3 * 0.3 + 0.3 * 0.3 + 0.8 * 0.8));
    INFO(size << " m, " << speed << " m/s, " << load << " N");
    CHECK(force_round_off(run) / expected == Approx(1).epsilon(1e-6));
  }
}

}  // namespace unfurl::force_round_off_test
