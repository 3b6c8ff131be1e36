// SPDX-License-Identifier: BSD-3-Clause
// Rods that give, of any stiffness: the axial force an unknown of the step, the compliance in the matrix.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "core/scene/library.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace stiff_rods_test {

namespace {

std::string node(const std::string& name, const Vec3& at, const Vec3& velocity, double mass) {
  std::ostringstream text;
  text.precision(17);
  text << "[[structure.nodes]]\nname = '" << name << "'\nposition = [" << at[0] << ", " << at[1] << ", "
       << at[2] << "]\n";
  if (mass > 0)
    text << "mass = " << mass << "\nvelocity = [" << velocity[0] << ", " << velocity[1] << ", " << velocity[2]
         << "]\n";
  else
    text << "fixed = true\n";
  return text.str();
}

// E A [N]; 0: rigid.
std::string rod(const std::string& a, const std::string& b, double stiff, const std::string& more = "") {
  std::string text = "[[structure.rods]]\nname = '" + a + b + "'\nnodes = ['" + a + "', '" + b + "']\n" +
                     (more.empty() ? "mass = 0.6\n" : more) + "area = 2e-4\n";
  if (stiff > 0) text += "elastic = true\nyoungs_modulus = " + number(stiff / 2e-4) + "\n";
  return text;
}

// Three masses on three rods in space, moving as if the rods were rigid, so that only loads make waves.
std::string chain(double first, double second, double third, double damping_time = 0) {
  const Vec3 x[] = {{0.2, -0.1, 0.4}, {0.9, 0.3, 0.1}, {1.3, -0.2, -0.5}, {1.8, 0.4, -0.4}};
  const Vec3 turn[] = {{0.3, 0.9, 1.4}, {-1.2, 0.4, 0.7}, {0.8, -0.9, 1.1}};
  std::string text = "[structure]\nkind = 'custom'\ndamping_time = " + number(damping_time) + "\n" +
                     node("O", x[0], Vec3::Zero(), 0);
  Vec3 v = Vec3::Zero();
  const char* names[] = {"A", "B", "C"};
  const double masses[] = {0.8, 1.3, 0.5};
  for (int i = 0; i < 3; ++i) {
    v += turn[i].cross(x[i + 1] - x[i]);
    text += node(names[i], x[i + 1], v, masses[i]);
  }
  return text + rod("O", "A", first) + rod("A", "B", second) + rod("B", "C", third) +
         "[gravity]\nacceleration = [0.3, -1, -9]\n[solver]\nend_time = 0.4\n";
}

// A statically indeterminate plane truss on a pinned and a sliding support, that turns about the pinned one:
// two bays with all diagonals, 11 rods for the 7 motions that it has but one.
std::string truss(double stiff, double damping_time) {
  const Vec3 x[] = {{0, 0, 0}, {1.1, 0, 0.1}, {2.3, 0, 0}, {0.1, 0, 0.9}, {1.2, 0, 1.1}, {2.2, 0, 1}};
  std::string text = "[structure]\nkind = 'custom'\ndamping_time = " + number(damping_time) +
                     (stiff > 0 ? "\nrod_model = 'elastic'" : "") +
                     "\nyoungs_modulus = " + number(stiff > 0 ? stiff / 2e-4 : 7e10) + "\n";
  const char* names[] = {"a", "b", "c", "d", "e", "f"};
  for (int i = 0; i < 6; ++i) text += node(names[i], x[i], Vec3(0, 0.7, 0).cross(x[i]), i == 0 ? 0 : 0.7);
  for (const char* ends : {"ab", "bc", "de", "ef", "ad", "be", "cf", "ae", "bd", "bf", "ce"})
    text += "[[structure.rods]]\nname = '" + std::string(ends) + "'\nnodes = ['" + ends[0] + "', '" +
            ends[1] + "']\nmass = 0.3\narea = 2e-4\n";
  return text +
         "[[structure.constraints]]\nkind = 'plane'\nnodes = ['b', 'c', 'd', 'e', 'f']\nnormal = [0, 1, 0]\n"
         "[[loads]]\nnodes = ['f']\nforce = [30, 0, -70]\n[gravity]\nacceleration = [0, 0, -9.81]\n"
         "[solver]\nend_time = 0.3\n";
}

std::vector<std::string> solved(int stages, double step) {
  return {"solver.stages=" + std::to_string(stages), "solver.step=" + number(step)};
}

Simulation completed(const std::string& scene, int stages, double step) {
  Simulation run = run_scene(scene, solved(stages, step));
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  return run;
}

// The largest difference of forces of two runs at their last state, of the largest force.
double force_error(const Simulation& a, const Simulation& b) {
  const Diagnostics da = diagnose(a), db = diagnose(b);
  const VectorXd x = da.axial_force.row(da.axial_force.rows() - 1),
                 y = db.axial_force.row(db.axial_force.rows() - 1);
  return (x - y).lpNorm<Eigen::Infinity>() / y.lpNorm<Eigen::Infinity>();
}

}  // namespace

