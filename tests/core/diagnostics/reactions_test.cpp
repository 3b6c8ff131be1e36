// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/reactions.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/export/summary.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace reactions_test {

using testing::run_scene;

namespace {

const std::string custom = "[structure]\nkind = 'custom'\n";

std::string node(const std::string& name, const Vec3& x, const std::string& rest) {
  return "[[structure.nodes]]\nname = '" + name + "'\nposition = [" + testing::number(x.x()) + ", " +
         testing::number(x.y()) + ", " + testing::number(x.z()) + "]\n" + rest + "\n";
}

std::string rod(const std::string& a, const std::string& b, const std::string& rest) {
  return "[[structure.rods]]\nnodes = ['" + a + "', '" + b + "']\n" + rest + "\n";
}

std::string run_for(double end, double step = 0.01) {
  return "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nstep = " + testing::number(step) +
         "\nend_time = " + testing::number(end) + "\n";
}

Vec3 reaction(const Diagnostics& d, const std::string& name, std::size_t i) {
  return {d.at(name + ".reaction_x_N").values[i], d.at(name + ".reaction_y_N").values[i],
          d.at(name + ".reaction_z_N").values[i]};
}

bool unique(const Diagnostics& d, const std::string& name, std::size_t i) {
  return d.at(name + ".reaction_unique").values[i] == 1.0;
}

// Of whole rods and nodes, by the formulas of uniform bodies [N s].
Vec3 momentum(const Trajectory& trajectory, std::size_t i) {
  const Structure& s = trajectory.structure();
  const VectorXd v = trajectory.node_velocities(i);
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < s.nodes.size(); ++n)
    sum += s.nodes[n].mass * v.segment<3>(3 * static_cast<Index>(n));
  for (const Rod& r : s.rods) sum += r.mass / 2 * (v.segment<3>(3 * r.a) + v.segment<3>(3 * r.b));
  return sum;
}

double mass_of(const Structure& s) {
  double mass = 0;
  for (const Node& n : s.nodes) mass += n.mass;
  for (const Rod& r : s.rods) mass += r.mass;
  return mass;
}

}  // namespace

// Along the rod m g cos a + S w^2, across it m g sin a + S a'' (S: mass times distance of the centre), with
// w^2 = 2 (S g / I)(cos a - cos a_0) and a'' = -(S g / I) sin a; of a bob alone m g (3 cos a - 2 cos a_0).
TEST_CASE("a pendulum's pin gives what the closed form says, all along its swing") {
  constexpr double g = 9.81, length = 1.3, bob = 1.7, start = 1.1;
  for (const double rod_mass : {0.0, 0.8}) {
    const Simulation run =
        run_scene(custom + node("O", Vec3(0.2, 0, 0.1), "fixed = true") +
                  node("A", Vec3(0.2 + length * std::sin(start), 0, 0.1 - length * std::cos(start)),
                       "mass = " + testing::number(bob)) +
                  rod("O", "A", "mass = " + testing::number(rod_mass)) + run_for(3.0));
    const Diagnostics d = diagnose(run);
    const double mass = bob + rod_mass, S = (bob + rod_mass / 2) * length,
                 I = (bob + rod_mass / 3) * length * length;
    double error = 0;
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      const VectorXd q = run.trajectory.node_positions(i);
      const Vec3 along = (q.segment<3>(0) - q.segment<3>(3)) / length;  // from the bob to the pin
      const Vec3 across(along.z(), 0, -along.x());
      const double cosine = along.z(), sine = -along.x();
      const double N = mass * g * cosine + S * 2 * S * g / I * (cosine - std::cos(start));
      const double T = mass * g * -sine + S * S * g / I * sine;
      const Vec3 wanted = N * along + T * -across;
      error = std::max(error, (reaction(d, "O", i) - wanted).norm());
      CHECK(unique(d, "O", i));
      if (rod_mass == 0.0)
        CHECK(reaction(d, "O", i).norm() ==
              Approx(std::abs(bob * g * (3 * cosine - 2 * std::cos(start)))).epsilon(1e-6));
    }
    // Order 6 at a hundredth of a second: energies, of which w^2 is made, are kept to some 1e-9 of m g l.
    CHECK(error < 1e-6);
  }
}

