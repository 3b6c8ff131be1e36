// SPDX-License-Identifier: BSD-3-Clause
// Where given lengths of rods move the nodes, all that is "as at t = 0" is so of the moved ones.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/stops.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace placed_nodes_test {

namespace {

using testing::error_of, testing::model_of, testing::number, testing::run_scene;

// A four-bar whose upper bar is made 0.5 % longer than A and B are apart: no node of it is where it is typed.
std::string four_bar(bool elastic, const std::string& more) {
  return std::string("[structure]\nkind = 'custom'\nyoungs_modulus = 1e9\n") +
         (elastic ? "rod_model = 'elastic'\n" : "") +
         "nodes = [{name = 'O', position = [0, 0, 0], fixed = true}, "
         "{name = 'A', position = [0.1, 0, 1], mass = 1}, "
         "{name = 'B', position = [1.2, 0, 1.3], mass = 2}, "
         "{name = 'C', position = [1, 0, 0], fixed = true}, {name = 'Q', position = [0.4, 0.7, 2], fixed = "
         "true}, {name = 'K', position = [1.21, 0, 1.3], fixed = true}]\n"
         "rods = [{nodes = ['O', 'A'], mass = 0.1, area = 1e-4}, "
         "{nodes = ['A', 'B'], mass = 0.1, area = 1e-4, length = 1.146}, "
         "{nodes = ['B', 'C'], mass = 0.1, area = 1e-4}]\n"
         "[[constraints]]\nkind = 'plane'\nnodes = ['A', 'B']\nnormal = [0, 1, 0]\n"
         "[solver]\nend_time = 0.1\nstages = 4\nstep = 1e-3\n" +
         more;
}

Vec3 at(const Model& model, int node) {
  return model.structure.nodes[static_cast<std::size_t>(node)].position;
}

// What acts on the nodes at t = 0, at rest.
double first_force(const Model& model) {
  const VectorXd q = node_positions(model.structure);
  VectorXd f = VectorXd::Zero(q.size());
  model.system.add_applied_force(0.0, q, VectorXd::Zero(q.size()), 1.0, f);
  return f.lpNorm<Eigen::Infinity>();
}

}  // namespace

TEST_CASE("nodes that lengths move: what is unstressed as built is so where they were moved to") {
  for (const bool elastic : {false, true}) {
    REQUIRE((at(*model_of(four_bar(elastic, "")), 2) - Vec3(1.2, 0, 1.3)).norm() > 1e-3);
    for (const char* force :
         {"kind = 'spring'\nnodes = ['Q', 'B']\nstiffness = 1e4\n",
          "kind = 'torsion_spring'\nnodes = ['A', 'B', 'C']\nstiffness = 1e4\n",
          "kind = 'torsion_spring'\nnodes = ['A', 'B', 'C']\naxis = [0, 1, 0]\nstiffness = 1e4\n",
          "kind = 'cable'\nnodes = ['Q', 'A', 'C']\naxial_stiffness = 1e4\n",
          "kind = 'combination'\nterms = ['2 length Q B', 'coordinate A along 1 2 3', 'angle O A B about 0 1 "
          "0']\nstiffness = 1e4\n",
          "kind = 'winch'\nnodes = ['Q', 'A']\ndrum_radius = 0.1\nstall_torque = 1\nno_load_speed = "
          "1\ninertia "
          "= 1\naxial_stiffness = 1e4\nmotion = 'hold'\ncontrol = 'position'\nproportional = 1\n"}) {
      INFO(force << (elastic ? "elastic" : "rigid"));
      // Rods that give have round-off of 1e-16 m by 1e5 N/m; typed places would give 10 N and more.
      CHECK(first_force(*model_of(four_bar(elastic, std::string("[[forces]]\n") + force))) < 1e-8);
    }
  }
}

TEST_CASE("nodes that lengths move: a pendulum on a spring of no length of its own stands still") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name="O", position=[0,0,0], fixed=true}, {name="P", position=[1,0,0], mass=1},
         {name="Q", position=[0,0,1], fixed=true}]
rods = [{nodes=["O","P"], mass=0, length=1.008}]
[[constraints]]
kind = "plane"
nodes = ["P"]
normal = [0,1,0]
[[forces]]
kind = "spring"
nodes = ["Q","P"]
stiffness = 1e4
[solver]
end_time = 0.5
)");
  const Diagnostics d = diagnose(run);
  // A stretch of round-off, 1e-16 m, has 1e-28 J.
  CHECK(testing::largest(d, "potential_energy_J") < 1e-24);
  CHECK(testing::largest(d, "kinetic_energy_J") < 1e-24);
}

