// SPDX-License-Identifier: BSD-3-Clause
// What whole runs cannot tell apart: coefficients whose errors cost iterations or damping, not the order.
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/integrators/galerkin.hpp"
#include "core/integrators/index1.hpp"
#include "core/integrators/integrator.hpp"
#include "core/integrators/stiff_correction.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace coefficients_test {

TEST_CASE("a step's polynomial is prolonged exactly") {
  // p(c) = c - 2 c^2 + 3 c^3 ... of degree s - 1: its increments over this step at the control times,
  // prolonged to those of the next, which is `ratio` times as long.
  for (const char* family : {"lobatto", "equidistant", "chebyshev"})
    for (int s = 2; s <= 6; ++s) {
      const GalerkinCoefficients c(family, s);
      const auto p = [&](double x) {
        double sum = 0;
        for (int k = 1; k < s; ++k) sum += (k % 2 ? k : -k) * std::pow(x, k);
        return sum;
      };
      const VectorXd& nodes = c.basis.nodes();
      VectorXd now(s - 1);
      for (int j = 1; j < s; ++j) now[j - 1] = p(nodes[j]);
      for (const double ratio : {1.0, 0.6, 1.9}) {
        MatrixXd E;
        c.extrapolate(ratio, E);
        if (ratio == 1.0) CHECK((E - c.extrapolation).norm() == 0);
        const VectorXd next = E * now;
        for (int i = 1; i < s; ++i) {
          INFO(family << ", s = " << s << ", ratio " << ratio);
          const double exact = p(1 + nodes[i] * ratio) - p(1);
          CHECK(next[i - 1] == Approx(exact).epsilon(1e-11).margin(1e-12));  // l_k(2.9) is up to 1e3
        }
      }
    }
}

TEST_CASE("the coefficients of a step integrate polynomials exactly") {
  for (const char* family : {"lobatto", "equidistant", "chebyshev"})
    for (int s = 2; s <= 6; ++s) {
      const GalerkinCoefficients c(family, s);
      const VectorXd& nodes = c.basis.nodes();
      for (int d = 0; d < s; ++d) {
        VectorXd powers(s);
        for (int k = 0; k < s; ++k) powers[k] = std::pow(nodes[k], d);
        INFO(family << ", s = " << s << ", degree " << d);
        CHECK(c.b.dot(powers) == Approx(1.0 / (d + 1)).epsilon(1e-13));
        // integral of (c^d)'^2 = d^2 / (2 d - 1)
        CHECK(powers.dot(c.K * powers) ==
              Approx(d == 0 ? 0.0 : d * d / (2.0 * d - 1)).epsilon(0).margin(1e-11));
      }
      CHECK((c.C * c.C_inverse - MatrixXd::Identity(s - 1, s - 1)).norm() <= 1e-11);
    }
}

TEST_CASE("Baumgarte's terms are 2 alpha G w and alpha^2 Phi") {
  const Structure structure = double_pendulum();
  const System system(structure, true);
  State state = initial_state(structure, system).state;
  for (Index i = 0; i < state.z.size(); ++i) {  // off the constraints, in place and velocity
    state.z[i] += 1e-3 * std::sin(3.0 + static_cast<double>(i));
    state.w[i] += 1e-2 * std::cos(2.0 * static_cast<double>(i));
  }
  VectorXd q(system.coordinates()), v(q.size()), a(state.z.size()), lambda(system.constraints());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  system.jacobian(q, G, scratch);
  VectorXd bias(lambda.size()), phi(lambda.size());
  system.constraint_bias(0, q, v, bias);
  system.constraint(0, q, phi);
  const VectorXd rate = G * state.w;
  for (const double alpha : {0.0, 7.0, 30.0}) {
    Index1 equations(system);
    equations.stabilise(alpha);
    REQUIRE(equations.evaluate(0, state.z, state.w, a, lambda));
    const VectorXd left = G * a + bias + 2 * alpha * rate + alpha * alpha * phi;
    CHECK(left.lpNorm<Eigen::Infinity>() <= 1e-10 * (1 + alpha * alpha));  // regularisation, refined away
  }
}

TEST_CASE("a step ends with the multipliers that the equations of motion give there") {
  // They are the start of the next step's iteration; between nodes of order 4 they agree to some h^3.
  const auto model = make_model(double_pendulum());
  State state = initial_state(model->structure, model->system).state;
  for (const int stages : {2, 3, 4}) {
    State next = state;
    const auto integrator = find_method("dvm")->make(model->system, dvm_options(stages, 1e-3, 1));
    REQUIRE(integrator->step(next, 1e-3).ok());
    VectorXd a(next.z.size()), exact(next.lambda.size());
    REQUIRE(Index1(model->system).evaluate(next.t, next.z, next.w, a, exact));
    INFO(stages << " stages");
    // Two stages take the mean over half a step, which is h/2 of the multiplier's rate away: 1e-2 of its
    // size.
    CHECK((next.lambda - exact).norm() <= 2e-2 * exact.norm());
  }
}

