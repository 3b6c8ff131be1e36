// SPDX-License-Identifier: BSD-3-Clause
// What is light moves as it does alone, whatever is heavy, stiff or far away beside it.
#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace row_noise_test {

namespace {

const std::string head = "[structure]\nkind = 'custom'\n";

std::string node(const std::string& name, const std::string& position, const std::string& more) {
  return "[[structure.nodes]]\nname = '" + name + "'\nposition = " + position + "\n" + more + "\n";
}
std::string rod(const std::string& a, const std::string& b) {
  return "[[structure.rods]]\nnodes = ['" + a + "', '" + b + "']\nmass = 0\n";
}

// A pendulum P of this mass on a massless rod from O.
std::string pendulum(const std::string& mass) {
  return node("O", "[0.1, 0.2, -0.3]", "fixed = true") +
         node("P", "[0.7, -0.1, 0.4]", "velocity = [0.5, 1, 0]\nmass = " + mass) + rod("O", "P");
}

const std::string tail = "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 1\nstages = 4\n";

Vec3 end_of(const std::string& scene, const std::string& method, const char* name) {
  const Simulation run = run_scene(scene, {"solver.method=" + method, "solver.step=0.005"});
  INFO(method << ": " << run.message);
  REQUIRE(run.status == RunStatus::completed);
  const auto& nodes = run.trajectory.structure().nodes;
  Index i = 0;
  while (nodes[static_cast<std::size_t>(i)].name != name) ++i;
  return run.trajectory.node_positions(run.trajectory.size() - 1).segment<3>(3 * i);
}

// Round-off of 200 steps of a motion of 1 m.
void check_alone(const std::string& scene, const std::string& alone) {
  for (const char* method : {"dvm", "generalized_alpha", "rk4_projected"}) {
    INFO(method);
    CHECK((end_of(head + scene + tail, method, "P") - end_of(head + alone + tail, method, "P")).norm() <=
          2e-12);
  }
}

}  // namespace

TEST_CASE("a light pendulum beside a heavy one") {
  for (const char* heavy : {"1e3", "1e9", "1e12"})
    check_alone(pendulum("1e-6") + node("H", "[3, 1, 0]", "fixed = true") +
                    node("W", "[3.4, 1.2, -0.7]", std::string("velocity = [0.3, 0, 0.2]\nmass = ") + heavy) +
                    rod("H", "W"),
                pendulum("1e-6"));
}

TEST_CASE("a light pendulum that hangs from a heavy one") {
  // W hangs at rest under H; P pulls at it with 1e-15 of its weight.
  check_alone(node("H", "[0.1, 0.2, 0.9]", "fixed = true") + node("O", "[0.1, 0.2, -0.3]", "mass = 1e9") +
                  rod("H", "O") + node("P", "[0.7, -0.1, 0.4]", "velocity = [0.5, 1, 0]\nmass = 1e-6") +
                  rod("O", "P"),
              pendulum("1e-6"));
}

TEST_CASE("a pendulum beside a spring that hardly gives") {
  for (const char* stiffness : {"1e6", "1e12", "1e15"})
    check_alone(pendulum("1.3") + node("L", "[2, 0.5, 0]", "fixed = true") +
                    node("W", "[3.2, 0.5, 0]", "mass = 1e6") +
                    "[[constraints]]\nkind = 'line'\nnodes = ['W']\ndirection = [1, 0, 0]\n"
                    "[[forces]]\nkind = 'spring'\nnodes = ['L', 'W']\nstiffness = " +
                    stiffness + "\n",
                pendulum("1.3"));
}

TEST_CASE("a pendulum near the origin beside one that is far away") {
  check_alone(pendulum("1.3") + node("H", "[3e9, 1e9, 0]", "fixed = true") +
                  node("W", "[3000000012, 1e9, -16]", "mass = 2.1") + rod("H", "W"),
              pendulum("1.3"));
}

}  // namespace row_noise_test
