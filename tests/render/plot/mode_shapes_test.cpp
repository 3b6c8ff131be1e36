// SPDX-License-Identifier: BSD-3-Clause
// The figure of modes: whatever moves in a mode is seen to move.
#include "render/plot/figures/mode_shapes.hpp"

#include <catch2/catch.hpp>

#include "core/diagnostics/vibration.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

namespace unfurl::mode_shapes_test {

// A mass between two springs, and rods or none: it moves along them by 9 % of the size of 2 m.
TEST_CASE("a mass on springs is drawn in its modes, with and without rods", "[figure]") {
  for (const bool rods : {false, true}) {
    CAPTURE(rods);
    const auto model =
        testing::model_of(std::string("[structure]\nkind = 'custom'\n"
                                      "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
                                      "{name = 'E', position = [1, 0, 0], mass = 2}, "
                                      "{name = 'B', position = [2, 0, 0], fixed = true}]\n") +
                          (rods ? "rods = [{nodes = ['A', 'B'], mass = 1}]\n" : "") +
                          "[[constraints]]\nkind = 'line'\nnodes = ['E']\ndirection = [1, 0, 0]\n"
                          "[[forces]]\nkind = 'spring'\nnodes = ['A', 'E']\nstiffness = 20\n"
                          "[[forces]]\nkind = 'spring'\nnodes = ['E', 'B']\nstiffness = 20\n");
    const State state = initial_state(model->structure, model->system).state;
    const Vibration found = vibration(*model, state);
    REQUIRE(found.modes.size() == 1);
    CHECK(found.modes[0].frequency == Approx(std::sqrt(40.0 / 2) / (2 * pi)));
    VectorXd q(model->system.coordinates());
    model->system.expand(state.z, q);
    const Figure f =
        mode_shapes_figure(model->structure, whole_positions(model->structure, q), found, "A mass");
    CHECK_THAT(f.caption,
               Catch::EndsWith("1 of all 1 are motions of the mechanism: rods keep their lengths."));
    Vibration elastic = found;
    elastic.mechanism_motions = 0;
    CHECK_THAT(
        mode_shapes_figure(model->structure, whole_positions(model->structure, q), elastic, "A mass").caption,
        Catch::EndsWith("None of the 1 is a motion of the mechanism."));
    const Panel& panel = f.panels.at(0);
    // Two springs, and the rod, of the pose and of the mode.
    CHECK(panel.segments.size() == (rods ? 6 : 4));
    // The mass and, where no rod holds them, both points.
    REQUIRE(panel.dots.size() == (rods ? 2 : 6));
    const std::size_t half = panel.dots.size() / 2, mass = rods ? 0 : 1;
    const Dot &rest = panel.dots[mass], &moved = panel.dots[half + mass];
    CHECK(rest.color != moved.color);
    CHECK(std::hypot(moved.x - rest.x, moved.y - rest.y) == Approx(0.09 * 2));
  }
}

}  // namespace unfurl::mode_shapes_test
