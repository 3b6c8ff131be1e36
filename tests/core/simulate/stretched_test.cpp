// SPDX-License-Identifier: BSD-3-Clause
// What quasi-static rods give next to a singular pose, at the first and last states of a run too.
#include "core/simulate/stretched.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/vibration.hpp"
#include "core/scene/library.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace stretched_test {

using testing::number;
using testing::run_scene;

namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

constexpr double lengths[] = {1, 2, 1}, masses[] = {1, 2, 1.3}, gravity = 9.81, EA = 2e9;

// A parallelogram of cranks A-B and D-C, coupler B-C, all in line at x = 0, through which it swings.
std::string parallelogram(double x, double step) {
  const std::string c = number(std::cos(x)), s = number(std::sin(x)), far = number(2 + std::cos(x)),
                    velocity = "velocity = [" + s + ", 0, " + number(-std::cos(x)) + "]";
  const auto rod = [](const char* nodes, int k) {
    return "{nodes = [" + std::string(nodes) + "], area = 1e-4, youngs_modulus = " + number(EA / 1e-4) +
           ", mass = " + number(masses[k]) + "}";
  };
  return "[structure]\nkind = 'custom'\nrod_model = 'quasi-static'\n"
         "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [" +
         c + ", 0, " + s + "], " + velocity + "}, {name = 'C', position = [" + far + ", 0, " + s + "], " +
         velocity + "}, {name = 'D', position = [2, 0, 0], fixed = true}]\nrods = [" + rod("'A', 'B'", 0) +
         ", " + rod("'B', 'C'", 1) + ", " + rod("'C', 'D'", 2) +
         "]\n[[structure.constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 1, 0]\n"
         "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nend_time = 0.03\nstep = " +
         number(step) + "\n";
}

// Its displacement (B, C; x and z), dense, in extended precision: M a + G^T lambda = F, G a = -|v|^2 / l,
// then the least u^T M u with G u = C lambda.
Vector exact(double angle, double rate) {
  const Real x = angle, w = rate, c = std::cos(x), s = std::sin(x);
  const Eigen::Matrix<Real, 2, 1> crank(c, s), v(-s * w, c * w);
  Matrix K = Matrix::Zero(7, 7);
  Vector b = Vector::Zero(7);
  const auto rod = [&](int r, int from, int to, const Eigen::Matrix<Real, 2, 1>& along, Real turning) {
    for (const auto& [node, sign] : {std::pair{from, -1}, std::pair{to, 1}}) {
      if (node < 0) continue;
      K.block<1, 2>(4 + r, 2 * node) += sign * along.transpose();
      K.block<2, 2>(2 * node, 2 * node) += masses[r] / Real(3) * Matrix::Identity(2, 2);
      b[2 * node + 1] -= gravity * masses[r] / Real(2);
    }
    if (from >= 0 && to >= 0) {
      K.block<2, 2>(2 * from, 2 * to) += masses[r] / Real(6) * Matrix::Identity(2, 2);
      K.block<2, 2>(2 * to, 2 * from) += masses[r] / Real(6) * Matrix::Identity(2, 2);
    }
    b[4 + r] = -turning / lengths[r];
  };
  rod(0, -1, 0, crank, v.squaredNorm());
  rod(1, 0, 1, {1, 0}, 0);
  rod(2, 1, -1, -crank, v.squaredNorm());
  K.topRightCorner(4, 3) = K.bottomLeftCorner(3, 4).transpose();
  const Eigen::FullPivLU<Matrix> solver(K);
  const Vector forces = solver.solve(b).tail(3);
  b.setZero();
  for (int r = 0; r < 3; ++r) b[4 + r] = lengths[r] / EA * forces[r];
  return solver.solve(b).head(4);
}

VectorXd stretch(const Simulation& run, std::size_t i) {
  return run.trajectory.positions(i) - run.trajectory.node_positions(i);
}

}  // namespace

