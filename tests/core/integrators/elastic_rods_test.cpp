// SPDX-License-Identifier: BSD-3-Clause
// Rods that give: order, stiff limits, energy, and closed forms.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/math/factors.hpp"
#include "core/scene/library.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/reference.hpp"
#include "tests/support/models.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace elastic_rods_test {

namespace {

std::string node(const std::string& name, const std::string& position, const std::string& more = "") {
  return "[[structure.nodes]]\nname = '" + name + "'\nposition = " + position + "\n" + more + "\n";
}

std::string rod(const std::string& a, const std::string& b, const std::string& more) {
  return "[[structure.rods]]\nnodes = ['" + a + "', '" + b + "']\n" + more + "\n";
}

// A mass on a massless rod along x, drawn out by `amplitude`.
constexpr double mass = 1.7, rest = 0.7, amplitude = 0.013, stiffness = 210;
std::string oscillator(const std::string& more = "") {
  return "[structure]\nkind = 'custom'\n" + more + node("O", "[-0.2, 0.3, 0.1]", "fixed = true") +
         node("A", "[" + number(rest - 0.2 + amplitude) + ", 0.3, 0.1]", "mass = " + number(mass)) +
         rod("O", "A",
             "mass = 0\narea = 3e-4\nyoungs_modulus = " + number(stiffness * rest / 3e-4) +
                 "\nelastic = true\nfree_length = " + number(rest)) +
         "[[constraints]]\nkind = 'line'\nnodes = ['A']\ndirection = [1, 0, 0]\n[solver]\nend_time = 1\n";
}

// Two rods, O-A rigid and A-B elastic of the stiffness E A = `stiff` newtons; heavy, moving, no symmetry.
std::string arms(double stiff, const std::string& elastic = "true", const std::string& more = "") {
  return "[structure]\nkind = 'custom'\n" + more + node("O", "[0.2, -0.1, 0.4]", "fixed = true") +
         node("A", "[0.9, 0.3, 0.1]", "velocity = [0.3, 0.9, 0.4]\nmass = 0.8") +
         node("B", "[1.3, -0.2, -0.5]", "velocity = [-0.5, 0.4, 1.1]\nmass = 1.3") +
         rod("O", "A", "mass = 0.9") +
         rod("A", "B",
             "mass = 0.6\narea = 2e-4\nyoungs_modulus = " + number(stiff / 2e-4) +
                 (elastic.empty() ? "" : "\nelastic = " + elastic)) +
         "[gravity]\nacceleration = [0.3, -1, -9]\n[solver]\nend_time = 0.8\n";
}

VectorXd end_at(const std::string& scene, int stages, double step) {
  const Simulation run =
      run_scene(scene, {"solver.stages=" + std::to_string(stages), "solver.step=" + number(step)});
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  return end_positions(run);
}

// Two bars of aluminium, A = 3e-5 m^2 and 5e-5 m^2, from the ground to a loaded node.
const std::string truss = R"(
[structure]
kind = "custom"
rod_model = "quasi-static"
youngs_modulus = 7e10
nodes = [
  {name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [2.1, 0, 0], fixed = true},
  {name = "C", position = [0.5, 0, -1.2], mass = 4}]
rods = [{name = "a", nodes = ["A", "C"], mass = 0, area = 3e-5},
        {name = "b", nodes = ["B", "C"], mass = 0, area = 5e-5}]
[[structure.constraints]]
kind = "plane"
nodes = ["C"]
normal = [0, 1, 0]
[[loads]]
nodes = ["C"]
force = [700, 0, -1900]
[solver]
step = 0.1
end_time = 0.3
)";

}  // namespace

TEST_CASE("elastic rods: a mass on one oscillates as the closed form says, to the order 2 s - 2") {
  const double omega = std::sqrt(stiffness / mass), wanted = rest - 0.2 + amplitude * std::cos(omega);
  for (const int s : {2, 3, 4, 5}) {
    // h omega between 0.2 and 1.1: errors far above round-off, and the leading term rules.
    const double h = s > 3 ? 0.1 : 0.02;
    const double coarse = std::abs(end_at(oscillator(), s, h)[3] - wanted),
                 fine = std::abs(end_at(oscillator(), s, h / 2)[3] - wanted);
    INFO(s << " stages: " << coarse << ", " << fine);
    CHECK(std::log2(coarse / fine) == Approx(2 * s - 2).epsilon(0).margin(0.25));
  }
}

