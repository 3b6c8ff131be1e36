// SPDX-License-Identifier: BSD-3-Clause
// Angles go on counting from state to state: springs that are wound up over many turns, stops beyond half a
// turn.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/integrators/integrator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace angle_memory_test {

namespace {

using testing::run_scene;

constexpr double degree = radians_per_degree;

// A rod of 3 kg and 2 m, hinged at O, in the plane z = 0: its moment of inertia about O is m l^2 / 3 = 4 kg
// m^2. It starts at `start` degrees from the x axis and turns at `rate` rad/s.
std::string rod(double start, double rate, const std::string& rest) {
  const double x = 2 * std::cos(start * degree), y = 2 * std::sin(start * degree);
  std::ostringstream text;
  text.precision(17);
  text << "[structure]\nkind = \"custom\"\n"
          "[[structure.nodes]]\nname = \"O\"\nposition = [0, 0, 0]\nfixed = true\n"
          "[[structure.nodes]]\nname = \"P\"\nposition = [1, 0, 0]\nfixed = true\n"
          "[[structure.nodes]]\nname = \"A\"\nposition = ["
       << x << ", " << y << ", 0]\nvelocity = [" << -rate * y << ", " << rate * x
       << ", 0]\n"
          "[[structure.rods]]\nname = \"rod\"\nnodes = [\"O\", \"A\"]\nmass = 3\n"
          "[[constraints]]\nkind = \"plane\"\nnodes = [\"A\"]\nnormal = [0, 0, 1]\n"
       << rest;
  return text.str();
}

constexpr double inertia = 4;

std::string spring(double free_angle, double stiffness = 6.76) {
  std::ostringstream text;
  text << "[[forces]]\nkind = \"torsion_spring\"\nnodes = [\"P\", \"O\", \"A\"]\naxis = [0, 0, 1]\nstiffness "
          "= "
       << stiffness << "\nfree_angle = " << free_angle << "\n";
  return text.str();
}

std::string stop(const std::string& limits, double restitution) {
  return "[[constraints]]\nkind = \"angle_stop\"\nname = \"end\"\nnodes = [\"P\", \"O\", \"A\"]\naxis = [0, "
         "0, 1]\n" +
         limits + "restitution = " + std::to_string(restitution) + "\n";
}

// Where the rod must be, against where it is at the end [m].
double miss(const Simulation& run, double angle) {
  const Trajectory& t = run.trajectory;
  const VectorXd q = t.positions(t.size() - 1);
  return (q.segment<3>(6) - 2 * Vec3(std::cos(angle), std::sin(angle), 0)).norm();
}

}  // namespace

// phi'' = -(k / I) (phi - free), omega = sqrt(6.76 / 4) = 1.3 rad/s: phi = free + (start - free) cos + rate /
// omega sin.
TEST_CASE("a torsion spring is wound up over a thousand degrees and unwinds") {
  const double start = 25 * degree, free = 40 * degree, omega = 1.3, rate = 24;  // up to 1058 deg from free
  for (const Method& method : methods()) {
    INFO(method.name);
    const Simulation run = run_scene(rod(25, rate, spring(40)), {"solver.method=" + std::string(method.name),
                                                                 "solver.step=0.001", "solver.end_time=3.1"});
    REQUIRE(run.status == RunStatus::completed);
    const double t = 3.1,
                 angle = free + (start - free) * std::cos(omega * t) + rate / omega * std::sin(omega * t);
    // 0.024 rad a step. The second order method: h^2 rate^3 t / 12 of the turn's curvature, 4e-3 m; the
    // others have the fourth and more.
    CHECK(miss(run, angle) <= (method.name == "generalized_alpha" ? 2e-2 : 1e-5));
    const Diagnostics d = diagnose(run);
    const double energy = 0.5 * inertia * rate * rate;  // 1152 J
    CHECK(testing::largest(d, "energy_balance_J") <=
          (method.name == "generalized_alpha" ? 1e-2 * energy : 1e-6 * energy));
    // The spring's energy is that of all its turns, not of what is left of them.
    CHECK(testing::largest(d, "potential_energy_J") == Approx(energy).epsilon(1e-2));
  }
}

