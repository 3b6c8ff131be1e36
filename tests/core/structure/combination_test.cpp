// SPDX-License-Identifier: BSD-3-Clause
// Sums of measures as rows and as springs: gears, racks, telescopes and cables against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace combination_test {

namespace {

using testing::end_positions, testing::error_of, testing::model_of, testing::run_scene;

// A ring that floats freely, one unit of which is driven harder than the others.
const std::string ring = R"(
[structure]
kind = "hoop"
units = 6
fold_angle = 83
[solver]
stages = 4
step = 0.02
end_time = 1.5
)";

// All bottom rods mesh: those beside each other at a post, and both of a unit.
std::string gear(int post, int hinge, int other_post, int other_hinge) {
  const auto wheel = [](int k, int m) {
    const std::string i = std::to_string(k);
    return "\"T" + i + "\", \"B" + i + "\", \"Mb" + std::to_string(m) + "\"";
  };
  return "[[constraints]]\nkind = \"gear\"\nradii = [0.7, -0.7]\nnodes = [" + wheel(post, hinge) + ", " +
         wheel(other_post, other_hinge) + "]\n";
}

std::string gears_of_ring() {
  std::string text;
  for (int k = 1; k < 6; ++k) text += gear(k, k, k, k - 1);
  for (int k = 0; k < 6; ++k) text += gear(k, k, (k + 1) % 6, k);
  return text;
}

// Two weights of 3 and 5 kg on a cable over two pulleys.
const std::string atwood = R"(
[structure]
kind = "custom"
nodes = [
  {name = "P", position = [0, 0, 3], fixed = true}, {name = "Q", position = [1.3, 0, 3], fixed = true},
  {name = "A", position = [0, 0, 1], mass = 3}, {name = "B", position = [1.3, 0, 1.4], mass = 5}]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "cable"
name = "rope"
nodes = ["A", "P", "Q", "B"]
[solver]
stages = 3
step = 0.01
end_time = 0.5
)";

}  // namespace

// With the gears all units have one fold angle, and what drives the ring is the sum of the forces: 5 * 150 +
// 690 N spread over six units. Mirror planes say the same. Rows of both differ, the motion by round-off alone
// (1e-16 times a few hundred rows and 75 steps).
TEST_CASE("a ring coupled by gears moves as one with mirror planes") {
  const Simulation geared =
      run_scene(ring + gears_of_ring(), {"structure.model=joints", "structure.hinge_force=150",
                                         "structure.perturbed_unit=2", "structure.perturbed_force=690"});
  const Simulation mirrored = run_scene(ring, {"structure.hinge_force=240"});
  REQUIRE(geared.trajectory.size() == mirrored.trajectory.size());
  const std::size_t last = mirrored.trajectory.size() - 1;
  CHECK(mirrored.trajectory.end_time() == geared.trajectory.end_time());
  CHECK((geared.trajectory.positions(last) - mirrored.trajectory.positions(last)).lpNorm<Eigen::Infinity>() <=
        1e-12);
  // It has moved, and without gears it is another motion.
  CHECK((mirrored.trajectory.positions(last) - mirrored.trajectory.positions(0)).lpNorm<Eigen::Infinity>() >
        0.1);
  const Simulation loose = run_scene(ring, {"structure.model=joints", "structure.hinge_force=150",
                                            "structure.perturbed_unit=2", "structure.perturbed_force=690"});
  CHECK((loose.trajectory.positions(loose.trajectory.size() - 1) - mirrored.trajectory.positions(last))
            .lpNorm<Eigen::Infinity>() > 0.01);
}

// Atwood's machine, a = g (5 - 3) / (5 + 3): the rope is taut from the start and stays so. The path is a sum
// of straight spans, so that the motion is uniformly accelerated and any method exact.
TEST_CASE("weights on a cable over pulleys fall as Atwood's machine says") {
  const double a = 9.81 * 2 / 8, s = 0.5 * a * 0.25;
  const Simulation run = run_scene(atwood);
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd end = end_positions(run);
  CHECK(end[8] == Approx(1 + s).epsilon(0).margin(1e-12));
  CHECK(end[11] == Approx(1.4 - s).epsilon(0).margin(1e-12));
}

// Drawn in from t = 0 by 0.4 m/s: the lighter weight hangs on the drum with T = m g when nothing accelerates.
TEST_CASE("a cable that is drawn in lifts what hangs on it") {
  const Simulation run = run_scene(atwood, {"structure.nodes[3].fixed=true", "constraints[0].motion=smooth",
                                            "constraints[0].to=5.3", "constraints[0].duration=0.4"});
  REQUIRE(run.status == RunStatus::completed);
  // 2 + 1.3 + 1.6 = 4.9 m at t = 0, 5.3 m in the end: paid out slower than it would fall.
  CHECK(end_positions(run)[8] == Approx(1 - 0.4).epsilon(0).margin(1e-11));
  const Diagnostics d = diagnose(run);
  CHECK(d.at("rope.force_N").values.back() == Approx(-3 * 9.81).epsilon(0).margin(1e-8));
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-9);
}

