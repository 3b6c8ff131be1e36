// SPDX-License-Identifier: BSD-3-Clause
// A pin with play in its hole: impacts on the rim, rest on it and sliding along it, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace clearance_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

// A pin of 2 kg in the middle of a hole of 0.2 m play, under 10 m/s^2 in a direction that nothing is along.
const std::string pin = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [1.1, -0.3, 0.7], fixed = true},
  {name = "A", position = [1.1, -0.3, 0.7], mass = 2}]
[[constraints]]
kind = "clearance"
name = "pin"
nodes = ["O", "A"]
clearance = 0.2
restitution = 0.5
[gravity]
acceleration = [2, -4, -8.94427190999916]
[solver]
stages = 4
step = 0.02
end_time = 1
)";

}  // namespace

// 5000 km from the origin places are 1 nm apart: 30 mm are 30.00000026.
TEST_CASE("a pin at the rim in map coordinates has not passed it") {
  for (const char* kind : {"clearance", "length_stop", "cable"}) {
    CAPTURE(kind);
    const std::string key = kind == std::string("clearance") ? "clearance"
                            : kind == std::string("cable")   ? "length"
                                                             : "max";
    CHECK(
        error_of("[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [5e6, 0, 0], fixed = true}, "
                 "{name = 'A', position = [5000000.03, 0, 0], mass = 1}]\n[[constraints]]\nkind = '" +
                 std::string(kind) + "'\nnodes = ['O', 'A']\n" + key + " = 0.03\n") == "");
  }
}

TEST_CASE("a pin that begins in the middle of its hole bounces on the rim in a geometric series") {
  // 0.2 m at 10 m/s^2: 0.2 s to the rim, then flights of 0.2, 0.1, 0.05, ... s: at rest after 0.6 s.
  for (const Method& method : methods()) {
    const Simulation run = run_scene(pin, {"solver.method=" + std::string(method.name)});
    INFO(method.name << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() >= 6);
    for (int k = 0; k < 6; ++k) {
      const Event& event = run.events[static_cast<std::size_t>(k)];
      CHECK(event.kind == "contact");
      CHECK(event.element == "pin");
      CHECK(event.t == Approx(0.6 - 0.4 * std::pow(0.5, k)).epsilon(0).margin(1e-10));
      CHECK(event.energy_lost == Approx(0.75 * 4 * std::pow(0.25, k)).epsilon(1e-8));
    }
    CHECK(run.events.back().name == "rests on stop pin");
    CHECK(run.events.back().t == Approx(0.6).epsilon(0).margin(5e-4));  // up to the rest speed of 1 mm/s
    const VectorXd q = end_positions(run);
    const Vec3 down = Vec3(2, -4, -std::sqrt(80.0)) / 10;
    CHECK((q.tail<3>() - q.head<3>() - 0.2 * down).norm() <= 1e-9);
    CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-8);
  }
}

TEST_CASE("a pin that touches the rim slides along it, one in the middle stays there") {
  // Round and round at 0.9 m/s, held by the rim: an angle of v t / c.
  const std::string plane = R"(
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 0, 1]
)";
  const Simulation round =
      run_scene(pin + plane, {"gravity.acceleration=[0,0,0]", "structure.nodes.A.position=[1.3,-0.3,0.7]",
                              "structure.nodes.A.velocity=[0,0.9,0]", "solver.stages=5"});
  INFO(round.message);
  REQUIRE(round.status == RunStatus::completed);
  const VectorXd q = end_positions(round);
  CHECK(q[3] == Approx(1.1 + 0.2 * std::cos(4.5)).epsilon(0).margin(1e-9));
  CHECK(q[4] == Approx(-0.3 + 0.2 * std::sin(4.5)).epsilon(0).margin(1e-9));
  const Simulation still = run_scene(pin, {"gravity.acceleration=[0,0,0]"});
  REQUIRE(still.status == RunStatus::completed);
  CHECK(still.events.empty());
  CHECK((end_positions(still).tail<3>() - end_positions(still).head<3>()).norm() == 0.0);
}

TEST_CASE("a clearance that cannot be is refused with its place") {
  CHECK(error_of(pin, {"constraints[0].clearance=-0.1"}).find("clearance: must be") != std::string::npos);
  CHECK(error_of(pin, {"constraints[0].clearance=0"}).find("clearance: must be") != std::string::npos);
  CHECK(error_of(pin, {"structure.nodes.A.position=[1.1,0.2,0.7]"}).find("is passed already at t = 0") !=
        std::string::npos);
}

}  // namespace clearance_test