TEST_CASE("long steps and adaptive steps wind a spring up as well") {
  const double start = 25 * degree, free = 40 * degree, omega = 1.3, rate = 24, t = 3.1;
  const double angle = free + (start - free) * std::cos(omega * t) + rate / omega * std::sin(omega * t);
  // Up to 2.4 rad a step: eight stages; what they leave was measured by halving the step.
  const Simulation fast =
      run_scene(rod(25, rate, spring(40)), {"solver.stages=8", "solver.step=0.1", "solver.end_time=3.1"});
  REQUIRE(fast.status == RunStatus::completed);
  CHECK(miss(fast, angle) <= 1e-3);
  const Simulation adaptive =
      run_scene(rod(25, rate, spring(40)),
                {"solver.stages=5", "solver.adaptive=true", "solver.step=0.02", "solver.end_time=3.1"});
  REQUIRE(adaptive.status == RunStatus::completed);
  CHECK(miss(adaptive, angle) <= 1e-3);
}

TEST_CASE("free angles are what they say, not modulo a turn") {
  // From rest at 180 deg towards a free angle of 378 deg: the rod turns on, past it and back, amplitude 198
  // deg.
  const double free = 378 * degree, start = 180 * degree, omega = 1.3, t = 2.2;
  const Simulation run =
      run_scene(rod(180, 0, spring(378)), {"solver.stages=5", "solver.step=0.01", "solver.end_time=2.2"});
  REQUIRE(run.status == RunStatus::completed);
  CHECK(miss(run, free + (start - free) * std::cos(omega * t)) <= 1e-8);  // eighth order, 0.045 rad a step
}

TEST_CASE("angle stops act beyond half a turn, at their place and no other") {
  const double rate = 6;
  for (const double limit : {90.0, 200.0, 270.0, 400.0, 1000.0})
    for (const double restitution : {1.0, 0.6}) {
      INFO(limit << " deg, restitution " << restitution);
      const double hit = (limit - 20) * degree / rate, end = hit + 1.7;  // back by up to 584 deg
      std::ostringstream end_time;
      end_time.precision(17);
      end_time << "solver.end_time=" << end;
      const Simulation run =
          run_scene(rod(20, rate, stop("max = " + std::to_string(limit) + "\n", restitution)),
                    {"solver.stages=5", "solver.step=0.013", end_time.str()});
      REQUIRE(run.status == RunStatus::completed);
      REQUIRE(run.events.size() == 1);
      CHECK(run.events[0].name == "stop end");
      CHECK(run.events[0].t == Approx(hit).epsilon(1e-11));
      CHECK(run.events[0].energy_lost ==
            Approx(0.5 * inertia * rate * rate * (1 - restitution * restitution)).epsilon(0).margin(1e-9));
      CHECK(miss(run, limit * degree - restitution * rate * 1.7) <= 1e-7);  // eighth order, 0.08 rad a step
    }
}

TEST_CASE("between two stops more than a turn apart the rod goes to and fro") {
  // From 20 deg at 6 rad/s between -250 and 300 deg: hits after 280, then every 550 deg, ten times.
  const Simulation run = run_scene(rod(20, 6, stop("min = -250\nmax = 300\n", 1)),
                                   {"solver.stages=5", "solver.step=0.013", "solver.end_time=16"});
  REQUIRE(run.status == RunStatus::completed);
  const double way = 6 * 16 / degree;
  const auto hits = static_cast<std::size_t>((way - 280) / 550) + 1;
  REQUIRE(run.events.size() == hits);
  for (std::size_t i = 0; i < hits; ++i)
    CHECK(run.events[i].t == Approx((280 + 550 * static_cast<double>(i)) * degree / 6).epsilon(1e-9));
}

TEST_CASE("a stop beyond a turn holds and lets go where it stands") {
  // A load that turns with the rod would be simpler; a spring wound to 900 deg presses the rod on the stop at
  // 450.
  const Simulation run = run_scene(rod(20, 0, spring(900, 3) + stop("max = 450\n", 0)),
                                   {"solver.stages=5", "solver.step=0.01", "solver.end_time=4"});
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() == 1);
  CHECK(run.events[0].name == "rests on stop end");
  const double omega = std::sqrt(3.0 / 4);
  CHECK(run.events[0].t == Approx(std::acos((900 - 450.0) / (900 - 20.0)) / omega).epsilon(1e-8));
  CHECK(miss(run, 450 * degree) <= 1e-9);
  // The spring's energy is left: k/2 (450 deg)^2.
  CHECK(diagnose(run).at("potential_energy_J").values.back() ==
        Approx(1.5 * std::pow(450 * degree, 2)).epsilon(1e-9));
}

