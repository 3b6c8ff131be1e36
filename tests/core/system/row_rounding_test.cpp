// SPDX-License-Identifier: BSD-3-Clause
// Rows of constraints that nothing is left of once linear ones are eliminated.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace row_rounding_test {

using testing::number;

TEST_CASE("a line through two nodes on guides and a fixed one moves as its one freedom says") {
  // A and B slide along x, the line through them turns about C: B moves s times as far as A, by similar
  // triangles. Two of the line's three rows say that; of the third, entries that cancel are left.
  constexpr double s = 0.48, force = 4.6, mass_a = 0.75, mass_b = 0.5;
  const Vec3 c(1.2956, -0.0469, 0.1894), a(-0.9245, -0.6145, -0.6772);
  const auto node = [](const std::string& name, const Vec3& x, const std::string& rest) {
    return "[[structure.nodes]]\nname = '" + name + "'\nposition = [" + number(x[0]) + ", " + number(x[1]) +
           ", " + number(x[2]) + "]\n" + rest + "\n";
  };
  const std::string scene = "[structure]\nkind = 'custom'\n" + node("A", a, "mass = " + number(mass_a)) +
                            node("B", c + s * (a - c), "mass = " + number(mass_b)) +
                            node("C", c, "fixed = true") +
                            "[[structure.constraints]]\nkind = 'collinear'\nnodes = ['A', 'B', 'C']\n"
                            "[[structure.constraints]]\nkind = 'line'\nnodes = ['A', 'B']\n"
                            "direction = [1, 0, 0]\n[[loads]]\nnodes = ['A']\nforce = [" +
                            number(force) + ", 0, 0]\n[solver]\nend_time = 0.5\nstep = 0.01\n";
  const double way = 0.5 * force / (mass_a + s * s * mass_b) * 0.25;
  for (const char* method : {"dvm", "rk4", "generalized_alpha"})
    for (const char* eliminate : {"true", "false"}) {
      const Simulation run = testing::run_scene(scene, {std::string("solver.method=") + method,
                                                        std::string("solver.eliminate_linear=") + eliminate});
      INFO(method << ", eliminated: " << eliminate << "; " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const VectorXd q = testing::end_positions(run);
      // A constant force is exact for all of them, but for the round-off of 50 steps and what the rows allow.
      CHECK(std::abs(q[0] - a[0] - way) <= 1e-9);
      CHECK(std::abs(q[3] - (c + s * (a - c))[0] - s * way) <= 1e-9);
    }
}

// Two or three equal cranks of one length on a fixed base and the coupler that their ends share, all held in
// one plane, and a constraint that this implies across the plane: as often drawn, and overconstrained. It has
// one freedom, the angle from the vertical.
struct Parallelogram {
  bool collinear = false;  // the coupler's middle E on the line of its ends; else the coupler coplanar
  bool third = false;      // a crank to E, too
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
  int decimals = 16;

  std::string place(const Vec3& x) const { return vector(turn * x + shift, decimals); }
  static std::string vector(const Vec3& x, int decimals) {
    char text[120];
    std::snprintf(text, sizeof text, "[%.*f, %.*f, %.*f]", decimals, x[0], decimals, x[1], decimals, x[2]);
    return text;
  }
  std::string scene() const {
    std::string text = "[structure]\nkind = 'custom'\n";
    const auto node = [&](const char* name, const Vec3& x, const char* rest) {
      text += std::string("[[structure.nodes]]\nname = '") + name + "'\nposition = " + place(x) + "\n" +
              rest + "\n";
    };
    const auto rod = [&](const char* a, const char* b) {
      text += std::string("[[structure.rods]]\nnodes = ['") + a + "', '" + b + "']\nmass = 1\n";
    };
    node("A", {0, 0, 0}, "fixed = true");
    node("B", {1, 0, 0}, "fixed = true");
    node("C", {0.3, 0, 1}, "mass = 1");
    node("D", {1.3, 0, 1}, "mass = 1");
    rod("A", "C"), rod("B", "D");
    if (collinear) {
      node("E", {0.8, 0, 1}, "mass = 1");
      rod("C", "E"), rod("E", "D");
    } else {
      rod("C", "D");
    }
    if (third) node("M", {0.5, 0, 0}, "fixed = true"), rod("M", "E");
    text += std::string("[[constraints]]\nkind = 'plane'\nnodes = ") +
            (collinear ? "['C', 'D', 'E']" : "['C', 'D']") +
            "\nnormal = " + vector(turn * Vec3::UnitY(), 16) + "\n[[constraints]]\nkind = " +
            (collinear ? "'collinear'\nnodes = ['C', 'D', 'E']" : "'coplanar'\nnodes = ['A', 'B', 'C', 'D']");
    return text + "\n[gravity]\nacceleration = " + vector(turn * Vec3(0, 0, -9.81), 16) +
           "\n[solver]\nstep = 0.01\nend_time = 0.3\n";
  }
  // C - A at the end: J angle'' = M g l sin(angle), a thousand steps of Runge and Kutta's method.
  Vec3 end() const {
    const double cranks = third ? 3 : 2,
                 moved = collinear ? 3 + 2 : 2 + 1;  // nodes and coupler move as C does
    const double l = std::hypot(0.3, 1), J = (cranks / 3 + moved) * l * l,
                 M = (cranks / 2 + moved) * 9.81 * l;
    using Angle = std::array<double, 2>;
    const auto rate = [&](const Angle& y) { return Angle{y[1], M / J * std::sin(y[0])}; };
    const auto along = [](const Angle& y, double h, const Angle& k) {
      return Angle{y[0] + h * k[0], y[1] + h * k[1]};
    };
    Angle y{std::atan2(0.3, 1), 0};
    constexpr double h = 0.0003;
    for (int i = 0; i < 1000; ++i) {
      const Angle a = rate(y), b = rate(along(y, h / 2, a)), c = rate(along(y, h / 2, b)),
                  d = rate(along(y, h, c));
      for (std::size_t k = 0; k < 2; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    return turn * Vec3(l * std::sin(y[0]), 0, l * std::cos(y[0]));
  }
  // What a run with these settings is off by at the end.
  double error(const std::vector<std::string>& set = {}) const {
    const Simulation run = testing::run_scene(scene(), set);
    INFO(run.message);
    REQUIRE(run.status == RunStatus::completed);
    const VectorXd q = testing::end_positions(run);
    return (q.segment<3>(6) - q.head<3>() - end()).norm();
  }
};

Mat3 some_turn(int i) {
  return Eigen::AngleAxisd(0.7 + i, Vec3(1, 0.4 - i, 0.2 + 0.3 * i).normalized()).toRotationMatrix();
}

TEST_CASE("a linkage in a turned plane moves as its one freedom says, whatever digits its positions have") {
  // The steps' own error is 1e-8, and a position that is off moves the rest by some ten times as much.
  for (const bool collinear : {false, true})
    for (const int decimals : {16, 14, 13, 12, 11, 10})
      for (int i = 0; i < 3; ++i) {
        INFO((collinear ? "collinear, " : "coplanar, ") << decimals << " decimals, turn " << i);
        CHECK(Parallelogram{collinear, false, some_turn(i), Vec3::Zero(), decimals}.error() <=
              2e-8 + 10 * std::pow(10, -decimals));
      }
}

// The crank is turned upright from the 73 degrees that it begins at, against nothing but what the plane
// holds.
TEST_CASE("a linkage in a turned plane is driven whatever digits its positions have") {
  for (const bool collinear : {false, true})
    for (const int decimals : {16, 12, 11, 10, 9})
      for (int i = 0; i < 3; ++i) {
        INFO((collinear ? "collinear, " : "coplanar, ") << decimals << " decimals, turn " << i);
        const Parallelogram linkage{collinear, false, some_turn(i), Vec3::Zero(), decimals};
        const Simulation run = testing::run_scene(
            linkage.scene() +
            "[[constraints]]\nkind = 'angle'\nname = 'crank'\nnodes = ['B', 'A', 'C']\naxis = " +
            Parallelogram::vector(linkage.turn * -Vec3::UnitY(), 16) +
            "\nmotion = 'smooth'\nto = 90\nduration = 0.2\n");
        INFO(run.message);
        REQUIRE(run.status == RunStatus::completed);
        const VectorXd q = testing::end_positions(run);
        CHECK((q.segment<3>(6) - q.head<3>() - linkage.turn * Vec3(0, 0, std::hypot(0.3, 1))).norm() <=
              1e-9 + 10 * std::pow(10, -decimals));
        for (const std::string& warning : run.warnings)
          CHECK(warning.find("follow from one another") == std::string::npos);
      }
}

TEST_CASE("a linkage far from the origin moves as near it") {
  // Rounding leaves 1e-16 of the distance in each coordinate.
  for (const double far : {1e2, 1e3, 1e4, 1e5})
    for (int i = 0; i < 3; ++i)
      for (const bool more : {false, true}) {
        const Vec3 shift = far * Vec3(1.1, 2.3, -1);
        INFO(far << " m, turn " << i << (more ? ", collinear, third crank" : ", coplanar"));
        CHECK(Parallelogram{more, more, some_turn(i), shift}.error() <= 2e-8 + 1e-13 * far);
      }
  for (const char* method : {"rk4", "rk4_projected"})
    CHECK(Parallelogram{true, true, some_turn(0), 1e5 * Vec3(1.1, 2.3, -1)}.error(
              {std::string("solver.method=") + method}) <= 1e-6);
}

// A is held across the plane that it moves in, and c times a coordinate of B is added to that: it holds B,
// whatever c is, as it does where nothing is eliminated. B is off by what errors of rows leave over c: 1e-15
// m of a row.
TEST_CASE("a small coefficient beside an eliminated one holds what it is of") {
  for (const double c : {1.0, 1e-4, 1e-6, 1e-8, 1e-10})
    for (const char* eliminated : {"true", "false"}) {
      INFO(c << ", eliminate_linear = " << eliminated);
      const Simulation run = testing::run_scene(
          "[structure]\nkind = 'custom'\nrods = [{nodes = ['O', 'D'], mass = 1}]\n"
          "nodes = [{name = 'A', position = [0, 0, 0], mass = 1}, {name = 'B', position = [1, 1, 0], mass = "
          "1},\n"
          "  {name = 'O', position = [3, 1, 0], fixed = true}, {name = 'D', position = [3, 2, 0]}]\n"
          "[[constraints]]\nkind = 'plane'\nnodes = ['A', 'D']\nnormal = [0, 0, 1]\n"
          "[[constraints]]\nkind = 'combination'\n"
          "terms = ['1 coordinate A along 0 0 1', '" +
              number(c) +
              " coordinate B along 1 0 0']\n"
              "[[loads]]\nnodes = ['B']\nforce = [1, 0, 0]\n[solver]\nstep = 0.1\nend_time = 1\n",
          {std::string("solver.eliminate_linear=") + eliminated});
      INFO(run.message);
      REQUIRE(run.status == RunStatus::completed);
      CHECK(testing::end_positions(run)[3] == Approx(1).epsilon(0).margin(1e-15 / c + 1e-12));
    }
}

// What moves starts on the constraints, as near as a coordinate can be told, however far the origin is; where
// the positions are off by what is let through, it does not start from them.
TEST_CASE("positions that are off a plane by a little are put onto it on either side") {
  const Vec3 normal(0.48, 0.6, 0.64);
  for (const double far : {0.0, 1300.0, -2900.0})
    for (const double off : {4e-8, -4e-8}) {
      INFO(far << " " << off);
      const Vec3 p = Vec3(0.3, -0.2, 0.9) + Vec3::Constant(far), q = p + Vec3(1.1, 0.7, -0.4);
      const auto node = [](const Vec3& x) {
        return "position = [" + number(x[0]) + ", " + number(x[1]) + ", " + number(x[2]) + "], mass = 1}";
      };
      const auto model = testing::model_of(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'P', " + node(p) + ", {name = 'Q', " + node(q) +
          "]\nrods = [{nodes = ['P', 'Q'], mass = 1}]\n[[constraints]]\nkind = 'relation'\nnodes = ['P']\n"
          "coefficients = [0.48, 0.6, 0.64]\nvalue = " +
          number(normal.dot(p) + off) + "\n");
      const System& system = model->system;
      REQUIRE(system.solved_coordinates() == 5);
      VectorXd start(6), on(6), phi(system.all_constraints());
      start << p, q;
      system.expand(system.reduce(start), on);
      system.all_constraint_values(0.0, on, phi);
      const std::vector<int> sources = system.all_sources();  // rods have none
      for (std::size_t r = 0; r < sources.size(); ++r)
        if (sources[r] >= 0) CHECK(std::abs(phi[static_cast<Index>(r)]) < 1e-12 + 1e-15 * std::abs(far));
      CHECK((on - start).lpNorm<Eigen::Infinity>() < 2 * std::abs(off));
    }
}

// P is held across the plane that it moves in once more, and once more in line with three nodes that stand in
// it: nothing new, whichever way it is counted. What is held along the plane is new, what Q holds as well.
TEST_CASE("a held coordinate across a plane follows from it along either way") {
  for (const double way : {1.0, -1.0}) {
    INFO(way);
    const auto model = testing::model_of(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0.3, -0.2, 0.9], mass = 1}, {name = "
        "'Q', position = [1.3, 0.7, 0.2], mass = 2}, {name = 'A', position = [-0.2, 0.2, 0.9], fixed = "
        "true}, "
        "{name = 'B', position = [0.3, 0.44, 0.3], fixed = true}, {name = 'C', position = [0.94, -0.2, "
        "0.42], "
        "fixed = true}]\n[[constraints]]\nkind = 'plane'\nnodes = ['P']\nnormal = [0.48, 0.6, 0.64]\n"
        "[[constraints]]\nkind = 'coordinate'\nname = 'along'\nnodes = ['P']\ndirection = [0.8, 0, -0.6]\n"
        "[[constraints]]\nkind = 'coordinate'\nname = 'across'\nnodes = ['P']\ndirection = [" +
        number(0.48 * way) + ", " + number(0.6 * way) + ", " + number(0.64 * way) +
        "]\n[[constraints]]\nkind = 'coordinate'\nname = 'other'\nnodes = ['Q']\ndirection = [0.48, 0.6, "
        "0.64]\n[[constraints]]\nkind = 'coplanar'\nname = 'flat'\nnodes = ['A', 'B', 'C', 'P']\n");
    std::vector<std::string> names;
    for (const int row : model->system.rows_of_digits())
      names.push_back(model->system.all_names()[static_cast<std::size_t>(row)]);
    CHECK(names == std::vector<std::string>{"across", "flat"});
  }
}

}  // namespace row_rounding_test