// Round-off of the pose is 1e-16 / x^3 of the forces, which are 1 / x: to 1e-5 of u down to |x| = 1e-3. The
// states from 0.003 rad to -0.01 rad had all the displacement of the last of them.
TEST_CASE("a parallelogram that starts next to its flat pose is stretched as its equations say") {
  double first = 0;
  for (const double step : {0.01, 0.001, 0.0001}) {
    const Simulation run = run_scene(parallelogram(0.003, step));
    REQUIRE(run.status == RunStatus::completed);
    for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
      const VectorXd q = run.trajectory.node_positions(i), v = run.trajectory.node_velocities(i),
                     u = stretch(run, i);
      const double x = std::atan2(q[5], q[3]), w = std::cos(x) * v[5] - std::sin(x) * v[3];
      if (std::abs(x) < 1e-3) continue;
      INFO("step " << step << ", x = " << x);
      const Vector truth = exact(x, w);
      const std::array<Index, 4> at{3, 5, 6, 8};
      for (Index k = 0; k < 4; ++k)
        CHECK(std::abs(u[at[static_cast<std::size_t>(k)]] - static_cast<double>(truth[k])) <=
              1e-5 * static_cast<double>(truth.lpNorm<Eigen::Infinity>()));
    }
    const double at_start = stretch(run, 0)[5];
    if (first != 0) CHECK(at_start == Approx(first).epsilon(1e-9));  // the same pose, whatever the step
    first = at_start;
  }
}

// The last state before the deployed pose, 2 ms before it: the same pose in a run with a quarter of the step,
// where it is not the last. Round-off of it is 1e-9 m of 2e-4 m; it was 1e-5 m off.
TEST_CASE("the last stretch before a deployed pose is that of its own state") {
  const auto run = [](double step) {
    const Scene scene = read_scene_file(
        find_scene("hoop6"),
        {"structure.rod_model=quasi-static", "structure.youngs_modulus=7e10", "solver.step=" + number(step)});
    return simulate(build_model(scene), scene.solver);
  };
  const Simulation coarse = run(0.002), fine = run(0.0005);
  REQUIRE(coarse.status == RunStatus::deployed);
  const std::size_t last = coarse.trajectory.size() - 2;
  std::size_t same = 0;
  while (fine.trajectory.time(same) < coarse.trajectory.time(last) - 1e-9) ++same;
  REQUIRE(fine.trajectory.time(same) == Approx(coarse.trajectory.time(last)).epsilon(0).margin(1e-9));
  const VectorXd u = stretch(coarse, last);
  CHECK((u - stretch(fine, same)).lpNorm<Eigen::Infinity>() <= 1e-8);
}

// Every rod of the deployed pose, and where it is latched there, is longer by N L / (E A) of its own force,
// which is the limit along the motion as that pose has none of its own. The state before, 20 ms from it, has
// two thirds. From 20 degrees on, the run has few states before it.
TEST_CASE("the deployed pose is stretched by the forces that it tells of") {
  for (const char* at : {"stop", "latch"})
    for (const double step : {0.05, 0.02, 0.01, 0.002}) {
      INFO(at << " " << step);
      const Scene scene = read_scene_file(
          find_scene("hoop6"),
          {"structure.rod_model=quasi-static", "structure.youngs_modulus=7e9", "solver.stages=5",
           std::string("solver.at_deployed=") + at, "solver.step=" + number(step),
           "structure.fold_angle=" + number(step == 0.02 ? 20 : 89.34)});
      const Simulation run = simulate(build_model(scene), scene.solver);
      const Diagnostics d = diagnose(run);
      const Structure& structure = run.trajectory.structure();
      std::size_t poses = 0;
      for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
        if (!run.trajectory.report(i).singular_event) continue;
        ++poses;
        const VectorXd q = run.trajectory.node_positions(i), u = stretch(run, i);
        double most = 0, off = 0;
        for (std::size_t r = 0; r < structure.rods.size(); ++r) {
          const Rod& rod = structure.rods[r];
          const Vec3 along = q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a);
          const double longer = along.normalized().dot(u.segment<3>(3 * rod.b) - u.segment<3>(3 * rod.a)),
                       force = d.axial_force(static_cast<Index>(i), static_cast<Index>(r));
          most = std::max(most, std::abs(force));
          off = std::max(off, std::abs(longer * rod.youngs_modulus * rod.area / along.norm() - force));
        }
        CHECK(most > 700);
        CHECK(off <= 1e-4 * most);  // the limit of forces is known to some 1e-5
      }
      CHECK(poses > 0);
    }
}

// A weight of 3 kg below two rods in one line, of 1 m and of 2 m, that both have grown by 0.5 m when it hangs
// still: E A / l of each as it was, whatever the warmth, as of rods that give. Rows of rods that are longer
// by e are 1 + e times their stretch, multipliers 1 / (1 + e) of their forces.
TEST_CASE("warmed quasi-static rods stretch and share and swing by their forces, E A and cold lengths") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
rod_model = "quasi-static"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [0, 0, 1], fixed = true},
         {name = "A", position = [0, 0, -1], mass = 3}]
