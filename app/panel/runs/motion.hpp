// SPDX-License-Identifier: BSD-3-Clause
// What is the same motion, however it is solved.
#pragma once

#include <memory>
#include <string>

#include "core/scene/scene.hpp"

namespace unfurl {

// Everything of a scene that its true motion depends on, as text: structure, loads, forces, constraints,
// gravity, its end and what happens when it is deployed; not method, steps, tolerance or looks.
using MotionKey = std::shared_ptr<const std::string>;
MotionKey motion_of(const Scene& scene);

inline bool same_motion(const MotionKey& a, const MotionKey& b) {
  return a && b && (a == b || *a == *b);
}

}  // namespace unfurl