TEST_CASE("every method tells the multipliers of where it has come to") {
  const auto model = make_model(double_pendulum());
  const State first = initial_state(model->structure, model->system).state;
  for (const Method& method : methods()) {
    INFO(method.name);
    State state = first;
    const auto integrator = method.make(model->system, dvm_options(3, 1e-3, 1));
    for (int k = 0; k < 200; ++k) REQUIRE(integrator->step(state, 1e-3).ok());
    VectorXd a(state.z.size()), exact(state.lambda.size());
    REQUIRE(Index1(model->system).evaluate(state.t, state.z, state.w, a, exact));
    CHECK((state.lambda - exact).norm() <= 1e-2 * exact.norm());  // some h times their rate
    CHECK((first.lambda - exact).norm() > 0.1 * exact.norm());
  }
}

TEST_CASE("the Newton iteration starts near and ends soon") {
  // Four stages at h = 0.01 on the ring: two corrections from a prolonged step, and one that confirms.
  const Simulation run = simulate(make_model(hoop_structure()), dvm_options(4, 0.01, 3.0));
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.newton_iterations <= 4 * run.steps);
}

TEST_CASE("a step's report tells how far its end is off the constraints") {
  // A crank of 1.1 m on a drive: constraints that move with time, others that do not.
  const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [1, 0, 0], fixed = true},
  {name = "A", position = [0, 1.1, 0]},
  {name = "B", position = [0.8, 1.3, 0.4], mass = 0.3}]
rods = [{nodes = ["O", "A"], mass = 3}, {nodes = ["A", "B"], mass = 0.7}]
[[constraints]]
kind = "angle"
nodes = ["P", "O", "A"]
axis = [0, 0, 1]
motion = "rate"
rate = 170
ramp = 0.1
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 0, 1]
[solver]
step = 0.01
end_time = 0.2
)";
  for (const Method& method : methods())
    for (const int stages : {2, 4}) {
      const Simulation run = run_scene(
          crank, {"solver.method=" + std::string(method.name), "solver.stages=" + std::to_string(stages)});
      INFO(method.name << " " << stages << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const System& system = run.trajectory.model().system;
      VectorXd phi(system.constraints());
      double most = 0;
      for (std::size_t i = 1; i < run.trajectory.size(); ++i) {
        most = std::max(most, run.trajectory.report(i).constraint_norm);
        system.constraint(run.trajectory.time(i), run.trajectory.node_positions(i), phi);
        // What is at round-off was so before the last correction of the iteration, too.
        CHECK(run.trajectory.report(i).constraint_norm ==
              Approx(phi.lpNorm<Eigen::Infinity>()).epsilon(1e-6).margin(1e-12));
      }
      CHECK(most > 0);  // rounding leaves something somewhere
    }
}

// Chung & Hulbert (1993, J. Appl. Mech. 60): the method on x'' = -omega^2 x, as a matrix on (x, h v, h^2 a).
Eigen::Matrix3d amplification(double rho, double wh) {
  const double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1), gamma = 0.5 - am + af,
               beta = 0.25 * std::pow(1 - am + af, 2), w2 = wh * wh;
  // (1 - am) a1 + am a0 + w2 ((1 - af) x1 + af x0) = 0, x1 = x0 + v0 + (1/2 - beta) a0 + beta a1,
  // v1 = v0 + (1 - gamma) a0 + gamma a1
  Eigen::Matrix3d left, right;
  left << 1, 0, -beta, 0, 1, -gamma, w2 * (1 - af), 0, 1 - am;
  right << 1, 1, 0.5 - beta, 0, 1, 1 - gamma, -w2 * af, 0, -am;
  return left.inverse() * right;
}

TEST_CASE("generalized-alpha is the published recursion, for every rho_inf") {
  // A mass between two equal springs in line, of which each gives k x: omega^2 = 2 k / m.
  constexpr double h = 0.02, wh = 0.9, x0 = 0.01;
  const std::string k = std::to_string(0.5 * 1.3 * std::pow(wh / h, 2));
  const std::string scene = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0.01, 0, 0], mass = 1.3},
  {name = "L", position = [-1, 0, 0], fixed = true},
  {name = "R", position = [1, 0, 0], fixed = true}]
