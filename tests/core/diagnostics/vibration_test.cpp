// SPDX-License-Identifier: BSD-3-Clause
// Frequencies at a pose against closed forms of the same rods.
#include "core/diagnostics/vibration.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "core/diagnostics/measures.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace vibration_test {

namespace {

Vibration at_start(const Scene& scene) {
  const auto model = build_model(scene);
  return vibration(*model, initial_state(model->structure, model->system).state);
}

Vibration of_text(const std::string& text) {
  return at_start(read_scene_text(text, "test.toml"));
}

std::vector<double> frequencies(const Vibration& v, bool mechanism) {
  std::vector<double> out;
  for (const VibrationMode& mode : v.modes)
    if (mode.mechanism == mechanism) out.push_back(mode.frequency);
  return out;
}

void check_close(const std::vector<double>& found, std::vector<double> squares, double tolerance) {
  std::sort(squares.begin(), squares.end());
  REQUIRE(found.size() == squares.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    CHECK(found[k] == Approx(std::sqrt(squares[k]) / (2 * pi)).epsilon(tolerance));
}

constexpr double E = 2.1e11, A = 1.3e-4, density = 7800;

// n rods in a row along x, one end fixed, all nodes in the plane z = 0; those of `on_axis` stay on the x
// axis.
std::string row_of_rods(int n, double l, const std::string& on_axis, double pull,
                        const std::string& modulus) {
  std::string text = "[structure]\nkind = 'custom'\n" + modulus;
  for (int i = 0; i <= n; ++i)
    text += "[[structure.nodes]]\nname = '" + std::to_string(i) + "'\nposition = [" + std::to_string(i * l) +
            ", 0, 0]\n" + (i == 0 ? "fixed = true\n" : "");
  for (int i = 0; i < n; ++i)
    text += "[[structure.rods]]\nnodes = ['" + std::to_string(i) + "', '" + std::to_string(i + 1) +
            "']\ndensity = " + std::to_string(density) + "\narea = 1.3e-4\n";
  for (int i = 1; i <= n; ++i)
    text += "[[structure.constraints]]\nkind = 'plane'\nnodes = ['" + std::to_string(i) +
            "']\nnormal = [0, 0, 1]\n";
  return text + "[[structure.constraints]]\nkind = 'plane'\nnodes = " + on_axis +
         "\nnormal = [0, 1, 0]\n[[loads]]\nnodes = ['" + std::to_string(n) + "']\nforce = [" +
         std::to_string(pull) + ", 0, 0]\n";
}

// Of rods of mass m with m/6 (2 1; 1 2) and k (1 -1; -1 1): w^2 = 6 k/m (1 - cos a) / (2 + cos a).
double square_of_wave(double k, double m, double a) {
  return 6 * k / m * (1 - std::cos(a)) / (2 + std::cos(a));
}

}  // namespace

TEST_CASE("a bar of elastic rods, fixed at one end, has the frequencies of its finite elements") {
  const int n = 5;
  const double l = 0.25, k = E * A / l, m = density * A * l;
  const Vibration v =
      of_text(row_of_rods(n, l, "['1', '2', '3', '4', '5']", 0.0, "youngs_modulus = 2.1e11\n"));
  std::vector<double> squares;
  for (int i = 1; i <= n; ++i) squares.push_back(square_of_wave(k, m, (2 * i - 1) * pi / (2 * n)));
  CHECK(v.mechanism_motions == 0);
  check_close(frequencies(v, false), squares, 1e-10);
  CHECK(v.lowest_elastic() == frequencies(v, false).front());
  CHECK(v.unique);
  // Amplitudes sin((2 k - 1) pi i / 2 n) along the bar, the largest 1.
  for (int mode = 1; mode <= n; ++mode) {
    const VectorXd& shape = v.modes[static_cast<std::size_t>(mode - 1)].shape;
    VectorXd wanted = VectorXd::Zero(3 * (n + 1));
    for (int i = 1; i <= n; ++i) wanted[3 * i] = std::sin((2 * mode - 1) * i * pi / (2 * n));
    wanted /= wanted.cwiseAbs().maxCoeff();
    CHECK(std::min((shape - wanted).norm(), (shape + wanted).norm()) <= 1e-9);
  }
}

TEST_CASE("a string of rods swings by its tension, and stretches by its stiffness") {
  const int n = 6;
  const double l = 0.25, T = 730.0, k = E * A / l, m = density * A * l;
  std::vector<double> across, along;
  for (int i = 1; i < n; ++i) across.push_back(square_of_wave(T / l, m, i * pi / n));
  for (int i = 1; i <= n; ++i) along.push_back(square_of_wave(k, m, (2 * i - 1) * pi / (2 * n)));
  for (const char* modulus : {"youngs_modulus = 2.1e11\n", ""}) {
    INFO(modulus);
    const Vibration v = of_text(row_of_rods(n, l, "['6']", T, modulus));
    const bool elastic = *modulus != '\0';
    CHECK(v.mechanism_motions == n - 1);
    // Of rods without a modulus the same: to first order they are not stretched.
    check_close(frequencies(v, true), across, 1e-10);
    check_close(frequencies(v, false), elastic ? along : std::vector<double>{}, 1e-10);
  }
  // Pushed instead of pulled it buckles: all of these grow.
  const Vibration pushed = of_text(row_of_rods(n, l, "['6']", -T, "youngs_modulus = 2.1e11\n"));
  for (int i = 0; i < n - 1; ++i) {
    const VibrationMode& mode = pushed.modes[static_cast<std::size_t>(i)];
    CHECK(mode.mechanism);
    CHECK(mode.frequency == 0.0);
    CHECK(mode.growth == Approx(std::sqrt(across[static_cast<std::size_t>(n - 2 - i)])).epsilon(1e-10));
  }
}

namespace {

// Corners of mass 1.9 kg of a square of 0.8 m, floating in its plane; rods without mass.
std::string square(bool diagonals) {
  std::string text = "[structure]\nkind = 'custom'\nyoungs_modulus = 2.1e11\n";
  const char* at[] = {"[0, 0, 0]", "[0.8, 0, 0]", "[0.8, 0.8, 0]", "[0, 0.8, 0]"};
  for (int i = 0; i < 4; ++i)
    text += "[[structure.nodes]]\nname = '" + std::to_string(i) + "'\nposition = " + at[i] + "\nmass = 1.9\n";
  std::vector<std::string> rods{"01", "12", "23", "30"};
  if (diagonals) rods.insert(rods.end(), {"02", "13"});
  for (const std::string& rod : rods)
    text += "[[structure.rods]]\nnodes = ['" + rod.substr(0, 1) + "', '" + rod.substr(1) +
            "']\nmass = 0\narea = 1.3e-4\n";
  return text +
         "[[structure.constraints]]\nkind = 'plane'\nnodes = ['0', '1', '2', '3']\nnormal = [0, 0, 1]\n";
}

}  // namespace

TEST_CASE("a square frame: by its symmetry, with and without diagonals") {
  const double k = E * A / 0.8, d = E * A / (0.8 * std::sqrt(2.0)), m = 1.9;
  const Vibration open = of_text(square(false));
  CHECK(open.mechanism_motions == 4);  // three of the whole, and the rhombus
  for (const double f : frequencies(open, true)) CHECK(f == 0.0);
  // Two corners at the ends of each side.
  check_close(frequencies(open, false), std::vector<double>(4, 2 * k / m), 1e-10);
  const Vibration braced = of_text(square(true));
  CHECK(braced.mechanism_motions == 3);
  for (const double f : frequencies(braced, true)) CHECK(f == 0.0);
  // The rhombus, three of the sides alone, and breathing.
  check_close(frequencies(braced, false), {2 * d / m, 2 * k / m, 2 * k / m, 2 * k / m, 2 * (k + d) / m},
              1e-10);
}

TEST_CASE("a hanging pendulum swings as a physical pendulum, however stiff, upright it falls") {
  const auto pendulum = [](double z, const std::string& modulus) {
    return of_text("[structure]\nkind = 'custom'\n" + modulus +
                   "[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
                   "[[structure.nodes]]\nname = 'A'\nposition = [0, 0, " +
                   std::to_string(z) + "]\nmass = 0.4\n" +
                   "[[structure.rods]]\nnodes = ['O', 'A']\nmass = 1.1\narea = 2e-4\n" +
                   "[gravity]\nacceleration = [0, 0, -9.81]\n");
  };
  const double l = 0.7, M = 1.1, b = 0.4, square = 9.81 * (M / 2 + b) * l / ((M / 3 + b) * l * l);
  for (const char* modulus : {"", "youngs_modulus = 7e10\n", "youngs_modulus = 7e15\n"}) {
    INFO(modulus);
    const Vibration hanging = pendulum(-l, modulus);
    REQUIRE(hanging.mechanism_motions == 2);
    check_close(frequencies(hanging, true), {square, square}, 1e-10);
    const Vibration upright = pendulum(l, modulus);
    for (int i = 0; i < 2; ++i)
      CHECK(upright.modes[static_cast<std::size_t>(i)].growth == Approx(std::sqrt(square)).epsilon(1e-10));
  }
}

TEST_CASE("the symmetric modes of a ring are those of its sector, and the stiffness scales them") {
  const auto ring = [](const char* scene, const char* modulus) {
    return at_start(
        read_scene_file(find_scene(scene), {"structure.youngs_modulus=" + std::string(modulus),
                                            "structure.hinge_force=0", "structure.fold_angle=37"}));
  };
  const Vibration full = ring("hoop6", "7e10"), sector = ring("hoop6_sector", "7e10"),
                  stiff = ring("hoop6", "2.8e11");
  CHECK(full.mechanism_motions == 1);
  CHECK(sector.mechanism_motions == 1);
  CHECK(full.modes.front().frequency == 0.0);
  const std::vector<double> all = frequencies(full, false), some = frequencies(sector, false);
  REQUIRE(some.size() >= 2);
  for (const double f : some) {
    double nearest = 1e300;
    for (const double g : all) nearest = std::min(nearest, std::abs(g - f));
    CHECK(nearest < 1e-9 * f);
  }
  const std::vector<double> twice = frequencies(stiff, false);
  for (std::size_t k = 0; k < all.size(); ++k) CHECK(twice[k] == Approx(2 * all[k]).epsilon(1e-9));
}

TEST_CASE("a latched ring has no free motion, its lowest frequency is a measure of runs") {
  const Simulation run = [] {
    const Scene scene =
        read_scene_file(find_scene("hoop6"), {"structure.youngs_modulus=7e10", "solver.at_deployed=latch",
                                              "solver.step=0.05", "solver.end_time=5.2"});
    return simulate(build_model(scene), scene.solver);
  }();
  REQUIRE(run.status == RunStatus::completed);
  const std::size_t last = run.trajectory.size() - 1;
  const Vibration v = vibration(run.trajectory.model(last), run.trajectory.state(last));
  CHECK(v.mechanism_motions == 0);
  CHECK(v.lowest_elastic() > 0.0);
  CHECK(find_measure("frequency").value(run, diagnose(run)) == v.lowest_elastic());
  for (const VibrationMode& mode : v.modes) {
    CHECK(mode.growth == 0.0);
    CHECK(mode.shape.lpNorm<Eigen::Infinity>() <= 1.0 + 1e-12);
  }
}

// Rods without a modulus, and a drive that holds the one way in which they can move.
// A mass on a rigid rod that hangs down, between two rods along x that give, which pull unequally: at rest,
// of springs k_1 and k_2, both with T = (k_2 T_1 + k_1 T_2) / (k_1 + k_2). m w^2 = k_1 + k_2 + N / h along
// them, T / L_1 + T / L_2 + N / h across, k = E A / l, N = m g.
TEST_CASE("a mass between rods that give swings by their stiffness, their tension and its weight") {
  const double m = 1.7, h = 0.8, L1 = 0.6, L2 = 0.9, l1 = 0.57, l2 = 0.88, EA1 = 3e4, EA2 = 2.1e4, g = 9.7;
  const auto rod = [](const std::string& from, double stiffness, double free_length) {
    return "{nodes = ['" + from + "', 'M'], mass = 0, area = 1e-4, elastic = true, youngs_modulus = " +
           testing::number(stiffness / 1e-4) + ", free_length = " + testing::number(free_length) + "}";
  };
  const Vibration v = of_text(R"(
[structure]
kind = "custom"
nodes = [{name = "M", position = [0, 0, 0], mass = 1.7}, {name = "A", position = [-0.6, 0, 0], fixed = true},
         {name = "B", position = [0.9, 0, 0], fixed = true}, {name = "D", position = [0, 0, 0.8], fixed = true}]
rods = [)" + rod("A", EA1, l1) +
                              ", " + rod("B", EA2, l2) + R"(, {nodes = ["D", "M"], mass = 0}]
[gravity]
acceleration = [0, 0, -9.7]
)");
  const double N = m * g, T1 = EA1 * (L1 - l1) / l1, T2 = EA2 * (L2 - l2) / l2;
  REQUIRE(std::abs(T1 - T2) > 1);
  const double k1 = EA1 / l1, k2 = EA2 / l2, T = (k2 * T1 + k1 * T2) / (k1 + k2);
  std::vector<double> all = frequencies(v, false);
  for (const double f : frequencies(v, true)) all.push_back(f);
  std::sort(all.begin(), all.end());
  // Eigenvalues of a 2 by 2 matrix.
  check_close(all, {(k1 + k2 + N / h) / m, (T / L1 + T / L2 + N / h) / m}, 1e-12);
  for (const VibrationMode& mode :
       v.modes) {  // the stiff one along x, the other along y; M is the first node
    const bool stiff = mode.frequency == all.back();
    CHECK(mode.shape.cwiseAbs().isApprox(VectorXd::Unit(12, stiff ? 0 : 1), 1e-12));
  }
}

// A beam with pinned ends under 0.9 of Euler's load P: f = pi / 2 sqrt(E I / rho A l^4) sqrt(1 - 0.9). Of 16
// parts the stiffness that is left is off by (pi / 16)^2 / 12 of P, 3 % of a tenth of it, and f by half of
// that.
TEST_CASE("rods that give vibrate under their loads, which they do not bear yet at the start") {
  const double area = 1e-4, l = 2, EI = 7e10 * area * area / (4 * pi), P = pi * pi * EI / (l * l);
  const double beam = pi / 2 * std::sqrt(EI / (2700 * area * std::pow(l, 4))) * std::sqrt(0.1);
  for (const char* rod_model : {"rigid", "elastic"}) {
    const Vibration v = of_text(R"([structure]
kind = "custom"
youngs_modulus = 7e10
segments = 16
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [2, 0, 0]}]
rods = [{nodes = ["A", "B"], density = 2700, area = 1e-4}]
rod_model = ")" + std::string(rod_model) +
                                R"("
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[[loads]]
nodes = ["B"]
force = [)" + testing::number(-0.9 * P) +
                                ", 0, 0]\n");
    INFO(rod_model);
    double lowest = 1e300;
    for (const VibrationMode& mode : v.modes) lowest = std::min(lowest, mode.frequency);
    CHECK(lowest == Approx(beam).epsilon(0.02));
  }
}