TEST_CASE("stiff rods: steps converge alike for E A from 1e2 to 1e15 N, and with both in one structure") {
  const double EA[][3] = {{1e2, 1e2, 1e2},    {1e5, 1e5, 1e5},    {1e8, 1e8, 1e8},  {1e11, 1e11, 1e11},
                          {1e13, 1e13, 1e13}, {1e15, 1e15, 1e15}, {1e3, 1e15, 1e3}, {1e15, 1e3, 1e11},
                          {0, 1e15, 1e3},     {1e13, 0, 1e15}};
  for (const int s : {2, 3, 4, 5})
    for (const auto& k : EA) {
      const Simulation run = completed(chain(k[0], k[1], k[2]), s, 0.01);
      INFO(s << " stages, " << k[0] << " " << k[1] << " " << k[2]);
      CHECK(run.steps == 40);  // none was taken in parts
      // One matrix serves while an iteration gains a digit, and then three may look for what round-off
      // leaves.
      CHECK(run.newton_iterations <= 11 * run.steps);
    }
}

TEST_CASE("stiff rods: the stiffer, the nearer to rigid ones by 1 / EA, down to round-off") {
  const double settled = 1e-3;  // damped, so that nothing of a wave's phase is left
  for (const int s : {4, 5}) {
    const VectorXd rigid = end_positions(completed(chain(0, 0, 0), 6, 0.0025));
    std::vector<double> off;
    for (const double EA : {1e7, 1e9, 1e11})
      off.push_back((end_positions(completed(chain(EA, EA, EA, settled), s, 0.0025)) - rigid).norm());
    INFO(s << " stages: " << off[0] << " " << off[1] << " " << off[2]);
    CHECK(off[0] < 1e-4);
    CHECK(off[0] / off[1] == Approx(100).epsilon(0.05));
    CHECK(off[1] / off[2] == Approx(100).epsilon(0.2));
    // What h = 0.0025 s leaves of a method whose steps do not follow the rods.
    for (const double EA : {1e13, 1e15}) {
      const double left = (end_positions(completed(chain(EA, EA, EA, settled), s, 0.0025)) - rigid).norm();
      INFO(left);
      CHECK(left < (s == 4 ? 5e-10 : 5e-11));
    }
  }
}

TEST_CASE("stiff rods: three stages tend to a limit of their own, by 1 / EA") {
  const auto end = [](double EA) { return end_positions(completed(chain(EA, EA, EA, 1e-3), 3, 0.0025)); };
  const VectorXd limit = end(1e16);
  const double at_9 = (end(1e9) - limit).norm(), at_11 = (end(1e11) - limit).norm(),
               at_13 = (end(1e13) - limit).norm();
  INFO(at_9 << " " << at_11 << " " << at_13);
  CHECK(at_9 / at_11 == Approx(100).epsilon(0.1));
  CHECK(at_11 / at_13 == Approx(100).epsilon(0.3));
}

TEST_CASE("stiff rods: where waves have died out their forces are those of rigid ones") {
  for (const int s : {4, 5}) {
    const Simulation rigid = completed(chain(0, 0, 0), s, 0.0025);
    for (const double EA : {1e11, 1e13, 1e15}) {
      INFO(s << " stages, EA = " << EA);
      CHECK(force_error(completed(chain(EA, EA, EA, 1e-3), s, 0.0025), rigid) < 1e-4);
      // Rigid ones beside them, too; and without damping, where the start makes hardly any.
      CHECK(force_error(completed(chain(0, EA, 0, 1e-3), s, 0.0025), rigid) < 5e-4);
      CHECK(force_error(completed(chain(EA, EA, EA), s, 0.0025), rigid) < 1e-3);
    }
  }
}

