// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/view/picking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/diagnostics/length_error.hpp"
#include "render/plot/ticks.hpp"
#include "render/scene/view.hpp"

namespace unfurl {

namespace {

Vec3f in_picture(const VectorXd& whole, int node, const PickView& view) {
  const Vec3 at = view.upright * (whole.segment<3>(3 * node) - view.origin);
  return project(view.camera, view.width, view.height, at.cast<float>());
}

// Distance of a pixel from a rod's picture; infinite behind the camera.
float distance_to(const Vec3f& a, const Vec3f& b, float x, float y) {
  if (a.z() <= 0 || b.z() <= 0) return std::numeric_limits<float>::infinity();
  const Eigen::Vector2f p(x, y), start = a.head<2>(), along = b.head<2>() - start;
  const float square = along.squaredNorm();
  const float u = square > 0 ? std::clamp((p - start).dot(along) / square, 0.0f, 1.0f) : 0.0f;
  return (start + u * along - p).norm();
}

template <class Parts>
int index_of(const Parts& parts, const std::string& name) {
  const auto it =
      std::find_if(parts.begin(), parts.end(), [&](const auto& part) { return part.name == name; });
  return it == parts.end() ? -1 : static_cast<int>(it - parts.begin());
}

// The states around a time and where between them.
struct Between {
  std::size_t i = 0, j = 0;
  double share = 0;
};
Between between(const Trajectory& trajectory, double t) {
  std::size_t low = 0, high = trajectory.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (trajectory.time(middle) <= t ? low : high) = middle;
  }
  const double span = trajectory.time(high) - trajectory.time(low);
  const double share = span > 0 ? std::clamp((t - trajectory.time(low)) / span, 0.0, 1.0) : 0.0;
  // At a state that one alone tells: what the other one has may not be known.
  return {share == 1 ? high : low, share == 0 ? low : high, share};
}

std::string quantity(double x, const char* unit) {
  return plot::format_number(x, 6) + " " + unit;
}

std::vector<Reading> rod_readings(int index, const LiveRun& run, double t) {
  const Trajectory& trajectory = run.simulation.trajectory;
  const RodCopy& copy = trajectory.structure().rod_copies[static_cast<std::size_t>(index)];
  const Rod& rod = trajectory.structure().rods[static_cast<std::size_t>(copy.source)];
  const VectorXd whole = trajectory.positions_at(t);
  const auto at = between(trajectory, t);
  // The length error is of solved states: between them it would be the interpolation's.
  const std::size_t nearest = at.share < 0.5 ? at.i : at.j;
  const double error = length_error(rod, trajectory.node_positions(nearest), trajectory.time(nearest));
  std::vector<Reading> rows{
      {"length", quantity((whole.segment<3>(3 * copy.b) - whole.segment<3>(3 * copy.a)).norm(), "m")},
      {"mass", quantity(rod.mass, "kg")}};
  if (!std::isnan(error)) rows.insert(rows.begin() + 1, {"length error", quantity(error, "m")});
  const MatrixXd& force = run.diagnostics.axial_force;
  if (force.rows() > static_cast<Index>(at.j) && force.cols() > copy.source) {
    const double f = (1 - at.share) * force(static_cast<Index>(at.i), copy.source) +
                     at.share * force(static_cast<Index>(at.j), copy.source);
    const bool unique = run.diagnostics.force_unique(static_cast<Index>(at.i), copy.source) &&
                        run.diagnostics.force_unique(static_cast<Index>(at.j), copy.source);
    rows.insert(rows.begin(), {f < 0 ? "compression" : "tension",
                               quantity(std::abs(f), "N") + (unique ? "" : ", not unique")});
  }
  return rows;
}

std::vector<Reading> node_readings(int index, const LiveRun& run, double t) {
  const Trajectory& trajectory = run.simulation.trajectory;
  const Vec3 v = trajectory.velocities_at(t).segment<3>(3 * index);
  const Vec3 x = trajectory.positions_at(t).segment<3>(3 * index);
  return {{"speed", quantity(v.norm(), "m/s")},
          {"x", quantity(x.x(), "m")},
          {"y", quantity(x.y(), "m")},
          {"z", quantity(x.z(), "m")}};
}

}  // namespace

Selection pick(const LiveRun& run, double t, const PickView& view, float x, float y, float reach,
               const VectorXd* pose) {
  const Structure& structure = run.simulation.trajectory.structure();
  const VectorXd whole = pose != nullptr ? *pose : run.simulation.trajectory.positions_at(t);
  Selection best;
  float nearest = reach, depth = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const Vec3f at = in_picture(whole, static_cast<int>(i), view);
    const float away = at.z() > 0 ? std::hypot(at.x() - x, at.y() - y) : reach;
    if (away >= reach || at.z() >= depth) continue;  // the nearest to the eye of those in reach
    depth = at.z();
    best = {Selection::Kind::node, structure.node_copies[i].name};
  }
  if (best.kind != Selection::Kind::none) return best;
  for (const RodCopy& rod : structure.rod_copies) {
    const float away = distance_to(in_picture(whole, rod.a, view), in_picture(whole, rod.b, view), x, y);
    if (away >= nearest) continue;
    nearest = away;
    best = {Selection::Kind::rod, rod.name};
  }
  return best;
}

PickedPlace place_of(const Selection& selection, const LiveRun& run, double t, const PickView& view) {
  const Structure& structure = run.simulation.trajectory.structure();
  int a = -1, b = -1;
  if (selection.kind == Selection::Kind::node) a = b = index_of(structure.node_copies, selection.name);
  if (selection.kind == Selection::Kind::rod) {
    const int rod = index_of(structure.rod_copies, selection.name);
    if (rod >= 0) {
      a = structure.rod_copies[static_cast<std::size_t>(rod)].a;
      b = structure.rod_copies[static_cast<std::size_t>(rod)].b;
    }
  }
  if (a < 0) return {};
  const VectorXd whole = run.simulation.trajectory.positions_at(t);
  return {true, in_picture(whole, a, view), in_picture(whole, b, view)};
}

std::vector<Reading> readings(const Selection& selection, const LiveRun& run, double t) {
  const Structure& structure = run.simulation.trajectory.structure();
  if (selection.kind == Selection::Kind::rod)
    if (const int rod = index_of(structure.rod_copies, selection.name); rod >= 0)
      return rod_readings(rod, run, t);
  if (selection.kind == Selection::Kind::node)
    if (const int node = index_of(structure.node_copies, selection.name); node >= 0)
      return node_readings(node, run, t);
  return {};
}

}  // namespace unfurl