// m x'' = -k (x - l) on the whole path: a mass in the middle of a taut elastic cable of 2 spans, moved along
// it, feels nothing, since S stays; moved across by y it feels 2 T y / s with T = E A (S / L - 1).
TEST_CASE("an elastic cable runs freely over what it passes") {
  const std::string bead = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [-1, 0, 0], fixed = true}, {name = "E", position = [1, 0, 0], fixed = true},
  {name = "A", position = [0.1, 0, 0], velocity = [0.3, 0, 0], mass = 0.5}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[forces]]
kind = "cable"
nodes = ["O", "A", "E"]
axial_stiffness = 900
length = 1.7
[solver]
step = 0.05
end_time = 1
)";
  CHECK(end_positions(run_scene(bead))[6] == Approx(0.4).epsilon(0).margin(1e-13));
  const auto model = testing::model_of(bead);
  VectorXd q(9), f = VectorXd::Zero(9);
  q << -1, 0, 0, 1, 0, 0, 0, 0.75, 0;  // spans of 1.25 m
  model->system.add_applied_force(0.0, q, VectorXd::Zero(9), 1.0, f);
  CHECK(f[7] == Approx(-2 * 900 * (2.5 / 1.7 - 1) * 0.75 / 1.25).epsilon(1e-14));
}

// A winch shortens L(t): energy that it puts in is on the books, with the damper's.
TEST_CASE("the books of a winch on an elastic cable close") {
  const Simulation run =
      run_scene(atwood, {"constraints[0].axial_stiffness=4000", "constraints[0].damping=20",
                         "constraints[0].motion=smooth", "constraints[0].to=4.6",
                         "constraints[0].duration=0.4", "solver.stages=4"});
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  CHECK(std::abs(d.at("work_J").values.back()) > 1);
  CHECK(d.at("dissipated_J").values.back() > 1e-3);
  // Quadrature of order 6 and a method of order 6 of a swing of 22 rad/s: (0.22 / 4)^6 of some 40 J.
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-5);
}

// A pinion of radius r under a constant force F on its rack: (m_rack + m_tip (l / r)^2) x'' = F. The crank
// goes round several times.
TEST_CASE("a rack turns its pinion any number of turns") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true}, {name = "E", position = [1, 0, 0], fixed = true},
  {name = "T", position = [0.3, 0.4, 0], mass = 0.8}, {name = "R", position = [0, -2, 0], mass = 3}]
rods = [{nodes = ["O", "T"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["T"]
normal = [0, 0, 1]
[[structure.constraints]]
kind = "line"
nodes = ["R"]
direction = [1, 0, 0]
[[constraints]]
kind = "rack"
nodes = ["E", "O", "T", "R"]
radius = 0.2
direction = [1, 0, 0]
axis = [0, 0, 1]
[[loads]]
nodes = ["R"]
force = [11, 0, 0]
[solver]
stages = 4
step = 0.02
end_time = 2
)";
  const double mass = 3 + 0.8 * std::pow(0.5 / 0.2, 2), x = 0.5 * 11 / mass * 4;
  const Simulation run = run_scene(text);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(x / 0.2 > 2 * pi);  // more than a turn
  const VectorXd end = end_positions(run);
  // Order 6 at 0.02 s and up to 14 rad/s: (0.28 / 4)^6 = 1e-7 of a radius, less its constant of 1e-2.
  CHECK(end[9] == Approx(x).epsilon(0).margin(1e-8));
  const double turned = std::atan2(0.4, 0.3) + x / 0.2;
  CHECK(end[6] == Approx(0.5 * std::cos(turned)).epsilon(0).margin(1e-8));
  CHECK(end[7] == Approx(0.5 * std::sin(turned)).epsilon(0).margin(1e-8));
}

TEST_CASE("stages of a telescope share the extension that drives them") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.5, 0, 0], mass = 1},
  {name = "C", position = [1.2, 0, 0], mass = 2}, {name = "D", position = [1.6, 0, 0], mass = 4}]
[[structure.constraints]]
kind = "line"
nodes = ["D"]
direction = [1, 0, 0]
[[constraints]]
kind = "telescope"
nodes = ["A", "B", "C", "D"]
shares = [1, 2, 5]
motion = "smooth"
to = 2.4
duration = 0.6
[solver]
step = 0.05
end_time = 0.8
)";
  const VectorXd end = end_positions(run_scene(text));
  CHECK(end[3] == Approx(0.6).epsilon(0).margin(1e-12));
  CHECK(end[6] == Approx(1.5).epsilon(0).margin(1e-12));
  CHECK(end[9] == Approx(2.4).epsilon(0).margin(1e-12));
}

