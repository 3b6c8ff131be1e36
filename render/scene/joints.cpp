// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/joints.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace unfurl {
namespace {

constexpr double least_sine = 0.03;      // of two directions that still tell their plane
constexpr double parallel = 0.98;        // cosine of axes that are one
constexpr double rigid_range = 1e-3;     // an angle that changes by less is kept [rad]
constexpr std::size_t most_rods = 4000;  // beyond, nobody sees on which side a rod passes another

Vec3 across(const Vec3& v, const Vec3& unit) {
  const Vec3 rest = v - unit * unit.dot(v);
  const double length = rest.norm();
  return length > 1e-9 ? Vec3(rest / length) : Vec3(Vec3::Zero());
}

// Where two segments come nearest: the squares' minimum over both parameters (Ericson, Real-Time Collision
// Detection, 5.1.9); here for directions that are not parallel.
struct Nearest {
  double distance, u, v;
  Vec3 middle;
};
Nearest nearest(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 x = b - a, y = d - c, r = a - c;
  const double xx = x.dot(x), yy = y.dot(y), xy = x.dot(y), xr = x.dot(r), yr = y.dot(r);
  const double free = xx * yy - xy * xy;
  double u = free > 1e-12 * xx * yy ? std::clamp((xy * yr - xr * yy) / free, 0.0, 1.0) : 0.5;
  const double v = std::clamp((xy * u + yr) / yy, 0.0, 1.0);
  u = std::clamp((xy * v - xr) / xx, 0.0, 1.0);
  const Vec3 p = a + u * x, q = c + v * y;
  return {(p - q).norm(), u, v, 0.5 * (p + q)};
}

bool share_a_node(const RodCopy& r, const RodCopy& s) {
  return r.a == s.a || r.a == s.b || r.b == s.a || r.b == s.b;
}

}  // namespace

Joints::Joints(const Structure& structure, std::vector<double> times,
               const std::vector<std::vector<Vec3>>& poses, const std::vector<double>& radius,
               const Vec3& center, const Vec3& plane_normal)
    : times_(std::move(times)),
      poses_(poses),
      rods_(structure.rod_copies),
      kinds_(structure.node_copies.size(), JointKind::none),
      ends_(structure.node_copies.size()),
      axes_(2 * structure.rod_copies.size()),
      layers_(2 * structure.rod_copies.size(), 0),
      sides_(structure.rod_copies.size()) {
  for (int i = 0; i < static_cast<int>(rods_.size()); ++i) {
    ends_[static_cast<std::size_t>(rods_[static_cast<std::size_t>(i)].a)].push_back({i, 0});
    ends_[static_cast<std::size_t>(rods_[static_cast<std::size_t>(i)].b)].push_back({i, 1});
  }
  find_axes(structure, plane_normal);
  if (rods_.size() > most_rods) return;
  find_crossings(structure, radius);
  find_pins(structure, radius);
  find_sides(center);
}

Vec3 Joints::direction(const RodEnd& e, std::size_t sample) const {
  const RodCopy& rod = rods_[static_cast<std::size_t>(e.rod)];
  const Vec3 along =
      poses_[sample][static_cast<std::size_t>(rod.b)] - poses_[sample][static_cast<std::size_t>(rod.a)];
  const double length = along.norm();
  if (length <= 0) return Vec3::UnitX();
  return (e.end == 0 ? 1.0 : -1.0) / length * along;
}

double Joints::angle_range(const RodEnd& a, const RodEnd& b) const {
  double least = 4, most = 0;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    const Vec3 x = direction(a, k), y = direction(b, k);
    const double angle = std::atan2(x.cross(y).norm(), x.dot(y));
    least = std::min(least, angle), most = std::max(most, angle);
  }
  return most - least;
}

// x cross y, carried over where they are on one line, and without a jump where they pass it.
DirectionTrack Joints::normal_of(const RodEnd& a, const RodEnd& b) const {
  DirectionTrack track(times_.size(), Vec3::Zero());
  Vec3 last = Vec3::Zero();
  for (std::size_t k = 0; k < times_.size(); ++k) {
    const Vec3 x = direction(a, k), c = x.cross(direction(b, k));
    if (c.norm() > least_sine)
      track[k] = c.normalized() * (last.dot(c) < 0 ? -1.0 : 1.0);
    else if (!last.isZero())
      track[k] = across(last, x);
    if (!track[k].isZero()) last = track[k];
  }
  if (last.isZero()) return {};
  for (std::size_t k = track.size() - 1; k-- > 0;)
    if (track[k].isZero()) track[k] = track[k + 1];
  return track;
}