TEST_CASE("elastic rods: a mechanism of two rods against extrapolation, to the order 2 s - 2") {
  const auto model = model_of(arms(90));
  const Reference reference = solve_reference(model, 0.8, 1, {});
  REQUIRE(reference.uncertainty <= 1e-10);
  for (const int s : {2, 3, 4, 5}) {
    const double h = s > 3 ? 0.08 : 0.02;
    const double coarse = (end_at(arms(90), s, h) - reference.q.back()).norm(),
                 fine = (end_at(arms(90), s, h / 2) - reference.q.back()).norm();
    INFO(s << " stages: " << coarse << ", " << fine);
    CHECK(std::log2(coarse / fine) == Approx(2 * s - 2).epsilon(0).margin(0.45));  // as of rigid mechanisms
  }
}

TEST_CASE("elastic rods: the stiffer, the nearer to rigid ones, by 1 / EA") {
  const VectorXd rigid = end_at(arms(1e8, "false"), 6, 0.005);
  std::vector<double> off;
  for (const double stiff : {1e6, 1e7, 1e8, 1e9})
    off.push_back((end_at(arms(stiff, "true", "damping_time = 1e-3\n"), 6, 0.005) - rigid).norm());
  INFO(off[0] << " " << off[1] << " " << off[2] << " " << off[3]);
  // Damped, so that the wave of the sudden load dies out: its phase goes by no rule.
  for (std::size_t i = 0; i + 1 < off.size(); ++i) {
    CHECK(off[i] / off[i + 1] > 5);
    CHECK(off[i] / off[i + 1] < 20);
  }
  // Forces of 20 N stretch 0.88 m by 18 / EA.
  CHECK(off[1] < 1e-5);
}

// Loops, redundant guides and all, far from the deployed pose: positions differ by strains, which are
// 1 / EA, down to the round-off of lengths and of 120 steps.
TEST_CASE("elastic rods: a ring of units moves as the rigid one up to 1 / EA, to 1e13 newtons") {
  const auto end_of_ring = [](double EA) {
    std::string scene = "[structure]\nkind = 'hoop'\nfold_angle = 60\n";
    if (EA > 0)
      scene += "rod_model = 'elastic'\ndamping_time = 1e-3\nyoungs_modulus = " + number(EA / 9e-4) + "\n";
    return end_at(scene + "[solver]\nend_time = 0.6\n", 4, 0.005);
  };
  const VectorXd rigid = end_of_ring(0);
  const double at_9 = (end_of_ring(1e9) - rigid).norm(), at_11 = (end_of_ring(1e11) - rigid).norm(),
               at_13 = (end_of_ring(1e13) - rigid).norm();
  INFO(at_9 << " " << at_11 << " " << at_13);
  CHECK(at_9 > 1e-7);
  CHECK(at_9 / at_11 == Approx(100).epsilon(0.02));
  CHECK(at_13 <= 1.5e-4 * at_9 + 1e-11);
}

TEST_CASE("elastic rods: forces of a rod that no step resolves are those of a rigid one") {
  const Simulation rigid = run_scene(arms(1e9, "false"), {"solver.stages=5", "solver.step=0.0025"});
  const Diagnostics d = diagnose(rigid);
  for (const double stiff : {1e7, 1e9, 1e11, 1e13, 1e15}) {
    // Damped, so that the wave of the sudden load dies out.
    const Simulation run =
        run_scene(arms(stiff, "true", "damping_time = 1e-4\n"), {"solver.stages=5", "solver.step=0.0025"});
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics e = diagnose(run);
    REQUIRE(e.axial_force.rows() >= d.axial_force.rows());
    const double most = d.axial_force.col(1).lpNorm<Eigen::Infinity>();
    // The rod that gives, and the rigid one that it hangs on.
    for (const Index rod : {1, 0}) {
      INFO("EA = " << stiff << ", rod " << rod);
      CHECK(e.axial_force(e.axial_force.rows() - 1, rod) ==
            Approx(d.axial_force(d.axial_force.rows() - 1, rod)).epsilon(0).margin(1e-3 * most));
    }
  }
}

