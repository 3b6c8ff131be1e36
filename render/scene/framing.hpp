// SPDX-License-Identifier: BSD-3-Clause
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

// A corner of a picture that something else needs, as shares of the picture's width and height.
struct CornerRoom {
  double wide = 0, high = 0;

  bool operator==(const CornerRoom&) const = default;
};

// Where the camera stands, as seen from what it looks at [rad].
struct ViewAngles {
  double azimuth = 0;    // from +x towards +y
  double elevation = 0;  // above the floor, -pi/2 .. pi/2

  Vec3 direction() const;  // unit, towards the camera
  Vec3 up() const;         // unit, upwards in the picture
  Vec3 right() const;
};

// Three-quarter view for a motion in space; a little aside of the normal for one in a plane.
ViewAngles automatic_view(const MotionBounds& bounds);

// What a camera has to show, and how.
struct Framing {
  double around = 0;  // room for every point [m]
  double aspect = 16.0 / 9;
  Margins margins;
  bool parallel = false;  // no perspective
  double zoom = 1;
};

// The nearest camera in that direction that has all points, each with its room, inside the margins. It is
// aimed at as far as `middle`, that of the points; whole: where all is that may be drawn, they among it.
Camera frame_points(const PointSource& points, const Vec3& middle, const MotionBounds& whole,
                    const ViewAngles& view, const Framing& framing);

// Width over height of the picture that they fill in that direction, if it has no perspective.
double fitting_aspect(const PointSource& points, const ViewAngles& view, const Framing& framing);

// How far such a camera must be from `center` at least (or how high its parallel picture) if it looks
// straight at it [m].
double centered_distance(const PointSource& points, const Vec3& center, const ViewAngles& view,
                         const Framing& framing);
// The camera at that distance.
Camera centered_camera(const MotionBounds& whole, const Vec3& center, double distance, const ViewAngles& view,
                       const Framing& framing);

}  // namespace unfurl
