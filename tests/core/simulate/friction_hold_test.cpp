// SPDX-License-Identifier: BSD-3-Clause
// Frictions that can only move together hold together: statically indeterminate, but what they bear is not.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/simulate/friction_hold.hpp"
#include "core/simulate/stepper.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace friction_hold_test {

namespace {

using testing::end_positions, testing::number, testing::run_scene;

// By duality, the least sum tau_j |a_j . u| / |l . u| of all u; it is reached where u is normal to as many
// generators a_j as leave one direction.
double most_by_normals(const MatrixXd& A, const VectorXd& l, const VectorXd& tau) {
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const VectorXd& u) {
    if (std::abs(l.dot(u)) > 1e-12 * l.norm() * u.norm())
      least = std::min(least, (A.transpose() * u).cwiseAbs().dot(tau) / std::abs(l.dot(u)));
  };
  for (Index i = 0; i < A.cols(); ++i) {
    if (A.rows() == 1) look(VectorXd::Ones(1));
    if (A.rows() == 2) look(Eigen::Vector2d(-A(1, i), A(0, i)));
    for (Index j = 0; A.rows() == 3 && j < i; ++j) look(Vec3(A.col(i)).cross(Vec3(A.col(j))));
  }
  return least;
}

// A chain of links between two supports, in the plane y = 0, with a friction in every hinge, that of the
// supports too, and loads that grow with time.
struct Chain {
  std::vector<Eigen::Vector2d> nodes;  // x, z
  std::vector<double> holding, kinetic;
  std::vector<Eigen::Vector2d> load;  // on the inner nodes [N/s]

  std::string scene(bool with_axis) const {
    const auto n = nodes.size();
    std::string text = "[structure]\nkind = \"custom\"\n";
    const auto name = [](std::size_t i) { return "\"n" + std::to_string(i) + "\""; };
    const auto vec = [](const Eigen::Vector2d& x) {
      return "[" + std::to_string(x[0]) + ", 0, " + std::to_string(x[1]) + "]\n";
    };
    for (std::size_t i = 0; i < n; ++i)
      text += "[[structure.nodes]]\nname = " + name(i) + "\nposition = " + vec(nodes[i]) +
              (i == 0 || i + 1 == n ? "fixed = true\n" : "mass = 1.3\n");
    for (std::size_t i = 0; i + 1 < n; ++i)
      text += "[[structure.rods]]\nnodes = [" + name(i) + ", " + name(i + 1) + "]\nmass = 0.4\n";
    text += "[[structure.constraints]]\nkind = \"plane\"\nnodes = [\"n*\"]\nnormal = [0, 1, 0]\n";
    for (std::size_t i = 0; i < n; ++i)
      text += "[[forces]]\nkind = \"friction\"\nnodes = [" + name((i + n - 1) % n) + ", " + name(i) + ", " +
              name((i + 1) % n) + "]\nkinetic = " + std::to_string(kinetic[i]) +
              "\nstatic = " + std::to_string(holding[i]) + (with_axis ? "\naxis = [0, 1, 0]\n" : "\n");
    for (std::size_t i = 1; i + 1 < n; ++i)
      text += "[[forces]]\nkind = \"load_over_time\"\nnodes = [" + name(i) +
              "]\nforce = " + vec(load[i - 1]) + "times = [0, 2]\nvalues = [0, 2]\n";
    return text + "[solver]\nstages = 4\nstep = 0.002\nend_time = 2\n";
  }

