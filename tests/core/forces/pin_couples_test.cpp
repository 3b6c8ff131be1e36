// SPDX-License-Identifier: BSD-3-Clause
// Dry friction by a pin's force on a rod that couples turn at both of its ends, also through gears, rotors
// and sums of angles, against Lagrange's equations of a double pendulum, whose pins bear by Newton's law what
// accelerates the rods beyond them; and on one that bends or carries others.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pin_couples_test {

namespace {

using testing::end_positions, testing::run_scene;
using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// H-B of 1 m and 1 kg along x, B-C of 0.8 m and 0.7 kg, 0.4 rad further about y. 1 N m turns H-B; its pin at
// H has mu r = 0.1 m.
const double m1 = 1, m2 = 0.7, l2 = 0.8, start = 0.4, arm = 0.1, weight = 2.0;

const std::string pendulum = R"toml(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [-1, 0, 0], fixed = true}, {name = "H", position = [0, 0, 0], fixed = true},
  {name = "B", position = [1, 0, 0]},
  {name = "C", position = ["=1 + 0.8 * cos(0.4)", 0, "=-0.8 * sin(0.4)"]},
  {name = "E", position = [-1, 0, 5], fixed = true}, {name = "K", position = [0, 0, 5], fixed = true},
  {name = "D", position = [1, 0, 5], mass = 2}, {name = "R", position = [0, 0, -5], mass = 0.9}]
