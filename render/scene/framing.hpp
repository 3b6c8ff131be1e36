// A still camera that keeps a whole motion in the picture.
#pragma once

#include <functional>
#include <vector>

#include "core/math/types.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

// The points of a motion [m], z up: calls its argument with each of them, as often as it is asked.
using PointSource = std::function<void(const std::function<void(const Vec3&)>&)>;

// Where a motion takes place.
struct MotionBounds {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // box [m]
  Vec3 center = Vec3::Zero();                    // of the box
  double radius = 0;                             // of the sphere around that centre [m]
  Vec3 plane_normal = Vec3::Zero();              // unit; zero where the motion fills space
};
MotionBounds motion_bounds(const PointSource& points);

// Share of the picture that stays free at each edge, 0..0.5.
struct Margins {
  double left = 0.05, right = 0.05, top = 0.10, bottom = 0.10;
};

// Where the camera stands, as seen from what it looks at: three-quarter view for a motion in space; a little
// aside of the normal for one in a plane.
Vec3 view_direction(const MotionBounds& bounds);

// The nearest camera in that direction that has all points, each with `around` metres of room, inside the
// margins.
Camera frame_motion(const PointSource& points, const MotionBounds& bounds, double around, double aspect,
                    const Margins& margins);

}  // namespace unfurl