[[forces]]
kind = "spring"
nodes = ["A", "L"]
free_length = 1
stiffness = )" + k + R"(
[[forces]]
kind = "spring"
nodes = ["A", "R"]
free_length = 1
stiffness = )" + k + R"(
[solver]
method = "generalized_alpha"
step = 0.02
end_time = 0.8
)";
  for (const double rho : {0.25, 0.6, 0.95}) {
    const Simulation run = run_scene(scene, {"solver.rho_inf=" + std::to_string(rho)});
    INFO("rho_inf " << rho << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.trajectory.size() == 41);
    // The first step has one algorithmic acceleration, a_0 = a_1 = (1 - alpha_f) x''_1 + alpha_f x''_0.
    const double af = rho / (rho + 1), w2 = wh * wh, x1 = x0 * (1 - af * w2 / 2) / (1 + (1 - af) * w2 / 2),
                 a = -w2 * ((1 - af) * x1 + af * x0);
    const Eigen::Vector3d first(x1, a, a);
    Eigen::Vector3d y(x0, 0, 0);
    for (std::size_t i = 0; i < 41; ++i, y = i == 1 ? first : amplification(rho, wh) * y) {
      // 40 steps of an iteration that ends at round-off, of 0.01 m; the stiffness is written to 7 digits.
      CHECK(run.trajectory.node_positions(i)[0] == Approx(y[0]).epsilon(0).margin(1e-10));
      CHECK(run.trajectory.node_velocities(i)[0] * h == Approx(y[1]).epsilon(0).margin(1e-10));
    }
  }
}

namespace {

// By the stages' equations: B_kj = sum_i w_i l_k l_j', A_kj = sum_i w_i l_k l_j.
struct Stages {
  MatrixXd A, B, Z;
  explicit Stages(const GalerkinCoefficients& c) {
    const MatrixXd tests = c.value.topRows(c.s - 1) * c.weight.asDiagonal();
    A = tests * c.value.bottomRows(c.s - 1).transpose();
    B = tests * c.slope.bottomRows(c.s - 1).transpose();
    Z = -c.C_inverse * B;
  }
};

}  // namespace

TEST_CASE("a step's matrix of stiffness is the square of that of damping") {
  for (const char* family : {"lobatto", "equidistant", "chebyshev"})
    for (int s = 2; s <= 7; ++s) {
      const GalerkinCoefficients c(family, s);
      const Stages stages(c);
      INFO(family << ", s = " << s);
      CHECK((c.C_inverse * stages.A + stages.Z * stages.Z).norm() <= 1e-11);
    }
}

// Springs with dampers among 40 masses, at random, h omega about 6, held by rows of which two are the same.
// What each correction leaves is computed from the equations themselves.
TEST_CASE(
    "stiff corrections gain most of a digit each and more, with redundant rows and stages of every number") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const Index n = 40, m = 7;
  MatrixXd M = MatrixXd::Zero(n, n), stretch(3 * n, n), G(m, n);
  for (Index i = 0; i < n; ++i) M(i, i) = 1.3 + any(random);
  for (Index i = 0; i < stretch.size(); ++i) stretch.data()[i] = any(random) > 0.9 ? any(random) : 0.0;
  for (Index i = 0; i < G.size(); ++i) G.data()[i] = any(random) > 0.5 ? any(random) : 0.0;
  G.row(m - 1) = G.row(1);
  const double h = 0.01, k = 36 / (h * h);
  const MatrixXd K = -k * stretch.transpose() * stretch, D = -0.3 / h * stretch.transpose() * stretch;
  const SparseRows sparse_M = M.sparseView(), sparse_G = G.sparseView();
  for (int s = 2; s <= 6; ++s) {
    const GalerkinCoefficients c("lobatto", s);
    const MatrixXd Z = Stages(c).Z;
    SaddleSolver saddle(sparse_M, sparse_G, std::max(s - 1, 2));
    REQUIRE(saddle.factorise(sparse_G));
    StiffCorrection correction(c, n, m);
    correction.take(h, sparse_M, K.sparseView(), D.sparseView());
    Interleaved f(n, s - 1), X = Interleaved::Zero(n, s - 1), Y = Interleaved::Zero(m, s - 1);
    for (Index i = 0; i < f.size(); ++i) f.data()[i] = any(random);
    const Interleaved g = G * f;  // in reach
    double first = 0, last = 0;
    const int corrections = 6;
    for (int it = 0; it <= corrections; ++it) {
      Interleaved rf =
          f - M * X + h * D * X * Z.transpose() + h * h * K * X * (Z * Z).transpose() - G.transpose() * Y;
      Interleaved rg = g - G * X;
      last = rf.norm() + rg.norm();
      if (it == 0) first = last;
      correction.solve(saddle, rf.data(), rg.data());
      X += rf;
      Y += rg;
    }
    INFO(s << " stages: " << first << " -> " << last);
    CHECK(last <= std::pow(0.2, corrections) * first);
  }
}

}  // namespace coefficients_test
