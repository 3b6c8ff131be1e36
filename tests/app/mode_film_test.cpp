// SPDX-License-Identifier: BSD-3-Clause
// Films of a mode: what they draw is what films of the motion draw.
#include "app/verbs/mode_film.hpp"

#include <catch2/catch.hpp>

#include "render/scene/frame_builder.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace mode_film_test {

TEST_CASE("a stop that holds is no actuator in the film of a mode") {
  // A rod level from A to B, carried by a strap of its full length: it swings to both sides as a door does.
  const Scene scene = read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]},
         {name = "Q", position = [1, 0, 1], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "length_stop"
nodes = ["B", "Q"]
max = 1
[gravity]
acceleration = [0, 0, -10]
[solver]
end_time = 0.1
)",
                                      "strap.toml");
  const ModalPose pose = modal_pose(scene, {});
  CHECK(pose.model->structure.constraints.size() == pose.drawn->structure.constraints.size() + 1);
  const Vibration found = vibration_of(pose);
  REQUIRE(found.modes.size() == 1);  // of two ways to swing the strap takes one
  const Simulation film = swinging(pose, found.modes[0], scene.render),
                   motion = simulate(build_model(scene), scene.solver);
  CHECK(FrameBuilder(film.trajectory, {}).build(0).tubes.size() ==
        FrameBuilder(motion.trajectory, {}).build(0).tubes.size());
}

}  // namespace mode_film_test
