// SPDX-License-Identifier: BSD-3-Clause
// Runs that end a moment before the deployed pose, in which no step can be solved.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"

using namespace unfurl;

namespace end_beside_flat_test {

// It is not deployed then: its fold angle is what is left of the way, rate times time, but for the square of
// that (of a rate that changes by itself within a radian), and what rounding moves hinges in line by, 1e-8 of
// a rod. A method of order 2 tells the time itself to 5e-6 s (2e-5 s with steps twice as long), from step to
// step otherwise. It is as fast there as at the pose, but for the 2.5 a second that it gains on the way.
TEST_CASE("a run that ends just before the flat pose ends when it was told to") {
  struct Way {
    std::vector<std::string> changes;
    double known;  // [s]
  };
  const std::vector<Way> ways{{{"solver.method=generalized_alpha", "solver.step=0.005"}, 5e-6},
                              {{"solver.method=generalized_alpha"}, 2e-5},
                              {{"solver.stages=6"}, 0},
                              {{"solver.stages=4"}, 0}};
  for (const Way& way : ways) {
    const Scene whole = read_scene_file(find_scene("hoop6"), way.changes);
    const Simulation run = simulate(build_model(whole), whole.solver);
    REQUIRE(run.status == RunStatus::deployed);
    const double deployed = run.trajectory.end_time();
    const std::size_t last = run.trajectory.size() - 1;
    const Deployment& deployment = run.trajectory.structure().deployment;
    const double rate = deployment.fold_rate(run.trajectory.positions(last), run.trajectory.velocities(last));
    for (const double before : {3e-4, 9e-5, 1e-5, 1e-6, 1e-9, 1e-11}) {
      if (before < way.known) continue;
      std::vector<std::string> early = way.changes;
      early.push_back("solver.end_time=" + exact_number(deployed - before));
      const Scene scene = read_scene_file(find_scene("hoop6"), early);
      const Simulation ends = simulate(build_model(scene), scene.solver);
      CAPTURE(early.front(), before, ends.message);
      CHECK(ends.status == RunStatus::completed);
      CHECK(ends.events.empty());
      CHECK(ends.trajectory.end_time() == scene.solver.end_time);
      const VectorXd q = ends.trajectory.positions(ends.trajectory.size() - 1);
      CHECK(std::abs(deployment.fold_angle(q) + rate * before) <
            std::abs(rate) * (2 * before * before + way.known) + 2e-8);
      const std::size_t end = ends.trajectory.size() - 1;
      CHECK(ends.trajectory.velocities(end).norm() ==
            Approx(run.trajectory.velocities(last).norm()).epsilon(3 * (before + way.known) + 1e-9));
    }
  }
}

}  // namespace end_beside_flat_test
