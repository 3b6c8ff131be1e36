// SPDX-License-Identifier: BSD-3-Clause
// From where figures of poses are seen.
#pragma once

#include "core/math/types.hpp"

namespace unfurl {

// A parallel projection: right and up span the page, `towards` points to the reader.
struct PoseView {
  Vec3 right, up, towards;
  bool flat = false;  // along the axis in which a plane mechanism has no extent

  // x and y on the page, z: larger is nearer.
  Vec3 project(const Vec3& p) const { return {p.dot(right), p.dot(up), p.dot(towards)}; }
};

struct PoseBox {
  Vec3 lo = Vec3::Constant(1e300), hi = Vec3::Constant(-1e300);
  void add(const Vec3& p) { lo = lo.cwiseMin(p), hi = hi.cwiseMax(p); }
  Vec3 size() const { return hi - lo; }
};

// Of what has this extent: along its thin axis, else axonometric. Gravity points down on the page.
PoseView pose_view(const Vec3& extent, const Vec3& gravity);

inline Vec3 pose_node(const VectorXd& q, int i) {
  return q.segment<3>(3 * i);
}

}  // namespace unfurl
