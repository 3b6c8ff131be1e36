// SPDX-License-Identifier: BSD-3-Clause
// A cable that rubs on what it runs over, against the capstan's closed form.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/structure/node_positions.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace pulleys_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

// A stair of right angles: nodes at (0, 0), (1, 0), (1, 1), (2, 1), ...
std::string stair(int pulleys, const std::string& keys) {
  std::string nodes, names;
  for (int i = 0; i <= pulleys + 1; ++i) {
    const std::string name = "'P" + std::to_string(i) + "'";
    nodes += std::string(i ? ", " : "") + "{name = " + name + ", mass = 1, position = [" +
             std::to_string((i + 1) / 2) + ", " + std::to_string(i / 2) + ", 0]}";
    names += (i ? ", " : "") + name;
  }
  return "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\n[[constraints]]\nkind = 'cable'\nnodes = [" +
         names + "]\n" + keys;
}

// The tension at a node that is pulled along the x axis or the y axis by one span.
double end_tension(const VectorXd& force, Index node) {
  return force.segment<3>(3 * node).norm();
}

// The last node goes away from its pulley at `speed`, so that the cable runs away from its first node.
VectorXd forces_at(const Model& model, double speed) {
  const Index n = model.system.coordinates();
  VectorXd q = node_positions(model.structure), v = VectorXd::Zero(n), f = VectorXd::Zero(n);
  v.tail<3>() = speed * (q.tail<3>() - q.segment<3>(n - 6)).normalized();
  model.system.add_applied_force(0.3, q, v, 1.0, f);
  return f;
}

// A weight on a line over a round bar: x'' = g - (k / m) e^(+-mu pi) x, x the stretch.
const std::string hoist = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, -1], fixed = true}, {name = "P", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0, 0, -0.7], velocity = [0, 0, -0.5], mass = 2}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [0, 0, 1]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "cable"
name = "line"
nodes = ["O", "P", "A"]
axial_stiffness = 340
pulley_friction = 0.2
pulley_creep = 0.02
[solver]
stages = 4
step = 0.002
end_time = 0.1
)";

}  // namespace

// Published ratios of 12 and 30 pulleys of 90 degrees with mu = 0.1 are exp(-0.1 n pi / 2); the sum of the
// exponents has a few roundings.
TEST_CASE("a cable that slips over pulleys loses tension as the capstan says, in both senses") {
  for (const auto& [pulleys, left] : {std::pair{12, 0.151835802}, {30, 0.008983291}}) {
    const auto model = testing::model_of(stair(
        pulleys, "axial_stiffness = 700\npulley_friction = 0.1\nlength = " + std::to_string(pulleys + 0.5)));
    const Index last = pulleys + 1;
    const double ratio = std::exp(-0.1 * pulleys * pi / 2), n = 700 * ((pulleys + 1) / (pulleys + 0.5) - 1);
    CHECK(ratio == Approx(left).epsilon(1e-8));
    for (const double speed : {-0.37, -0.01, 0.01, 2.6}) {  // towards the first node; away from it
      const VectorXd f = forces_at(*model, speed);
      CHECK(end_tension(f, 0) == Approx(n).epsilon(1e-12));
      CHECK(end_tension(f, last) == Approx(n * (speed < 0 ? ratio : 1 / ratio)).epsilon(1e-12));
    }
    // A pulley carries both of its spans, which differ by one step of the capstan's law.
    const VectorXd f = forces_at(*model, -0.37);
    CHECK(f[4] == Approx(n * std::exp(-0.1 * pi / 2)).epsilon(1e-12));
    CHECK(f[3] == Approx(-n).epsilon(1e-12));
    // At rest and creeping: within the bounds, by an odd law; without friction all spans pull alike.
    CHECK(end_tension(forces_at(*model, 0), last) == Approx(n).epsilon(1e-12));
    const double slow = end_tension(forces_at(*model, 0.004), last) / n,
                 back = end_tension(forces_at(*model, -0.004), last) / n;
    CHECK(slow > 1.0);
    CHECK(slow < 1 / ratio);
    CHECK(slow * back == Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("a weight on a line over a bar swings by the capstan's stiffness, and the books close") {
  const Simulation run = run_scene(hoist);
  REQUIRE(run.status == RunStatus::completed);
  // It falls faster than it creeps all the while: x = x_e (1 - cos w t) + (v / w) sin w t about x_e = g /
  // w^2.
  const double w2 = 340 / 1.7 * std::exp(0.2 * pi) / 2, w = std::sqrt(w2), t = 0.1, x_e = 9.81 / w2;
  const double x = x_e * (1 - std::cos(w * t)) + 0.5 / w * std::sin(w * t);
  REQUIRE(0.5 * std::cos(w * t) + x_e * w * std::sin(w * t) > 0.02);
  // Order 6 of w h = 0.03; round-off of 50 steps.
  CHECK(end_positions(run)[8] == Approx(-0.7 - x).epsilon(0).margin(1e-12));
  // To rest, creeping at the turns: the weight ends where the line bears it with any tension of the far end
  // between both bounds, and what the bar took is on the books.
  const Simulation rest = run_scene(hoist, {"solver.end_time=3", "solver.step=0.001"});
  REQUIRE(rest.status == RunStatus::completed);
  const Diagnostics d = diagnose(rest);
  const double share = 340 / 1.7 * (-0.7 - end_positions(rest)[8]) / (2 * 9.81);
  CHECK(share <= std::exp(0.2 * pi));
  CHECK(share >= std::exp(-0.2 * pi));
  CHECK(d.at("dissipated_J").values.back() > 0.1);
  CHECK(d.at("kinetic_energy_J").values.back() < 0.5 * 2 * 0.02 * 0.02);
  // The law bends at the creeping speed, where it has three derivatives; passed within a step or two.
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-7);
}

TEST_CASE("friction of pulleys where there is none is refused with one clear error") {
  CHECK(error_of(hoist, {"constraints[0].axial_stiffness=0"}).find("give axial_stiffness") !=
        std::string::npos);
  CHECK(error_of(hoist, {"constraints[0].nodes=[\"P\",\"A\"]"}).find("runs over none") != std::string::npos);
  CHECK(error_of(hoist, {"constraints[0].pulley_friction=-0.1"}).find("must be >= 0") != std::string::npos);
}

}  // namespace pulleys_test
