// SPDX-License-Identifier: BSD-3-Clause
// Forces that are stiffer than the step: springs, dampers, both, alone and in mechanisms.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace stiff_forces_test {

namespace {

constexpr double mass = 1.7, amplitude = 1e-3, h = 0.01;

// A mass on the x axis, its spring drawn out by the amplitude.
std::string oscillator(double h_omega, double damping = 0.0) {
  std::ostringstream text;
  text.precision(17);
  text << "[structure]\nkind = 'custom'\n"
          "[[structure.nodes]]\nname = 'O'\nposition = [-0.2, 0.3, 0.1]\nfixed = true\n"
          "[[structure.nodes]]\nname = 'A'\nposition = ["
       << 0.5 + amplitude << ", 0.3, 0.1]\nmass = " << mass
       << "\n[[constraints]]\nkind = 'line'\nnodes = ['A']\ndirection = [1, 0, 0]\n"
          "[[forces]]\nkind = 'spring'\nnodes = ['O', 'A']\nfree_length = 0.7\nstiffness = "
       << mass * std::pow(h_omega / h, 2) << "\ndamping = " << damping << "\n[solver]\nstep = " << h
       << "\nend_time = 1\n";
  return text.str();
}

// The energies of a model after each of `steps` steps, over that of the start; empty after a step that fails.
std::vector<double> energies(const std::string& scene, const SolverOptions& options, int steps) {
  const auto model = build_model(read_scene_text(scene, "test.toml"));
  State state = initial_state(model->structure, model->system).state;
  const auto method = find_method(options.method)->make(model->system, options);
  VectorXd q(model->system.coordinates());
  const auto energy = [&] {
    model->system.expand(state.z, q);
    return model->system.kinetic_energy(state.w) + model->system.potential_energy(q);
  };
  const double start = energy();
  std::vector<double> found;
  for (int i = 0; i < steps; ++i) {
    if (!method->step(state, h).ok()) return {};
    found.push_back(energy() / start);
  }
  return found;
}

struct Judged {
  Simulation run;
  Diagnostics d;
  std::vector<std::string> warnings;
};

Judged judged(const std::string& scene, const std::vector<std::string>& changes) {
  Judged j{run_scene(scene, changes), {}, {}};
  j.d = judge(j.run);
  j.warnings = accuracy_warnings(j.run, j.d);
  return j;
}

VectorXd end_of(const Simulation& run) {
  return run.trajectory.node_positions(run.trajectory.size() - 1);
}

}  // namespace

TEST_CASE("dvm keeps the energy of an oscillator of any frequency") {
  for (const int stages : {2, 3, 4, 5, 6, 8})
    for (const double h_omega : {0.1, 1.0, 3.3, 7.0, 11.0, 15.0, 22.0, 47.0, 100.0, 1e3, 1e4, 1e5, 1e6}) {
      const auto e = energies(oscillator(h_omega), dvm_options(stages, h, 1), 400);
      INFO("s = " << stages << ", h omega = " << h_omega);
      REQUIRE(e.size() == 400);
      // Gauss collocation keeps quadratic energies. A step ends within 30 * 4 ulp of h k x, that is 3e-14 m
      // of an amplitude of 1e-3 m; 400 of them add up to 1e-8, and to more
      // from h omega = 1e4 on, where tensions have lost digits of their own.
      for (const double share : e)
        REQUIRE(share == Approx(1.0).epsilon(0).margin(h_omega < 1e4 ? 1e-8 : 1e-6));
    }
}

TEST_CASE("dvm keeps its order with springs in a mechanism") {
  // A rod, a spring from its end, a mass on that: nothing is linear, the rod's row stays at the nodes.
  const std::string scene = R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "O"
position = [0.2, -0.1, 0.4]
fixed = true
[[structure.nodes]]
name = "A"
position = [0.9, 0.3, 0.1]
velocity = [0.3, 0.9, 0.4]
mass = 0.8
[[structure.nodes]]
name = "B"
position = [1.3, -0.2, -0.5]
velocity = [-0.5, 0.4, 1.1]
mass = 1.3
[[structure.rods]]
nodes = ["O", "A"]
mass = 0.9
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 130
free_length = 0.8
damping = 0.4
[gravity]
acceleration = [0.3, -1, -9]
[solver]
end_time = 0.8
)";
  const auto end = [&](int stages, double step) {
    return end_of(
        run_scene(scene, {"solver.stages=" + std::to_string(stages), "solver.step=" + number(step)}));
  };
  const VectorXd reference = end(7, 0.01);
  REQUIRE((end(7, 0.005) - reference).norm() <= 1e-12);
  for (const int stages : {2, 3, 4, 5}) {
    const double coarse = stages > 3 ? 0.08 : 0.02;
    const double order =
        std::log2((end(stages, coarse) - reference).norm() / (end(stages, coarse / 2) - reference).norm());
    INFO(stages << " stages");
    CHECK(order == Approx(2 * stages - 2).epsilon(0).margin(0.45));  // as in the orders of rigid mechanisms
  }
}

