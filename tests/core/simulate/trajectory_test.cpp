// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/trajectory.hpp"

#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

TEST_CASE("between its rows a trajectory shows a straight line of what rods give way by") {
  const Simulation rigid = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 1}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.07
end_time = 0.5
)");
  Simulation shown = rigid;
  // In proportion to time: straight lines between uneven rows are it.
  VectorXd grows(6);
  grows << 0, 0, 0, 0.3, -0.2, 0.5;
  const Trajectory& rows = rigid.trajectory;
  for (std::size_t i = 0; i < rows.size(); ++i) shown.trajectory.add_stretch(i, rows.time(i) * grows);
  for (const double t : {0.0, 0.013, 0.07, 0.2, 0.333, 0.49, 0.4999, 0.5}) {
    INFO(t);
    const VectorXd moved = shown.trajectory.positions_at(t) - rows.positions_at(t);
    CHECK((moved - t * grows).cwiseAbs().maxCoeff() <= 1e-15 * 4);  // rounding of coordinates of a metre
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const VectorXd moved = shown.trajectory.positions(i) - rows.positions(i);
    CHECK((moved - rows.time(i) * grows).cwiseAbs().maxCoeff() <= 1e-15 * 4);
    CHECK(shown.trajectory.velocities(i) == rows.velocities(i));
  }
}