// A pin keeps its direction while a rod turns about it: of the others that the rod turns against by a good
// part of the most, the one whose common normal wanders least; of equal ones, the one against which it turns
// most.
DirectionTrack Joints::axis_of(const RodEnd& end, const std::vector<RodEnd>& ends) const {
  double most = 0;
  for (const RodEnd& other : ends)
    if (other.rod != end.rod) most = std::max(most, angle_range(end, other));
  DirectionTrack best;
  double least = 2, best_range = -1;
  for (const RodEnd& other : ends) {
    if (other.rod == end.rod) continue;
    const double range = angle_range(end, other);
    if (range < 0.2 * most) continue;
    DirectionTrack track = normal_of(end, other);
    if (track.empty() && !best.empty()) continue;
    double wander = 0;
    for (const Vec3& axis : track) wander = std::max(wander, 1 - std::abs(axis.dot(track.front())));
    const bool steadier = wander < least - 1e-6;
    if (!best.empty() && !steadier && !(wander < least + 1e-6 && range > best_range + 1e-6)) continue;
    best = std::move(track), least = wander, best_range = range;
  }
  return best;
}

void Joints::find_axes(const Structure& structure, const Vec3& plane_normal) {
  std::vector<bool> fixed(structure.nodes.size(), false);
  for (const Constraint& c : structure.constraints)
    if (c.kind == "fixed")
      for (const int n : c.nodes) fixed[static_cast<std::size_t>(n)] = true;
  for (std::size_t n = 0; n < ends_.size(); ++n) {
    const std::vector<RodEnd>& ends = ends_[n];
    if (ends.empty()) continue;
    for (const RodEnd& end : ends) axes_[index(end)] = axis_of(end, ends);
    const bool pivot = ends.size() == 1 && fixed[static_cast<std::size_t>(structure.node_copies[n].source)];
    if (pivot && !plane_normal.isZero()) axes_[index(ends[0])].assign(times_.size(), plane_normal);
    JointKind& kind = kinds_[n] = JointKind::hinge;
    const DirectionTrack& first = axes_[index(ends[0])];
    for (const RodEnd& end : ends) {
      const DirectionTrack& axis = axes_[index(end)];
      if (axis.empty()) kind = JointKind::ball;
      if (kind == JointKind::ball) break;
      for (std::size_t k = 0; k < times_.size(); ++k)
        if (std::abs(axis[k].dot(first[k])) < parallel) kind = JointKind::hub;
    }
    if (kind == JointKind::hinge) find_layers(static_cast<int>(n));
  }
}

void Joints::find_layers(int node) {
  const std::vector<RodEnd>& ends = ends_[static_cast<std::size_t>(node)];
  int layers = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    int& layer = layers_[index(ends[i])] = -1;
    for (std::size_t j = 0; j < i && layer < 0; ++j)
      if (angle_range(ends[i], ends[j]) < rigid_range) layer = layers_[index(ends[j])];
    if (layer < 0) layer = layers++;
  }
}