// A dihedral sprung like a hinge: two triangles about a fixed edge, of which one is free with the inertia
// m h^2: theta'' = -k (theta - theta_0) / (m h^2).
TEST_CASE("a combination with a dihedral is a torsion spring between two faces") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 1, 0], fixed = true}, {name = "P", position = [0, 0, 0], fixed = true},
  {name = "Q", position = [0, 0, 1], fixed = true}, {name = "D", position = [-0.6, 0.8, 0.5], mass = 0.7}]
rods = [{nodes = ["P", "D"], mass = 0}, {nodes = ["Q", "D"], mass = 0}]
[[forces]]
kind = "combination"
terms = ["2 dihedral A P Q D"]
stiffness = 0.9
free_value = 90
[solver]
stages = 4
step = 0.02
end_time = 2
)";
  // theta from A to D about z: atan2 of the turned x-axis; S = 2 theta, F = -k (S - pi/2) dS/dtheta.
  const double begin = std::atan2(0.6, 0.8), rest = pi / 4, w = std::sqrt(0.9 * 4 / (0.7 * 1.0));
  const double theta = rest + (begin - rest) * std::cos(2 * w);
  const VectorXd end = end_positions(run_scene(text));
  CHECK(end[9] == Approx(-std::sin(theta)).epsilon(0).margin(1e-9));
  CHECK(end[10] == Approx(std::cos(theta)).epsilon(0).margin(1e-9));
}

// Two arms of 1 m on one shaft, at 3 rad/s and 0.3 rad apart, and a spring on the difference of their angles,
// each of which turns twice round: phi = 0.3 cos(w t) apart, w^2 = k (1/I + 1/J), the sum of I a and J b as
// at the start.
TEST_CASE("a spring on a difference of angles goes on while both turn round") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true}, {name = "H", position = [1, 0, 0], fixed = true},
  {name = "A", position = [1, 0, 0], velocity = [0, 3, 0], mass = 0.5},
  {name = "B", position = [0.955336489125606, 0.29552020666133955, 0], velocity = [-0.8865606199840187, 2.866009467376818, 0], mass = 2}]
rods = [{nodes = ["O", "A"], mass = 0}, {nodes = ["O", "B"], mass = 0}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]},
               {kind = "plane", nodes = ["B"], normal = [0, 0, 1]}]
[[forces]]
kind = "combination"
terms = ["-1 angle A O H about 0 0 1", "1 angle B O H about 0 0 1"]
stiffness = 0.9
free_value = 0
[solver]
stages = 4
step = 0.02
end_time = 4
)";
  const double w = std::sqrt(0.9 * (1 / 0.5 + 1 / 2.0)), apart = 0.3 * std::cos(4 * w);
  const double a = 3 * 4 + (2 * 0.3 - 2 * apart) / 2.5, b = a + apart;
  const VectorXd end = end_positions(run_scene(text));
  CHECK(end[6] == Approx(std::cos(a)).epsilon(0).margin(1e-8));
  CHECK(end[7] == Approx(std::sin(a)).epsilon(0).margin(1e-8));
  CHECK(end[9] == Approx(std::cos(b)).epsilon(0).margin(1e-8));
  CHECK(end[10] == Approx(std::sin(b)).epsilon(0).margin(1e-8));
}

