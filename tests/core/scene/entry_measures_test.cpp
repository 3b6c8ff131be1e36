// SPDX-License-Identifier: BSD-3-Clause
// What entries of a scene measure and hold, in poses in space, against the geometry written down.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/scene/surfaces.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace entry_measures_test {

namespace {

Structure structure_of(const std::string& text) {
  return build_structure(read_scene_text(text, "s.toml"));
}

const std::string nodes = R"(nodes = [
  {name = "A", position = [0.6, 0.8, 0.1], mass = 1}, {name = "H", position = [0.1, -0.2, 0.3], mass = 1},
  {name = "B", position = [-0.7, 0.5, 0.9], mass = 1}, {name = "C", position = [1.5, 1.1, -0.5], mass = 1},
  {name = "K", position = [1.9, 0.2, 0.4], mass = 1}, {name = "D", position = [2.3, 1.2, 1.1], mass = 1}]
)";

Vec3 at(const VectorXd& q, int node) {
  return q.segment<3>(3 * static_cast<Index>(node));
}
enum { A, H, B, C, K, D };

// From a to b: without a sign, or about n.
double between(const Vec3& a, const Vec3& b) {
  return std::acos(a.dot(b) / (a.norm() * b.norm()));
}
double about(const Vec3& n, const Vec3& a, const Vec3& b) {
  const Vec3 u = n.normalized(), p = a - u.dot(a) * u, r = b - u.dot(b) * u;
  return std::atan2(u.dot(p.cross(r)), p.dot(r));
}

// Poses beside the one that is given: no angle turns by half a turn.
VectorXd beside(const Structure& s, std::mt19937& dice) {
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  VectorXd q = node_positions(s);
  for (double& x : q) x += any(dice);
  return q;
}

double value(const Structure& s, const Measure& measure, const VectorXd& q) {
  return MeasureFunction(measure, s.deployment).value(q.data());
}

}  // namespace

TEST_CASE("an angle of rods is that at the node which they share whichever way each is told and cut") {
  const std::string n = "[0.3, -0.5, 1.2]";
  const Vec3 axis(0.3, -0.5, 1.2);
  for (const bool cut : {false, true})
    for (const auto& [first, second] : {std::pair{"'H', 'A'", "'H', 'B'"},
                                        {"'A', 'H'", "'H', 'B'"},
                                        {"'H', 'A'", "'B', 'H'"},
                                        {"'A', 'H'", "'B', 'H'"}})
      for (const bool sign : {false, true}) {
        CAPTURE(cut, first, second, sign);
        const std::string more = ", mass = 1, area = 1e-4}";
        const Structure s = structure_of(
            std::string("[structure]\nkind = 'custom'\n") +
            (cut ? "youngs_modulus = 7e10\nsegments = 3\n" : "") + nodes + "rods = [{name = 'r', nodes = [" +
            first + "]" + more + ", {name = 's', nodes = [" + second + "]" + more +
            ", {name = 't', nodes = ['C', 'K']" + more + "]\n[[forces]]\nkind = 'torsion_spring'\n" +
            "rods = ['r', 's']\nstiffness = 1\n" + (sign ? "axis = " + n : "") +
            "\n[[forces]]\nkind = 'torsion_spring'\nrods = ['t', 'r']\nstiffness = 1\n");
        const VectorXd q = node_positions(s);
        const Vec3 a = at(q, A) - at(q, H), b = at(q, B) - at(q, H), t = at(q, K) - at(q, C);
        const auto springs = [&] {
          std::vector<const Force*> found;
          for (const Force& f : s.forces)
            if (f.kind == "torsion_spring") found.push_back(&f);
          return found;
        }();
        REQUIRE(springs.size() == 2);
        const double wanted = sign ? about(axis, a, b) : between(a, b);
        CHECK(springs[0]->rest == Approx(wanted).epsilon(1e-12));
        CHECK(value(s, springs[0]->measure, q) == Approx(wanted).epsilon(1e-12));
        // No node is shared: from the first node of each to its second.
        CHECK(springs[1]->rest == Approx(between(t, first[1] == 'H' ? a : Vec3(-a))).epsilon(1e-12));
        CHECK(value(s, springs[1]->measure, q) == Approx(springs[1]->rest).epsilon(1e-12));
        CHECK(springs[0]->measure.nodes.size() == (cut ? 6U : 4U));
      }
}