// A beam on a pin and a roller, a bob at rest under the roller: half of the beam's weight on each.
TEST_CASE("at rest the supports carry the weight as the lever says") {
  for (const char* eliminate : {"true", "false"}) {
    const Simulation run =
        run_scene(custom + node("O", Vec3(0, 0, 0), "fixed = true") + node("R", Vec3(2, 0, 0), "") +
                      node("B", Vec3(2, 0, -1), "mass = 0.7") + rod("O", "R", "mass = 3") +
                      rod("R", "B", "mass = 0.4") +
                      "[[structure.constraints]]\nkind = 'line'\nnodes = ['R']\ndirection = [1, 0, 0]\n"
                      "[[loads]]\nnodes = ['R']\nforce = [5, 0, -8]\n" +
                      run_for(0.1),
                  {std::string("solver.eliminate_linear=") + eliminate});
    const Diagnostics d = diagnose(run);
    INFO("eliminated: " << eliminate);
    CHECK(supports(run.trajectory.structure()) == std::vector<int>{0, 1});
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      // Round-off of a sum of a few forces of some 30 N.
      CHECK((reaction(d, "O", i) - Vec3(-5, 0, 1.5 * 9.81)).norm() < 1e-9);
      CHECK((reaction(d, "R", i) - Vec3(0, 0, (1.5 + 0.4 + 0.7) * 9.81 + 8)).norm() < 1e-9);
      CHECK(unique(d, "O", i));
      CHECK(unique(d, "R", i));
    }
  }
}

// Three bars of equal stiffness E A carry W: the upright one W / (1 + 2 cos^3 b), b that of the others from
// the vertical. Rigid bars leave it open.
TEST_CASE("supports that share a load are unique where their rods have a modulus") {
  const auto truss = [](const std::string& bars) {
    return custom + node("L", Vec3(-1, 0, 1), "fixed = true") + node("M", Vec3(0, 0, 1), "fixed = true") +
           node("R", Vec3(1, 0, 1), "fixed = true") + node("A", Vec3(0, 0, 0), "mass = 2") +
           node("B", Vec3(0, 0, -1), "mass = 1") + rod("L", "A", bars) + rod("M", "A", bars) +
           rod("R", "A", bars) + rod("A", "B", "mass = 0") +
           "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 1, 0]\n" + run_for(0.05);
  };
  const double weight = 3 * 9.81, cosine = std::sqrt(0.5), upright = weight / (1 + 2 * std::pow(cosine, 3));
  const Diagnostics rigid = diagnose(run_scene(truss("mass = 0")));
  const Diagnostics shared = diagnose(run_scene(truss("mass = 0\narea = 1e-4\nyoungs_modulus = 7e10")));
  for (std::size_t i = 0; i < rigid.t.size(); ++i) {
    for (const char* name : {"L", "M", "R"}) {
      CHECK_FALSE(unique(rigid, name, i));
      CHECK(unique(shared, name, i));
    }
    CHECK(unique(rigid, "A", i));  // across the plane nothing else holds
    const Vec3 sum = reaction(rigid, "L", i) + reaction(rigid, "M", i) + reaction(rigid, "R", i);
    // Of multipliers that are not unique 1e-9 is round-off (Index1).
    CHECK((sum - Vec3(0, 0, weight)).norm() < 1e-6);
    CHECK((reaction(shared, "M", i) - Vec3(0, 0, upright)).norm() < 1e-6);
    const double slanted = (weight - upright) / 2;
    CHECK((reaction(shared, "R", i) - Vec3(slanted, 0, slanted)).norm() < 1e-6);
  }
}