  // It moves once the loads' power exceeds what the frictions take, for some rates omega of the links that
  // keep the loop closed: each hinge turns at the difference of its links' rates.
  double slips_at() const {
    const auto links = static_cast<Index>(nodes.size()) - 1, hinges = links + 1;
    MatrixXd closed(2, links), turns = MatrixXd::Zero(hinges, links);
    VectorXd power = VectorXd::Zero(links), tau(hinges);
    for (Index i = 0; i < links; ++i) {
      const Eigen::Vector2d d = nodes[static_cast<std::size_t>(i) + 1] - nodes[static_cast<std::size_t>(i)];
      closed.col(i) << -d[1], d[0];
      turns(i, i) = 1;
      turns(i + 1, i) = -1;
      for (Index k = i; k + 1 < links; ++k) power[i] += load[static_cast<std::size_t>(k)].dot(closed.col(i));
    }
    for (Index i = 0; i < hinges; ++i) tau[i] = holding[static_cast<std::size_t>(i)];
    const MatrixXd free = closed.fullPivLu().kernel();
    return most_by_normals((turns * free).transpose(), free.transpose() * power, tau);
  }
};

std::vector<Event> slips(const Simulation& run) {
  std::vector<Event> out;
  for (const Event& event : run.events)
    if (event.kind == "slip") out.push_back(event);
  return out;
}

const Chain four_bar{{{0, 0}, {0.2, 0.7}, {1.3, 0.9}, {1.1, 0}},
                     {1.0, 0.9, 1.2, 0.8},
                     {0.5, 0.4, 0.3, 0.6},
                     {{10, 3}, {-1, 2}}};
const Chain five_bar{{{0, 0}, {0.25, 0.75}, {0.8, 1.05}, {1.35, 0.6}, {1.2, 0}},
                     {0.7, 1.1, 0.9, 0.6, 1.3},
                     {0.7, 0.6, 0.9, 0.2, 0.8},
                     {{4, -3}, {-2, 7}, {5, 1}}};

}  // namespace

TEST_CASE("what frictions bear together is what duality says") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> any(-1, 1), some(0.1, 2);
  for (int trial = 0; trial < 60; ++trial) {
    const Index rows = 1 + trial % 3, resting = trial % 5;
    MatrixXd c(resting, rows), A(rows, rows + resting);
    VectorXd l(rows), tau(rows + resting);
    for (double& x : c.reshaped()) x = any(random);
    for (double& x : l) x = any(random);
    for (double& x : tau) x = some(random);
    A << MatrixXd::Identity(rows, rows), c.transpose();
    const auto holds = friction_holds(c, l, tau.head(rows), tau.tail(resting));
    INFO(rows << " held, " << resting << " resting");
    if (resting == 0) {
      REQUIRE(std::ssize(holds) == rows);
      for (const FrictionHold& hold : holds) CHECK(hold.capacity == tau[hold.held.front()]);
      continue;
    }
    REQUIRE(holds.size() == 1);
    CHECK(holds[0].load == l.lpNorm<Eigen::Infinity>());
    // The nearest x leaves 1e-11 of the load.
    CHECK(holds[0].capacity / holds[0].load == Approx(most_by_normals(A, l, tau)).epsilon(1e-10));
  }
  // Two that have nothing to do with one another, each with a helper: c = diag.
  const MatrixXd apart = (MatrixXd(2, 2) << -0.5, 0, 0, 2).finished();
  const auto holds =
      friction_holds(apart, Eigen::Vector2d(1, 3), Eigen::Vector2d(1, 2), Eigen::Vector2d(4, 8));
  REQUIRE(holds.size() == 2);
  CHECK(holds[0].capacity == 1 + 0.5 * 4);
  CHECK(holds[1].capacity == 2 + 2 * 8);
}