TEST_CASE("what a drive holds has no modes") {
  const Vibration held = at_start(read_scene_file(find_scene("hoop6_motor")));
  CHECK(held.mechanism_motions == 0);
  CHECK(held.modes.empty());
  CHECK(std::isnan(held.lowest_elastic()));
}

// A mass on a rod that gives, and no constraint that is not eliminated: f = sqrt(E A / l m) / 2 pi, and two
// ways to swing.
// 1 kg hangs by a massless rod of 1 m below a node that a drive lifts by 0.5 m in 0.4 s: held at rest in any
// of these poses it swings by sqrt(g / l), whatever the drive was about to do.
TEST_CASE("a drive that accelerates is no load of a pose that is held at rest") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "S", position = [0, 0, 0], mass = 1}, {name = "B", position = [0, 0, -1], mass = 1}]
rods = [{nodes = ["S", "B"], mass = 0}]
[[constraints]]
kind = "line"
nodes = ["S"]
direction = [0, 0, 1]
[[constraints]]
kind = "coordinate"
nodes = ["S"]
direction = [0, 0, 1]
motion = "smooth"
to = 0.5
duration = 0.4
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 0.5
step = 0.05
)");
  REQUIRE(run.status == RunStatus::completed);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const Vibration v = vibration(run.trajectory.model(i), run.trajectory.state(i));
    INFO(run.trajectory.time(i));
    REQUIRE(v.modes.size() == 2);
    for (const auto& mode : v.modes)
      CHECK(mode.frequency == Approx(std::sqrt(9.81) / (2 * pi)).epsilon(1e-9));
  }
}