TEST_CASE("gears and racks and telescopes hold the sums that are written down") {
  const Structure s = structure_of("[structure]\nkind = 'custom'\n" + nodes + R"(
[[constraints]]
kind = "gear"
nodes = ["A", "H", "B", "C", "K", "D"]
radii = [0.7, -1.9]
axis = [0.3, -0.5, 1.2]
second_axis = [1, 0.2, 0.1]
[[constraints]]
kind = "gear"
nodes = ["A", "H", "B", "C", "K", "D"]
radii = [0.7, -1.9]
axis = [0.3, -0.5, 1.2]
[[constraints]]
kind = "rack"
nodes = ["A", "H", "B", "K", "D"]
radius = -0.4
direction = [2, -3, 6]
axis = [0.3, -0.5, 1.2]
[[constraints]]
kind = "rack"
nodes = ["A", "H", "B", "D"]
radius = 0.3
direction = [2, -3, 6]
[[constraints]]
kind = "telescope"
nodes = ["A", "H", "B", "C"]
shares = [0.5, 2, 3]
motion = "rate"
rate = 0.3
start = 1
[[constraints]]
kind = "combination"
terms = ["2.5 length A B", "-0.7 coordinate C along 0 3 4", "coordinate H K along 1 0 0", "0.4 angle A H B"]
motion = "rate"
rate = -0.2
)");
  std::mt19937 dice(16);
  const VectorXd start = node_positions(s);
  std::vector<const Constraint*> sums, lines;
  for (const Constraint& c : s.constraints) {
    if (c.kind == "measure") sums.push_back(&c);
    if (c.kind == "collinear") lines.push_back(&c);
  }
  REQUIRE(sums.size() == 8);
  const Vec3 n(0.3, -0.5, 1.2), m(1, 0.2, 0.1), d = Vec3(2, -3, 6) / 7;
  const auto all = [&](const VectorXd& q) {
    const auto way = [&](int i, int k) { return Vec3(at(q, k) - at(q, i)); };
    const Vec3 a = way(H, A), b = way(H, B), c = way(K, C), e = way(K, D);
    const double l1 = way(A, H).norm(), l2 = way(H, B).norm(), l3 = way(B, C).norm();
    VectorXd out(8);
    out << about(n, a, b) - 1.9 / 0.7 * about(m, c, e), about(n, a, b) - 1.9 / 0.7 * about(n, c, e),
        d.dot(e) + 0.4 * about(n, a, b), d.dot(at(q, D)) - 0.3 * between(a, b), l1 - 0.5 / 2 * l2,
        l2 - 2.0 / 3 * l3, l1 + l2 + l3,
        2.5 * way(A, B).norm() - 0.7 * Vec3(0, 0.6, 0.8).dot(at(q, C)) + way(H, K)[0] + 0.4 * between(a, b);
    return out;
  };
  for (int k = 0; k < 5; ++k) {
    const VectorXd q = beside(s, dice), wanted = all(q), first = all(start);
    for (std::size_t i = 0; i < 8; ++i) {
      CAPTURE(i);
      const auto row = static_cast<Index>(i);
      CHECK(value(s, sums[i]->measure, q) == Approx(wanted[row]).epsilon(0).margin(1e-12));
      const double moved = i == 6 ? 0.3 * 1.5 : i == 7 ? -0.2 * 2.5 : 0;
      CHECK(sums[i]->target(2.5) == Approx(first[row] + moved).epsilon(0).margin(1e-12));
    }
  }
  REQUIRE(lines.size() == 2);
  CHECK(lines[0]->nodes == std::vector<int>{A, C, H});
  CHECK(lines[1]->nodes == std::vector<int>{A, C, B});
}