// Its rows share the weight in many ways; what they give the node together is the weight.
TEST_CASE("what holds a node twice over is unique as their sum") {
  const std::string held =
      "[[structure.constraints]]\nkind = 'plane'\nnodes = ['O']\nnormal = [0.3, 0.2, 0.9]\n"
      "[[structure.constraints]]\nkind = 'line'\nnodes = ['O']\ndirection = [1, 1, 0.5]\n";
  for (const char* eliminate : {"true", "false"}) {
    const Diagnostics d = diagnose(
        run_scene(custom + node("O", Vec3(0, 0, 0), "fixed = true") +
                      node("P", Vec3(2, 0, 0), "fixed = true") + node("A", Vec3(0, 0, -1.5), "mass = 2") +
                      rod("O", "A", "mass = 1") + rod("O", "P", "mass = 0") + held + run_for(0.05),
                  {std::string("solver.eliminate_linear=") + eliminate}));
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      // The rod from O to P may push both apart as it likes: across it all is told.
      CHECK_FALSE(unique(d, "O", i));
      CHECK_FALSE(unique(d, "P", i));
      CHECK(reaction(d, "O", i).z() == Approx(3 * 9.81).epsilon(0).margin(1e-6));
    }
    const Diagnostics alone = diagnose(run_scene(custom + node("O", Vec3(0, 0, 0), "fixed = true") +
                                                     node("A", Vec3(0, 0, -1.5), "mass = 2") +
                                                     rod("O", "A", "mass = 1") + held + run_for(0.05),
                                                 {std::string("solver.eliminate_linear=") + eliminate}));
    for (std::size_t i = 0; i < alone.t.size(); ++i) {
      CHECK(unique(alone, "O", i));
      // Of multipliers that are not unique 1e-9 is round-off (Index1).
      CHECK((reaction(alone, "O", i) - Vec3(0, 0, 3 * 9.81)).norm() < 1e-6);
    }
  }
}

TEST_CASE("a plane that holds a node against a spring beside it bears what the spring pulls") {
  const Diagnostics d = diagnose(
      run_scene(custom + node("A", Vec3(0, 0, 0), "fixed = true") + node("B", Vec3(1, 0, 0), "mass = 1") +
                node("P", Vec3(1, 0.8, 0), "fixed = true") + rod("A", "B", "mass = 1") +
                "[[constraints]]\nkind = 'plane'\nnodes = ['B']\nnormal = [0, 1, 0]\n"
                "[[forces]]\nkind = 'spring'\nnodes = ['B', 'P']\nstiffness = 100\nfree_length = 0.5\n"
                "[solver]\nend_time = 0.01\n"));
  CHECK((reaction(d, "B", 0) - Vec3(0, -100 * (0.8 - 0.5), 0)).norm() < 1e-10);
}

// What keeps a support in its plane gives nothing there, and cancels what a fixed node could give against it.
TEST_CASE("a support of a flat structure is unique, in the plane of all nodes or not") {
  const std::string bob = node("B", Vec3(1, 0, 0), "mass = 1") + rod("A", "B", "mass = 1");
  const auto plane = [](const char* nodes) {
    return "[[constraints]]\nkind = 'plane'\nnodes = ['" + std::string(nodes) + "']\nnormal = [0, 1, 0]\n";
  };
  const std::string free = node("A", Vec3(0, 0, 0), ""), fixed = node("A", Vec3(0, 0, 0), "fixed = true");
  const std::string held = "[[constraints]]\nkind = 'fixed'\nnodes = ['A']\n",
                    line = "[[constraints]]\nkind = 'line'\nnodes = ['A']\ndirection = [1, 0, 0]\n";
  for (const std::string& scene : {fixed + bob + plane("*"), fixed + bob + plane("B"),
                                   free + bob + held + plane("*"), free + bob + line + plane("*")}) {
    const Diagnostics d = diagnose(run_scene(custom + scene + run_for(0.05)));
    INFO(scene);
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      CHECK(unique(d, "A", i));
      CHECK(reaction(d, "A", i).y() == Approx(0).epsilon(0).margin(1e-9));
    }
  }
}

