// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/framing.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

constexpr double field_of_view = 28 * radians_per_degree;  // vertical

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
  // The same for an eye that stands at `along` itself.
  double farthest_at(double along) const {
    return std::min((along - high) / tan_high, (-along - low) / tan_low);
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

Vec3 ViewAngles::direction() const {
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}
Vec3 ViewAngles::up() const {  // d direction / d elevation: also where the view is straight from above
  return {-std::cos(azimuth) * std::sin(elevation), -std::sin(azimuth) * std::sin(elevation),
          std::cos(elevation)};
}
Vec3 ViewAngles::right() const {
  return {-std::sin(azimuth), std::cos(azimuth), 0};
}

ViewAngles automatic_view(const MotionBounds& bounds) {
  const Vec3& n = bounds.plane_normal;
  if (n.isZero()) return {-62 * radians_per_degree, 24 * radians_per_degree};
  if (std::abs(n.z()) > 0.7) return {-70 * radians_per_degree, 48 * radians_per_degree};
  // From the side that has x to the right, or y where the plane is that of y and z.
  const Vec3 front = n.dot(Vec3(0.3, -1, 0)) > 0 ? n : Vec3(-n);
  return {std::atan2(front.y(), front.x()) + 20 * radians_per_degree, 12 * radians_per_degree};
}

namespace {

// The two directions of a picture, filled with points. A parallel projection is one without tangents.
struct Sight {
  Vec3 right, up, forward;
  double tan_y;
  Extremes x, y;
  double nearest = std::numeric_limits<double>::infinity();  // along the view, with its room
  double share_x, share_y;  // of the picture's width and height that are inside the margins

  Sight(const PointSource& points, const ViewAngles& view, const Framing& f)
      : right(view.right()),
        up(view.up()),
        forward(-view.direction()),
        tan_y(f.parallel ? 0.0 : std::tan(0.5 * field_of_view)),
        x{tan_y * f.aspect * (1 - 2 * f.margins.left), tan_y * f.aspect * (1 - 2 * f.margins.right)},
        y{tan_y * (1 - 2 * f.margins.bottom), tan_y * (1 - 2 * f.margins.top)},
        share_x(1 - f.margins.left - f.margins.right),
        share_y(1 - f.margins.bottom - f.margins.top) {
    points([&](const Vec3& p) {
      const double depth = forward.dot(p);
      nearest = std::min(nearest, depth - f.around);
      x.add(right.dot(p), depth, f.around);
      y.add(up.dot(p), depth, f.around);
    });
  }
};

// What it is aimed at may be a small part of the whole, and the eye far inside that.
Camera looking(const Vec3& eye, const Vec3& center, const MotionBounds& whole, const ViewAngles& view,
               const Framing& f, double parallel_height) {
  const Vec3 forward = -view.direction();
  const double depth = forward.dot(center - eye), reach = whole.radius + f.around;
  const double whole_depth = forward.dot(whole.center - eye);
  Camera camera;
  camera.eye = eye.cast<float>();
  camera.target = (eye + forward * depth).cast<float>();
  camera.up = view.up().cast<float>();
  camera.vertical_field_of_view = static_cast<float>(field_of_view);
  camera.parallel_height = static_cast<float>(parallel_height);
  camera.near_plane = static_cast<float>(std::max(0.02 * depth, 0.8 * (whole_depth - 1.05 * reach)));
  camera.far_plane = static_cast<float>(whole_depth + 13 * reach);  // and the floor behind
  return camera;
}

constexpr double parallel_distance = 8;  // of the eye of a parallel picture, in radii of the motion

}  // namespace

Camera frame_points(const PointSource& points, const Vec3& middle, const MotionBounds& whole,
                    const ViewAngles& view, const Framing& f) {
  const Sight sight(points, view, f);
  const double center = sight.forward.dot(middle);
  if (f.parallel) {
    const double height = std::max((sight.y.high + sight.y.low) / sight.share_y,
                                   (sight.x.high + sight.x.low) / (sight.share_x * f.aspect)) /
                          f.zoom;
    // The margins' middle lies beside the picture's.
    const double x = sight.x.middle(0) + 0.5 * (f.margins.right - f.margins.left) * height * f.aspect;
    const double y = sight.y.middle(0) + 0.5 * (f.margins.top - f.margins.bottom) * height;
    const double depth = sight.forward.dot(whole.center) - parallel_distance * (whole.radius + f.around);
    return looking(x * sight.right + y * sight.up + depth * sight.forward, middle, whole, view, f, height);
  }
  const double fitted = std::min(sight.x.farthest(), sight.y.farthest());
  const double depth = center - (center - fitted) / f.zoom;
  // As far aside of the middle as the margins ask for, where it is nearer as little as that is: it stays in
  // its place.
  const auto aside = [&](double eye, double at) { return at + (eye - at) / f.zoom; };
  const double x = aside(sight.x.middle(fitted), sight.right.dot(middle)),
               y = aside(sight.y.middle(fitted), sight.up.dot(middle));
  Camera camera = looking(x * sight.right + y * sight.up + depth * sight.forward, middle, whole, view, f, 0);
  // What is long along the view and slim begins close to the eye.
  const double nearest = std::max(0.9 * (sight.nearest - depth), 0.002 * (center - depth));
  camera.near_plane = std::min(camera.near_plane, static_cast<float>(nearest));
  return camera;
}

double fitting_aspect(const PointSource& points, const ViewAngles& view, const Framing& framing) {
  Framing parallel = framing;
  parallel.parallel = true;
  const Sight sight(points, view, parallel);
  return (sight.x.high + sight.x.low) / sight.share_x / ((sight.y.high + sight.y.low) / sight.share_y);
}

double centered_distance(const PointSource& points, const Vec3& center, const ViewAngles& view,
                         const Framing& framing) {
  // Both sides of the middle are as near as the larger margin, and half of the picture would leave none of
  // it.
  Framing f = framing;
  f.margins.bottom = std::min(f.margins.bottom, 0.4);
  const Sight sight(points, view, f);
  const double x = sight.right.dot(center), y = sight.up.dot(center);
  if (f.parallel) {
    const double half_x = std::max(sight.x.high - x, sight.x.low + x),
                 half_y = std::max(sight.y.high - y, sight.y.low + y);
    return 2 * std::max(half_y / (1 - 2 * std::max(f.margins.top, f.margins.bottom)),
                        half_x / (f.aspect * (1 - 2 * std::max(f.margins.left, f.margins.right))));
  }
  return sight.forward.dot(center) - std::min(sight.x.farthest_at(x), sight.y.farthest_at(y));
}

Camera centered_camera(const MotionBounds& whole, const Vec3& center, double distance, const ViewAngles& view,
                       const Framing& f) {
  if (!f.parallel) return looking(center + distance / f.zoom * view.direction(), center, whole, view, f, 0);
  const double back = parallel_distance * (whole.radius + f.around);
  return looking(center + back * view.direction(), center, whole, view, f, distance / f.zoom);
}

}  // namespace unfurl
