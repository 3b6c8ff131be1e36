// SPDX-License-Identifier: BSD-3-Clause
// Rods that bend, against the elastica.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/diagnostics/vibration.hpp"
#include "core/math/factors.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/models.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace bending_test {

namespace {

constexpr double EI = 0.37, L = 1.3;

// A cantilever of k segments along x, clamped at its first node, under P across its end: rows of equal
// segments, with bending stiffness at the inner nodes. The clamp is a node behind the first, half a segment
// away on the other side: its bend belongs to half a segment, and so resists with E I over l / 2.
std::string cantilever(int k, double alpha) {
  const double l = L / k;
  std::ostringstream text;
  text.precision(17);
  text << "[structure]\nkind = 'custom'\n"
       << "[[structure.nodes]]\nname = 'wall'\nposition = [" << -l / 2 << ", 0, 0]\nfixed = true\n";
  for (int i = 0; i <= k; ++i)
    text << "[[structure.nodes]]\nname = 'N" << i << "'\nposition = [" << i * l << ", 0, 0]\n"
         << (i == 0 ? "fixed = true\n" : "mass = 0.1\n");
  for (int i = 0; i < k; ++i)
    text << "[[structure.rods]]\nnodes = ['N" << i << "', 'N" << i + 1 << "']\nmass = 0\n";
  // The mean length at the clamp is 3/4 l; E I / (l / 2) there.
  text << "[[forces]]\nkind = 'bending'\nnodes = ['wall', 'N0', 'N1']\nstiffness = " << EI * 1.5 << "\n";
  for (int i = 1; i < k; ++i)
    text << "[[forces]]\nkind = 'bending'\nnodes = ['N" << i - 1 << "', 'N" << i << "', 'N" << i + 1
         << "']\nstiffness = " << EI << "\n";
  text << "[[loads]]\nnodes = ['N" << k << "']\nforce = [0, " << alpha * EI / (L * L) << ", 0]\n";
  return text.str();
}

// The pose at rest: Newton on F(q) - G^T lambda = 0, Phi(q) = 0 with the load in `steps` parts.
VectorXd equilibrium(const Model& model, int steps) {
  const System& system = model.system;
  const Index n = system.solved_coordinates(), m = system.constraints();
  VectorXd q = node_positions(model.structure), rest = VectorXd::Zero(q.size()), lambda = VectorXd::Zero(m);
  VectorXd z = system.reduce(q), load = VectorXd::Zero(q.size());
  for (const Load& l : model.structure.loads) load.segment<3>(3 * l.node) += l.force;
  SparseRows G = system.jacobian_pattern(), by_z, by_w;
  std::vector<double> scratch;
  for (int part = 1; part <= steps; ++part)
    for (int it = 0; it < 40; ++it) {
      system.expand(z, q);
      VectorXd f = (static_cast<double>(part) / steps - 1) * load, r(n), phi(m);
      system.add_applied_force(0, q, rest, 1.0, f);
      system.add_constraint_force(q, lambda, -1.0, f);
      system.reduce_force(f, r);
      system.constraint(0, q, phi);
      system.jacobian(q, G, scratch);
      system.force_derivatives(0, q, rest, by_z, by_w);
      MatrixXd A = MatrixXd::Zero(n + m, n + m);
      A.topLeftCorner(n, n) = MatrixXd(system.curvature(q, lambda)) - MatrixXd(by_z);
      A.topRightCorner(n, m) = MatrixXd(G).transpose();
      A.bottomLeftCorner(m, n) = MatrixXd(G);
      VectorXd b(n + m);
      b << r, -phi;
      const VectorXd x = least_squares(A, b);
      z += x.head(n);
      lambda += x.tail(m);
      if (x.head(n).lpNorm<Eigen::Infinity>() < 1e-13) break;
    }
  system.expand(z, q);
  return q;
}

}  // namespace