TEST_CASE("an angle that starts at 180 degrees is 180 degrees, however it is typed") {
  const std::string motor =
      "[[constraints]]\nkind = \"angle\"\nname = \"motor\"\nnodes = [\"P\", \"O\", \"A\"]\naxis = [0, 0, 1]\n"
      "motion = \"smooth\"\nto = 270\nduration = 1\n";
  for (const char* position : {"[-2, 0, 0]", "[-2, -0.0, 0]", "[-2, -1e-17, 0]", "[-2, 2.4e-16, 0]"}) {
    INFO(position);
    const Simulation run =
        run_scene(rod(180, 0, motor),
                  {"structure.nodes.A.position=" + std::string(position),
                   "structure.nodes.A.velocity=[0,0,0]", "solver.end_time=0.5", "solver.step=0.01"});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(miss(run, 225 * degree) <= 1e-9);  // half way, the short way
  }
}

TEST_CASE("tables may begin a whole number of turns away from where angles are counted") {
  for (const double turns : {0.0, -1.0, 2.0}) {
    const double from = 180 + 360 * turns;
    std::ostringstream motor;
    motor << "[[constraints]]\nkind = \"angle\"\nname = \"motor\"\nnodes = [\"P\", \"O\", \"A\"]\naxis = [0, "
             "0, 1]\n"
             "motion = \"table\"\ntimes = [0, 1, 2]\nvalues = ["
          << from << ", " << from + 30 << ", " << from + 700 << "]\n";
    const Simulation run = run_scene(rod(180, 0, motor.str()), {"solver.end_time=2", "solver.step=0.01"});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(miss(run, (from + 700) * degree) <= 1e-9);
  }
}

TEST_CASE("the fold angle counts on behind the deployed pose") {
  const Simulation run = run_scene(
      "[structure]\nkind = \"hoop\"\nmodel = \"sector\"\n[solver]\nstep = 0.01\nend_time = 14\nat_deployed = "
      "\"pass\"\n");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const auto &fold = d.at("fold_angle_rad").values, &rate = d.at("fold_rate_rad_s").values;
  // The trapezoidal rule on the rate: h^3 / 12 of its second derivative, at most 20 rad/s^3 or so, a step.
  double sum = fold.front();
  for (std::size_t i = 1; i < fold.size(); ++i) {
    sum += 0.5 * (d.t[i] - d.t[i - 1]) * (rate[i] + rate[i - 1]);
    CHECK(fold[i] == Approx(sum).epsilon(0).margin(1e-2));
  }
  CHECK(*std::min_element(fold.begin(), fold.end()) < -pi);
}

// What is held is let go by the torque of all turns: a load across the rod grows by 3.1 N/s from t = 3 s on,
// until it outweighs the spring, or with it what friction holds.
TEST_CASE("what rests bears the turns of the spring that pulls at it") {
  const double k = 1.3, omega = std::sqrt(k / inertia), rate = 6, slope = 3.1;
  const auto back = [&](double angle) {
    std::ostringstream text;
    text.precision(17);
    text << "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"A\"]\nforce = [" << std::sin(angle) << ", "
         << -std::cos(angle) << ", 0]\ntimes = [0, 3, 13]\nvalues = [0, 0, " << 10 * slope << "]\n";
    return text.str();
  };
  const auto last = [](const Simulation& run) {
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(!run.events.empty());
    return run.events.back();
  };
  // On a stop at 700 degrees, 300 short of the spring's free angle.
  const Simulation stopped =
      run_scene(rod(25, rate, spring(1000, k) + stop("max = 700\n", 0) + back(700 * degree)),
                {"solver.stages=5", "solver.step=0.02", "solver.end_time=5"});
  CHECK(last(stopped).name == "leaves stop end");
  CHECK(last(stopped).t == Approx(3 + k * 300 * degree / (2 * slope)).epsilon(1e-8));
  // By friction, where u = phi - free + 5 / k, which swings about zero, is largest: some 500 degrees.
  const double u = -15 * degree + 5 / k, far = std::hypot(u, rate / omega), wound = far - 5 / k;
  const Simulation stuck = run_scene(
      rod(25, rate,
          spring(40, k) + back(40 * degree + wound) +
              "[[forces]]\nkind = \"friction\"\nname = \"pin\"\nnodes = [\"P\", \"O\", \"A\"]\naxis = [0, "
              "0, 1]\nkinetic = 5\nstatic = 21\n"),
      {"solver.stages=5", "solver.step=0.02", "solver.end_time=6"});
  REQUIRE(stuck.events.size() == 2);
  CHECK(stuck.events[0].kind == "stick");
  CHECK(stuck.events[0].t == Approx(std::atan2(rate / omega, u) / omega).epsilon(1e-8));
  CHECK(last(stuck).kind == "slip");
  CHECK(last(stuck).t == Approx(3 + (21 - k * wound) / (2 * slope)).epsilon(1e-8));
}

}  // namespace angle_memory_test
