// SPDX-License-Identifier: BSD-3-Clause
// A camera that goes around a point, led by hand.
#pragma once

#include "render/scene/draw_list.hpp"

namespace unfurl {

enum class ViewPreset { three_quarter, front, side, top };

struct OrbitCamera {
  Vec3f target = Vec3f::Zero();
  float distance = 10;                        // of the eye from the target [m]
  float azimuth = -1.08f, elevation = 0.42f;  // of the eye as seen from the target [rad]
  float field_of_view = 0.5f;                 // vertical [rad]

  bool operator==(const OrbitCamera&) const = default;
};

OrbitCamera orbit_of(const Camera& camera);
// Near and far planes that hold a sphere and the floor behind it.
Camera camera_of(const OrbitCamera& orbit, const Vec3f& center, float radius);

// By the mouse's way in pixels of a picture of that height.
OrbitCamera orbited(OrbitCamera orbit, float dx, float dy, float height);
OrbitCamera panned(OrbitCamera orbit, float dx, float dy, float height);
// Nearer by steps of the wheel; `along` (unit) is the direction under the pointer, which stays where it is.
// So that the way leads back, no farther than floats tell a structure of that radius.
OrbitCamera zoomed(OrbitCamera orbit, float steps, const Vec3f& along, float radius);
// The direction of a preset; sees a sphere whole.
OrbitCamera preset_view(ViewPreset preset, const Vec3f& center, float radius, float aspect,
                        float field_of_view);

// From the eye through a pixel (from the top left): unit.
Vec3f ray_through(const Camera& camera, float x, float y, float width, float height);

}  // namespace unfurl