TEST_CASE("bending: a cantilever of k segments is the elastica, to the second order in 1/k") {
  struct Row {
    double alpha, slope, shortening, deflection;
  };
  // Tip slope [rad], u / L, w / L of the elastica with alpha = P L^2 / E I.
  const Row rows[] = {{1, 0.46135194971188, 0.056433236283377, 0.30172077379981},
                      {2, 0.78174983155654, 0.16064172082517, 0.49345748039671},
                      {5, 1.2153681176117, 0.38762836072443, 0.71379152361191}};
  for (const Row& row : rows) {
    std::vector<Vec3> off;
    for (const int k : {8, 16, 32}) {
      const VectorXd q = equilibrium(*model_of(cantilever(k, row.alpha)), 5);
      const Vec3 tip = q.tail<3>(), end = q.segment<3>(q.size() - 6);
      off.emplace_back(tip.y() / L - row.deflection, 1 - tip.x() / L - row.shortening,
                       std::atan2(tip.y() - end.y(), tip.x() - end.x()) - row.slope);
      // Of second order with constants of order one: curvature is at most alpha / L.
      CHECK(off.back().lpNorm<Eigen::Infinity>() <= row.alpha / (k * k));
    }
    for (int i = 0; i < 3; ++i) {
      // e = a / k^2 + b / k^3, both of one size: what is left without the first falls eightfold.
      const double coarse = (4 * off[1][i] - off[0][i]) / 3, fine = (4 * off[2][i] - off[1][i]) / 3;
      INFO("alpha = " << row.alpha << ", " << i << ": " << off[0][i] << ", " << off[1][i] << ", "
                      << off[2][i]);
      CHECK(std::abs(fine) <= std::abs(coarse) / 5);
      CHECK(std::abs(fine) <= 1e-4);
    }
  }
}

// Two rods, the second turned by a from the first, F = 2 E I / l tan(a/2) / cos^2(a/2) / l_i across each:
// what rounding leaves along a rod would be of the size of E I eps / l^2.
TEST_CASE("bending: the force of a rod that is hardly bent has nothing along the rod") {
  const double l1 = 0.0833, l2 = 0.0711, stiffness = 8.4e4;
  for (const Vec3& t : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.48, 0.6, -0.64)}) {
    const Vec3 across = t.unitOrthogonal();
    for (const double a : {1e-3, 1e-6, 1e-9}) {
      const Vec3 turned = std::cos(a) * t + std::sin(a) * across,
                 from = std::cos(a) * across - std::sin(a) * t;
      const auto model = model_of(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], mass = 1}, {name = 'B', "
          "position = [1, 0, 0], mass = 1}, {name = 'C', position = [2, 0, 0], mass = 1}]\n[[forces]]\nkind "
          "= "
          "'bending'\nnodes = ['A', 'B', 'C']\nstiffness = " +
          number(stiffness) + "\n");
      VectorXd q(9), f = VectorXd::Zero(9);
      q << Vec3::Zero(), l1 * t, l1 * t + l2 * turned;
      model->system.add_applied_force(0, q, VectorXd::Zero(9), 1.0, f);
      const double moment =
          2 * stiffness * std::tan(a / 2) / std::pow(std::cos(a / 2), 2);  // mean length 1 m
      INFO(t.transpose() << ", " << a);
      // Turned by a, C is known to the rounding of B and C beside each other: eps l / l2 of a radian.
      const double known = moment * (1e-15 / a + 1e-14);
      CHECK((f.head<3>() + moment / l1 * across).norm() <= known / l1);
      CHECK((f.tail<3>() + moment / l2 * from).norm() <= known / l2);
      CHECK(std::abs(f.head<3>().dot(t)) <= 1e-15 * (moment / l1));
      CHECK(std::abs(f.tail<3>().dot((q.tail<3>() - q.segment<3>(3)).normalized())) <= 1e-15 * (moment / l2));
    }
  }
}

TEST_CASE("bending: forces are the derivatives of the potential, and theirs theirs") {
  const auto model = model_of(cantilever(3, 1.0));
  const System& system = model->system;
  VectorXd q(system.coordinates());
  for (Index i = 0; i < q.size(); ++i)
    q[i] = (i % 3 == 0 ? 0.4 * static_cast<double>(i / 3) : 0) +
           0.2 * std::sin(2.0 + 1.7 * static_cast<double>(i));
  const VectorXd rest = VectorXd::Zero(q.size());
  const auto force = [&](const VectorXd& x) {
    VectorXd f = VectorXd::Zero(x.size());
    system.add_applied_force(0, x, rest, 1.0, f);
    return f;
  };
  SparseRows by_z, by_w;
  system.force_derivatives(0, q, rest, by_z, by_w);
  const double e = 1e-6;
  const VectorXd f = force(q);
  VectorXd load = VectorXd::Zero(q.size());
  for (const Load& l : model->structure.loads) load.segment<3>(3 * l.node) += l.force;
  for (Index i = 0; i < q.size(); ++i) {
    VectorXd there = q, back = q;
    there[i] += e, back[i] -= e;
    const double slope = (system.potential_energy(there) - system.potential_energy(back)) / (2 * e);
    CHECK(f[i] - load[i] == Approx(-slope).epsilon(0).margin(1e-8 * f.norm()));  // e^2 and 1e-16 / e of it
  }
  const MatrixXd by_q = MatrixXd(by_z);
  for (Index c = 0; c < by_q.cols(); ++c) {
    VectorXd dz = VectorXd::Zero(by_q.cols()), move(q.size()), reduced(by_q.cols());
    dz[c] = e;
    system.expand_rate(dz, move);
    system.reduce_force((force(q + move) - force(q - move)) / (2 * e), reduced);
    CHECK((reduced - by_q.col(c)).lpNorm<Eigen::Infinity>() <= 1e-7 * by_q.lpNorm<Eigen::Infinity>());
  }
}