TEST_CASE("mirrors and equal coordinates and relations hold where the geometry says and nowhere else") {
  const Structure s = structure_of("[structure]\nkind = 'custom'\n" + nodes + R"(
[[constraints]]
kind = "mirror"
nodes = ["A", "B"]
normal = [2, -3, 6]
point = [0.3, 0.4, -0.2]
[[constraints]]
kind = "equal"
nodes = ["C", "K", "D"]
direction = [2, -3, 6]
[[constraints]]
kind = "relation"
nodes = ["H", "C"]
coefficients = [0.3, -0.4, 1.1, 2, 0.6, -0.8]
[[constraints]]
kind = "relation"
nodes = ["D"]
coefficients = [0.3, -0.4, 1.1]
value = 0.9
)");
  const Vec3 n = Vec3(2, -3, 6) / 7, p(0.3, 0.4, -0.2), u(0.3, -0.4, 1.1), w(2, 0.6, -0.8);
  std::mt19937 dice(17);
  REQUIRE(s.constraints.size() == 7);
  const VectorXd start = node_positions(s);
  for (int k = 0; k < 5; ++k) {
    const VectorXd q = beside(s, dice);
    const auto off = [&](std::size_t row) {
      const Constraint& c = s.constraints[row];
      double sum = -c.value;
      for (std::size_t i = 0; i < c.nodes.size(); ++i) sum += c.vectors[i].dot(at(q, c.nodes[i]));
      return sum;
    };
    const Vec3 a = at(q, A), image = a - 2 * n.dot(a - p) * n;
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(off(i) ==
            Approx(at(q, B)[static_cast<Index>(i)] - image[static_cast<Index>(i)]).epsilon(0).margin(1e-14));
    CHECK(off(3) == Approx(n.dot(at(q, K) - at(q, C))).epsilon(0).margin(1e-14));
    CHECK(off(4) == Approx(n.dot(at(q, D) - at(q, C))).epsilon(0).margin(1e-14));
    const double moved = u.dot(at(q, H) - at(start, H)) + w.dot(at(q, C) - at(start, C));
    CHECK(off(5) == Approx(moved).epsilon(0).margin(1e-14));
    CHECK(off(6) == Approx(u.dot(at(q, D)) - 0.9).epsilon(0).margin(1e-14));
  }
}

// From 0 at the pose that is given to 1 at the deployed value, in the measure's unit and on the turn that is
// told.
TEST_CASE("a deployment is told by its measure from the stowed value to the deployed one") {
  const Vec3 n(0.3, -0.5, 1.2);
  const Structure bare = structure_of("[structure]\nkind = 'custom'\n" + nodes);
  const VectorXd q = node_positions(bare);
  const Vec3 a = at(q, A) - at(q, H), b = at(q, B) - at(q, H);
  const double degree = pi / 180, angle = about(n, a, b), length = (at(q, C) - at(q, A)).norm();
  const auto deployment = [&](const std::string& measure, double deployed, double stowed) {
    return structure_of("[structure]\nkind = 'custom'\n" + nodes + "[deployment]\nmeasure = '" + measure +
                        "'\ndeployed = " + testing::number(deployed) +
                        (std::isnan(stowed) ? "" : "\nstowed = " + testing::number(stowed)) + "\n")
        .deployment;
  };
  const double as_built = std::numeric_limits<double>::quiet_NaN();
  const std::string turn = "angle A H B about 0.3 -0.5 1.2";
  for (const double rounds : {0.0, 1.0, -2.0}) {
    const double stowed = angle / degree + 360 * rounds - 20, deployed = stowed + 130;
    const Deployment d = deployment(turn, deployed, stowed);
    CHECK(d.measured);
    CHECK(d.measure.kind == MeasureKind::angle);
    CHECK(d.stowed == Approx(stowed * degree).epsilon(1e-14));
    CHECK(d.deployed == Approx(deployed * degree).epsilon(1e-14));
    CHECK(d.measure.reference == Approx(angle + 2 * pi * rounds).epsilon(1e-12));
    CHECK(d.fraction(q, d.first_angles()) == Approx(20.0 / 130).epsilon(1e-10));
  }
  const Deployment built = deployment(turn, angle / degree - 90, as_built);
  CHECK(built.stowed == Approx(angle).epsilon(1e-12));
  CHECK(built.fraction(q, built.first_angles()) == Approx(0).epsilon(0).margin(1e-12));
  const Deployment stretch = deployment("length A C", length + 0.6, length - 0.2),
                   twice = deployment("2 length A C", 2 * length + 1.2, 2 * length - 0.4),
                   sum = deployment("0.5 angle A H B", 0.5 * between(a, b) / degree + 30, as_built);
  CHECK(stretch.measure.kind == MeasureKind::length);
  CHECK(twice.measure.kind == MeasureKind::combination);
  CHECK(stretch.fraction(q) == Approx(0.25).epsilon(1e-12));
  CHECK(twice.fraction(q) == Approx(0.25).epsilon(1e-12));
  CHECK(sum.stowed == Approx(0.5 * between(a, b)).epsilon(1e-12));
  CHECK(sum.deployed - sum.stowed == Approx(30 * degree).epsilon(1e-12));
}