// Two and three stages have their own order there, 2 and 4, and forces at states that go with it. Lengths
// that were not held would be 1e-5 m off: 1e5 J.
TEST_CASE("stiff rods: forces and energies of two and three stages are those of the motion") {
  const Simulation rigid = completed(chain(0, 0, 0), 5, 0.0025);
  for (const int s : {2, 3})
    for (const double EA : {1e11, 1e13, 1e15}) {
      INFO(s << " stages, EA = " << EA);
      const Simulation run = completed(chain(EA, EA, EA), s, 0.0025);
      CHECK(force_error(run, rigid) < (s == 2 ? 1e-3 : 3e-8));
      CHECK(force_error(run, rigid) / force_error(completed(chain(EA, EA, EA), s, 0.005), rigid) < 0.4);
      // Some 20 J turn over; the method's own error, of order 2.
      CHECK(largest(diagnose(run), "energy_balance_J") < 0.02);
    }
}

TEST_CASE("stiff rods: a truss with more rods than it needs shares forces as rigid ones with a modulus do") {
  const Simulation rigid = completed(truss(0, 0), 4, 0.0025);
  for (const double EA : {1e9, 1e11, 1e13, 1e15}) {
    INFO("EA = " << EA);
    const Simulation run = completed(truss(EA, 1e-3), 4, 0.0025);
    // Self-stress is told by lengths alone: their round-off, some 4e-16 m, times E A / l.
    const double most = diagnose(rigid).axial_force.bottomRows(1).lpNorm<Eigen::Infinity>();
    INFO(force_error(run, rigid) << " of " << most << " N, "
                                 << (end_positions(run) - end_positions(rigid)).norm());
    CHECK(force_error(run, rigid) < 1e-4 + 3e6 / EA + 2e-15 * EA / most);
    // The load turns a truss that gives by forces / E A a little less.
    CHECK((end_positions(run) - end_positions(rigid)).norm() < 1e-10 + 1e3 / EA);
  }
}

TEST_CASE("stiff rods: the energy of waves that no step follows stays bounded") {
  struct Case {
    double EA;
    int stages;
    double allowed;  // [J], of some 20 that turn over
  };
  // Where nothing held the rods' rates at ends, 1e13 N would make 1e5 J of it and more. Even numbers of
  // stages are symmetric, and of the order of their points, 4 and 6 with three and five: 5 J times (0.02)^4
  // and so on, turns in a step. Where lengths were held in their motion, too, four would drift like three.
  for (const auto& [EA, stages, allowed] : {Case{1e8, 4, 1e-5}, Case{1e13, 3, 4e-3}, Case{1e13, 4, 5e-6},
                                            Case{1e13, 5, 5e-7}, Case{1e13, 6, 2e-9}}) {
    const auto model = model_of(chain(0, EA, EA));
    SolverOptions options;
    options.stages = stages;
    State state = initial_state(model->structure, model->system).state;
    const auto method = find_method("dvm")->make(model->system, options);
    VectorXd q(model->system.coordinates());
    const auto energy = [&] {
      model->system.expand(state.z, q);
      return model->system.kinetic_energy(state.w) + model->system.potential_energy(q);
    };
    const double start = energy();
    double most = 0;
    for (int i = 0; i < 4000; ++i) {
      REQUIRE(method->step(state, 0.004).ok());
      most = std::max(most, std::abs(energy() - start));
    }
    INFO("EA = " << EA << ", " << stages << " stages: " << most << " J");
    CHECK(most < allowed);
  }
}

TEST_CASE("stiff rods: a run back returns") {
  for (const double EA : {1e3, 1e5, 1e7, 1e13})
    for (const int s : {3, 4, 5}) {
      const auto model = model_of(chain(EA, 0, EA));
      SolverOptions options;
      options.stages = s;
      const auto method = find_method("dvm")->make(model->system, options);
      const State start = initial_state(model->structure, model->system).state;
      State state = start;
      for (int i = 0; i < 20; ++i) REQUIRE(method->step(state, 0.01).ok());
      CHECK((state.z - start.z).norm() > 0.1);
      method->restart();
      for (int i = 0; i < 20; ++i) REQUIRE(method->step(state, -0.01).ok());
      INFO(s << " stages, EA = " << EA << ": " << (state.z - start.z).norm());
      // Round-off of 40 steps. Where velocities at ends are held, what that takes out of them, times the way
      // back: the method's own error at s = 4, h = 0.01, and no more.
      CHECK((state.z - start.z).norm() < (EA < 1e6 ? 1e-11 : s == 3 ? 1e-3 : 1e-6));
    }
}