TEST_CASE("bending: segments = k cuts a rod, and its first bending frequency is that of a beam") {
  // Pinned ends: w = (pi / l)^2 sqrt(E I / (rho A)); segments of a heavy rod tend to it.
  const auto scene = [](int k) {
    return "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nsegments = " + std::to_string(k) +
           "\n[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nfixed = true\n"
           "[[structure.nodes]]\nname = 'B'\nposition = [1.4, 0, 0]\n"
           "[[structure.rods]]\nnodes = ['A', 'B']\ndensity = 2700\narea = 1e-4\n"
           "[[constraints]]\nkind = 'line'\nnodes = ['B']\ndirection = [1, 0, 0]\n"
           "[[constraints]]\nkind = 'plane'\nnodes = ['A-B.*']\nnormal = [0, 0, 1]\n";
  };
  const auto model = model_of(scene(6));
  CHECK(model->structure.rods.size() == 6);
  CHECK(model->structure.rods[2].name == "A-B.3");
  CHECK(model->structure.nodes[3].name == "A-B.2");
  double mass = 0;
  for (const Rod& rod : model->structure.rods) mass += rod.mass;
  CHECK(mass == Approx(2700 * 1e-4 * 1.4).epsilon(1e-14));
  const double wanted = pi / (2 * 1.4 * 1.4) * std::sqrt(7e10 * (1e-4 / (4 * pi)) / 2700);
  double before = 0;
  for (const int k : {6, 12}) {
    const auto cut = model_of(scene(k));
    const double f =
        vibration(*cut, initial_state(cut->structure, cut->system).state).modes.front().frequency;
    INFO("k = " << k << ": " << f << " Hz of " << wanted);
    CHECK(f == Approx(wanted).epsilon(2.0 / (k * k)));  // pi^2 / 12 k^2 and the like
    if (before != 0) CHECK(before / (f - wanted) == Approx(16).epsilon(0).margin(1.5));  // of fourth order
    before = f - wanted;
  }
  CHECK_THAT(error_of("[structure]\nkind = 'scissor_mast'\nyoungs_modulus = 7e10\nsegments = 4\n"),
             Catch::Contains("structure.segments: rods that carry a pin between their ends"));
  CHECK_THAT(error_of("[structure]\nkind = 'hoop'\nmodel = 'sector'\nyoungs_modulus = 7e10\nsegments = 4\n"),
             Catch::Contains("structure.segments: a sector model"));
}