TEST_CASE("a structure whose rods all give and that nothing else holds has modes") {
  const Vibration v = at_start(read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [1.5, 0, 0], mass = 2}]
rods = [{nodes = ["O", "P"], mass = 0, area = 1e-4, youngs_modulus = 1.1e6, elastic = true}]
)",
                                               "s.toml"));
  CHECK(v.mechanism_motions == 2);
  CHECK(v.lowest_elastic() == Approx(std::sqrt(1.1e6 * 1e-4 / (1.5 * 2)) / (2 * pi)).epsilon(1e-12));
}

// Ziegler's column: rods of 1 m with 2 and 1 kg at their ends, hinges of 1 N m/rad, and a push P along the
// last rod, which follows it (Ziegler 1952): 2 w^4 - (7 - 2 P) w^2 + 1 = 0.
TEST_CASE("a follower makes stiffness that has no potential, and flutter beyond its limit") {
  const auto column = [](const std::string& push, const std::string& modulus) {
    return of_text("[structure]\nkind = 'custom'\n" + modulus + R"(
nodes = [{name = "G", position = [-1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1, 0, 0], mass = 2}, {name = "B", position = [2, 0, 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0, area = 1}, {name = "tip", nodes = ["A", "B"], mass = 0, area = 1}]
[[constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 0, 1]
[[forces]]
kind = "torsion_spring"
nodes = ["G", "O", "A"]
axis = [0, 0, 1]
stiffness = 1
[[forces]]
kind = "torsion_spring"
nodes = ["O", "A", "B"]
axis = [0, 0, 1]
stiffness = 1
[[forces]]
kind = "follower"
rod = "tip"
force = -)" + push +
                   R"(
[solver]
end_time = 1
)");
  };
  // With rods of 1e8 N/m, general eigenvalues are right to 1e-16 of theirs, 1e-8, and rods give by 1e-8.
  for (const std::string modulus : {"", "youngs_modulus = 1e8"}) {
    const double tolerance = modulus.empty() ? 1e-12 : 1e-6;
    for (const double P : {0.5, 2.0, 3.0, 3.1}) {
      const Vibration v = column(std::to_string(P), modulus);
      INFO(P << modulus);
      REQUIRE(v.mechanism_motions == 2);
      CHECK(v.modes.size() == (modulus.empty() ? 2u : 4u));
      const double b = (7 - 2 * P) / 4, d = b * b - 0.5;
      for (std::size_t k = 0; k < 2; ++k) {
        CHECK(v.modes[k].mechanism);
        if (d > 0) {
          CHECK(v.modes[k].growth <= 1e-6);
          const double square = b + (k == 0 ? -1 : 1) * std::sqrt(d);
          CHECK(v.modes[k].frequency == Approx(std::sqrt(square) / (2 * pi)).epsilon(tolerance));
        } else {
          // w^2 = b +- i sqrt(-d): rates sqrt(-w^2).
          const std::complex<double> rate = std::sqrt(-std::complex<double>(b, std::sqrt(-d)));
          CHECK(v.modes[k].growth == Approx(std::abs(rate.real())).epsilon(tolerance));
          CHECK(v.modes[k].frequency == Approx(std::abs(rate.imag()) / (2 * pi)).epsilon(tolerance));
        }
      }
    }
  }
}

// Six motions of the whole and the hinge's: nothing acts on them, and V >= 0.
TEST_CASE("free rods that bend have no other free motions than rigid ones, and those are not unstable") {
  for (const int segments : {1, 2, 3, 8, 32}) {
    INFO(segments);
    const Vibration v = of_text(R"([structure]
kind = 'custom'
youngs_modulus = 7e10
segments = )" + std::to_string(segments) +
                                R"(
nodes = [{name = 'A', position = [0, 0, 0]}, {name = 'B', position = [1, 1, 0]}, {name = 'C', position = [2, 0, 1]}]
rods = [{nodes = ['A', 'B'], density = 2700, area = 1e-4}, {nodes = ['B', 'C'], density = 2700, area = 1e-4}]
)");
    REQUIRE(v.mechanism_motions == 7);
    for (const VibrationMode& mode : v.modes) {
      CHECK(mode.growth == 0.0);
      CHECK((mode.frequency == 0.0) == mode.mechanism);
    }
  }
}

