#include "render/scene/framing.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

constexpr double field_of_view = 28 * radians_per_degree;  // vertical

// The unit vector at an azimuth from +x and an elevation above the floor [rad].
Vec3 towards(double azimuth, double elevation) {
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

// The normal of the plane that holds all points, or zero. `moments`: sum of (x - c)(x - c)^T.
Vec3 plane_normal(const Mat3& moments) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(moments);
  const Vec3 squares = solver.eigenvalues();  // ascending
  // Squares of extents: a motion that leaves its plane by less than 1e-4 of its size looks plane.
  if (squares(0) > 1e-8 * squares(2)) return Vec3::Zero();
  if (squares(1) > 1e-8 * squares(2)) return solver.eigenvectors().col(0);
  const Vec3 line = solver.eigenvectors().col(2);  // on a line: take the plane that stands on the floor
  const Vec3 normal = line.cross(Vec3::UnitZ());
  return normal.norm() > 1e-4 ? normal.normalized() : Vec3(-Vec3::UnitY());
}

// The range of eye positions along one axis of the picture: p.a - e.a <= tan_high (depth), e.a - p.a <=
// tan_low (depth). With depth = p.f - e.f both are linear in the eye, so only two extremes of the points
// matter.
struct Extremes {
  double tan_low, tan_high;
  double high = -std::numeric_limits<double>::infinity();  // max of p.a - tan_high p.f
  double low = -std::numeric_limits<double>::infinity();   // max of -p.a - tan_low p.f

  // With room for a sphere of the radius `around`: it touches a plane through the eye at 1/cos of it.
  void add(double along, double depth, double around) {
    high = std::max(high, along - tan_high * depth + around * std::hypot(1.0, tan_high));
    low = std::max(low, -along - tan_low * depth + around * std::hypot(1.0, tan_low));
  }
  double farthest() const { return -(high + low) / (tan_low + tan_high); }  // the largest e.f that fits
  double middle(double eye_depth) const {
    return 0.5 * ((high + tan_high * eye_depth) - (low + tan_low * eye_depth));
  }
};

}  // namespace

MotionBounds motion_bounds(const PointSource& points) {
  MotionBounds out;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  out.low = Vec3::Constant(infinity);
  out.high = Vec3::Constant(-infinity);
  double count = 0;
  Vec3 sum = Vec3::Zero();
  points([&](const Vec3& x) {
    out.low = out.low.cwiseMin(x);
    out.high = out.high.cwiseMax(x);
    sum += x;
    ++count;
  });
  if (count == 0) return {};
  out.center = 0.5 * (out.low + out.high);
  const Vec3 mean = sum / count;
  Mat3 moments = Mat3::Zero();
  points([&](const Vec3& x) {
    out.radius = std::max(out.radius, (x - out.center).norm());
    moments += (x - mean) * (x - mean).transpose();
  });
  out.plane_normal = plane_normal(moments);
  return out;
}

Vec3 view_direction(const MotionBounds& bounds) {
  const Vec3& n = bounds.plane_normal;
  if (n.isZero()) return towards(-62 * radians_per_degree, 24 * radians_per_degree);
  if (std::abs(n.z()) > 0.7) return towards(-70 * radians_per_degree, 48 * radians_per_degree);
  // From the side that has x to the right, or y where the plane is that of y and z.
  const Vec3 front = n.dot(Vec3(0.3, -1, 0)) > 0 ? n : Vec3(-n);
  return towards(std::atan2(front.y(), front.x()) + 20 * radians_per_degree, 12 * radians_per_degree);
}

Camera frame_motion(const PointSource& points, const MotionBounds& bounds, double around, double aspect,
                    const Margins& margins) {
  const Vec3 forward = -view_direction(bounds);
  const Vec3 right = forward.cross(Vec3::UnitZ()).normalized(), up = right.cross(forward);
  const double tan_y = std::tan(0.5 * field_of_view), tan_x = aspect * tan_y;
  Extremes x{tan_x * (1 - 2 * margins.left), tan_x * (1 - 2 * margins.right)};
  Extremes y{tan_y * (1 - 2 * margins.bottom), tan_y * (1 - 2 * margins.top)};
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  points([&](const Vec3& p) {
    const double depth = forward.dot(p);
    x.add(right.dot(p), depth, around);
    y.add(up.dot(p), depth, around);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  });
  const double depth = std::min(x.farthest(), y.farthest());
  const Vec3 eye = x.middle(depth) * right + y.middle(depth) * up + depth * forward;
  Camera camera;
  camera.eye = eye.cast<float>();
  camera.target = (eye + forward * (forward.dot(bounds.center) - depth)).cast<float>();
  camera.vertical_field_of_view = static_cast<float>(field_of_view);
  camera.near_plane = static_cast<float>(0.25 * (nearest - around - depth));
  camera.far_plane =
      static_cast<float>(farthest - depth + 12 * (bounds.radius + around));  // and the floor behind
  return camera;
}

}  // namespace unfurl