TEST_CASE("elastic rods: energy stays bounded over 10^5 steps, at any stiffness") {
  for (const double stiff : {90.0, 1e5}) {
    const auto model = model_of(arms(stiff));
    SolverOptions options;
    options.stages = 2;
    const double h = 0.01 * std::sqrt(90 / stiff);
    State state = initial_state(model->structure, model->system).state;
    const auto method = find_method("dvm")->make(model->system, options);
    VectorXd q(model->system.coordinates());
    const auto energy = [&] {
      model->system.expand(state.z, q);
      return model->system.kinetic_energy(state.w) + model->system.potential_energy(q);
    };
    const double start = energy();
    double early = 0, late = 0;
    for (int i = 0; i < 100000; ++i) {
      REQUIRE(method->step(state, h).ok());
      const double off = std::abs(energy() - start);
      (i < 10000 ? early : late) = std::max(i < 10000 ? early : late, off);
    }
    INFO("EA = " << stiff << ": " << early << " J, then " << late << " J");
    CHECK(late <= 4 * early);  // a drift would make ten times as much of it
  }
}

TEST_CASE("elastic rods: dvm is symplectic and symmetric with them") {
  // Two masses on two elastic rods, no rigid row: canonical coordinates z and p = M w.
  const std::string scene = "[structure]\nkind = 'custom'\nyoungs_modulus = 6e5\nrod_model = 'elastic'\n" +
                            node("O", "[0.2, -0.1, 0.4]", "fixed = true") +
                            node("A", "[0.9, 0.3, 0.1]", "velocity = [0.3, 0.9, 0.4]\nmass = 0.8") +
                            node("B", "[1.3, -0.2, -0.5]", "velocity = [-0.5, 0.4, 1.1]\nmass = 1.3") +
                            rod("O", "A", "mass = 0.9\narea = 2e-4") +
                            rod("A", "B", "mass = 0.6\narea = 2e-4") +
                            "[gravity]\nacceleration = [0.3, -1, -9]\n";
  const auto model = model_of(scene);
  const MatrixXd M(model->system.mass());
  const Index n = M.rows();
  REQUIRE(model->system.constraints() == 0);
  const State start = initial_state(model->structure, model->system).state;
  VectorXd x0(2 * n);
  x0 << start.z, M * start.w;
  for (const int stages : {2, 3, 4}) {
    SolverOptions options;
    options.stages = stages;
    const auto after = [&](const VectorXd& x, const std::vector<double>& steps) {
      const auto method = find_method("dvm")->make(model->system, options);
      State state = start;
      state.z = x.head(n);
      state.w = Cholesky(M).solve(VectorXd(x.tail(n)));
      for (const double h : steps) {
        method->restart();
        REQUIRE(method->step(state, h).ok());
      }
      VectorXd y(2 * n);
      y << state.z, M * state.w;
      return y;
    };
    MatrixXd J(2 * n, 2 * n), omega = MatrixXd::Zero(2 * n, 2 * n);
    omega.topRightCorner(n, n).setIdentity();
    omega.bottomLeftCorner(n, n) = -MatrixXd::Identity(n, n);
    const double e = 1e-5;
    for (Index i = 0; i < 2 * n; ++i) {
      VectorXd there = x0, back = x0;
      there[i] += e, back[i] -= e;
      J.col(i) = (after(there, {0.04}) - after(back, {0.04})) / (2 * e);
    }
    INFO(stages << " stages");
    // Central differences: e^2 times a third derivative of order 100, round-off 1e-15 / e.
    CHECK((J.transpose() * omega * J - omega).lpNorm<Eigen::Infinity>() < 1e-7);
    CHECK((after(x0, {0.04, -0.04}) - x0).lpNorm<Eigen::Infinity>() < 1e-13);
  }
}

TEST_CASE("elastic rods: a rod twice in place of one of twice the area, at half the force") {
  const std::string single = arms(5e4);
  std::string thick = single, twice = single;
  thick.replace(thick.find("area = 2e-4"), 11, "area = 4e-4");
  twice.insert(twice.find("[gravity]"), rod("A", "B",
                                            "name = 'again'\nmass = 0\narea = 2e-4\nyoungs_modulus = " +
                                                number(5e4 / 2e-4) + "\nelastic = true"));
  const Simulation a = run_scene(thick), b = run_scene(twice);
  const Diagnostics da = diagnose(a), db = diagnose(b);
  REQUIRE(a.trajectory.size() == b.trajectory.size());
  // Round-off of 100 steps; forces E A eps / l = 5e-12 N of it each.
  for (std::size_t i = 0; i < a.trajectory.size(); ++i)
    CHECK((a.trajectory.node_positions(i) - b.trajectory.node_positions(i)).lpNorm<Eigen::Infinity>() <=
          1e-12);
  const double most = da.axial_force.col(1).lpNorm<Eigen::Infinity>();
  for (const Index r : {1, 2})
    CHECK((2 * db.axial_force.col(r) - da.axial_force.col(1)).lpNorm<Eigen::Infinity>() <= 1e-7 * most);
  CHECK(db.rod_unique == std::vector<char>(3, 1));
}