TEST_CASE("planes that say that a structure is flat, and the rotor of a motor, are no supports") {
  const auto flat = [](const std::string& held, double y = 0) {
    return custom + node("O", Vec3(0, y, 0), "fixed = true") + node("A", Vec3(1, y, 0), "mass = 1") +
           node("B", Vec3(2, y, 0), "mass = 1") + rod("O", "A", "mass = 0.1") + rod("A", "B", "mass = 0.1") +
           "[[structure.constraints]]\nkind = 'plane'\nnodes = " + held + "\nnormal = [0, 1, 0]\n" +
           "[[forces]]\nkind = 'motor'\nnodes = ['O', 'A', 'B']\naxis = [0, 1, 0]\nstall_torque = 1\n"
           "no_load_speed = 60\ninertia = 0.1\n" +
           run_for(0.1);
  };
  CHECK(supports(testing::model_of(flat("['*']"))->structure) == std::vector<int>{0});
  CHECK(supports(testing::model_of(flat("['A', 'B']"))->structure) == std::vector<int>{0});
  CHECK(supports(testing::model_of(flat("['B']"))->structure) == std::vector<int>{0, 2});
  CHECK(supports(testing::model_of(flat("['A', 'B']", 0.7))->structure) == std::vector<int>{0});
  // Whatever plane stands before it.
  const std::string guide = "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [1, 0, 0]\n";
  CHECK(supports(testing::model_of(guide + flat("['A', 'B']"))->structure) == std::vector<int>{0, 1});
  CHECK(supports(testing::model_of(flat("['A', 'B']") + guide)->structure) == std::vector<int>{0, 1});
  const std::vector<std::string> along{"loads=[{nodes=['B'],force=[3,0,-2]}]"};
  CHECK(supports(testing::model_of(flat("['A', 'B']"), along)->structure) == std::vector<int>{0});
  for (const std::string across :
       {"loads=[{nodes=['B'],force=[3,0.1,-2]}]",
        "forces[1]={kind='load_over_time',nodes=['B'],force=[1,0,0],times=[0,1],values=[0,1]}"}) {
    INFO(across);
    CHECK(supports(testing::model_of(flat("['A', 'B']"), {across})->structure) == std::vector<int>{0, 1, 2});
  }
  // What is fixed beside the plane pulls out of it, within it it does not.
  for (const double y : {0.0, 0.3})
    for (const char* pull :
         {"forces[1]={kind='spring',nodes=['B','P'],stiffness=100,free_length=0.5}",
          "forces[1]={kind='cable',nodes=['O','P','B'],axial_stiffness=100}",
          "forces[1]={kind='combination',terms=['length B P'],stiffness=100}",
          "forces[1]={kind='friction',nodes=['B','P'],kinetic=1}",
          "forces[1]={kind='winch',nodes=['B','P'],drum_radius=0.1,stall_torque=1,no_load_speed=9,inertia=1}",
          "constraints=[{kind='length',nodes=['B','P']}]",
          "constraints=[{kind='length_stop',nodes=['B','P'],max=9}]",
          "constraints=[{kind='combination',terms=['length B P','length A P']}]",
          "constraints=[{kind='cable',nodes=['O','P','B']}]"}) {
      INFO(pull << " at " << y);
      CHECK(
          supports(testing::model_of(flat("['A', 'B']") + node("P", Vec3(2.2, y, 1), "fixed = true"), {pull})
                       ->structure) == (y == 0 ? std::vector<int>{0, 3} : std::vector<int>{0, 1, 2, 3}));
    }
  for (const char* turn : {"[0, 1, 0]", "[0.1, 1, 0]"}) {
    const auto model = testing::model_of(
        flat("['A', 'B']"),
        {std::string("forces[1]={kind='torsion_spring',nodes=['O','A','B'],stiffness=1,axis=") + turn + "}"});
    CHECK(supports(model->structure).size() == (std::string(turn) == "[0, 1, 0]" ? 1 : 3));
  }
  // What bears something across: a table under its weight, a guide below a tripod.
  const std::vector<std::string> weight{"gravity.acceleration=[0,-9.81,0]"};
  CHECK(supports(testing::model_of(flat("['A', 'B']"), weight)->structure) == std::vector<int>{0, 1, 2});
  const std::string tripod = custom + node("O", Vec3(0, 1, 0), "fixed = true") +
                             node("A", Vec3(1, 0, 0), "mass = 1") + rod("O", "A", "mass = 0.1") +
                             "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 1, 0]\n";
  CHECK(supports(testing::model_of(tripod + run_for(0.1))->structure) == std::vector<int>{0, 1});
}