// A body of friction 2 N, pushed with 1.5 N onto another one of friction 3 N that a load of 1.3 N pushes on:
// t (1.5, 1.3) = (x_0 - N, x_1 + N), N >= 0, hence 2.8 t <= 5. Without a load: what friction bears.
TEST_CASE("frictions bear through a stop that rests by them what they could not alone") {
  const double inf = std::numeric_limits<double>::infinity();
  const MatrixXd c = (MatrixXd(1, 2) << 1, -1).finished();
  const Eigen::Vector2d tau(2, 3);
  const auto load = [&](double first, double second) {
    const auto holds = friction_holds(c, Eigen::Vector2d(first, second), tau, VectorXd::Constant(1, inf));
    REQUIRE(holds.size() == 1);
    return holds[0];
  };
  CHECK(load(1.5, 1.3).capacity / load(1.5, 1.3).load == Approx(5 / 2.8));
  CHECK(load(-1.5, -1.3).capacity / load(-1.5, -1.3).load == Approx(2 / 1.5));  // no stop can pull
  CHECK(load(0, 0).capacity == Approx(5));
  CHECK(load(0, 0).load == 0);
}

TEST_CASE("linkages with a friction in every hinge move when all of them together give way") {
  for (const Chain* chain : {&four_bar, &five_bar})
    for (const char* method : {"dvm", "rk4"})
      for (const bool with_axis : {true, false}) {
        const double exact = chain->slips_at();
        const Simulation run = run_scene(
            chain->scene(with_axis),
            {std::string("solver.method=") + method, "solver.end_time=" + std::to_string(exact + 0.01)});
        INFO(chain->nodes.size() << " hinges, " << method << ", slips at " << exact << "; " << run.message);
        REQUIRE(run.status == RunStatus::completed);
        CHECK(run.warnings.empty());
        const auto first = slips(run);
        REQUIRE(!first.empty());
        // At rest until then; the margin is zero within 1e-10 of the largest multiplier.
        CHECK(first[0].t == Approx(exact).epsilon(1e-8));
        if (chain == &four_bar) CHECK(first.size() == 4);
      }
}

TEST_CASE("frictions of a loop stick, slip and turn round as every method says") {
  for (const Chain* chain : {&four_bar, &five_bar}) {
    // Up, back, and nothing: it comes to rest.
    Chain loaded = *chain;
    std::string scene = loaded.scene(true);
    for (std::size_t at = 0; (at = scene.find("times = [0, 2]\nvalues = [0, 2]", at)) != std::string::npos;
         ++at)
      scene.replace(at, 30, "times = [0, 0.9, 1.5, 2]\nvalues = [0, 1, -0.8, 0]");
    const Simulation run = run_scene(scene, {"solver.end_time=3", "solver.stages=5"});
    const Simulation by_rk4 =
        run_scene(scene, {"solver.end_time=3", "solver.method=rk4", "solver.step=0.0005"});
    for (const Simulation* r : {&run, &by_rk4}) {
      INFO(r->message);
      REQUIRE(r->status == RunStatus::completed);
      CHECK(r->warnings.empty());
      CHECK(r->trajectory.state(r->trajectory.size() - 1).w.norm() <= 1e-9);
    }
    CHECK(run.events.size() == by_rk4.events.size());
    // rk4 with turns of some 10 rad/s in steps of 0.5 ms: 0.005^4 a radian, over some.
    CHECK((end_positions(run) - end_positions(by_rk4)).lpNorm<Eigen::Infinity>() <= 1e-7);
    CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-7);
  }
}

// Nothing acts but friction, in every hinge: the accelerations at rest are squares of what rounding leaves of
// the rates, unlike in each hinge of the one freedom, and no force is needed to hold it.
TEST_CASE("linkages that nothing drives come to rest by the friction of their hinges and stay there") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 30; ++k) {
    Chain linkage = k % 3 < 2 ? four_bar : five_bar;
    for (double* x : {&linkage.nodes[1][0], &linkage.nodes[1][1], &linkage.nodes[2][0], &linkage.nodes[2][1]})
      *x += 0.2 * uniform(random);
    for (double& tau : linkage.kinetic) tau = 0.2 + uniform(random);
    linkage.holding = linkage.kinetic;
    for (Eigen::Vector2d& load : linkage.load) load.setZero();
    const double vx = 0.3 + uniform(random), vz = uniform(random);
    const Simulation run = run_scene(
        linkage.scene(k % 2 == 0),
        {"structure.nodes.n1.velocity=[" + number(vx) + ", 0, " + number(vz) + "]", "solver.step=0.01"});
    INFO(k << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    CHECK(d.at("kinetic_energy_J").values.front() > 1e-4);
    CHECK(d.at("kinetic_energy_J").values.back() == 0);
    CHECK(d.axial_force.row(d.axial_force.rows() - 1).lpNorm<Eigen::Infinity>() == 0);
  }
}