TEST_CASE("elastic rods: the shallow truss of two bars snaps at its limit load") {
  // Half span 1, rise 0.25, E A = 1; the apex is pushed down and the load read off the drive. Its mass takes
  // 1e-13 kg times 6 m/s^2.
  const std::string scene =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 1e4\nrod_model = 'elastic'\n" +
      node("L", "[-1, 0, 0]", "fixed = true") + node("R", "[1, 0, 0]", "fixed = true") +
      node("top", "[0, 0.25, 0]", "mass = 1e-13") + rod("L", "top", "mass = 0\narea = 1e-4") +
      rod("R", "top", "mass = 0\narea = 1e-4") +
      "[[constraints]]\nkind = 'line'\nnodes = ['top']\ndirection = [0, 1, 0]\n"
      "[[constraints]]\nkind = 'coordinate'\nname = 'push'\nnodes = ['top']\ndirection = [0, 1, 0]\n"
      "motion = 'smooth'\nto = 0.05\nduration = 1\n[solver]\nstep = 4e-4\nend_time = 0.7\n";
  const Diagnostics d = diagnose(run_scene(scene));
  const std::vector<double>&height = d.at("push.value_m").values, &force = d.at("push.force_N").values;
  std::size_t top = 1;
  for (std::size_t i = 1; i + 1 < force.size(); ++i)
    if (std::abs(force[i]) > std::abs(force[top])) top = i;
  // The parabola through three states about the peak; heights 1.5e-4 apart leave 1e-12 of the third order.
  const double x0 = height[top - 1], x1 = height[top], x2 = height[top + 1];
  const double f0 = std::abs(force[top - 1]), f1 = std::abs(force[top]), f2 = std::abs(force[top + 1]);
  const double s01 = (f1 - f0) / (x1 - x0), s12 = (f2 - f1) / (x2 - x1), c = (s12 - s01) / (x2 - x0);
  const double at = 0.5 * (x0 + x1) - s01 / (2 * c), peak = f0 + (at - x0) * (s01 + c * (at - x1));
  CHECK(peak == Approx(0.005659141161730162).epsilon(1e-9));
  CHECK(at == Approx(0.1428767842560051).epsilon(0).margin(1e-6));  // flat there: sqrt of the force's digits
}

TEST_CASE("elastic rods: SSNL105, the forces of a square of bars and cables come to rest at the published") {
  // Published for small displacements: free lengths l / (1 + N / E A) put the deformed nodes on the square. A
  // blow, and damping until nothing of it is left; the cable 2-4 is slack.
  const double EA = 2e7, wanted[] = {0, 0, -1000, 0, 1000 * std::sqrt(2.0)};
  std::string text =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 2e11\nrod_model = 'elastic'\n"
      "damping_time = 2e-4\n" +
      node("1", "[0, 0, 0]", "fixed = true") + node("2", "[0, 1, 0]", "mass = 1") +
      node("3", "[1, 1, 0]", "mass = 1\nvelocity = [0.03, -0.05, 0]") + node("4", "[1, 0, 0]", "mass = 1");
  int r = 0;
  for (const char* name : {"12", "23", "34", "41", "13"}) {
    const double l = r == 4 ? std::sqrt(2.0) : 1.0;
    text += rod(std::string(1, name[0]), std::string(1, name[1]),
                "mass = 0\narea = 1e-4\nfree_length = " + number(l / (1 + wanted[r++] / EA)));
  }
  text +=
      "[[forces]]\nkind = 'spring'\nnodes = ['2', '4']\nstiffness = 1.4e7\ntension_only = true\n"
      "free_length = 1.4145\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['2', '3', '4']\nnormal = [0, 0, 1]\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['4']\nnormal = [0, 1, 0]\n"
      "[[loads]]\nnodes = ['3']\nforce = [1000, 0, 0]\n[solver]\nstep = 1e-4\nend_time = 0.1\n";
  const Simulation run = run_scene(text);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  CHECK(d.axial_force.col(2).maxCoeff() > -980);  // it did move
  for (r = 0; r < 5; ++r) CHECK(std::abs(d.axial_force(d.axial_force.rows() - 1, r) - wanted[r]) < 1e-6);
}

