// SPDX-License-Identifier: BSD-3-Clause
// From metres to pixels: the matrices of a camera and of a light.
#pragma once

#include <Eigen/Core>

#include "render/scene/draw_list.hpp"

namespace unfurl {

// World -> clip coordinates of OpenGL.
Eigen::Matrix4f view_projection(const Camera& camera, float aspect);

// World -> clip coordinates of a parallel light that shines against `direction` on a sphere.
Eigen::Matrix4f light_projection(const Vec3f& direction, const Vec3f& center, float radius);

// Where a point appears in a picture: pixels from the top left, and its distance along the view [m]; a point
// with a distance that is not positive is behind the camera.
Vec3f project(const Camera& camera, int width, int height, const Vec3f& point);

}  // namespace unfurl