// At three moments, those whose axes come nearer than their thickness well inside both; found by sweeping
// along x.
// Parts of a rod that bends pass straight: aside of their neighbours they would break off.
void Joints::find_crossings(const Structure& structure, const std::vector<double>& radius) {
  std::vector<bool> found(rods_.size() * (rods_.size() < 512 ? rods_.size() : 0), false);
  for (const std::size_t k : {times_.size() / 4, times_.size() / 2, 3 * times_.size() / 4}) {
    const std::vector<Vec3>& x = poses_[k];
    const auto a = [&](int i) -> const Vec3& {
      return x[static_cast<std::size_t>(rods_[static_cast<std::size_t>(i)].a)];
    };
    const auto b = [&](int i) -> const Vec3& {
      return x[static_cast<std::size_t>(rods_[static_cast<std::size_t>(i)].b)];
    };
    const auto cut = [&](std::size_t i) {
      return structure.rods[static_cast<std::size_t>(rods_[i].source)].parts > 1;
    };
    std::vector<int> order(rods_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto low = [&](int i) { return std::min(a(i).x(), b(i).x()); };
    std::ranges::sort(order, [&](int i, int j) { return low(i) < low(j) || (low(i) == low(j) && i < j); });
    for (std::size_t p = 0; p < order.size(); ++p)
      for (std::size_t q = p + 1; q < order.size(); ++q) {
        const int i = std::min(order[p], order[q]), j = std::max(order[p], order[q]);
        const auto ui = static_cast<std::size_t>(i), uj = static_cast<std::size_t>(j);
        const double reach = radius[ui] + radius[uj];
        if (low(order[q]) > std::max(a(order[p]).x(), b(order[p]).x()) + reach) break;
        if (share_a_node(rods_[ui], rods_[uj])) continue;
        if (cut(ui) || cut(uj)) continue;
        const Vec3 along = (b(i) - a(i)).normalized(), other = (b(j) - a(j)).normalized();
        if (!(along.cross(other).norm() > 3 * least_sine)) continue;
        const Nearest n = nearest(a(i), b(i), a(j), b(j));
        if (n.distance > reach || std::min(n.u, n.v) < 0.08 || std::max(n.u, n.v) > 0.92) continue;
        const auto known = [&](const RodCrossing& c) { return c.rod == i && c.other == j; };
        if (!found.empty()) {
          if (found[ui * rods_.size() + uj]) continue;
          found[ui * rods_.size() + uj] = true;
        } else if (std::ranges::any_of(crossings_, known)) {
          continue;
        }
        crossings_.push_back({i, j, -1});
      }
  }
  std::ranges::sort(crossings_, [](const RodCrossing& c, const RodCrossing& d) {
    return std::pair(c.rod, c.other) < std::pair(d.rod, d.other);
  });
}

// A node at which no rod ends, where two cross in the first, the middle and the last pose.
void Joints::find_pins(const Structure& structure, const std::vector<double>& radius) {
  for (std::size_t n = 0; n < structure.node_copies.size(); ++n) {
    if (!ends_[n].empty()) continue;
    for (RodCrossing& c : crossings_) {
      const RodCopy &r = rods_[static_cast<std::size_t>(c.rod)],
                    &s = rods_[static_cast<std::size_t>(c.other)];
      const auto on = [&](const RodCopy& rod, std::size_t k) {
        const Vec3 &a = poses_[k][static_cast<std::size_t>(rod.a)],
                   &b = poses_[k][static_cast<std::size_t>(rod.b)];
        const Vec3 along = b - a, to = poses_[k][n] - a;
        return (to - along * (to.dot(along) / along.squaredNorm())).norm() <
               0.2 * radius[static_cast<std::size_t>(c.rod)];
      };
      bool pinned = true;
      for (const std::size_t k : {std::size_t{0}, middle(), times_.size() - 1})
        pinned = pinned && on(r, k) && on(s, k);
      if (pinned) c.pin = static_cast<int>(n);
    }
  }
}

// The first of each pair passes inside, its other outside, and so on from rod to rod: of a ring the upper
// rods are outside, and what they carry ends before them.
void Joints::find_sides(const Vec3& center) {
  for (const RodCrossing& c : crossings_) {
    DirectionTrack normal = normal_of({c.rod, 0}, {c.other, 0});
    if (normal.empty()) continue;
    const Vec3 n = normal[middle()];
    const RodCopy& rod = rods_[static_cast<std::size_t>(c.rod)];
    const std::vector<Vec3>& x = poses_[middle()];
    const Vec3 away =
        0.5 * (x[static_cast<std::size_t>(rod.a)] + x[static_cast<std::size_t>(rod.b)]) - center;
    Index largest = 0;
    n.cwiseAbs().maxCoeff(&largest);
    const double outward = std::abs(n.dot(away)) > 0.02 * away.norm() ? n.dot(away) : n(largest);
    DirectionTrack &mine = sides_[static_cast<std::size_t>(c.rod)],
                   &its = sides_[static_cast<std::size_t>(c.other)];
    double sign = outward < 0 ? 1 : -1;
    if (!mine.empty()) sign = mine[middle()].dot(n) < 0 ? -1 : 1;
    if (mine.empty() && !its.empty()) sign = its[middle()].dot(n) < 0 ? 1 : -1;
    DirectionTrack opposite = normal;
    for (Vec3& v : normal) v *= sign;
    for (Vec3& v : opposite) v *= -sign;
    if (mine.empty()) mine = std::move(normal);
    if (its.empty()) its = std::move(opposite);
  }
}

Vec3 Joints::at(const DirectionTrack& track, double t) const {
  if (track.empty()) return Vec3::Zero();
  const auto next = std::upper_bound(times_.begin(), times_.end(), t);
  if (next == times_.begin()) return track.front();
  if (next == times_.end()) return track.back();
  const auto i = static_cast<std::size_t>(next - times_.begin());
  const double u = (t - times_[i - 1]) / (times_[i] - times_[i - 1]);
  const Vec3 mixed = (1 - u) * track[i - 1] + u * track[i];
  return mixed.norm() > 1e-6 ? Vec3(mixed.normalized()) : track[i];
}

Vec3 Joints::axis(const RodEnd& end, double t) const {
  return at(axes_[index(end)], t);
}

Vec3 Joints::side(int rod, double t) const {
  return at(sides_[static_cast<std::size_t>(rod)], t);
}

}  // namespace unfurl
