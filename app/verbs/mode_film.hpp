// SPDX-License-Identifier: BSD-3-Clause
// unfurl render SCENE --mode K [--at TIME|start|end|deployed] -o DIR: a film of a natural mode or a free
// motion.
#pragma once

#include "app/command.hpp"
#include "app/verbs/modal_pose.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

// Modes count as in `unfurl modes`. The film shows three periods, each of two seconds however long it is in
// truth, and runs round without a jump. A mode of elastic rods moves along its shape, the largest
// displacement 9 % of the structure's size; a motion of the mechanism moves as its constraints let it. Writes
// scene.toml, modes.csv, frames, animations and the figure of the modes.
int render_mode(const Arguments& arguments);

// A trajectory that rests at the pose and is shown displaced: a state at the time of each frame.
Simulation swinging(const ModalPose& pose, const VibrationMode& mode, const RenderOptions& render);

}  // namespace unfurl