TEST_CASE("elastic rods: a free rod rings down at its damping ratio") {
  // Two equal masses and a heavy rod: the lengths as a damped oscillator. The ratio is that of the rod alone,
  // w^2 = 12 k / m; with masses M at its ends w^2 = 2 k / (M + m / 6), of damping time T ratio w T / 2.
  const double E = 2e6, A = 1e-4, l = 0.8, m = 0.6, M = 0.9, ratio = 0.03, stretch = 0.02;
  const std::string scene =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 2e6\nrod_model = 'elastic'\ndamping_ratio = 0.03\n" +
      node("A", "[0.1, 0.2, 0]", "mass = 0.9") + node("B", "[0.9, 0.2, 0]", "mass = 0.9") +
      rod("A", "B", "mass = 0.6\narea = 1e-4\nfree_length = " + number(l - stretch)) +
      "[solver]\nstages = 5\nstep = 0.01\nend_time = 0.7\n";
  const double k0 = E * A / (l - stretch), T = 2 * ratio / std::sqrt(12 * k0 / m);
  const double w = std::sqrt(2 * k0 / (M + m / 6)), zeta = w * T / 2, wd = w * std::sqrt(1 - zeta * zeta),
               t = 0.7;
  const VectorXd q = end_at(scene, 5, 0.01);
  const double wanted =
      stretch * std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t));
  CHECK(q[3] - q[0] - (l - stretch) == Approx(wanted).epsilon(0).margin(1e-8));
}

TEST_CASE("elastic rods: the fastest period, and what is said of a step beyond it") {
  const auto model = model_of(oscillator());
  const State start = initial_state(model->structure, model->system).state;
  const double period = 2 * pi * std::sqrt(mass / stiffness);
  CHECK(fastest_elastic_period(*model, start) == Approx(period).epsilon(1e-6));
  SolverOptions options;
  options.step = 0.2 * period;
  CHECK(elastic_step_warning(*model, start, options).empty());
  options.step = 0.3 * period;
  const std::string said = elastic_step_warning(*model, start, options);
  for (const char* part : {"the step of 0.1", "period, 0.56", "solver.step", "damping_ratio", "quasi-static"})
    CHECK_THAT(said, Catch::Contains(part));
  CHECK(said.find("four stages") == std::string::npos);  // nothing is spoiled yet
  options.step = 1.3 * period;
  CHECK_THAT(elastic_step_warning(*model, start, options), Catch::Contains("solver.stages = 4"));
  options.stages = 4;
  CHECK(elastic_step_warning(*model, start, options).find("stages") == std::string::npos);
  const Simulation run = run_scene(oscillator(), {"solver.step=" + number(0.3 * period)});
  CHECK(std::count(run.warnings.begin(), run.warnings.end(), said) == 1);
}

TEST_CASE("elastic rods: what cannot be is refused, once and by its key") {
  const std::string good = arms(90);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return error_of(text);
  };
  const std::string first = "mass = 0.9\n[[structure.rods]]";
  CHECK(with(first, "mass = 0.9\nelastic = true\n[[structure.rods]]").find("rods[0].area: an elastic rod") !=
        std::string::npos);
  CHECK_THAT(with("area = 2e-4", "area = 0"), Catch::Contains("rods[1].area"));
  CHECK_THAT(with("kind = 'custom'\n", "kind = 'custom'\nrod_model = 'soft'\n"),
             Catch::Contains("structure.rod_model"));
  CHECK_THAT(with("kind = 'custom'\n", "kind = 'custom'\ndamping_ratio = 0.1\ndamping_time = 0.1\n"),
             Catch::Contains("damping_ratio or damping_time, not both"));
  CHECK_THAT(with("kind = 'custom'\n", "kind = 'custom'\ndamping_time = -0.1\n"),
             Catch::Contains("structure.damping_time"));
  CHECK_THAT(with("elastic = true", "free_length = 0.9"), Catch::Contains("is for elastic rods"));
  CHECK_THAT(error_of("[structure]\nkind = 'hoop'\nrod_model = 'elastic'\n"),
             Catch::Contains("structure.youngs_modulus") && Catch::Contains("rod_model = \"elastic\" needs"));
}

