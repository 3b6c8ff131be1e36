// SPDX-License-Identifier: BSD-3-Clause
// Dry friction where a mechanism hardly moves what it acts on.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/integrators/integrator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace dead_centre_test {

// A slider-crank of 10 J turns through its dead centres, where 0.5 N of friction on the slider turn round.
// The rate is zero there up to a method's error, and the little that the slider moves makes an impulse of it
// that would stop the crank. The end by dvm in steps of 1 ms, five stages, is that of 0.1 ms to nine digits;
// methods of lower order come within their own errors of it.
TEST_CASE("friction that turns round at a dead centre stops nothing, whatever the method") {
  const std::string scene = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "B", position = [0, 0, 0.3], velocity = [3, 0, 0], mass = 1},
         {name = "C", position = [0.9539392014169457, 0, 0], velocity = [3, 0, 0], mass = 0.5}]
rods = [{nodes = ["O", "B"], mass = 0.5}, {nodes = ["B", "C"], mass = 0.5}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "line"
nodes = ["C"]
direction = [1, 0, 0]
[[forces]]
kind = "friction"
nodes = ["C"]
direction = [1, 0, 0]
kinetic = 0.5
[solver]
end_time = 2
)";
  const VectorXd right =
      testing::end_positions(testing::run_scene(scene, {"solver.step=0.001", "solver.stages=5"}));
  for (const auto& [method, step, apart] : {std::tuple{"rk4", "0.01", 0.05},
                                            {"rk4", "0.002", 1e-3},
                                            {"rk4_projected", "0.002", 1e-3},
                                            {"rk4_baumgarte", "0.002", 1e-3},
                                            {"generalized_alpha", "0.005", 0.2},
                                            {"generalized_alpha", "0.001", 0.02}}) {
    INFO(method << ", " << step);
    const Simulation run = testing::run_scene(
        scene, {std::string("solver.method=") + method, std::string("solver.step=") + step});
    CHECK(run.status == RunStatus::completed);
    CHECK((testing::end_positions(run) - right).lpNorm<Eigen::Infinity>() < apart);
    CHECK(std::ranges::none_of(run.events, [](const Event& e) { return e.kind == "stick"; }));
  }
}

}  // namespace dead_centre_test
