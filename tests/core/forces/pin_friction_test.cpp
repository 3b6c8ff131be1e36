// SPDX-License-Identifier: BSD-3-Clause
// Dry friction of hinges by the force of their pins, against the closed form of a pendulum.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <vector>

#include "core/path/path.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pin_friction_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

// 1.3 kg on a rod of 0.8 m without mass, hung at P; B makes the angle with the vertical. mu r = 0.024 m.
const std::string pendulum = R"(
[structure]
kind = "custom"
nodes = [
  {name = "P", position = [0, 0, 0], fixed = true}, {name = "B", position = [0, 0, -1], fixed = true},
  {name = "A", position = [0.8, 0, 0], velocity = [0, 0, -0.5], mass = 1.3}]
rods = [{name = "arm", nodes = ["P", "A"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "friction"
name = "pin"
nodes = ["A", "P", "B"]
axis = [0, 1, 0]
kinetic = 0
pin_friction = 0.3
pin_radius = 0.08
[solver]
stages = 4
step = 0.005
end_time = 0.3
)";

const double length = 0.8, weight = 9.81 / length, arm = 0.024 / length;

// With th the angle from the vertical, N = m l (w^2 + (g / l) cos th) along the rod and tau / l across it,
// |F| = N / sqrt(1 - (mu r / l)^2), so that for u = w^2 and b = (mu r / l) / sqrt(1 - (mu r / l)^2)
//
//     du/dth + 2 s b u = -2 (g / l) (sin th + s b cos th),   s = sgn w
//
// is linear: u = C e^(-2 s b th) + P cos th + Q sin th.
double rate_squared(double th, double th_0, double u_0, double s) {
  const double b = s * arm / std::sqrt(1 - arm * arm);
  // -P sin + Q cos + 2 b (P cos + Q sin) = -2 (g/l) (sin + b cos)
  const double Q = -6 * weight * b / (1 + 4 * b * b), P = 2 * weight + 2 * b * Q;
  const auto particular = [&](double x) { return P * std::cos(x) + Q * std::sin(x); };
  return (u_0 - particular(th_0)) * std::exp(-2 * b * (th - th_0)) + particular(th);
}

double angle_of(const VectorXd& q) {
  return std::atan2(q[6], -q[8]);
}

}  // namespace

TEST_CASE("a pendulum whose pin rubs by its load moves as its closed form") {
  const Simulation run = run_scene(pendulum);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const std::size_t last = run.trajectory.size() - 1;
  const VectorXd q = end_positions(run), v = run.trajectory.node_velocities(last);
  const double th = angle_of(q), u = v.tail<3>().squaredNorm() / (length * length);
  REQUIRE(th < 1.2);  // it has moved
  // Order 6 of w h = 0.02, s = 4; without friction u differs by 2 b of it, some 5 %.
  CHECK(u == Approx(rate_squared(th, pi / 2, 0.25 / (length * length), -1)).epsilon(1e-10));
  const Diagnostics d = diagnose(run);
  CHECK(d.at("dissipated_J").values.back() > 0.05);
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-9);  // a quadrature of order 6
}

// F is then the rod's own, E A times its strain: the closed form but for strains of some N / EA, N up to
// m l (w^2 + g / l) = 29 newtons, in the length and in the wave that letting it go makes.
TEST_CASE("a pin on an elastic rod rubs by the rod's force, up to its strain") {
  for (const double EA : {1e5, 1e6}) {
    std::ostringstream rod;
    rod << "structure.rods=[{name='arm', nodes=['P', 'A'], mass=0, area=1e-4, elastic=true, youngs_modulus="
        << EA / 1e-4 << "}]";
    const Simulation run = run_scene(pendulum, {rod.str(), "solver.step=0.001"});
    INFO(run.message);
    REQUIRE(run.status == RunStatus::completed);
    const double th = angle_of(end_positions(run));
    const double u =
        run.trajectory.node_velocities(run.trajectory.size() - 1).tail<3>().squaredNorm() / (length * length);
    CHECK(u == Approx(rate_squared(th, pi / 2, 0.25 / (length * length), -1)).epsilon(3 * 29 / EA));
    CHECK(diagnose(run).at("dissipated_J").values.back() > 0.05);
  }
}

