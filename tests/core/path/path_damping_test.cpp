// SPDX-License-Identifier: BSD-3-Clause
// What dampers take of a run on the path, where they stop rates within a step.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/path/path_run.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace path_damping_test {

// A rod let go where it is level, its tip dragged: it sinks at the rate (3/2) m g / (3 c) after m / (3 c) s.
// Dissipated is what gravity has done, m g / 2 of the tip's way down, less the kinetic energy m v^2 / 6.
TEST_CASE("dissipated energy is right where a damper is stiff at the step") {
  constexpr double m = 3, g = 10;
  for (const double c : {3.0, 30.0, 100.0, 300.0, 1000.0, 1e4, 1e6})
    for (const double step : {0.01, 0.002}) {
      CAPTURE(c, step);
      const Scene scene =
          read_scene_text(R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 3}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -10]
[[forces]]
kind = "drag"
nodes = ["B"]
damping = 1
[solver]
end_time = 0.5
)toml",
                          "s.toml", {"forces[0].damping=" + number(c), "solver.step=" + number(step)});
      Simulation run = simulate_on_path(build_model(scene), scene.solver);
      const Diagnostics d = judge(run);
      const std::size_t last = run.trajectory.size() - 1;
      const double z = run.trajectory.node_positions(last)[5],
                   speed = run.trajectory.node_velocities(last).tail<3>().norm();
      const double taken = -0.5 * m * g * z - m * speed * speed / 6;
      // Of what falls like e^(-3 c t / m) a few thousandths are left to the second step at 3 c h / m = 3,
      // some of them to a rule of order 4.
      CHECK(d.at("dissipated_J").values.back() == Approx(taken).epsilon(1e-4));
      CHECK(accuracy_warnings(run, d).empty());
    }
}

}  // namespace path_damping_test