TEST_CASE("dvm and generalized_alpha damp an oscillator of any frequency, and add nothing") {
  // h c / m from far below to far above critical.
  for (const double h_omega : {0.3, 5.0, 100.0, 1e4})
    for (const double h_rate : {0.2, 5.0, 40.0, 1e3, 1e6}) {
      const std::string scene = oscillator(h_omega, mass * h_rate / h);
      for (const int stages : {2, 3, 4, 5}) {
        const auto e = energies(scene, dvm_options(stages, h, 1), 60);
        INFO("s = " << stages << ", h omega = " << h_omega << ", h c / m = " << h_rate);
        REQUIRE(e.size() == 60);
        for (const double share : e) REQUIRE(share <= 1 + 1e-8);  // Gauss collocation contracts
      }
      for (const double rho : {0.0, 0.6, 0.9}) {
        SolverOptions options;
        options.method = "generalized_alpha";
        options.rho_inf = rho;
        const auto e = energies(scene, options, 60);
        INFO("rho_inf = " << rho << ", h omega = " << h_omega << ", h c / m = " << h_rate);
        REQUIRE(e.size() == 60);
        for (const double share : e) REQUIRE(share <= 1.01);
      }
    }
}

TEST_CASE("generalized_alpha keeps or takes the energy of an oscillator of any frequency, as rho_inf says") {
  for (const double rho : {0.0, 0.3, 0.6, 0.9, 1.0})
    for (const double h_omega : {0.1, 1.0, 10.0, 100.0, 1e4, 1e6}) {
      SolverOptions options;
      options.method = "generalized_alpha";
      options.rho_inf = rho;
      const auto e = energies(oscillator(h_omega), options, 100);
      INFO("rho_inf = " << rho << ", h omega = " << h_omega);
      REQUIRE(e.size() == 100);
      // The recursion by hand (3 x 3, all rho_inf and h omega of the list): never above 1.004 of the start,
      // and where h omega >= 100 the rest of n steps is below n^4 rho_inf^(2 n).
      for (const double share : e) REQUIRE(share <= 1.005);
      if (rho == 1.0) CHECK(e.back() == Approx(1.0).epsilon(0).margin(1e-6));
      if (h_omega >= 100 && rho < 1) CHECK(e.back() <= 1e8 * std::pow(rho, 200) + 1e-20);
      if (h_omega > 1e4) continue;  // the rounding of k x alone is more than moves
      const auto j =
          judged(oscillator(h_omega), {"solver.method=generalized_alpha", "solver.rho_inf=" + number(rho)});
      CHECK(j.run.status == RunStatus::completed);  // damping that is meant is no failure
    }
}

TEST_CASE("what generalized_alpha loses is said, what it gains ends a run") {
  const std::vector<std::string> damped{"solver.method=generalized_alpha", "solver.rho_inf=0.5"};
  Judged j = judged(oscillator(30), damped);
  REQUIRE(j.run.status == RunStatus::completed);
  REQUIRE(j.warnings.size() == 1);
  CHECK(j.warnings[0].find("as solver.rho_inf means it to") != std::string::npos);
  // Half of what was lost comes back.
  for (Series& column : j.d.columns)
    if (column.name == "energy_balance_J") column.values.back() *= 0.5;
  CHECK(mistrust(j.run, j.d).find("energy balance is off") != std::string::npos);
}