// A level arm H-A on a pin at H, balanced by a rack that a load pulls; the pinion's angle is against the
// fixed node B. The ground holds the rack, and H and B bear the arm; A is in the air.
TEST_CASE("of a rack the ground holds the node whose place it tells") {
  const std::string arm = custom + node("A", {1, 0, 0}, "mass = 1") + node("H", {0, 0, 0}, "fixed = true") +
                          node("B", {-1, 0, 1}, "fixed = true") + node("R", {0.3, 0, -0.2}, "mass = 1") +
                          rod("A", "H", "mass = 1") +
                          "[[constraints]]\nkind = 'line'\nnodes = ['R']\ndirection = [1, 0, 0]\n"
                          "[[constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 1, 0]\n"
                          "[[loads]]\nnodes = ['R']\nforce = [-73.575, 0, 0]\n" +
                          run_for(0.1);
  const std::string rack =
      "[[constraints]]\nkind = 'rack'\nnodes = ['A', 'H', 'B', 'R']\nradius = 0.2\ndirection = [1, 0, 0]\n";
  const Simulation run = run_scene(arm + rack);
  const Diagnostics d = diagnose(run);
  for (std::size_t i = 0; i < d.t.size(); i += 3) {
    // Statics: 19.62 N of the arm and A, 9.81 N of R; 1e-9 of the largest force.
    CHECK((reaction(d, "H", i) + reaction(d, "B", i) - Vec3(0, 0, 19.62)).norm() < 1e-7);
    if (d.find("A.reaction_N")) CHECK(reaction(d, "A", i).norm() < 1e-7);
    CHECK((reaction(d, "R", i) - Vec3(73.575, 0, 9.81)).norm() < 1e-7);
  }
  // Let go, all of it moves; the supports' impulse, with weight and load, is the momentum.
  const Simulation moving = run_scene(arm + rack, {"loads[0].force=[-20, 0, 0]", "solver.stages=5"});
  const Diagnostics m = diagnose(moving);
  Vec3 impulse = Vec3::Zero();
  const std::size_t last = m.t.size() - 1;
  const auto all = [&](std::size_t i) -> Vec3 {
    return reaction(m, "H", i) + reaction(m, "B", i) + reaction(m, "R", i);
  };
  for (std::size_t i = 0; i + 2 <= last; i += 2)  // Simpson's rule of ten steps: some 1e-6 of it
    impulse += (m.t[i + 2] - m.t[i]) / 6 * (all(i) + 4 * all(i + 1) + all(i + 2));
  const Vec3 given = impulse + m.t[last] * Vec3(-20, 0, -9.81 * 3);
  CHECK((given - momentum(moving.trajectory, last)).norm() < 1e-5 * 3);
}

TEST_CASE("what comes to rest on a stop is held by it") {
  const Simulation run =
      run_scene(custom + node("A", Vec3(0, 0, 0.02), "mass = 2") + node("B", Vec3(1, 0, 0.02), "mass = 1") +
                rod("A", "B", "mass = 0") +
                "[[constraints]]\nkind = 'coordinate_stop'\nnodes = ['A']\ndirection = [0, 0, 1]\nmin = 0\n"
                "[[constraints]]\nkind = 'coordinate_stop'\nnodes = ['B']\ndirection = [0, 0, 1]\nmin = 0\n" +
                run_for(0.3));
  const Diagnostics d = diagnose(run);
  CHECK(reaction(d, "A", 0).norm() == 0.0);
  const std::size_t last = d.t.size() - 1;
  CHECK((reaction(d, "A", last) - Vec3(0, 0, 2 * 9.81)).norm() < 1e-9);
  CHECK((reaction(d, "B", last) - Vec3(0, 0, 9.81)).norm() < 1e-9);
  CHECK(unique(d, "A", last));
  const std::string json = summary_json(
      "s", run, d, analyse_mobility(run.trajectory.model().system, run.trajectory.node_positions(0)));
  CHECK(json.find("\"reactions\": {\n    \"A\": {\n      \"peak_N\": 19.62") != std::string::npos);
}