TEST_CASE("a surface keeps what its entry says of it") {
  ParamSet values(surface_params());
  values.set("kind", std::string("net"));
  values.set("shape", std::string("paraboloid"));
  values.set("focal_ratio", 0.7);
  values.set("cells", 13L);
  values.set("opacity", 0.37);
  values.set("enabled", false);
  for (const SceneSurface& s :
       {scene_surface(values), scene_surface(surface_values(scene_surface(values)))}) {
    CHECK((s.kind == "net" && s.shape == "paraboloid"));
    CHECK((s.focal_ratio == 0.7 && s.cells == 13 && s.opacity == 0.37 && !s.enabled));
  }
  values.set("kind", std::string("paraboloid")), values.set("shape", std::string("flat"));
  CHECK(scene_surface(values).shape == "paraboloid");
}

namespace {

std::string triple(const Vec3& x) {
  return "[" + testing::number(x[0]) + ", " + testing::number(x[1]) + ", " + testing::number(x[2]) + "]";
}

}  // namespace

// O-A-B in a plane that is not through the origin, Q beside it: planes on A and B say that it is flat, no
// more, while nothing acts across.
TEST_CASE("planes are no supports while nothing pushes the structure out of them") {
  const Vec3 n = Vec3(2, -3, 6) / 7, u = Vec3(3, 2, 0).normalized(), w = n.cross(u), p(0.3, 0.4, -0.2);
  const std::string across = triple(u + 0.2 * n), within = triple(0.3 * u - w), skew = triple(n + 0.5 * u);
  const auto flat = [&](const std::string& entry, const std::string& planes = "'A', 'B'") {
    const Structure s = structure_of(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = " + triple(p) +
        ", fixed = true}, {name = 'A', position = " + triple(p + 0.8 * u + 0.3 * w) +
        ", mass = 1}, {name = 'B', position = " + triple(p + 1.5 * u - 0.4 * w) +
        ", mass = 2}, {name = 'Q', position = " + triple(p + 0.4 * u + 0.7 * n) +
        ", fixed = true}]\nrods = [{nodes = ['O', 'A'], mass = 1}, {nodes = ['A', 'B'], mass = 1}]\n" +
        "[[constraints]]\nkind = 'plane'\nnodes = [" + planes + "]\nnormal = " + triple(-0.4 * n) + "\n" +
        entry);
    int said = 0, all = 0;
    for (const Constraint& c : s.constraints)
      if (c.kind == "plane") ++all, said += c.symmetry;
    CHECK((said == 0 || said == all));
    return said > 0;
  };
  const auto force = [](const std::string& kind, const std::string& rest) {
    return "[[forces]]\nkind = '" + kind + "'\n" + rest + "\n";
  };
  const auto row = [](const std::string& kind, const std::string& rest) {
    return "[[constraints]]\nkind = '" + kind + "'\n" + rest + "\n";
  };
  const std::string to_Q = "[deployment]\nmeasure = 'length Q B'\ndeployed = 1.6\n",
                    to_O = "[deployment]\nmeasure = 'length O B'\ndeployed = 1.3\n",
                    latch = "[solver]\nat_deployed = 'latch'\n";
  for (const std::string& inside :
       {std::string(), "[gravity]\nacceleration = " + within + "\n",
        "[[loads]]\nnodes = ['B']\nforce = " + within + "\n",
        force("spring", "nodes = ['O', 'B']\nstiffness = 1"),
        force("torsion_spring", "nodes = ['O', 'A', 'B']\nstiffness = 1"),
        force("torsion_spring", "nodes = ['O', 'A', 'B']\nstiffness = 1\naxis = " + triple(-3 * n)),
        force("combination", "stiffness = 1\nterms = ['1 length O B', '2 angle O A B']"),
        row("length_stop", "nodes = ['O', 'B']\nmin = 0.1"),
        row("coordinate_stop", "nodes = ['B']\nmin = -9\ndirection = " + within),
        row("length", "nodes = ['O', 'B']"), to_Q, to_O, to_O + latch}) {
    INFO(inside);
    CHECK(flat(inside));
  }
  for (const std::string& out :
       {"[gravity]\nacceleration = " + across + "\n", "[[loads]]\nnodes = ['B']\nforce = " + across + "\n",
        force("load_over_time", "nodes = ['B']\nforce = " + within),
        force("spring", "nodes = ['Q', 'B']\nstiffness = 1"),
        force("torsion_spring", "nodes = ['O', 'A', 'B']\nstiffness = 1\naxis = " + skew),
        force("combination", "stiffness = 1\nterms = ['1 length O B', '2 length Q A']"),
        row("length_stop", "nodes = ['Q', 'B']\nmin = 0.1"),
        row("coordinate_stop", "nodes = ['B']\nmin = -9\ndirection = " + across),
        row("length", "nodes = ['Q', 'B']"),
        row("relation", "nodes = ['Q', 'B']\ncoefficients = [1, 2, 3, 4, 5, 6]"), to_Q + latch}) {
    INFO(out);
    CHECK_FALSE(flat(out));
  }
  CHECK_FALSE(flat("", "'A'"));
}