TEST_CASE("drag of any size stops a mass where the exponential does, with its books in order") {
  const Vec3 x0(1.13, 0.2, -0.4), v0(7, -3, 2);
  for (const double c : {0.3, 30.0, 310.0, 450.0, 1e3, 3.1e3, 1e4, 1e6, 1e9, 3e10, 1e12, 1e15})
    for (const int stages : {2, 3, 4, 5}) {
      const auto j = judged(
          "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\n"
          "position = [1.13, 0.2, -0.4]\nvelocity = [7, -3, 2]\nmass = 1.3\n"
          "[[forces]]\nkind = 'drag'\nnodes = ['A']\ndamping = " +
              number(c) + "\n[solver]\nend_time = 0.3\n",
          {"solver.stages=" + std::to_string(stages)});
      INFO("c = " << c << " N s/m, " << stages << " stages: " << j.run.message);
      REQUIRE(j.run.status == RunStatus::completed);
      const double rate = c / 1.3, z = rate * h;
      const VectorXd q = end_of(j.run), v = j.run.trajectory.node_velocities(j.run.trajectory.size() - 1);
      // Decays up to h c / m = 1.5 by the order of the method, with Pade's constant ((s-1)!)^2 / ((2s-2)!
      // (2s-1)!) and 30 steps; beyond, the run begins with steps of h c / m = s / 5, some 50 of them.
      const double pade =
          std::pow(std::tgamma(stages), 2) / std::tgamma(2 * stages - 1) / std::tgamma(2 * stages);
      const double error = 50 * pade * std::pow(z < 1.5 ? z : 0.2 * stages, 2 * stages - 1);
      // From 1e9 on rates are gone within the shortest step, and the way with it.
      CHECK((q - x0 - v0 * (-std::expm1(-rate * 0.3) / rate)).norm() <=
            v0.norm() / rate * (c < 1e8 ? error : 3) + 1e-13);
      CHECK((v - v0 * std::exp(-rate * 0.3)).norm() <= v0.norm() * (z < 1.5 ? error : 1e-6) + 1e-12);
      if (stages > 2 && (z > 1.5 || z < 0.5)) CHECK(j.warnings == std::vector<std::string>{});
    }
}

// From rest and from a blow, a mass on a rod that drag of any size holds back: it creeps with m g / c, what
// it had is taken, and the books say so. h c / m to 1e13; what creeps moves by less than the rounding of
// coordinates.
TEST_CASE("a weight on a rod creeps through drag of any size, and its books close") {
  for (const double c : {1e6, 1e8, 1e9, 1e10, 1e11, 1e12, 1e15})
    for (const int stages : {3, 4, 5})
      for (const double speed : {0.0, 0.4}) {
        const auto j = judged(
            "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = "
            "true\n"
            "[[structure.nodes]]\nname = 'A'\nposition = [0.9, 0, 0]\nmass = 1.3\nvelocity = [0, " +
                number(0.7 * speed) + ", " + number(speed) +
                "]\n[[structure.rods]]\nnodes = ['O', 'A']\nmass = 0\n[gravity]\nacceleration = [0, 0, "
                "-9.8]\n"
                "[[forces]]\nkind = 'drag'\nnodes = ['A']\ndamping = " +
                number(c) + "\n[solver]\nend_time = 0.3\n",
            {"solver.stages=" + std::to_string(stages)});
        INFO("c = " << c << " N s/m, " << stages << " stages, from " << speed << " m/s: " << j.run.message);
        REQUIRE(j.run.status == RunStatus::completed);
        CHECK(j.warnings == std::vector<std::string>{});
        // Falls by g m / c t; the arc bends that by its square. Coordinates round at 1e-16, a step's
        // increment at 1e-4 of the smallest.
        // Falls by g m / c t; the arc bends that by its square. Coordinates round at 1e-16 m, rates at a
        // tenth of that over a step.
        const double creep = 1.3 * 9.8 / c;
        const VectorXd q = end_of(j.run), v = j.run.trajectory.node_velocities(j.run.trajectory.size() - 1);
        CHECK(q[5] == Approx(-creep * 0.3).epsilon(1e-4).margin(2e-16 + 3 * speed * 1.3 / c));
        CHECK(v[5] == Approx(-creep).epsilon(1e-4).margin(1e-15));
        CHECK(v.norm() == Approx(creep).epsilon(1e-4).margin(1e-15));
      }
}