TEST_CASE("nodes that lengths move: limits are looked at where they were moved to") {
  for (const bool elastic : {false, true}) {
    const auto model = model_of(four_bar(elastic, ""));
    const Vec3 B = at(*model, 2), typed(1.2, 0, 1.3), Q(0.4, 0.7, 2), K(1.21, 0, 1.3);
    const auto degrees = [](const Vec3& b) {
      return std::atan2(b[2], b[0] - 1) * 180 / pi;  // from x to B about -y at C
    };
    struct Limit {
      const char* kind;
      const char* members;
      double typed, placed;
    };
    for (const Limit& limit :
         {Limit{"length_stop", "nodes = ['Q', 'B']", (typed - Q).norm(), (B - Q).norm()},
          Limit{"coordinate_stop", "nodes = ['B']\ndirection = [1, 0, 0]", typed[0], B[0]},
          Limit{"angle_stop", "nodes = ['K', 'C', 'B']\naxis = [0, -1, 0]", degrees(typed) - degrees(K),
                degrees(B) - degrees(K)},
          Limit{"clearance", "nodes = ['K', 'B']", (typed - K).norm(), (B - K).norm()},
          Limit{"cable", "nodes = ['Q', 'B']", (typed - Q).norm(), (B - Q).norm()}}) {
      INFO(limit.kind << ": " << limit.typed << " typed, " << limit.placed << " placed");
      const double off = limit.placed - limit.typed;
      REQUIRE(std::abs(off) > 1e-5);
      const std::string kind = limit.kind;
      const auto refused = [&](const char* key, double value) {
        return error_of(four_bar(elastic, "[[constraints]]\nkind = '" + kind + "'\n" + limit.members + "\n" +
                                              key + " = " + number(value) + "\n"));
      };
      const std::string key = kind == "clearance" ? "clearance" : kind == "cable" ? "length" : "max";
      CHECK(refused(key.c_str(), limit.placed + 0.1 * std::abs(off)) == "");
      CHECK(refused(key.c_str(), limit.placed - 0.1 * std::abs(off)).find("at t = 0") != std::string::npos);
      if (key != "max") continue;
      CHECK(refused("min", limit.placed - 0.1 * std::abs(off)) == "");
      CHECK(refused("min", limit.placed + 0.1 * std::abs(off)).find("at t = 0") != std::string::npos);
    }
    const auto rope =
        model_of(four_bar(elastic, "[[constraints]]\nkind = 'cable'\nnodes = ['Q', 'A', 'B']\n"));
    CHECK(rope->structure.stops.front().reel(0.0) ==
          Approx((Q - at(*rope, 1)).norm() + (at(*rope, 1) - at(*rope, 2)).norm()).epsilon(1e-14));
  }
}

TEST_CASE("nodes that lengths move: a deployment begins at fraction 0, a trolley hangs above") {
  for (const bool elastic : {false, true})
    for (const char* measure : {"length Q B", "angle K C B about 0 -1 0", "2 coordinate A along 1 0 0"}) {
      INFO(measure);
      const auto model = model_of(
          four_bar(elastic, std::string("[deployment]\ndeployed = 170\nmeasure = '") + measure + "'\n"));
      CHECK(model->structure.deployment.fraction(node_positions(model->structure)) ==
            Approx(0).epsilon(0).margin(1e-13));
    }
  const auto hung = model_of(four_bar(false, R"(
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "offload"
nodes = ["B"]
length = 3
)"));
  const VectorXd q = node_positions(hung->structure);
  VectorXd f = VectorXd::Zero(q.size());
  hung->system.add_applied_force(0.0, q, VectorXd::Zero(q.size()), 1.0, f);
  CHECK(std::abs(f[6]) < 1e-12);  // nothing pulls B aside
}

TEST_CASE(
    "nodes that lengths move: what is held as built is the given value, as the lengths are fitted to it") {
  const auto model = model_of(four_bar(false, ""));
  // The crank at C begins where it is typed, so that A alone gives way.
  const auto held =
      model_of(four_bar(false,
                        "[[constraints]]\nkind = 'angle'\nnodes = ['K', 'C', 'B']\naxis = [0, -1, 0]\n"
                        "motion = 'smooth'\nto = 10\nduration = 1\n"));
  CHECK(at(*held, 2).isApprox(Vec3(1.2, 0, 1.3), 1e-12));
  CHECK_FALSE(at(*held, 1).isApprox(at(*model, 1), 1e-5));
  CHECK((at(*held, 1) - at(*held, 2)).norm() == Approx(1.146).epsilon(1e-13));
}

}  // namespace placed_nodes_test
