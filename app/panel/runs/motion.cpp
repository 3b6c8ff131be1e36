// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/motion.hpp"

#include "core/scene/write.hpp"

namespace unfurl {

MotionKey motion_of(const Scene& scene) {
  Scene bare = scene;
  bare.title.clear();
  bare.solver = {};
  bare.solver.end_time = scene.solver.end_time;
  bare.solver.at_deployed = scene.solver.at_deployed;
  bare.render = {};
  return std::make_shared<const std::string>(scene_text(bare));
}

}  // namespace unfurl