// A chain of three tubes, its first joint driven, turns as rigid ones do but for what the bend stores, some
// M^2 L / (E I) with M = 11 N m, L = 3.3 m, and of what steps as long leave of the work, a few parts in 10^4.
// All energy is booked: of some 20 J turned over 5e-5 J are left, waves that turn up between step and step,
// and as much again where the stiffest rods give in the longest steps, whose lengths these waves leave open.
TEST_CASE("bending: the work of drives beside waves that steps do not resolve") {
  const auto run = [](double E, const std::vector<std::string>& changes) {
    std::vector<std::string> all = {"structure.youngs_modulus=" + number(E)};
    all.insert(all.end(), changes.begin(), changes.end());
    return run_scene(R"(
[structure]
kind = 'custom'
youngs_modulus = 1
nodes = [
  {name = 'P0', position = [-0.068, 0.014, -0.025], fixed = true},
  {name = 'P1', position = [0.965, 0.137, 0.294], mass = 0.4},
  {name = 'P2', position = [1.693, 0.834, 0.166], mass = 0.4},
  {name = 'P3', position = [2.192, 0.263, 0.709], mass = 0.4},
]
rods = [
  {nodes = ['P0', 'P1'], mass = 0.3, area = 5e-4, second_moment = 5e-6},
  {nodes = ['P1', 'P2'], mass = 0.4, area = 5e-4, second_moment = 5e-6},
  {nodes = ['P2', 'P3'], mass = 0.5, area = 5e-4, second_moment = 5e-6},
]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = 'angle'
rods = ['P0-P1', 'P1-P2']
motion = 'smooth'
to = 112.664
duration = 0.4
[solver]
stages = 4
step = 0.005
end_time = 0.5
)",
                     all);
  };
  const std::string name = "angle of P0-P1-P1-P2.";
  const Diagnostics rigid = diagnose(run(1e14, {}));
  for (const char* model : {"elastic", "rigid"})
    for (const double E : {1.5e11, 1e14})
      for (const char* solver : {"solver.stages=4", "solver.stages=6", "solver.step=0.01"}) {
        INFO(model << ", " << E << ", " << solver);
        const Simulation bent =
            run(E, {"structure.rod_model='" + std::string(model) + "'", "structure.segments=8", solver});
        REQUIRE(bent.status == RunStatus::completed);
        const Diagnostics d = diagnose(bent);
        const double stored = 11.0 * 11.0 * 3.3 / (E * 5e-6);
        const bool open_lengths =
            model == std::string("elastic") && E == 1e14 && solver == std::string("solver.step=0.01");
        CHECK(largest(d, "energy_balance_J") <= stored + (open_lengths ? 1e-4 : 5e-5));
        double off = 0, told_off = 0, most = 0, pull_off = 0;
        for (std::size_t i = 0, j = 0; i < d.t.size(); ++i) {
          while (rigid.t[j] < d.t[i] - 1e-9) ++j;
          off = std::max(off, std::abs(d.at("drive_work_J").values[i] - rigid.at("drive_work_J").values[j]));
          const double torque = rigid.at((name + "torque_N_m").c_str()).values[j];
          most = std::max(most, std::abs(torque));
          const auto row = static_cast<Index>(i), of_rigid = static_cast<Index>(j);
          if (i > 0 && E == 1e14 && std::string(model) == "elastic" &&
              d.force_unique.row(row).head<8>().all())
            pull_off = std::max(
                pull_off, std::abs(d.axial_force.row(row).head<8>().mean() - rigid.axial_force(of_rigid, 0)));
          if (i > 0 && d.at((name + "torque_unique").c_str()).values[i] != 0)
            told_off = std::max(told_off, std::abs(d.at((name + "torque_N_m").c_str()).values[i] - torque));
        }
        CHECK(off <= stored + 3e-4);
        CHECK(told_off <= 0.05 * most);
        CHECK(pull_off <= 0.05 * largest(rigid, "axial_force_max_N"));
        CHECK(d.at((name + "energy_J").c_str()).values.back() ==
              Approx(d.at("drive_work_J").values.back()).epsilon(1e-12));
      }
}

// Two rods pull a mass to both sides with 30 kN, storing 30 J; what it moves with is all that waves can have.
TEST_CASE("what stopped waves can have had is not what rods store from the start") {
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nyoungs_modulus = 1e11\nrod_model = 'elastic'\nnodes = [{name = 'A', "
      "position "
      "= [-1, 0, 0], fixed = true}, {name = 'M', position = [0, 0, 0], velocity = [0.1, 0, 0], mass = 1.3}, "
      "{name = "
      "'B', position = [1, 0, 0], fixed = true}]\nrods = [{nodes = ['A', 'M'], mass = 0, area = 3e-4, "
      "free_length = "
      "0.999}, {nodes = ['M', 'B'], mass = 0, area = 3e-4, free_length = 0.999}]\n[solver]\nstages = 4\nstep "
      "= "
      "0.01\nend_time = 0.1\n");
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.trajectory.state(5).tension.size() == 2);
  CHECK(run.trajectory.state(5).tension.minCoeff() > 2.9e4);
  CHECK(energy_of_stopped_waves(run).back() <= 4 * (0.5 * 1.3 * 0.1 * 0.1) * (1 + 1e-9));
}

// A tube hangs where it is, let go at once: its own waves, which the steps stop, are all that its weight of
// 17 N can turn over, F^2 L / (2 E A) = 2 uJ, and nothing ends the run. The tip is below by F L / E A at
// most.
TEST_CASE("bending: a tube that only hangs") {
  for (const int segments : {1, 2, 12})
    for (const char* step : {"solver.step=0.01", "solver.step=0.001"}) {
      INFO(segments << ", " << step);
      const Simulation run = run_scene(
          "[structure]\nkind = 'custom'\nyoungs_modulus = 1.5e11\nsection = 'tube'\nwall_thickness = "
          "1.5e-3\nrod_model = 'elastic'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
          "{name = 'B', position = [0, 0, -1], mass = 1}]\nrods = [{nodes = ['A', 'B'], density = 1600, "
          "area = 4.64e-4}]\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\n"
          "end_time = 0.5\n",
          {"structure.segments=" + std::to_string(segments), step});
      REQUIRE(run.status == RunStatus::completed);
      const Diagnostics d = diagnose(run);
      CHECK(mistrust(run, d).empty());
      CHECK(largest(d, "energy_balance_J") <= 17.1 * 17.1 / (2 * 1.5e11 * 4.64e-4));
      const Vec3 tip = end_positions(run).segment<3>(3);
      CHECK((tip - Vec3(0, 0, -1)).norm() <= 2 * 17.1 / (1.5e11 * 4.64e-4));
    }
}

}  // namespace bending_test