rods = [{name = "short", nodes = ["O", "A"], mass = 0, area = 1e-4, youngs_modulus = 2e10},
        {name = "long", nodes = ["P", "A"], mass = 0, area = 1e-4, youngs_modulus = 7e10}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [0, 0, 1]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "temperature"
rods = ["short"]
expansion = 0.01
change = 50
times = [0, 0.5]
values = [0, 1]
[[forces]]
kind = "temperature"
rods = ["long"]
expansion = 0.005
change = 50
times = [0, 0.5]
values = [0, 1]
[solver]
step = 0.01
end_time = 0.6
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const std::size_t last = run.trajectory.size() - 1;
  REQUIRE(run.trajectory.node_positions(last)[8] == Approx(-1.5).epsilon(1e-12));
  const double weight = 3 * 9.81, k1 = 2e6, k2 = 7e6 / 2;
  const Diagnostics d = diagnose(run);
  const auto row = static_cast<Index>(last);
  CHECK(d.axial_force(row, 0) == Approx(weight * k1 / (k1 + k2)).epsilon(1e-9));
  CHECK(d.axial_force(row, 1) == Approx(weight * k2 / (k1 + k2)).epsilon(1e-9));
  // Read off a difference of positions of metres.
  CHECK(stretch(run, last)[8] == Approx(-weight / (k1 + k2)).epsilon(1e-9));
  const Vibration v = vibration(run.trajectory.model(), run.trajectory.state(last));
  REQUIRE(v.modes.size() == 1);
  CHECK(v.modes[0].frequency == Approx(std::sqrt((k1 + k2) / 3) / (2 * pi)).epsilon(1e-9));
}

