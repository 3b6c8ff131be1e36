// SPDX-License-Identifier: BSD-3-Clause
// The pose opposite to the deployed one, half a turn of the fold angle away, is another one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/path/path_run.hpp"
#include "core/scene/library.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace opposite_pose_test {

TEST_CASE("what remains of a fold rises on to half a turn, and its zero is the deployed pose alone") {
  double before = -2;
  for (int k = -1799; k <= 1799; ++k) {
    const double angle = 0.1 * k * radians_per_degree,
                 left = remaining_of_fold(std::sin(angle), std::cos(angle));
    CHECK(left > before);
    CHECK((left > 0) == (k > 0));
    if (std::abs(k) <= 900) CHECK(left == std::sin(angle));
    before = left;
  }
  const auto left = [](double degrees) {
    const double angle = degrees * radians_per_degree;
    return remaining_of_fold(std::sin(angle), std::cos(angle));
  };
  for (const auto& [a, b] : {std::pair(1.0, -1.0), {80, -95}, {120, -50}, {170, -9}})
    CHECK(is_fold_passed(left(a), left(b)));
  for (const auto& [a, b] : {std::pair(179.0, 181.0), {170, 190}, {95, 260}, {80, 200}})
    CHECK_FALSE(is_fold_passed(left(a), left(b)));
}

// Loads that fold them up turn them inside out instead: the fold angle leaves the deployed one behind on the
// other side, at more than half a turn from it.
TEST_CASE("a structure that turns inside out is not deployed") {
  struct Inverted {
    const char *scene, *load;
    double deployed;  // [deg]
  };
  for (const Inverted& s : {Inverted{"scissor_mast", "structure.tip_force=-5", 35},
                            Inverted{"scissor_ring", "structure.radial_force=-5", 20},
                            Inverted{"hoberman", "structure.radial_force=-5", 8},
                            Inverted{"reentrant_sheet", "structure.stretch_force=-5", 8}})
    for (const bool path : {false, true}) {
      INFO(s.scene << " " << path);
      const Scene scene = read_scene_file(find_scene(s.scene), {s.load, "solver.end_time=5"});
      const auto model = build_model(scene);
      const Simulation run = path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
      CHECK(run.status == RunStatus::completed);
      CHECK(run.events.empty());
      const Diagnostics d = diagnose(run);
      CHECK(*std::ranges::max_element(d.at("fold_angle_deg").values) > s.deployed + 180);
    }
}

}  // namespace opposite_pose_test