namespace {

// With pinned ends, E I = 56 N m^2 and rho A = 0.27 kg/m.
std::string beam(int segments, const std::string& b) {
  return R"([structure]
kind = 'custom'
youngs_modulus = 7e10
segments = )" +
         std::to_string(segments) +
         R"(
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [2, 0, 0])" +
         b + R"(}]
rods = [{nodes = ['A', 'B'], density = 2700, area = 1e-4, second_moment = 8e-10}]
[solver]
end_time = 0.01
)";
}

}  // namespace

// f = pi/2 sqrt(E I / m l^4); parts are off by (pi / k)^2 / 12 of the stiffness at most, and f by half of it.
TEST_CASE("the lowest frequency of rods that bend is that of bending") {
  const double wanted = pi / 2 * std::sqrt(56 / (0.27 * 16));
  for (const int segments : {4, 16}) {
    const Vibration v = of_text(beam(segments, ", fixed = true"));
    CHECK(v.mechanism_motions == 0);
    CHECK(v.lowest_elastic() == Approx(wanted).epsilon(std::pow(pi / segments, 2) / 24));
  }
}

// Held at one end, it may turn about that, and about its own axis where it is not straight: two motions, or
// three. Its pose changes frequencies by the square of its slopes, 1e-4; nothing holds the turns.
TEST_CASE("a rod that is bent has the same frequencies, and a turn about itself") {
  const auto model = build_model(read_scene_text(beam(12, ""), "s.toml"));
  State pose = initial_state(model->structure, model->system).state;
  const Vibration straight = vibration(*model, pose);
  VectorXd q(model->system.coordinates());
  model->system.expand(pose.z, q);
  for (Index i = 0; i < q.size(); i += 3) q[i + 1] += 0.004 * std::sin(1.1 * q[i]) * q[i];
  pose.z = model->system.reduce(q);
  const Vibration bent = vibration(*model, pose);
  CHECK(straight.mechanism_motions == 2);
  CHECK(bent.mechanism_motions == 3);
  // Clamped by nothing at A: the first of a pinned and a free end, (3.9266 / l)^2 sqrt(E I / m) / 2 pi.
  const double first = std::pow(3.926602 / 2, 2) * std::sqrt(56 / 0.27) / (2 * pi);
  CHECK(straight.lowest_elastic() == Approx(first).epsilon(std::pow(3.93 / 12, 2) / 24));
  CHECK(bent.lowest_elastic() == Approx(straight.lowest_elastic()).epsilon(1e-2));
}

// A pendulum of 2 kg on a rod of 1 m, held by a position controller over a gear of 10: the torque by the
// angle is that of the proportional part, whatever its integral part does with time.
TEST_CASE("the integral of a controller is no motion of the structure") {
  for (const double integral : {0.0, 5.0}) {
    CAPTURE(integral);
    const Vibration v = of_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "D", position = [1, 0, 0], fixed = true},
  {name = "P", position = [0, 0, -1], mass = 2}]
rods = [{nodes = ["O", "P"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["P"]
normal = [0, 1, 0]
[[forces]]
kind = "motor"
nodes = ["D", "O", "P"]
axis = [0, 1, 0]
stall_torque = 0.1
no_load_speed = 4000
gear_ratio = 10
control = "position"
proportional = 20
integral = )" + testing::number(integral) +
                                "\nmotion = \"hold\"\n[gravity]\nacceleration = [0, 0, -9.81]\n");
    CHECK(v.mechanism_motions == 1);
    REQUIRE(v.modes.size() == 1);
    CHECK(v.modes[0].frequency == Approx(std::sqrt(9.81 + 20.0 / 2) / (2 * pi)).epsilon(1e-9));
  }
}

}  // namespace vibration_test