TEST_CASE("stops have the limits and rebounds and speeds of their entries in their unit") {
  const Structure s = structure_of("[structure]\nkind = 'custom'\n" + nodes + R"(
[[constraints]]
kind = "length_stop"
nodes = ["A", "B"]
min = 0.2
max = 7.5
restitution = 0.3
rest_speed = 0.04
[[constraints]]
kind = "angle_stop"
nodes = ["A", "H", "B"]
axis = [0.3, -0.5, 1.2]
min = -170
max = 175
restitution = 0.4
rest_speed = 5
[[constraints]]
kind = "clearance"
nodes = ["C", "K"]
clearance = 3.5
restitution = 0.6
rest_speed = 0.07
)");
  REQUIRE(s.stops.size() == 3);
  const double degree = pi / 180;
  CHECK((s.stops[0].min == 0.2 && s.stops[0].max == 7.5 && s.stops[2].max == 3.5));
  CHECK(s.stops[1].min == Approx(-170 * degree).epsilon(1e-15));
  CHECK(s.stops[1].max == Approx(175 * degree).epsilon(1e-15));
  CHECK((s.stops[0].restitution == 0.3 && s.stops[1].restitution == 0.4 && s.stops[2].restitution == 0.6));
  CHECK((s.stops[0].rest_speed == 0.04 && s.stops[2].rest_speed == 0.07));
  CHECK(s.stops[1].rest_speed == Approx(5 * degree).epsilon(1e-15));
  CHECK(std::isinf(s.stops[2].min));
}

TEST_CASE("what is wrong with rods and their material is said at its key") {
  const std::string two = "[structure]\nkind = 'custom'\n" + nodes;
  CHECK_THAT(testing::error_of(two + "rods = [{nodes = ['A', 'H'], mass = 1, masss = 2}]\n"),
             Catch::Contains("structure.rods[0].masss"));
  CHECK_THAT(
      testing::error_of(two + "rods = [{nodes = ['A', 'H'], mass = 1, area = 1e-4}]\n"
                              "rod_model = 'elastic'\nyoungs_modulus = 1e9\ndamping_time = 0.1\n"
                              "damping_ratio = 0.2\n"),
      Catch::Contains("s.toml:10:16: structure.damping_time: give damping_ratio or damping_time, not both"));
  CHECK_THAT(testing::error_of(two + "[[constraints]]\nkind = 'gear'\nnodes = ['A', 'H', 'B', 'C', 'K']\n"
                                     "radii = [1, 2]\n"),
             Catch::Contains("must be six"));
  CHECK_THAT(testing::error_of(two + "[[constraints]]\nkind = 'rack'\nnodes = ['A', 'H', 'B']\nradius = 1\n"
                                     "direction = [1, 0, 0]\n"),
             Catch::Contains("must be A, HINGE, B"));
}

}  // namespace entry_measures_test
