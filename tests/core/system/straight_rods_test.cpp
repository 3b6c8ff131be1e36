// SPDX-License-Identifier: BSD-3-Clause
// Rods that were cut to bend are moved to fit lengths as if they were not cut.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/initial_state.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace straight_rods_test {

namespace {

constexpr double E = 7e10, A = 1e-4, EI = E * A * A / (4 * pi);

// Rods between fixed and free nodes in a plane, k parts each.
std::string scene(const std::string& nodes, const std::string& rods, int k, const std::string& more = "") {
  return "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nsegments = " + std::to_string(k) + "\n" +
         "nodes = [" + nodes + "]\nrods = [" + rods + "]\n" +
         "[[constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 0, 1]\n" + more;
}

std::string rod(const char* ends, const char* length = "") {
  return std::string("{nodes = ") + ends + ", area = 1e-4, density = 2700" + length + "},";
}

const std::string chain =
    "{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0]}, "
    "{name = 'C', position = [1.6, 0.5, 0], mass = 0.3}, {name = 'D', position = [0, 1, 0], fixed = true}";

struct Start {
  double stored;     // [J]
  VectorXd force;    // of rods that give [N]
  VectorXd corners;  // of the nodes that were given
  double crooked;    // how far off their line inner nodes are [m]
};

Start start_of(const std::string& text, const std::string& model, Index corners) {
  const auto built = testing::model_of(text, {"structure.rod_model='" + model + "'"});
  const Structure& s = built->structure;
  const VectorXd q = node_positions(s);
  Start out{built->system.potential_energy(q), {}, q.head(3 * corners), 0};
  out.force.resize(static_cast<Index>(built->system.giving_rods().size()));
  built->system.giving_rod_forces(0.0, q, VectorXd::Zero(q.size()), out.force);
  for (std::size_t r = 0; r + 1 < s.rods.size(); ++r) {
    if (s.rods[r].whole.empty() || s.rods[r].whole != s.rods[r + 1].whole) continue;
    const auto at = [&](int node) { return s.nodes[static_cast<std::size_t>(node)].position; };
    const Vec3 one = at(s.rods[r].b) - at(s.rods[r].a), two = at(s.rods[r + 1].b) - at(s.rods[r + 1].a);
    out.crooked = std::max(out.crooked, (two - one).norm());
  }
  return out;
}

}  // namespace

// The same corners to what fitting leaves, 1e-13 of each part, and rods that are straight and bear nothing: E
// A / l of some 1e7 N/m by rounding of 1e-15 m.
TEST_CASE("lengths are fitted by straight rods whether they are cut or not") {
  const std::string longer = rod("['A', 'B']", ", length = 1.005");
  for (const std::string& rods :
       {longer + rod("['B', 'C']", ", length = 0.776") + rod("['C', 'D']"),
        rod("['A', 'B']", ", length = 1.005, segments = 1") + rod("['B', 'C']") + rod("['C', 'D']")})
    for (const char* model : {"rigid", "elastic"}) {
      const Start whole = start_of(scene(chain, rods, 1), model, 4);
      for (const int k : {2, 4, 8}) {
        INFO(model << ", " << k << " parts");
        const Start cut = start_of(scene(chain, rods, k), model, 4);
        CHECK((cut.corners - whole.corners).norm() < 1e-12);
        CHECK(cut.crooked < 1e-14);
        CHECK(cut.stored < 1e-20);
        if (cut.force.size()) CHECK(cut.force.lpNorm<Eigen::Infinity>() < 1e-6);
      }
    }
}

// Three rods hold a node in a plane: one is redundant. The self-stress of the unit load method for one made
// too long by e, X = -e / sum(s^2 l / E A) with forces s that are in balance and 1 in that rod, is right to e
// and what it turns rods by; cut rods have the pose and the forces of whole ones.
TEST_CASE("self-stress of cut rods is that of whole ones") {
  const std::string nodes =
      "{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [2, 0, 0], fixed = true}, "
      "{name = 'D', position = [0.6, -1, 0], fixed = true}, {name = 'C', position = [1, 0.9, 0], mass = 0.3}";
  const std::string rods = rod("['C', 'A']", ", length = 1.346") + rod("['C', 'B']") + rod("['C', 'D']");
  const Vec3 C(1, 0.9, 0), to_a = -C, to_b = Vec3(2, 0, 0) - C, to_d = Vec3(0.6, -1, 0) - C;
  Eigen::Matrix2d others;
  others << to_b.normalized().head<2>(), to_d.normalized().head<2>();
  const Eigen::Vector2d s = -others.inverse() * to_a.normalized().head<2>();
  const double flexible = to_a.norm() + s[0] * s[0] * to_b.norm() + s[1] * s[1] * to_d.norm(),
               X = -(1.346 - to_a.norm()) * E * A / flexible;
  const Start whole = start_of(scene(nodes, rods, 1), "elastic", 4);
  CHECK(whole.force[0] == Approx(X).epsilon(2e-3));
  for (const int k : {2, 4}) {
    INFO(k << " parts");
    const Start cut = start_of(scene(nodes, rods, k), "elastic", 4);
    CHECK((cut.corners - whole.corners).norm() < 1e-12);
    CHECK(cut.crooked < 1e-14);
    CHECK(cut.stored == Approx(whole.stored).epsilon(1e-9));
    for (Index r = 0; r < 3 * k; ++r)  // N of 1e-15 m in 1e7 N/m
      CHECK(cut.force[r] == Approx(whole.force[r / k]).epsilon(0).margin(1e-5));
  }
}

// Two rods welded at a corner, of which one is made longer: the corner keeps its angle, that between the ends
// of the rods grows by d, and both bend by what a moment at an end does, l / 3 E I each: V = d^2 / 2 over
// their sum, with that of k parts (bent_ends_test.cpp) and forces of M / l that stretch them by far less. It
// starts in balance, and stays at rest but for the 0.3 % by which its parts were shorter when that was looked
// for: of the energy the square of that.
TEST_CASE("rods welded to each other start with the bend that their lengths ask for") {
  const std::string nodes =
      "{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [2, 0, 0], fixed = true}, "
      "{name = 'C', position = [1.1, 0.9, 0], mass = 0.3}";
  const int k = 4;
  const std::string text =
      scene(nodes, rod("['A', 'C']", ", length = 1.425") + rod("['B', 'C']"), k,
            "[[constraints]]\nkind = 'angle'\nnodes = ['A', 'C', 'B']\naxis = [0, 0, 1]\n"
            "[solver]\nstep = 2e-5\nstages = 4\nend_time = 2e-3\n");
  const double a = std::hypot(1.1, 0.9), b = std::hypot(0.9, 0.9);
  const auto angle = [b](double l) { return std::acos((l * l + b * b - 4) / (2 * l * b)); };
  const double d = angle(1.425) - angle(a);
  double compliance = (1.5 - 1.0 / k) * (1.5 - 1.0 / k) / 1.5;
  for (int j = 2; j < k; ++j) compliance += (1 - 1.0 * j / k) * (1 - 1.0 * j / k);
  compliance *= (1.425 + b) / (k * EI);
  const Start start = start_of(text, "elastic", 3);
  CHECK(start.stored == Approx(d * d / 2 / compliance).epsilon(1e-3));
  const Simulation run = testing::run_scene(text, {"structure.rod_model='elastic'"});
  REQUIRE(run.status == RunStatus::completed);
  CHECK(testing::largest(diagnose(run), "kinetic_energy_J") < 1e-5 * start.stored);
}

}  // namespace straight_rods_test