rods = [{name = "b", nodes = ["H", "B"], mass = 1}, {name = "c", nodes = ["B", "C"], mass = 0.7},
        {name = "d", nodes = ["K", "D"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["B", "C", "D"]
normal = [0, 1, 0]
[[structure.constraints]]
kind = "line"
nodes = ["R"]
direction = [1, 0, 0]
[gravity]
acceleration = [0, 0, -2]
[[forces]]
kind = "load_over_time"  # holds D, as gravity is not to turn what is geared
nodes = ["D"]
force = [0, 0, 4]
[[forces]]
kind = "motor"
name = "mot"
nodes = ["A", "H", "B"]
axis = [0, 1, 0]
stall_torque = 1
no_load_speed = 1e13
[[forces]]
kind = "friction"
name = "pin"
nodes = ["B", "H", "A"]
axis = [0, 1, 0]
kinetic = 0
pin_friction = 0.2
pin_radius = 0.5
[solver]
stages = 4
step = 0.01
end_time = 0.8
)toml";

// What acts besides, on the angles p of both rods about y: a generalized force, what its rotors and wheels
// add to the inertia, a row p . row = f(t) with f'', and the friction of the pin at B in the sense in which C
// - B turns against H - B.
struct Besides {
  std::function<Vec2(const Vec2& p, const Vec2& w)> force = {};
  Mat2 inertia = Mat2::Zero();
  Vec2 row = Vec2::Zero();
  std::function<double(double t)> target = {};
  double arm = 0, torque = 0, sense = 0;
};

Vec3 along(double p) {
  return {std::cos(p), 0, -std::sin(p)};
}
Vec3 across(double p) {
  return {-std::sin(p), 0, -std::cos(p)};
}

Vec2 acceleration(double t, const Vec2& p, const Vec2& w, const Besides& besides) {
  const double d = p[1] - p[0], s = m2 * l2 / 2 * std::sin(d), c = m2 * l2 / 2 * std::cos(d);
  const Vec3 g(0, 0, -weight);
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  M.topLeftCorner<2, 2>() << m1 / 3 + m2, c, c, m2 * l2 * l2 / 3;
  M.topLeftCorner<2, 2>() += besides.inertia;
  M.topRightCorner<2, 1>() = besides.row;
  M.bottomLeftCorner<1, 2>() = besides.row.transpose();
  if (besides.row.isZero(0.0)) M(2, 2) = 1;
  Vec2 known(1 + s * w[1] * w[1] + (m1 / 2 + m2) * g.dot(across(p[0])),
             -s * w[0] * w[0] + m2 * l2 / 2 * g.dot(across(p[1])));
  if (besides.force) known += besides.force(p, w);
  double at_H = 0, at_B = besides.torque * besides.sense;
  Vec3 y;
  for (int round = 0; round < 60; ++round) {  // contracts by some mu r = 0.1 each
    y = M.inverse() * Vec3(known[0] - at_H + at_B, known[1] - at_B, besides.target ? besides.target(t) : 0.0);
    const Vec3 aB = y[0] * across(p[0]) - w[0] * w[0] * along(p[0]),
               a2 = aB + l2 / 2 * (y[1] * across(p[1]) - w[1] * w[1] * along(p[1])), F2 = m2 * (a2 - g);
    at_H = arm * (m1 * (aB / 2 - g) + F2).norm();
    at_B = besides.sense * (besides.torque + besides.arm * F2.norm());
  }
  return y.head<2>();
}

struct End {
  Vec2 p, w;
};

// Steps of Runge and Kutta of order 4: 1e-12 off with 1 ms at rates of some radians per second.
End by_runge_kutta(double t_end, const Besides& besides) {
  using Y = Eigen::Vector4d;
  const int steps = 800;
  const double h = t_end / steps;
  const auto rate = [&](double t, const Y& y) {
    Y f;
    f << y.tail<2>(), acceleration(t, y.head<2>(), y.tail<2>(), besides);
    return f;
  };
  Y y(0, start, 0, 0);
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Y a = rate(t, y), b = rate(t + h / 2, y + h / 2 * a), c = rate(t + h / 2, y + h / 2 * b),
            d = rate(t + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return {y.head<2>(), y.tail<2>()};
}

void check(const std::string& what, const std::string& entry, const Besides& besides) {
  INFO(what);
  const Simulation run = run_scene(pendulum + "\n" + entry);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const End exact = by_runge_kutta(0.8, besides);
  const VectorXd q = end_positions(run), v = run.trajectory.node_velocities(run.trajectory.size() - 1);
  const Vec3 B = q.segment<3>(6), C = q.segment<3>(9), vB = v.segment<3>(6), vC = v.segment<3>(9);
  REQUIRE(exact.w[0] > 0.05);  // the pin at H has slipped in one sense
  // Order 8 in steps of 10 ms, and what Runge and Kutta leave; a couple that is left out moves the rods by
  // 1e-4 m and more.
  CHECK((B - along(exact.p[0])).norm() < 1e-9);
  CHECK((C - B - l2 * along(exact.p[1])).norm() < 1e-9);
  CHECK((vB - exact.w[0] * across(exact.p[0])).norm() < 1e-8);
  CHECK((vC - vB - l2 * exact.w[1] * across(exact.p[1])).norm() < 1e-8);
  CHECK(testing::largest(diagnose(run), "energy_balance_J") < 1e-9);
}

std::string force(const std::string& kind, const std::string& rest) {
  return "[[forces]]\nkind = \"" + kind + "\"\n" + rest + "\n";
}

// A spring and damper on c . p.
Besides spring(double k, double damping, const Vec2& c) {
  Besides out;
  out.force = [=](const Vec2& p, const Vec2& w) {
    return Vec2(-(k * c.dot(p - Vec2(0, start)) + damping * c.dot(w)) * c);
  };
  return out;
}

Besides geared(double inertia, const Vec2& c) {
  Besides out;
  out.inertia = inertia * c * c.transpose();
  return out;
}

}  // namespace

TEST_CASE("a pin bears the couples that springs and dampers put on its rod at the other end") {
  const Vec2 hinge(-1, 1);
  const std::string at_B = "nodes = [\"H\", \"B\", \"C\"]\n", y = "axis = [0, 1, 0]\n";
  check("nothing besides", "", {});
  check("torsion spring", force("torsion_spring", at_B + y + "stiffness = 3"), spring(3, 0, hinge));
  check("told from the other side",
        force("torsion_spring", "nodes = [\"C\", \"B\", \"H\"]\nstiffness = 3\ndamping = 0.2"),
        spring(3, 0.2, hinge));
  check("joint damping", force("joint_damping", "nodes = [\"B\"]\ndamping = 0.3"), spring(0, 0.3, hinge));
  check("sum of angles at both ends",
        force("combination",
              "terms = [\"1 angle H B C about 0 1 0\", \"0.5 angle A H B about 0 1 0\"]\n"
              "stiffness = 3\ndamping = 0.1"),
        spring(3, 0.1, {-0.5, 1}));
  check("spring at the hinge",
        force("combination", "terms = [\"-2 angle B H A about 0 1 0\"]\nstiffness = 1"),
        spring(1, 0, {2, 0}));
  Besides motor;
  motor.force = [](const Vec2&, const Vec2&) { return Vec2(-0.3, 0.3); };
  check("motor", force("motor", at_B + y + "stall_torque = 0.3\nno_load_speed = 1e13\nname = \"second\""),
        motor);
}

TEST_CASE("a pin bears the couples of rotors, gears and racks on its rod") {
  const std::string y = "axis = [0, 1, 0]\n";
  const std::string no_torque = "stall_torque = 1e-14\nno_load_speed = 1e13\nname = \"second\"\n";
  check("rotor at the hinge",
        force("motor", "nodes = [\"A\", \"H\", \"B\"]\n" + y + no_torque + "inertia = 0.02\ngear_ratio = 5"),
        geared(0.5, {1, 0}));
  check("rotor at the other end",
        force("motor", "nodes = [\"H\", \"B\", \"C\"]\n" + y + no_torque + "inertia = 0.2"),
        geared(0.2, {-1, 1}));
  // D of 2 kg at 1 m turns half as fast, the other way.
  check("gear",
        "[[constraints]]\nkind = \"gear\"\nnodes = [\"A\", \"H\", \"B\", \"E\", \"K\", \"D\"]\nradii = [1, "
        "2]\n" +
            y,
        geared(0.5, {1, 0}));
  check("gear at the other end",
        "[[constraints]]\nkind = \"gear\"\nnodes = [\"H\", \"B\", \"C\", \"E\", \"K\", \"D\"]\nradii = [1, "
        "-2]\n" +
            y,
        geared(0.5, {-1, 1}));
  check("rack",
        "[[constraints]]\nkind = \"rack\"\nnodes = [\"A\", \"H\", \"B\", \"R\"]\nradius = 0.5\n"
        "direction = [1, 0, 0]\n" +
            y,
        geared(0.9 * 0.25, {1, 0}));
}

TEST_CASE("a pin bears the couples that hold or drive angles of its rod") {
  Besides driven;
  driven.row = {-1, 1};
  driven.target = [](double t) {  // to 0.4 + 0.6 rad within 0.8 s
    const double u = t / 0.8, v = 1 - u;
    return 0.6 / 0.64 * 60 * u * v * (v - u);
  };
  const std::string smooth = "motion = \"smooth\"\nduration = 0.8\n";
  // From pi + 0.4 or pi - 0.4, as the angle counts.
  check("driven angle at the other end",
        "[[constraints]]\nkind = \"angle\"\nname = \"drive\"\nnodes = [\"H\", \"B\", \"C\"]\naxis = [0, 1, "
        "0]\n" +
            smooth + "to = \"=(0.4 + 0.6 - pi) * 180 / pi\"\n",
        driven);
  Besides held;
  held.row = {1, 1};
  check("sum of both angles held",
        "[[constraints]]\nkind = \"combination\"\nterms = [\"2 angle A H B about 0 1 0\", \"1 angle H B C "
        "about "
        "0 1 0\"]\nmotion = \"hold\"\n",
        held);
  driven.row = {1, 1};
  check("sum of both angles driven",
        "[[constraints]]\nkind = \"combination\"\nname = \"drive\"\nterms = [\"-2 angle B H A about 0 1 0\", "
        "\"1 "
        "angle H B C about 0 1 0\"]\n" +
            smooth + "to = \"=(0.4 + 0.6 - 3 * pi) * 180 / pi\"\n",
        driven);
}

// C swings back against H-B, which the motor turns on.
TEST_CASE("a pin bears the friction at its rod's other end and the other way round") {
  Besides rubs;
  rubs.sense = -1, rubs.torque = 0.02;
  const std::string constant = "axis = [0, 1, 0]\nname = \"second\"\nkinetic = 0.02\n",
                    by_load = constant + "pin_friction = 0.1\npin_radius = 0.4\n";
  check("constant", force("friction", "nodes = [\"H\", \"B\", \"C\"]\n" + constant), rubs);
  rubs.arm = 0.04;
  check("on the outer rod", force("friction", "nodes = [\"C\", \"B\", \"H\"]\n" + by_load), rubs);
  Besides sticks;
  sticks.row = {-1, 1};
  check("what sticks", force("friction", "nodes = [\"C\", \"B\", \"H\"]\n" + constant + "static = 9"),
        sticks);
  check("on the inner rod", force("friction", "nodes = [\"H\", \"B\", \"C\"]\n" + by_load), rubs);
}

namespace {

// A rod of E I = 5.6 kN m^2 in parts, turned by a load that grows to 4 N within a second.
std::string bending_rod(int parts, const std::string& entry) {
  std::string inner;
  for (int k = 1; k < parts; ++k) inner += ", \"b." + std::to_string(k) + "\"";
  return R"toml([structure]
kind = "custom"
rod_model = "elastic"
youngs_modulus = 7e10
nodes = [{name = "A", position = [-1, 0, 0], fixed = true}, {name = "H", position = [0, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0]}]
rods = [{name = "a", nodes = ["A", "H"], mass = 1, area = 1e-3, elastic = false, segments = 1},
        {name = "b", nodes = ["H", "B"], mass = 1, area = 1e-3, segments = )toml" +
         std::to_string(parts) + "}]\nconstraints = [{kind = \"plane\", nodes = [\"B\"" + inner +
         "], normal = [0, 1, 0]}]\n" + R"toml([[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0.3, 0, -1]
times = [0, 0.3, 1]
values = [0, 1, 4]
[[forces]]
kind = "friction"
rods = ["b", "a"]
axis = [0, 1, 0]
kinetic = 0
pin_friction = 0.2
pin_radius = 0.5
[solver]
stages = 4
step = 0.002
end_time = 1
)toml" + entry;
}

}  // namespace

TEST_CASE("a pin bears the bending couple of the rod on it") {
  for (const std::string who : {"", "nodes = [\"A\", \"H\", \"B\"]", "rods = [\"a\", \"b\"]"}) {
    const std::string entry =
        who.empty() ? who : force("torsion_spring", who + "\naxis = [0, 1, 0]\nstiffness = 2");
    INFO(entry);
    const Simulation rigid = run_scene(bending_rod(1, entry));
    REQUIRE(rigid.status == RunStatus::completed);
    const double taken = diagnose(rigid).at("dissipated_J").values.back();
    CHECK(taken > 0.3);
    for (const int parts : {2, 3}) {
      const Simulation run = run_scene(bending_rod(parts, entry));
      INFO(parts << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      // Bent by less than 4 N m over 1 m, by 7e-4 rad; without its couple friction is off by a hundredth.
      CHECK(diagnose(run).at("dissipated_J").values.back() == Approx(taken).epsilon(7e-4));
      CHECK((end_positions(run).segment<3>(6) - end_positions(rigid).segment<3>(6)).norm() < 7e-4);
    }
  }
}

namespace {

// A rod of 1 m and 1 kg that 1 N m turns, with 0.8 kg at X, 0.6 m from its pin with mu r = 0.1 m.
const std::string carrying_rod = R"toml([structure]
kind = "custom"
nodes = [{name = "A", position = [-1, 0, 0], fixed = true}, {name = "H", position = [0, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0]}, {name = "X", position = [0.6, 0, 0], mass = 0.8}]
rods = [{name = "b", nodes = ["H", "B"], mass = 1}, {name = "x", nodes = ["H", "X"], mass = 0}]
constraints = [{kind = "plane", nodes = ["B"], normal = [0, 1, 0]}]
[[forces]]
kind = "motor"
nodes = ["A", "H", "B"]
axis = [0, 1, 0]
stall_torque = 1
no_load_speed = 1e13
[[forces]]
kind = "friction"
nodes = ["B", "H", "A"]
axis = [0, 1, 0]
kinetic = 0
pin_friction = 0.2
pin_radius = 0.5
[solver]
stages = 4
step = 0.01
end_time = 1
)toml";

// Its rate after 1 s: the pin holds m / 2 and what it holds of M s, along the rod and across.
double carried_to(double along, double across = 0.5 + 0.8 * 0.6) {
  const double I = 1.0 / 3 + 0.8 * 0.36, h = 1e-3;
  const auto rate = [&](double w) {
    double a = 1 / I;
    for (int i = 0; i < 80; ++i) a = (1 - 0.1 * std::hypot(across * a, along * w * w)) / I;
    return a;
  };
  double w = 0;
  for (int i = 0; i < 1000; ++i) {  // 1e-13 off
    const double a = rate(w), b = rate(w + h / 2 * a), c = rate(w + h / 2 * b), d = rate(w + h * c);
    w += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return w;
}

}  // namespace

TEST_CASE("a pin bears what a pin between its rod's ends and a slider on it put there") {
  std::string pinned;
  for (int k = 0; k < 3; ++k) {
    std::string c;
    for (const std::string share : {"1", "-0.4", "-0.6"})
      for (int i = 0; i < 3; ++i) c += (c.empty() ? "" : ", ") + (i == k ? share : "0");
    pinned +=
        "[[constraints]]\nkind = \"relation\"\nnodes = [\"X\", \"H\", \"B\"]\ncoefficients = [" + c + "]\n";
  }
  const auto rate = [](const std::string& entry, const std::vector<std::string>& changes = {}) {
    const Simulation run = run_scene(carrying_rod + entry, changes);
    INFO(run.message);
    REQUIRE(run.status == RunStatus::completed);
    return run.trajectory.node_velocities(run.trajectory.size() - 1).segment<3>(6).norm();
  };
  // Order 8 in steps of 10 ms.
  const std::vector<std::string> one_rod = {"structure.rods=[{name='b', nodes=['H', 'B'], mass=1}]"};
  CHECK(rate(pinned, one_rod) == Approx(carried_to(0.5 + 0.48)).epsilon(1e-9));
  // Beside the rod it is on no rod: the share at the hinge is none of the rod's force.
  const double at_end = 0.5 + 0.8 * 0.36;
  CHECK(rate(pinned, {one_rod[0], "structure.nodes.X.position=[0.6, 0, 3]"}) ==
        Approx(carried_to(at_end, at_end)).epsilon(1e-9));
  // The other rod holds the slider from the pin, with a pin of its own, however the line is told.
  const auto in_line = [&](const std::string& nodes, const std::vector<std::string>& changes = {}) {
    return rate("[[constraints]]\nkind = \"collinear\"\nnodes = [" + nodes + "]\n", changes);
  };
  for (const char* nodes : {"'H', 'B', 'X'", "'B', 'H', 'X'", "'X', 'B', 'H'", "'B', 'X', 'H'"})
    CHECK(in_line(nodes) == Approx(carried_to(0.5)).epsilon(1e-9));
  // The first row of all: nothing pushes out of the plane.
  CHECK(in_line("'H', 'B', 'X'", {"structure.constraints=[]"}) == Approx(carried_to(0.5)).epsilon(1e-9));
  // On the line of the other rod, which takes M s^2 alpha over 1 m from B.
  for (const char* nodes : {"'H', 'X', 'B'", "'X', 'H', 'B'"})
    CHECK(in_line(nodes) == Approx(carried_to(0.5, at_end)).epsilon(1e-9));
}

TEST_CASE("friction by the force of a pin is refused where the couples on its rod are left open") {
  const std::string second =
      "[[constraints]]\nkind = \"combination\"\nname = \"NAME\"\nterms = [\"TERMS\"]\n"
      "motion = \"hold\"\n";
  const auto holds = [&](std::string name, const std::string& terms) {
    std::string out = second;
    out.replace(out.find("NAME"), 4, name);
    out.replace(out.find("TERMS"), 5, terms);
    return out;
  };
  const std::string one = holds("one", "1 angle A H B about 0 1 0\", \"1 angle H B C about 0 1 0"),
                    other = holds("other", "2 angle A H B about 0 1 0\", \"2 angle H B C about 0 1 0");
  CHECK(testing::error_of(pendulum + one) == "");
  const std::string said = testing::error_of(pendulum + one + other);
  for (const char* part : {"forces[2].pin_friction", "torque of 'one'", "leave open", "kinetic"})
    CHECK_THAT(said, Catch::Contains(part));
}

TEST_CASE("what acts on plates at a pin's rod is noted not to count in the pin's force") {
  const auto notes = [](const std::string& nodes) {
    const auto model = testing::model_of(pendulum + force("combination",
                                                          "name = \"crease\"\nstiffness = 1\n"
                                                          "terms = [\"1 dihedral " +
                                                              nodes + "\"]"));
    std::string all;
    for (const std::string& note : model->structure.notes) all += note + "\n";
    return all;
  };
  CHECK_THAT(notes("E H B R"),
             Catch::Contains("friction 'pin'") && Catch::Contains("'crease' acts on nodes"));
  CHECK_THAT(notes("E H K C"), !Catch::Contains("crease"));
}

}  // namespace pin_couples_test
