// SPDX-License-Identifier: BSD-3-Clause
// Names are for readers: what is called alike is told apart all the same.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace equal_names_test {

namespace {

using testing::model_of, testing::run_scene;

// The same arithmetic: to the last digit, whatever is called how. Columns come in one order.
void check_alike(const Diagnostics& a, const Diagnostics& b) {
  REQUIRE(a.columns.size() == b.columns.size());
  for (std::size_t k = 0; k < a.columns.size(); ++k) {
    INFO(a.columns[k].name << " beside " << b.columns[k].name);
    CHECK(std::ranges::equal(a.columns[k].values, b.columns[k].values,
                             [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); }));
  }
  CHECK((a.force_unique == b.force_unique).all());
}

// Two weights on cables that pull them up, slack at first; a drive; two walls that a ball meets.
const std::string weights = R"(
[structure]
kind = "custom"
nodes = [{name = "D", position = [0, 0, 2], fixed = true}, {name = "B", position = [0, 0, 1], mass = 2},
  {name = "E", position = [1, 0, 2], fixed = true}, {name = "C", position = [1, 0, 1], mass = 1},
  {name = "K", position = [2, 0, 0], mass = 3}, {name = "P", position = [3, 0, 0], mass = 1, velocity = [0, 0, 2]}]
constraints = [{kind = "line", nodes = ["B", "C", "K", "P"], direction = [0, 0, 1]},
  {kind = "coordinate_stop", name = "a", nodes = ["P"], direction = [0, 0, 1], min = -0.1},
  {kind = "coordinate_stop", name = "b", nodes = ["P"], direction = [0, 0, 1], max = 0.2, restitution = 0.5},
  {kind = "cable", name = "c", nodes = ["D", "B"], length = 1.05, motion = "rate", rate = -0.5, ramp = 0.3},
  {kind = "cable", name = "d", nodes = ["E", "C"], length = 1.02, motion = "rate", rate = -0.3, ramp = 0.2},
  {kind = "coordinate", name = "e", nodes = ["K"], direction = [0, 0, 1], motion = "rate", rate = 0.3}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.9
)";

}  // namespace

TEST_CASE("stops and cables of one name have each its own forces and works") {
  const auto model = model_of(weights);
  Structure renamed = model->structure;
  for (Stop& stop : renamed.stops) stop.name = "e";
  System system(renamed, true);
  const SolverOptions options = read_scene_text(weights, "s.toml", {}).solver;
  const Simulation own = simulate(model, options),
                   same = simulate(
                       std::make_shared<const Model>(Model{std::move(renamed), std::move(system)}), options);
  const Diagnostics d = diagnose(own);
  check_alike(diagnose(same), d);
  // A force of its own each, weight and all: they are told apart, and both are taut in the end.
  CHECK(d.at("c.force_N").values.back() == Approx(-2 * 9.81).epsilon(1e-9));
  CHECK(d.at("d.force_N").values.back() == Approx(-9.81).epsilon(1e-9));
}

TEST_CASE("a cable of one's own may be called as that of the ring on which it is") {
  const auto named = [](const std::string& name) {
    return diagnose(run_scene(R"(
[structure]
kind = "cable_ring"
units = 6
cable_rate = 0.3
joint_damping = 4
[[constraints]]
kind = "cable"
name = ")" + name + R"("
nodes = ["B0", "B3"]
motion = "rate"
rate = 0.2
[solver]
end_time = 0.5
step = 0.02
)"));
  };
  check_alike(named("cable"), named("rope"));
}

}  // namespace equal_names_test