namespace {

// On a rod that gives, which starts at 2 m/s stretched as that keeps it, so that it begins without a wave.
std::vector<std::string> on_elastic_rod(double EA, double damping_time = 0) {
  const double pull = 1.3 * 4 / length;
  std::ostringstream rod;
  rod.precision(17);
  rod << "structure.rods=[{name='arm', nodes=['P', 'A'], mass=0, area=1e-4, elastic=true, youngs_modulus="
      << EA / 1e-4 << ", free_length=" << length / (1 + pull / EA) << "}]";
  return {rod.str(), "structure.nodes[2].velocity=[0,0,-2]",
          "structure.damping_time=" + std::to_string(damping_time)};
}

// Length r and angle th of the same, with N = EA (r - l_0) / l_0 > 0 and the friction by P's force on the
// rod, N along it and tau / r across, tau = mu r_pin |F| = mu r_pin N / sqrt(1 - (mu r_pin / r)^2), against
// th' < 0:
//
//     m (r'' - r th'^2) = m g cos th - N,     m (r^2 th'' + 2 r r' th') = -m g r sin th + tau
//
// by Runge and Kutta's steps of order 4. Returns r, th, r', th', and what tau has taken.
Eigen::Matrix<double, 5, 1> by_runge_kutta(double EA, double t, int steps) {
  using Y = Eigen::Matrix<double, 5, 1>;
  const double m = 1.3, g = 9.81, free = length / (1 + m * 4 / length / EA), mu_r = 0.024;
  const auto rate = [&](const Y& y) {
    const double r = y[0], N = EA * (r - free) / free,
                 tau = mu_r * std::abs(N) / std::sqrt(1 - mu_r * mu_r / (r * r));
    Y f;
    f << y[2], y[3], r * y[3] * y[3] + g * std::cos(y[1]) - N / m,
        (-m * g * r * std::sin(y[1]) + tau) / (m * r * r) - 2 * y[2] * y[3] / r, tau * std::abs(y[3]);
    return f;
  };
  Y y;
  y << length, pi / 2, 0, -2 / length, 0;
  const double h = t / steps;
  for (int i = 0; i < steps; ++i) {
    const Y a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b), d = rate(y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

}  // namespace

TEST_CASE("a pin on an elastic rod of moderate stiffness moves as an independent integration has it") {
  for (const double EA : {2e4, 2e5}) {
    const auto exact = by_runge_kutta(EA, 0.3, 60000);
    // Steps of 1/20 of the wave's period, s = 4.
    auto changes = on_elastic_rod(EA);
    changes.push_back(EA < 1e5 ? "solver.step=0.002" : "solver.step=0.0006");
    const Simulation run = run_scene(pendulum, changes);
    INFO(EA << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    const VectorXd q = end_positions(run), v = run.trajectory.node_velocities(run.trajectory.size() - 1);
    CHECK(q.tail<3>().norm() == Approx(exact[0]).epsilon(1e-9));
    CHECK(angle_of(q) == Approx(exact[1]).epsilon(0).margin(1e-8));
    CHECK(v.tail<3>().norm() == Approx(std::hypot(exact[2], exact[0] * exact[3])).epsilon(1e-8));
    const Diagnostics d = diagnose(run);
    CHECK(d.at("dissipated_J").values.back() == Approx(exact[4]).epsilon(1e-7));
    CHECK(testing::largest(d, "energy_balance_J") <= 1e-7);
  }
}

// Steps do not follow the wave from 1e8 N on: the pin's force then is the step's own unknown.
TEST_CASE("a pin on a rod that hardly gives rubs as on a rigid one, by 1 / EA") {
  const std::vector<std::string> steps = {"solver.step=0.0025"};
  const Simulation rigid = run_scene(pendulum, {"structure.nodes[2].velocity=[0,0,-2]", steps[0]});
  REQUIRE(rigid.status == RunStatus::completed);
  const double th = angle_of(end_positions(rigid)), taken = diagnose(rigid).at("dissipated_J").values.back();
  const double u = rigid.trajectory.node_velocities(rigid.trajectory.size() - 1).tail<3>().squaredNorm() /
                   (length * length);
  CHECK(u == Approx(rate_squared(th, pi / 2, 4 / (length * length), -1)).epsilon(1e-10));
  std::vector<double> off;
  for (const double EA : {1e6, 1e8, 1e10, 1e12}) {
    auto changes = on_elastic_rod(EA, 1e-3);
    changes.push_back(steps[0]);
    const Simulation run = run_scene(pendulum, changes);
    INFO("EA = " << EA << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    off.push_back((end_positions(run) - end_positions(rigid)).norm());
    INFO(off.back());
    // Of 41 N in the rod at most: that share of its length, and of the rest. Beside it what steps of 2.5 ms
    // leave of the rod's own motion where its damper settles, an eighth of it at half the step.
    CHECK(off.back() < 1e-8 + 100 / EA);
    const Diagnostics d = diagnose(run);
    CHECK(d.at("dissipated_J").values.back() == Approx(taken).epsilon(1e-5 + 100 / EA));
    CHECK(testing::largest(d, "energy_balance_J") <= 1e-5 * taken + 100 / EA);
  }
  CHECK(off[0] / off[1] == Approx(100).epsilon(0.1));
}

// A rod that is short for its pin, mu r = 0.6 l: the torque's answer to N is most of what steers the step.
TEST_CASE("steps with strong friction by a stiff rod's force converge") {
  for (const double EA : {1e6, 1e10, 1e14}) {
    auto changes = on_elastic_rod(EA);
    changes.insert(changes.end(), {"forces[0].pin_friction=6", "solver.end_time=0.05"});
    const Simulation run = run_scene(pendulum, changes);
    INFO("EA = " << EA << ": " << run.message);
    CHECK(run.status == RunStatus::completed);
    CHECK(run.newton_iterations <= 15 * run.steps);
  }
}

// Turning points by the closed form, one after the other, until the pin holds the weight: at rest F = m g, so
// within |sin th| <= mu r / l.
TEST_CASE("a pin that rubs by its load turns a pendulum round and stops it where the closed form says") {
  const Simulation run = run_scene(pendulum, {"solver.end_time=60", "structure.nodes[2].velocity=[0,0,0]"});
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  double th = pi / 2, s = -1;
  std::size_t turns = 0;
  for (const Event& event : run.events) {
    if (event.kind == "slip") continue;
    CHECK(event.element == "pin");
    // The next zero of u: by bisection between the lowest pose and where it came from.
    double inside = 0, outside = s * std::abs(th) * 1.001;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (inside + outside);
      (rate_squared(middle, th, 0, s) > 0 ? inside : outside) = middle;
    }
    if (rate_squared(0, th, 0, s) <= 0) break;  // it does not come so far: the last half swing
    th = inside;
    CHECK(angle_of(run.trajectory.positions_at(event.t)) == Approx(th).epsilon(0).margin(1e-7));
    s = -s;
    ++turns;
  }
  CHECK(turns > 10);
  CHECK(run.events.back().kind == "stick");
  const std::size_t last = run.trajectory.size() - 1;
  CHECK(std::abs(std::sin(angle_of(run.trajectory.positions(last)))) <= arm);
  CHECK(run.trajectory.node_velocities(last).norm() <= 1e-12);
}

TEST_CASE("friction by a pin's force where there is no such force is refused with one clear error") {
  CHECK(error_of(pendulum, {"forces[0].pin_radius=0"}).find("forces[0].pin_radius: is missing") !=
        std::string::npos);
  CHECK(error_of(pendulum, {"forces[0].nodes=[\"B\",\"P\",\"A\"]"}).find("with a rod from A to HINGE") !=
        std::string::npos);
  const Scene path = read_scene_text(pendulum, "s.toml", {"solver.model=path"});
  CHECK_THROWS_WITH(simulate_as_asked(build_model(path), path.solver),
                    Catch::Contains("friction depends on the force of a pin"));
  // A node without mass that two constraints together hold, wherever it stands in the list.
  for (const std::string name : {"A0", "Z"}) {
    const std::string three =
        R"({name="P",position=[0,0,0],fixed=true},{name="B",position=[0,0,-1],fixed=true},)"
        R"({name="A",position=[0.8,0,0],mass=1.3})";
    const std::string held = "{name='" + name + "',position=[3,0,0]}";
    CHECK(error_of(pendulum,
                   {"structure.nodes=[" + (name == "Z" ? three + "," + held : held + "," + three) + "]",
                    "constraints=[{kind='line',nodes=['" + name +
                        "'],direction=[1,0,0]},{kind='plane',nodes=['" + name + "'],normal=[1,0,0]}]"})
              .find("needs nodes with mass, and '" + name + "' has none") != std::string::npos);
  }
  // A second rod beside the first: neither force is determined.
  const std::string twin =
      "structure.rods=[{name=\"arm\",nodes=[\"P\",\"A\"],mass=0},"
      "{name=\"twin\",nodes=[\"A\",\"P\"],mass=0}]";
  CHECK(error_of(pendulum, {twin}).find("which rigid rods leave open here ('arm'") != std::string::npos);
}

// With three stages the friction of this rod came to 0.59 J in place of 0.78 J, its energy balance in order.
TEST_CASE("friction by a rod's force with stages that do not tell it is refused before the run") {
  auto changes = on_elastic_rod(1e10);
  changes.emplace_back("solver.stages=3");
  const std::string said = error_of(pendulum, changes);
  // 2 pi sqrt(m l / E A)
  for (const char* part :
       {"forces[0].pin_friction", "rod arm", "6.41e-05 s", "solver.stages must be at least 4"})
    CHECK_THAT(said, Catch::Contains(part));
  changes.emplace_back("solver.step=6e-5");
  CHECK(error_of(pendulum, changes) == "");
}

// A coarse tolerance of positions is met by two or three stages too, whose steps do not tell the friction.
TEST_CASE("a tolerance takes no fewer than four stages for friction by the force of an elastic rod") {
  auto changes = on_elastic_rod(1e10);
  changes.emplace_back("solver.tolerance=1e-3");
  const Scene scene = read_scene_text(pendulum, "s.toml", changes);
  const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.options.stages >= 4);
}

// A torque tau turns the rod of mass m with M at its end by I = m l^2 / 3 + M l^2 about P, which bears
// (m / 2 + M) l tau / I of it: mu r must be below l (m / 3 + M) / (m / 2 + M), without mass below l.
TEST_CASE("a pin whose friction locks it is refused before the run, with the rod and what is allowed") {
  const auto with = [&](double mu, const std::string& more = "") {
    return error_of(pendulum,
                    {"forces[0].pin_friction=" + std::to_string(mu), more.empty() ? "title=''" : more});
  };
  CHECK(with(9.9) == "");  // mu r = 0.792 m
  const std::string said = with(10.1);
  for (const char* part : {"forces[0].pin_friction", "0.808 m", "below 0.8 m", "rod arm of 0.8 m", "kinetic"})
    CHECK_THAT(said, Catch::Contains(part));
  // 0.8 m (0.2 + 1.3) / (0.3 + 1.3) = 0.75 m
  CHECK(with(9.3, "structure.rods[0].mass=0.6") == "");
  CHECK_THAT(with(9.4, "structure.rods[0].mass=0.6"), Catch::Contains("below 0.75 m"));
}

}  // namespace pin_friction_test
