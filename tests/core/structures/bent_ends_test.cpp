// SPDX-License-Identifier: BSD-3-Clause
// What acts on the end of a rod that bends, and what hangs there.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/vibration.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace bent_ends_test {

namespace {

// A beam of 1 m along x beside a wall, without mass but for its end: E A / l = 7e6 N/m, E I = 7e8 * 1e-4 / 4
// pi.
std::string beam(int k, const std::string& more) {
  return "[structure]\nkind = 'custom'\nmass = 'lumped'\nrod_model = 'elastic'\nyoungs_modulus = 7e10\n"
         "nodes = [{name = 'G', position = [-0.5, 0, 0], fixed = true, mass = 1},\n"
         "  {name = 'A', position = [0, 0, 0], fixed = true},\n"
         "  {name = 'B', position = [1, 0, 0], mass = 1}]\n"
         "rods = [{nodes = ['G', 'A'], mass = 1, area = 1e-4, elastic = false, name = 'wall'},\n"
         "  {nodes = ['A', 'B'], mass = 1e-3, area = 1e-4, name = 'beam', segments = " +
         std::to_string(k) +
         "}]\n[[constraints]]\nkind = 'plane'\nnodes = ['beam.*', 'B']\nnormal = [0, 0, 1]\n" + more;
}

}  // namespace

// A mass m on the end of a cantilever: w^2 = 3 E I / (m l^3), with 33/140 of the beam's own 1e-3 of it in m;
// k parts change that share by less than half. By their compliance, virtual work with moments 1.5 - 1 / k at
// the first node, which stands for 1.5 parts, and 1 - j / k at the others,
//     3 / k ((1.5 - 1 / k)^2 / 1.5 + sum_(j = 2)^(k - 1) (1 - j / k)^2) = 1 + 0.47 / k^2 + ... of l^3 / 3 E I
TEST_CASE("segments: a cantilever held by an angle is right to the second order, by rods or by nodes") {
  const double EI = 7e10 * 1e-8 / (4 * pi), wanted = std::sqrt(3 * EI / (1 + 33e-3 / 140)) / (2 * pi);
  for (const char* members : {"rods = ['wall', 'beam']", "nodes = ['G', 'A', 'B']"})
    for (const int k : {2, 4, 8, 16}) {
      const auto model = testing::model_of(
          beam(k, "[[constraints]]\nkind = 'angle'\naxis = [0, 0, 1]\n" + std::string(members) + "\n"));
      const Vibration v = vibration(*model, initial_state(model->structure, model->system).state);
      double compliance = (1.5 - 1.0 / k) * (1.5 - 1.0 / k) / 1.5;
      for (int j = 2; j < k; ++j) compliance += (1 - 1.0 * j / k) * (1 - 1.0 * j / k);
      compliance *= 3.0 / k;
      INFO(members << ", k = " << k);
      CHECK(v.modes.front().frequency == Approx(wanted / std::sqrt(compliance)).epsilon(1e-4));
      CHECK(std::abs(compliance - 1) < 0.5 / (k * k));
    }
}

// A load across the end, at rest: cut anywhere, the beam carries P, of which the part along it is axial, be
// the torque at its end that of a held angle or of a spring. E I / l^2 = 55.7 N bends it by 17 degrees; a
// mass of 1 kg on it swings in a drag of 10 N s/m on each node, to e^-20 in 4 s. A torque that pulls
// along the parts too is off by 3/4 M^2 / E I, 35 N.
TEST_CASE("segments: the axial forces of a bent cantilever are those of its load") {
  const std::string held = "[[constraints]]\nkind = 'angle'\n",
                    sprung =
                        "[[forces]]\nkind = 'torsion_spring'\n"
                        "stiffness = 200\n",
                    members = "axis = [0, 0, 1]\nnodes = ['G', 'A', 'B']\n",
                    load =
                        "[[forces]]\nkind = 'load_over_time'\nnodes = ['B']\nforce = [0, -55.7, 0]\n"
                        "times = [0, 1]\nvalues = [0, 1]\n[[forces]]\nkind = 'drag'\nnodes = "
                        "['beam.*', 'B']\ndamping = 10\n[solver]\nend_time = 5\nstep = 0.01\nstages = 4\n";
  const Vec3 P(0, -55.7, 0);
  for (const std::string& root : {held, sprung})
    for (const bool rigid : {true, false}) {
      INFO(root << (rigid ? "rigid" : "elastic"));
      std::vector<std::string> changes{"structure.rods[1].mass=1"};
      if (rigid) changes.push_back("structure.rod_model='rigid'");
      if (rigid == (root == held)) changes.push_back("structure.rods[1].nodes=['B', 'A']");
      const Simulation run = testing::run_scene(beam(4, root + members + load), changes);
      REQUIRE(run.status == RunStatus::completed);
      const Structure& s = run.trajectory.structure();
      const VectorXd q = testing::end_positions(run);
      const Diagnostics d = diagnose(run);
      for (std::size_t r = 1; r < s.rods.size(); ++r) {
        Vec3 along = (q.segment<3>(3 * s.rods[r].b) - q.segment<3>(3 * s.rods[r].a)).normalized();
        if (along[0] < 0) along = -along;
        const double force = d.axial_force(d.axial_force.rows() - 1, static_cast<Index>(r));
        CHECK(force == Approx(P.dot(along)).epsilon(0).margin(1e-3));
      }
    }
}