// Two panels that stand 90 degrees open about the x axis: L lies in -y of it, R in +z. About the edge from H0
// to H1, which is +x, the half-plane of R follows that of L by atan2(x . (L x R), L . R) = atan2(-1, 0) = -90
// deg.
TEST_CASE("a dihedral has a sign, and one that is sent the long way round is noted") {
  const std::string panels = R"(
[structure]
kind = "custom"
nodes = [
  {name = "H0", position = [0, 0, 0], fixed = true}, {name = "H1", position = [1, 0, 0], fixed = true},
  {name = "L", position = [0.5, -1, 0], fixed = true}, {name = "R", position = [0.5, 0, 1], mass = 0.3}]
rods = [{nodes = ["H0", "R"], mass = 1}, {nodes = ["H1", "R"], mass = 1}]
[solver]
step = 0.05
)";
  const auto notes = [&](const std::string& entry) {
    std::string all;
    const auto model = model_of(panels + entry);
    for (const std::string& note : model->structure.notes) all += note + "\n";
    return all;
  };
  const auto drive = [](const std::string& term, const std::string& to) {
    return "[[constraints]]\nkind = 'combination'\nterms = ['" + term + "']\nmotion = 'smooth'\nto = " + to +
           "\n";
  };
  const std::string long_way = notes(drive("dihedral L H0 H1 R", "180"));
  CHECK(long_way.starts_with(
      "s.toml:14:6: constraints[0].to: takes the dihedral from -90 to 180 deg, more than "));
  CHECK(long_way.find("name A and D the other way round to change its sign") != std::string::npos);
  CHECK(notes(drive("-2 dihedral L H0 H1 R", "-360")) == long_way);  // -2 times as much
  for (const char* order : {"R H0 H1 L", "L H1 H0 R"})
    CHECK(notes(drive(std::string("dihedral ") + order, "180")).empty());
  for (const char* to : {"-180", "90", "-270"}) CHECK(notes(drive("dihedral L H0 H1 R", to)).empty());
  // The short way to 180 lays the panel flat at +y without going through the other one at 0.
  const Simulation run = run_scene(panels + "end_time = 1\n" + drive("dihedral R H0 H1 L", "180"));
  CHECK((run.trajectory.node_positions(run.trajectory.size() - 1).tail<3>() - Vec3(0.5, 1, 0)).norm() < 1e-9);
  const std::string spring = "[[forces]]\nkind = 'combination'\nterms = ['dihedral L H0 H1 R']\n";
  CHECK(notes(spring + "stiffness = 2\nfree_value = 135\n")
            .find("forces[0].free_value: takes the dihedral from -90 to 135") != std::string::npos);
  CHECK(notes(spring + "stiffness = 2\nfree_value = 45\n").empty());
  const std::string deployment = "[deployment]\nmeasure = 'dihedral L H0 H1 R'\n";
  CHECK(notes(deployment + "deployed = 180\n")
            .find("deployment.deployed: takes the dihedral from -90 to 180") != std::string::npos);
  CHECK(notes(deployment + "deployed = -180\n").empty());
}

TEST_CASE("combinations that cannot be say what is wrong and where") {
  const auto with = [](const std::string& entry) { return error_of(atwood + "[[constraints]]\n" + entry); };
  CHECK(with("kind = 'cable'\nnodes = ['A']\n").find("constraints[1].nodes: must be at least two") !=
        std::string::npos);
  CHECK(with("kind = 'gear'\nnodes = ['A', 'P', 'Q', 'B', 'Q', 'P']\nradii = [0.1, 0]\n")
            .find("constraints[1].radii: must not be 0") != std::string::npos);
  CHECK(with("kind = 'gear'\nnodes = ['A', 'P', 'Q']\nradii = [0.1, 0.2]\n").find("must be six") !=
        std::string::npos);
  CHECK(with("kind = 'rack'\nnodes = ['A', 'P', 'Q', 'B']\nradius = 0\ndirection = [1, 0, 0]\n")
            .find("constraints[1].radius: must not be 0") != std::string::npos);
  CHECK(with("kind = 'cable'\nnodes = ['A', 'P']\nlength = 1.5\n").find("is shorter than the path") !=
        std::string::npos);
  CHECK(with("kind = 'combination'\nterms = ['2 lenght A P']\n").find("measures nothing that is known") !=
        std::string::npos);
  for (const char* mistyped : {"2 lenght A P", "lenght A P", "lengths A P"}) {
    const std::string said = with(std::string("kind = 'combination'\nterms = ['") + mistyped + "']\n");
    INFO(said);
    CHECK(said.find(std::string("\"") + mistyped +
                    "\" measures nothing that is known (did you mean 'length'?)") != std::string::npos);
  }
  CHECK(with("kind = 'combination'\nterms = ['banana A P']\n")
            .find("\"banana A P\" does not begin with a number") != std::string::npos);
  CHECK(with("kind = 'combination'\n").find("terms: is missing; must be a list of terms such as") !=
        std::string::npos);
  CHECK(with("kind = 'combination'\nterms = ['0 length A P']\n").find("coefficient 0") != std::string::npos);
  CHECK(
      testing::error_of("structure = {kind = 'custom', nodes = [{name = 'left foot', position = [0, 0, 0]}, "
                        "{name = 'B', position = [1.3, 0, 0], mass = 1}]}\n[[constraints]]\n"
                        "kind = 'combination'\nterms = ['length left foot B']\n")
          .find(
              "has 'left', a part of a name with a space, which cannot stand in a term: rename that node") !=
      std::string::npos);
  CHECK(with("kind = 'combination'\nterms = ['1 length A X']\n").find("there is no node 'X'") !=
        std::string::npos);
  CHECK(with("kind = 'telescope'\nnodes = ['A', 'P', 'Q']\nshares = [1, 0]\n").find("shares: must be > 0") !=
        std::string::npos);
}

TEST_CASE("a combination without a name is called by its sum") {
  const auto model = testing::model_of(atwood + R"([[forces]]
kind = "combination"
terms = ["-1.36 length A P", "-0.268 length A B", "1.43 length P B"]
stiffness = 3
)");
  CHECK(model->structure.forces.back().name ==
        "combination of -1.36 length A P - 0.268 length A B + 1.43 length P B");
}

}  // namespace combination_test