TEST_CASE("dampers of very different strength, each with its own layer") {
  const auto j = judged(R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "A"
position = [1, 0.2, -0.4]
velocity = [7, -3, 2]
mass = 1.3
[[structure.nodes]]
name = "B"
position = [0, 0.2, 0.7]
velocity = [-2, 5, 3]
mass = 2.9
[[structure.nodes]]
name = "C"
position = [0, 1.2, 0]
velocity = [4, 1, -6]
mass = 0.7
[[forces]]
kind = "drag"
nodes = ["A"]
damping = 8e6
[[forces]]
kind = "drag"
nodes = ["B"]
damping = 2e4
[[forces]]
kind = "drag"
nodes = ["C"]
damping = 21
[solver]
stages = 4
end_time = 0.2
)",
                        {});
  REQUIRE(j.run.status == RunStatus::completed);
  CHECK(j.warnings == std::vector<std::string>{});
  const VectorXd q = end_of(j.run);
  CHECK((q.segment<3>(0) - Vec3(1, 0.2, -0.4) - Vec3(7, -3, 2) * 1.3 / 8e6).norm() <= 1e-9);
  CHECK((q.segment<3>(3) - Vec3(0, 0.2, 0.7) - Vec3(-2, 5, 3) * 2.9 / 2e4).norm() <= 1e-7);
  CHECK((q.segment<3>(6) - Vec3(0, 1.2, 0) - Vec3(4, 1, -6) * 0.7 / 21 * -std::expm1(-6.0)).norm() <= 1e-7);
}

TEST_CASE("a joint with enormous damping is a locked joint") {
  // The same arms with the angle at A held: they differ by what 1e7 N m s/rad give way under some 10 N m in
  // 0.5 s, 5e-7 rad.
  const std::string arms = R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "O"
position = [0.1, -0.2, 0.3]
fixed = true
[[structure.nodes]]
name = "A"
position = [0.73, 0.31, -0.17]
[[structure.nodes]]
name = "B"
position = [1.21, -0.14, -0.62]
mass = 0.37
[[structure.rods]]
nodes = ["O", "A"]
mass = 1.3
[[structure.rods]]
nodes = ["A", "B"]
mass = 0.7
[gravity]
acceleration = [0.7, -1.9, -9.1]
[solver]
end_time = 0.5
)";
  const Simulation locked =
      run_scene(arms + "[[constraints]]\nkind = 'angle'\nnodes = ['O', 'A', 'B']\n", {"solver.stages=6"});
  for (const int stages : {3, 4, 5}) {
    const auto j = judged(arms + "[[forces]]\nkind = 'joint_damping'\nnodes = ['A']\ndamping = 1e7\n",
                          {"solver.stages=" + std::to_string(stages)});
    INFO(stages << " stages: " << j.run.message);
    REQUIRE(j.run.status == RunStatus::completed);
    CHECK((end_of(j.run) - end_of(locked)).norm() <= 2e-6);
    // With three stages the rate of the joint carries on what each step leaves of it: a warning.
    if (stages > 3) CHECK(j.warnings == std::vector<std::string>{});
  }
}

TEST_CASE("a pendulum on a stiff spring is a pendulum on a rod") {
  const auto pendulum = [](const std::string& arm) {
    return "[structure]\nkind = 'custom'\n"
           "[[structure.nodes]]\nname = 'O'\nposition = [0.1, 0.2, -0.3]\nfixed = true\n"
           "[[structure.nodes]]\nname = 'A'\nposition = [0.7, -0.1, 0.4]\nvelocity = [0.5, 1, 0]\nmass = "
           "1.7\n" +
           arm + "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 1\n";
  };
  const Simulation rigid =
      run_scene(pendulum("[[structure.rods]]\nnodes = ['O', 'A']\nmass = 0\n"), {"solver.stages=7"});
  // The largest has h omega = 1e4 at steps of 0.01 s.
  for (const double k : {1e8, 1e10, 1e12, 1.7e12})
    for (const int stages : {4, 5, 6, 7, 8}) {
      const auto j =
          judged(pendulum("[[forces]]\nkind = 'spring'\nnodes = ['O', 'A']\nstiffness = " + number(k) + "\n"),
                 {"solver.stages=" + std::to_string(stages)});
      INFO("k = " << k << " N/m, " << stages << " stages: " << j.run.message);
      REQUIRE(j.run.status == RunStatus::completed);
      // It starts without the stretch m (g + v^2 / l) / k, which is at most 53 N / k at the 4.6 m/s of the
      // lowest point, and swings by that; speeds change by the same share over up to 4.6 m of way. At the
      // ends of steps a stretch shows by order s - 1 of the step, (0.04 rad)^(s-1) of 1 m. What a coordinate
      // is rounded by, u = 1.1e-16 m, is a force k u, which moves the end by (h omega)^2 u in a step; 100
      // steps add up to ten times that at random.
      const double rounding = 10 * 1.1e-16 * k * 1e-4 / 1.7;
      CHECK((end_of(j.run) - end_of(rigid)).norm() <= 300 / k + std::pow(0.04, stages - 1) + rounding);
    }
}