// n_a N_a + n_b N_b = f and n_i . u = N_i l_i / (E A_i), n_i from the support to C: two equations each.
TEST_CASE("quasi-static rods: two bars under a load give by N l / EA") {
  const Simulation run = run_scene(truss);
  REQUIRE(run.status == RunStatus::completed);
  const std::size_t last = run.trajectory.size() - 1;
  const double la = 1.3, lb = 2.0;  // (0.5, 1.2) and (1.6, 1.2)
  Eigen::Matrix2d n;                // columns n_a, n_b in x and z
  n << 0.5 / la, -1.6 / lb, -1.2 / la, -1.2 / lb;
  const Eigen::Vector2d force = n.inverse() * Eigen::Vector2d(700, -1900);
  const Eigen::Vector2d stretch(force[0] * la / (7e10 * 3e-5), force[1] * lb / (7e10 * 5e-5));
  const Eigen::Vector2d u = n.transpose().inverse() * stretch;
  REQUIRE(u.norm() > 1e-3);
  const VectorXd shown = run.trajectory.positions(last);
  // Round-off of coordinates of a metre; the multipliers' is 1e-16 of 1e3 N.
  CHECK(shown[6] - 0.5 == Approx(u[0]).epsilon(0).margin(1e-14));
  CHECK(shown[8] + 1.2 == Approx(u[1]).epsilon(0).margin(1e-14));
  CHECK(shown.head<6>() == run.trajectory.positions(0).head<6>());
  CHECK(run.trajectory.node_positions(last)[6] ==
        Approx(0.5).epsilon(0).margin(1e-15));  // the motion stays rigid
}

// Ring, loads and rods have the symmetry of five, so do the displacements; they pass the bundle, where all
// bars stand upright, smoothly. States whose round-off is 1e-8 of the forces or less are off by some 1e-7 of
// a displacement (1e-5 at 6e-7, falling with the power 5/3).
TEST_CASE("quasi-static rods: a ring that passes its bundle keeps its symmetry") {
  const std::vector<std::string> ring{"structure.units=5",
                                      "structure.chord_rod_length=2",
                                      "structure.post_length=1",
                                      "structure.fold_angle=40",
                                      "structure.hinge_force=500",
                                      "structure.section_area=4e-4",
                                      "structure.youngs_modulus=1e9",
                                      "solver.stages=4",
                                      "solver.step=0.0005",
                                      "solver.end_time=0.33",
                                      "solver.at_deployed=pass",
                                      "structure.rod_model=rigid"};
  auto quasi = ring;
  quasi.back() = "structure.rod_model=quasi-static";
  const auto run = [](const std::vector<std::string>& changes) {
    const Scene scene = read_scene_file(find_scene("hoop6"), changes);
    return simulate(build_model(scene), scene.solver);
  };
  const Simulation rigid = run(ring), stretched = run(quasi);
  REQUIRE(stretched.trajectory.size() == rigid.trajectory.size());
  const auto& nodes = stretched.trajectory.structure().nodes;
  double before = 0;
  for (std::size_t i = 0; i < stretched.trajectory.size(); ++i) {
    const VectorXd u = stretched.trajectory.positions(i) - rigid.trajectory.positions(i);
    double least = 1e9, most = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (nodes[k].name.starts_with("B")) {
        const double size = u.segment<3>(3 * static_cast<Index>(k)).norm();
        least = std::min(least, size), most = std::max(most, size);
      }
    INFO(stretched.trajectory.time(i));
    REQUIRE(most < 1e9);
    CHECK(most - least < 1e-6 * most);
    // By the bundle, which is passed at 0.318 s, it is smallest, and even.
    if (stretched.trajectory.time(i) > 0.3) CHECK(std::abs(most - before) < 1e-3 * most);
    before = most;
  }
}

TEST_CASE("quasi-static rods: a bar that is pushed shortens by F l / EA") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
rod_model = "quasi-static"
youngs_modulus = 2.1e11
nodes = [{name = "O", position = [0.2, 0, 0], fixed = true}, {name = "A", position = [1.9, 0, 0], mass = 3}]
rods = [{nodes = ["O", "A"], mass = 0.6, area = 2e-5}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[loads]]
nodes = ["A"]
force = [-830, 0, 0]
[solver]
step = 0.1
end_time = 0.2
)");
  REQUIRE(run.status == RunStatus::completed);
  const double x = run.trajectory.positions(run.trajectory.size() - 1)[3];
  CHECK(1.9 - x == Approx(830 * 1.7 / (2.1e11 * 2e-5)).epsilon(0).margin(1e-14));
}

}  // namespace elastic_rods_test