// A cantilever truss of n bays of 1 m x 1 m under P at its tip: by virtual work, with the chords' forces k P
// of bay k and (k - 1) P, sqrt(2) P of diagonals and P of posts,
//
//     u = P / (E A) (sum of k^2 + (k - 1)^2, and n (2 sqrt(2) + 1))
//
// down. Its rods' strains are n P / (E A) at most, while the turns add up to n times that: what a turn makes
// a rod longer by is more than what rods give from n of some 2 / sqrt(strain) on, though no rod turns by much
// beside its neighbour. Of second order the tip comes back along the mast by some u^2 / n.
TEST_CASE("turns that add up along a mast are no displacement that is too large") {
  constexpr double stiffness = 1e7;
  for (const auto& [bays, P] : {std::pair(4, 100.0), {20, 100.0}, {60, 100.0}, {60, 600.0}}) {
    const std::string n = number(bays);
    const Simulation run = run_scene(R"(
[structure]
kind = "custom"
rod_model = "quasi-static"
youngs_modulus = 1e11
nodes = [{repeat = {i = "0:)" + n + R"("}, name = "A{i+1}", position = ["=i+1", 0, 0], mass = 1},
         {repeat = {i = "0:)" + n + R"("}, name = "B{i+1}", position = ["=i+1", 0, 1], mass = 1},
         {name = "A0", position = [0, 0, 0], fixed = true}, {name = "B0", position = [0, 0, 1], fixed = true},
         {name = "O", position = [0, 9, 0], fixed = true}, {name = "M", position = [1, 9, 0], mass = 1}]
rods = [{repeat = {i = "0:)" + n + R"("}, nodes = ["A{i}", "A{i+1}"], mass = 0, area = 1e-4},
        {repeat = {i = "0:)" + n + R"("}, nodes = ["B{i}", "B{i+1}"], mass = 0, area = 1e-4},
        {repeat = {i = "0:)" + n + R"("}, nodes = ["A{i+1}", "B{i+1}"], mass = 0, area = 1e-4},
        {repeat = {i = "0:)" + n + R"("}, nodes = ["B{i}", "A{i+1}"], mass = 0, area = 1e-4},
        {nodes = ["O", "M"], mass = 0, elastic = false}]
[[structure.constraints]]
kind = "plane"
nodes = ["A*", "B*", "M"]
normal = [0, 1, 0]
[[loads]]
nodes = ["B)" + n + R"("]
force = [0, 0, -)" + number(P) + R"(]
[solver]
step = 0.01
end_time = 0.02
)");
    INFO(bays << " bays: " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    double sum = bays * (2 * std::sqrt(2.0) + 1);
    for (int k = 1; k <= bays; ++k) sum += k * k + (k - 1) * (k - 1);
    const VectorXd u = stretch(run, run.trajectory.size() - 1);
    // The mast's weakest direction is some 1 / n^2, whose square divides round-off of 1e-16 in the rows.
    CHECK(u[3 * (2 * bays - 1) + 2] == Approx(-P / stiffness * sum).epsilon(1e-8));
    // A tenth of the mast's length is no small displacement any more.
    const std::vector<std::string> warnings = accuracy_warnings(run, diagnose(run));
    CHECK(warnings.size() == (P / stiffness * sum > 0.1 * bays ? 1 : 0));
    for (const std::string& warning : warnings)
      CHECK(warning.find("14.4 % of the structure's size: that is of first order") != std::string::npos);
  }
}

// Where rods lie in line u of G u = C lambda is 1 / sine, and a state is as near to that pose as the step
// happens to bring it: nodes were shown a metre off. Whatever the step, a rod is shown as long as its
// force says, N l / (E A), up to as much again by what the largest of these turns it; or as it is, and said.
TEST_CASE("rods are shown no longer than their forces make them next to poses with rods in line") {
  for (const char* at : {"stop", "pass"})
    for (const double step : {0.01, 0.0025, 0.001}) {
      INFO(at << " " << step);
      const Scene scene = read_scene_file(
          find_scene("scissor_mast"),
          {"structure.rod_model=quasi-static", "structure.youngs_modulus=7e10", "structure.deployed_angle=0",
           "solver.end_time=1.5", std::string("solver.at_deployed=") + at, "solver.step=" + number(step)});
      const Simulation run = simulate(build_model(scene), scene.solver);
      const Diagnostics d = diagnose(run);
      const std::vector<Rod>& rods = run.trajectory.structure().rods;
      bool unshown = false;
      for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
        const VectorXd q = run.trajectory.positions(i);
        unshown = unshown || stretch(run, i).isZero(0);
        double longer = 0, most = 0;
        for (std::size_t r = 0; r < rods.size(); ++r) {
          const double force = d.axial_force(static_cast<Index>(i), static_cast<Index>(r));
          most = std::max(most, std::abs(force) * rods[r].length / (rods[r].youngs_modulus * rods[r].area));
          longer = std::max(
              longer,
              std::abs((q.segment<3>(3 * rods[r].b) - q.segment<3>(3 * rods[r].a)).norm() - rods[r].length));
        }
        CHECK(longer <= 2.1 * most);
      }
      const std::vector<std::string> warnings = accuracy_warnings(run, d);
      CHECK(unshown == std::ranges::any_of(warnings, [](const std::string& text) {
              return text.find("shown without what the rods give") != std::string::npos;
            }));
    }
}

// 2 kg on a rod of 1 m and 1e5 N, which gives in the motion and is then no quasi-static one, with 1 kg on a
// rigid rod below it: x = 3 g l / EA (1 - cos(w t)), w^2 = EA / (3 l). The step's error at h w = 0.9 rad is
// below 1e-7 of the swing.
TEST_CASE("where all rods with a modulus give in the motion quasi-static ones are none") {
  Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nrod_model = 'quasi-static'\nnodes = [{name = 'A', position = [0, 0, 0], "
      "fixed = true}, {name = 'B', position = [0, 0, -1], mass = 2}, {name = 'C', position = [0, 0, -2], "
      "mass = "
      "1}]\nrods = [{nodes = ['A', 'B'], mass = 0, area = 1e-4, youngs_modulus = 1e9, elastic = true}, "
      "{nodes = ['B', 'C'], mass = 0}]\n[[constraints]]\nkind = 'line'\nnodes = ['B', 'C']\ndirection = [0, "
      "0, "
      "1]\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 6\nstep = 0.005\nend_time = 0.1\n");
  REQUIRE(run.status == RunStatus::completed);
  const std::vector<std::string> warnings = warnings_of(run, judge(run));
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].starts_with("rod_model = \"quasi-static\" does nothing"));
  const double sag = 3 * gravity / 1e5, omega = std::sqrt(1e5 / 3);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double down = sag * (1 - std::cos(omega * run.trajectory.time(i)));
    const VectorXd q = run.trajectory.positions(i);
    CHECK(q[5] == Approx(-1 - down).epsilon(0).margin(1e-6 * sag));
    CHECK(q[8] == Approx(-2 - down).epsilon(0).margin(1e-6 * sag));
  }
}

}  // namespace stretched_test