// Such steps never lose the rates that a damper takes, which change their sign instead: that is told by the
// balance, and no short steps are spent on it. Places are those of the creep all the same, m g / c of 1e-5
// m/s; what rings is h / 2 times a rate of twice that.
TEST_CASE("constraints at the ends of steps spend no short ones on stiff dampers") {
  constexpr double c = 1e6, creep = 1.3 * 9.8 / c;
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = 'A', "
      "position = [0.9, 0, 0], mass = 1.3}]\nrods = [{nodes = ['O', 'A'], mass = 0}]\n"
      "[gravity]\nacceleration = [0, 0, -9.8]\n[[forces]]\nkind = 'drag'\nnodes = ['A']\ndamping = " +
      number(c) + "\n[solver]\nconstraints_at = 'ends'\nstep = 0.01\nend_time = 0.3\n");
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.steps <= 31);
  CHECK(end_of(run)[5] == Approx(-creep * 0.3).epsilon(0).margin(0.01 * creep));
}

TEST_CASE("constraints at the ends of steps take stiff springs too") {
  // A rod and a second one behind it, or a spring of its length.
  const std::string arms = R"([structure]
kind = "custom"
nodes = [
  {name = "O", position = [0.1, -0.2, 0.3], fixed = true},
  {name = "A", position = [0.73, 0.31, -0.17], velocity = [0.4, 1.1, -0.6]},
  {name = "B", position = [1.21, -0.14, -0.62], velocity = [-0.3, 0.9, 1.3], mass = 0.37}]
[[structure.rods]]
nodes = ["O", "A"]
mass = 1.3
[gravity]
acceleration = [0.7, -1.9, -9.1]
[solver]
constraints_at = "ends"
end_time = 0.5
)";
  const Simulation rigid = run_scene(arms + "[[structure.rods]]\nnodes = ['A', 'B']\nmass = 0\n",
                                     {"solver.stages=7", "solver.constraints_at=nodes"});
  // h omega = 2000. (Within a step the rod leaves its length by order 2, and so does the spring at its ends:
  // of very stiff ones that is an energy which the balance of a run does not let pass.)
  constexpr double k = 1e10;
  for (const int stages : {3, 5}) {
    const auto error = [&](double step) {
      const Simulation run =
          run_scene(arms + "[[forces]]\nkind = 'spring'\nnodes = ['A', 'B']\nstiffness = " + number(k) + "\n",
                    {"solver.stages=" + std::to_string(stages), "solver.step=" + number(step)});
      INFO("k = " << k << " N/m, " << stages << " stages, h = " << step << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      return (end_of(run) - end_of(rigid)).norm();
    };
    // Order 2: (0.1 rad)^2 of 1 m, and less with a quarter of the step.
    const double coarse = error(0.01), fine = error(0.0025);
    INFO(k << " N/m: " << coarse << " m, " << fine << " m");
    CHECK(coarse <= 1e-2);
    CHECK(fine <= coarse / 2);
  }
}

// A tube of carbon cut in segments, its bending periods down to 1e-5 of the step, falls as a rigid rod does.
// Its weight bends it by less than w / (E I) with w = (m_tip / 3 + m_rod / 8) g L^3, twice as much as it sets
// out.
TEST_CASE("stiff rods that bend: those along an axis fall like all others") {
  const auto tip = [](const Vec3& at, const std::string& model) {
    const Simulation run = run_scene(
        "[structure]\nkind = 'custom'\nyoungs_modulus = 1.5e13\nsection = 'tube'\nwall_thickness = "
        "1.5e-3\nrod_model = '" +
            model +
            "'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [" +
            number(at[0]) + ", " + number(at[1]) + ", " + number(at[2]) +
            "], mass = 1}]\nrods = [{nodes = ['A', 'B'], density = 1600, area = "
            "4.64e-4}]\n[gravity]\nacceleration "
            "= [0, 0, -9.81]\n[solver]\nstages = 4\nstep = 0.01\nend_time = 0.6\n",
        {model == "rigid" ? "structure.segments=1" : "structure.segments=24"});
    CAPTURE(run.message);
    REQUIRE(run.status == RunStatus::completed);
    return Vec3(end_positions(run).segment<3>(3));
  };
  const double EI = 1.5e13 * 5.6e-7, bent = 9.81 * (1.0 / 3 + 0.74 / 8) / EI;
  for (const Vec3& at : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.48, 0.6, 0.64), Vec3(0.6, 0, 0.8)}) {
    INFO(at.transpose());
    CHECK((tip(at, "elastic") - tip(at, "rigid")).norm() < 3 * bent);
  }
}

}  // namespace stiff_forces_test