TEST_CASE("stiff rods: what holds a bar that warms, fits badly or is drawn in is E A times its strain") {
  // Between two walls, with a mass in the middle: (a) each half of its own stiffness.
  const double l1 = 0.7, l2 = 1.1;
  const auto bar = [&](double EA, const std::string& first, const std::string& second,
                       const std::string& more) {
    return "[structure]\nkind = 'custom'\ndamping_time = 1e-3\n" + node("O", {0, 0, 0}, Vec3::Zero(), 0) +
           node("A", {l1, 0, 0}, Vec3::Zero(), 0.9) + node("B", {l1 + l2, 0, 0}, Vec3::Zero(), 0) +
           rod("O", "A", EA, "mass = 0.2\n" + first) + rod("A", "B", 3 * EA, "mass = 0.3\n" + second) +
           "[[structure.constraints]]\nkind = 'line'\nnodes = ['A']\ndirection = [1, 0, 0]\n" + more +
           "[solver]\nstages = 4\nstep = 0.01\nend_time = 0.2\n";
  };
  for (const double EA : {1e9, 1e11, 1e13, 1e15}) {
    // Forces of 130 N whatever the stiffness: each rod is short by N l / E A, or the first by all of it.
    const double N = 130, e1 = N * l1 / EA, e2 = N * l2 / (3 * EA);
    INFO("EA = " << EA);
    // What is left of rates after cooling, damping_time times them; lengths' round-off times E A / l.
    const double told = 1e-4 * N + 1e-14 * EA;
    const Diagnostics pulled = diagnose(completed(
        bar(EA, "free_length = " + number(l1 - e1) + "\n", "free_length = " + number(l2 - e2) + "\n", ""), 4,
        0.01));
    const Diagnostics cold = diagnose(completed(
        bar(EA, "", "",
            "[[forces]]\nkind = 'temperature'\nrods = ['OA']\nexpansion = " + number((e1 + e2) / l1) +
                "\nchange = -1\ntimes = [0, 0.1, 0.2]\nvalues = [0, 0.8, 1]\n"),
        4, 0.01));
    for (const Diagnostics* d : {&pulled, &cold})
      for (const Index r : {0, 1}) CHECK(std::abs(d->axial_force(d->axial_force.rows() - 1, r) - N) < told);
  }
}

TEST_CASE("stiff rods: a drive puts e^2 / 2 C into a rod that it holds, and the books close") {
  const double l = 0.7, e = 1e-4;
  for (const int s : {2, 3, 4})
    for (const double EA : {1e7, 1e9, 1e11, 1e13}) {
      const Simulation run =
          completed("[structure]\nkind = 'custom'\n" + node("O", {0, 0, 0}, Vec3::Zero(), 0) +
                        node("A", {l, 0, 0}, Vec3::Zero(), 0.9) + rod("O", "A", EA) +
                        "[[structure.constraints]]\nkind = 'line'\nnodes = ['A']\ndirection = [1, 0, 0]\n"
                        "[[constraints]]\nkind = 'length'\nname = 'jack'\nnodes = ['O', 'A']\nmotion = "
                        "'smooth'\nto = " +
                        number(l + e) + "\nduration = 0.3\n[solver]\nend_time = 0.5\n",
                    s, 0.01);
      INFO(s << " stages, EA = " << EA);
      const double stored = 0.5 * e * e * EA / l;
      const Diagnostics d = diagnose(run);
      // Lengths are known to 1e-16 m of 1e-4 m.
      CHECK(d.at("drive_work_J").values.back() == Approx(stored).epsilon(1e-10));
      CHECK(d.at("potential_energy_J").values.back() == Approx(stored).epsilon(1e-10));
      CHECK(largest(d, "energy_balance_J") <= 1e-9 * stored);
    }
}

// The ring as a mechanism takes what rigid rods take; that of waves, and what starting up makes, goes with 1
// / EA. Lengths between states told the rods' forces before: 2e-5 to all of the work were missed.
TEST_CASE("stiff rods: a motor puts the same into a ring of rods that give as into one of rigid rods") {
  const auto work = [](const std::vector<std::string>& more, double& balance) {
    std::vector<std::string> changes = {"solver.end_time=1.2", "solver.stages=4"};
    changes.insert(changes.end(), more.begin(), more.end());
    const Scene scene = read_scene_file(find_scene("hoop6_motor"), changes);
    const Simulation run = simulate(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    balance = largest(d, "energy_balance_J");
    return d.at("drive_work_J").values.back();
  };
  double balance = 0;
  const double rigid = work({}, balance);
  CHECK(rigid > 100);
  for (const char* modulus : {"7e10", "7e12", "7e15"}) {
    INFO(modulus);
    const double given =
        work({"structure.rod_model='elastic'", std::string("structure.youngs_modulus=") + modulus}, balance);
    CHECK(given == Approx(rigid).epsilon(1e-5));
    CHECK(balance <= 1e-5 * rigid);
  }
}

}  // namespace stiff_rods_test