TEST_CASE("segments: an angle that is only measured bends nothing") {
  const auto lowest = [](const std::string& more) {
    const auto model = testing::model_of(
        "[structure]\nkind = 'custom'\nrod_model = 'elastic'\n"
        "nodes = [{name = 'C', position = [0, 0, -1], fixed = true}, {name = 'A', position = [0, 0, 0], "
        "fixed "
        "= true}, {name = 'B', position = [1, 0, 0]}]\n"
        "rods = [{name = 'R', nodes = ['A', 'B'], mass = 1, area = 1e-4, youngs_modulus = 2e11, segments = "
        "4}, {name = 'S', nodes = "
        "['A', 'C'], mass = 1}]\n"
        "constraints = [{kind = 'plane', nodes = ['R.*', 'B'], normal = [0, 1, 0]}, {kind = 'plane', nodes = "
        "['B'], normal = [0, 0, 1]}]\n" +
        more);
    return vibration(*model, initial_state(model->structure, model->system).state).modes.front().frequency;
  };
  // A pinned beam: pi/2 sqrt(E I / m l^3), of which four parts have 0.9997.
  const double I = 1e-8 / (4 * pi), plain = lowest("");
  CHECK(plain == Approx(pi / 2 * std::sqrt(2e11 * I)).epsilon(1e-3));
  const std::string opens = "[deployment]\nmeasure = 'angle B A C about 0 1 0'\ndeployed = 200\n";
  CHECK(lowest(opens) == Approx(plain).epsilon(1e-12));
  // Locked there it is held by it, which it is to bend for.
  CHECK(lowest(opens + "[solver]\nat_deployed = 'latch'\n") > 1.02 * plain);
}

// Its half at either end, as if it were not cut: both masses stay.
TEST_CASE("offload of nodes by name holds rods that are cut, and one node hangs on one rope") {
  const std::string hung = R"([structure]
kind = 'custom'
rod_model = 'elastic'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0], mass = 1}]
rods = [{nodes = ['A', 'B'], mass = 2, area = 1e-3, youngs_modulus = 7e10, segments = 4}]
[gravity]
acceleration = [0, 0, -10]
[[forces]]
kind = 'offload'
nodes = ['B']
[solver]
end_time = 0.4
step = 0.001
stages = 4
)";
  // It sags between its ends, 5 q l^4 / 384 E I = 5 * 20 / (384 * 5570) = 5e-5 m and twice that in its wave,
  // and turns about A by what that moves its weight aside: far less. Without the share B is 0.2 m lower at
  // 0.4 s.
  const Simulation run = testing::run_scene(hung);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(std::abs(testing::end_positions(run)[5]) < 1e-3);
  CHECK_THAT(testing::error_of(hung + "[[forces]]\nkind = 'offload'\nname = 'two'\nnodes = ['B']\n"),
             Catch::Contains("hangs on the rope of another entry already"));
}

TEST_CASE("pin_friction takes a rod that is cut, and says of what order its bending is") {
  const std::string scene = R"([structure]
kind = 'custom'
rod_model = 'elastic'
youngs_modulus = 7e9
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0], mass = 1},
         {name = 'C', position = [1, 1, 0], mass = 1}]
rods = [{nodes = ['A', 'B'], mass = 1, area = 1e-4, segments = 2}, {nodes = ['B', 'C'], mass = 1, area = 1e-4}]
[[forces]]
kind = 'friction'
nodes = ['A', 'B', 'C']
kinetic = 0
pin_friction = 0.1
pin_radius = 0.01
[solver]
stages = 4
step = 1e-4
)";
  const auto model = testing::model_of(scene);
  CHECK(model->structure.forces.back().measure.nodes.size() == 4);
  REQUIRE_FALSE(model->structure.notes.empty());
  CHECK_THAT(model->structure.notes.front(), Catch::Contains("first order in 1/segments"));
}

TEST_CASE("a node without mass whose coordinate is held is refused for what it is") {
  CHECK_THAT(testing::error_of(R"([structure]
kind = 'custom'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'M', position = [1, 0, 0]}]
rods = [{nodes = ['A', 'M'], mass = 0}]
[[constraints]]
kind = 'coordinate'
nodes = ['M']
direction = [0, 1, 0]
)"),
             Catch::Contains("has no mass") && Catch::Contains("kind = \"plane\""));
}

}  // namespace bent_ends_test