// Newton's law for all of it: the sum of the reactions and the weight is the rate of momentum, which is
// integrated by Simpson's rule over pairs of steps.
TEST_CASE("over any motion reactions and weight are the change of momentum") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 dice(seed);
    const auto between = [&](double a, double b) {
      return a + (b - a) * static_cast<double>(dice()) / 4294967295.0;
    };
    const auto point = [&](double r) { return Vec3(between(-r, r), between(-r, r), between(-r, r)); };
    const auto triple = [](const Vec3& x) {
      return "[" + testing::number(x.x()) + ", " + testing::number(x.y()) + ", " + testing::number(x.z()) +
             "]";
    };
    std::string text = custom, rods, rest;
    for (int k = 0; k < 5; ++k) {
      const std::string name = "N" + std::to_string(k);
      text += node(name, Vec3(k, 0, 0) + point(0.3), "mass = " + testing::number(between(0.2, 2)));
      if (k > 0)
        rods += rod("N" + std::to_string(k - 1), name,
                    "mass = " + testing::number(between(0.1, 1)) +
                        (dice() % 2 ? "" : "\narea = 1e-4\nyoungs_modulus = 1e9"));
    }
    const std::string kinds[] = {
        "kind = 'fixed'\n", "kind = 'plane'\nnormal = " + triple(point(1)) + "\n",
        "kind = 'line'\ndirection = " + triple(point(1)) + "\n",
        "kind = 'coordinate'\nmotion = 'rate'\nrate = 0.5\nramp = 0.5\ndirection = " + triple(point(1)) +
            "\n"};
    for (const int k : {0, 3})
      rest += "[[constraints]]\nnodes = ['N" + std::to_string(k) + "']\n" + kinds[dice() % 4];
    const Simulation run =
        run_scene(text + rods + rest + run_for(0.4, 0.002),
                  {seed % 2 ? "solver.eliminate_linear=true" : "solver.eliminate_linear=false"});
    INFO("seed " << seed << ": " << text << rods << rest);
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const Vec3 weight = mass_of(run.trajectory.structure()) * Vec3(0, 0, -9.81);
    const auto force = [&](std::size_t i) {
      return Vec3(reaction(d, "N0", i) + reaction(d, "N3", i) + weight);
    };
    const double h = 0.002;
    double error = 0, largest = 0;
    Vec3 impulse = Vec3::Zero();
    for (std::size_t i = 0; i + 2 < d.t.size(); i += 2) {
      impulse += h / 3 * (force(i) + 4 * force(i + 1) + force(i + 2));
      const Vec3 change = momentum(run.trajectory, i + 2) - momentum(run.trajectory, 0);
      error = std::max(error, (impulse - change).norm());
      largest = std::max(largest, change.norm());
    }
    // Simpson's rule: h^4 / 180 of the fourth derivative of a force that changes within some 0.05 s, 1e-8.
    CHECK(error < 1e-6 * std::max(1.0, largest));
  }
}

// An arm of 1 m with 2 kg at its tip B and 1 kg of its own turns a pinion about H, whose teeth move a rack R
// of 1 kg: 25 N m about H, which a brake at the tip bears by 25 N at 1 m, one at the rack by 125 N at 0.2 m,
// teeth and the pinion's frame A at 1 m with it. Both brakes: in any proportion.
TEST_CASE("reactions: what two brakes of one freedom leave open is not unique where a rack is between them") {
  const auto braked = [](bool tip, bool rack) {
    const std::string brake = "[[constraints]]\nkind = 'coordinate'\n";
    return run_scene(custom + node("A", {0, 0, 1}, "fixed = true") + node("H", {0, 0, 0}, "fixed = true") +
                     node("B", {1, 0, 0}, "mass = 2") + node("R", {0, 0, -0.2}, "mass = 1") +
                     node("P", {3, 0, 0}, "fixed = true") + node("Q", {3, 0, -1}, "mass = 1") +
                     rod("H", "B", "mass = 1") + rod("P", "Q", "mass = 1") +
                     "[[constraints]]\nkind = 'plane'\nnodes = ['B', 'Q']\nnormal = [0, 1, 0]\n"
                     "[[constraints]]\nkind = 'line'\nnodes = ['R']\ndirection = [1, 0, 0]\n"
                     "[[constraints]]\nkind = 'rack'\nnodes = ['A', 'H', 'B', 'R']\nradius = 0.2\n"
                     "direction = [1, 0, 0]\naxis = [0, 1, 0]\n" +
                     (tip ? brake + "nodes = ['B']\ndirection = [0, 0, 1]\n" : "") +
                     (rack ? brake + "nodes = ['R']\ndirection = [1, 0, 0]\n" : "") +
                     "[gravity]\nacceleration = [0, 0, -10]\n[solver]\nend_time = 0.02\n");
  };
  const Diagnostics at_tip = diagnose(braked(true, false)), at_rack = diagnose(braked(false, true)),
                    both = diagnose(braked(true, true));
  for (const char* name : {"A", "H", "B"}) {
    INFO(name);
    CHECK(unique(at_tip, name, 0));
    if (name != std::string("B")) CHECK(unique(at_rack, name, 0));
    CHECK_FALSE(unique(both, name, 0));
  }
  CHECK(reaction(at_tip, "B", 0).z() == Approx(25).epsilon(1e-9));
  CHECK(reaction(at_tip, "A", 0).norm() < 1e-9);
  CHECK(reaction(at_rack, "A", 0).norm() == Approx(25).epsilon(1e-9));
}

}  // namespace reactions_test