TEST_CASE("friction on an angle without a sign goes on through straight rods") {
  // The load straightens the first two links; the same angle with an axis has a sign and nothing happens
  // there.
  const Chain pulled{{{0, 0}, {0.5, 0.62}, {1.3, 0.9}, {1.4, 0}},
                     {0.2, 0.3, 0.25, 0.15},
                     {0.2, 0.3, 0.25, 0.15},
                     {{2, 1}, {14, 2}}};
  const Simulation with = run_scene(pulled.scene(true), {"solver.end_time=1.2"}),
                   without = run_scene(pulled.scene(false), {"solver.end_time=1.2"});
  for (const Simulation* r : {&with, &without}) {
    INFO(r->message);
    REQUIRE(r->status == RunStatus::completed);
    CHECK(r->warnings.empty());
  }
  CHECK(std::ranges::count(without.events, "reversal", &Event::kind) >
        std::ranges::count(with.events, "reversal", &Event::kind));
  // Steps end at other times there: two errors of four stages.
  CHECK((end_positions(with) - end_positions(without)).lpNorm<Eigen::Infinity>() <= 1e-8);
  // What evaluates forces at the ends of steps, in line, too: (h w)^4 at some 10 rad/s.
  const Simulation by_rk4 =
      run_scene(pulled.scene(false), {"solver.end_time=1.2", "solver.method=rk4", "solver.step=0.0005"});
  REQUIRE(by_rk4.status == RunStatus::completed);
  CHECK((end_positions(by_rk4) - end_positions(with)).lpNorm<Eigen::Infinity>() <= 1e-8);
}

TEST_CASE("friction on an angle without a sign goes on through straight rods, whichever of them moves") {
  // 2 kg, a metre from B, turn at 3 rad/s against 1.5 N m from 0.5 rad before the line of AB through it.
  const std::string scene = R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "A"
position = [-1, 0, 0]
fixed = true
[[structure.nodes]]
name = "B"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "C"
position = [0.8775825618903728, 0, -0.479425538604203]
velocity = [1.438276615812609, 0, 2.632747685671118]
mass = 2
[[structure.rods]]
nodes = ["B", "C"]
mass = 0
[[structure.constraints]]
kind = "plane"
nodes = ["C"]
normal = [0, 1, 0]
[[forces]]
kind = "friction"
nodes = ["A", "B", "C"]
kinetic = 1.5
[solver]
stages = 4
step = 0.01
end_time = 1
)";
  for (const char* nodes : {R"(["A", "B", "C"])", R"(["C", "B", "A"])"}) {
    INFO(nodes);
    const Simulation run = run_scene(scene, {std::string("forces[0].nodes=") + nodes});
    INFO(run.message);
    REQUIRE(run.status == RunStatus::completed);
    // phi = -0.5 + 3 t - (1.5 / 2 kg m^2) t^2 / 2; four stages: far below 1e-9.
    const double turned = -0.5 + 3 - 0.375;
    const VectorXd end = end_positions(run);
    CHECK(std::atan2(end[8], end[6]) == Approx(turned).epsilon(0).margin(1e-9));
    REQUIRE(run.events.size() == 1);  // the angle grows again
    CHECK(run.events[0].kind == "reversal");
    CHECK(run.events[0].t == Approx((3 - std::sqrt(9 - 0.75)) / 0.75).epsilon(1e-9));
  }
}

}  // namespace friction_hold_test
