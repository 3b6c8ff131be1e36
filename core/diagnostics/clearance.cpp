// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace unfurl {

// |p + s u - r t|^2 with p = a0 - b0, u = a1 - a0, r = b1 - b0 is least over the unit square of s and t where
// both derivatives vanish, or on its border: for a given t the best s is (t u.r - u.p) / u.u held to 0..1,
// and the same for t. Parallel segments have a whole line of such points, any of which will do.
double segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 p = a0 - b0, u = a1 - a0, r = b1 - b0;
  const double uu = u.squaredNorm(), rr = r.squaredNorm(), ur = u.dot(r), up = u.dot(p), rp = r.dot(p);
  const auto share = [](double above, double below) {
    return below > 0 ? std::clamp(above / below, 0.0, 1.0) : 0.0;
  };
  const double area = uu * rr - ur * ur;  // of what they span, squared
  const double s = area > 1e-14 * uu * rr ? std::clamp((ur * rp - rr * up) / area, 0.0, 1.0) : 0.0;
  const double t = share(s * ur + rp, rr), best = share(t * ur - up, uu);
  return (p + best * u - t * r).norm();
}

namespace {

class ClearanceScan {
 public:
  explicit ClearanceScan(const Trajectory& trajectory)
      : trajectory_(trajectory), rods_(trajectory.structure().rod_copies) {
    for (const RodCopy& copy : rods_) {
      const Rod& rod = trajectory.structure().rods[static_cast<std::size_t>(copy.source)];
      radius_.push_back(rod.radius);
      if (rod.radius > 0) thinnest_ = std::min(thinnest_, 2 * rod.radius);
      const bool goes_on = !wholes_.empty() && wholes_.back().size() < static_cast<std::size_t>(rod.parts) &&
                           !rod.whole.empty() && rod.whole == last_whole_;
      if (!goes_on) wholes_.emplace_back();
      last_whole_ = rod.whole;
      wholes_.back().push_back(whole_of_.size());
      whole_of_.push_back(wholes_.size() - 1);
    }
    const std::size_t last = trajectory.size() - 1;
    for (const std::size_t i : {std::size_t{0}, last / 2, last}) poses_.push_back(trajectory.positions(i));
    for (int n = 0; n < poses_.front().size() / 3; ++n) along_.push_back(n);
    std::ranges::sort(along_, {}, [&](int n) { return poses_.front()[3 * Index(n)]; });
  }

  void look(std::size_t i) {
    q_ = trajectory_.positions(i);
    if (!q_.allFinite()) return;
    look_at_pose(trajectory_.time(i));
    ++best_.states;
  }

  // Between state i and the next, so often that no node goes farther than the thinnest rod is thick: two of
  // these that pass through each other are seen to.
  void look_behind(std::size_t i) {
    constexpr double most_poses = 64;
    const VectorXd way = trajectory_.positions(i + 1) - trajectory_.positions(i);
    if (!way.allFinite() || way.size() == 0 || !std::isfinite(thinnest_)) return;
    const double farthest = way.reshaped(3, way.size() / 3).colwise().norm().maxCoeff();
    const auto parts = static_cast<int>(std::min(std::ceil(farthest / thinnest_), most_poses));
    const double t = trajectory_.time(i), step = (trajectory_.time(i + 1) - t) / parts;
    for (int k = 1; k < parts; ++k) {
      q_ = trajectory_.positions_at(t + k * step);
      look_at_pose(t + k * step);
    }
  }
  // The nearest pair between the states beside the one where it was nearest, by golden sections.
  std::optional<Clearance> refined(std::size_t states) {
    if (!found_) return std::nullopt;
    const auto a = static_cast<std::size_t>(best_.rod_a), b = static_cast<std::size_t>(best_.rod_b);
    const std::size_t i = trajectory_.state_before(best_.t);
    double lo = trajectory_.time(i > 0 ? i - 1 : i), hi = trajectory_.time(std::min(i + 1, states - 1));
    const auto axes = [&](double t) {
      q_ = trajectory_.positions_at(t);
      return axis_distance(a, b);
    };
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    for (int k = 0; k < 60 && hi - lo > 1e-12 * (hi - trajectory_.start_time()); ++k) {
      const double left = hi - golden * (hi - lo), right = lo + golden * (hi - lo);
      if (axes(left) <= axes(right))
        hi = right;
      else
        lo = left;
    }
    const double t = 0.5 * (lo + hi), least = axes(t);
    if (least < best_.axes - round_off_of(a, b)) {
      best_.t = t;
      best_.distance += least - best_.axes;
      best_.axes = least;
    }
    if (best_.distance < 0) overlapping_.emplace(a, b);
    best_.overlapping = overlapping_.size();
    return best_;
  }

 private:
  void look_at_pose(double t) {
    sort_by_place();
    for (std::size_t k = 0; k < boxes_.size(); ++k)
      for (std::size_t l = k + 1; l < boxes_.size(); ++l) {
        const Box &a = boxes_[k], &b = boxes_[l];
        // What begins farther on can be no nearer than this, nor can what comes behind it.
        const double most = std::max(best_.distance, 0.0) + rounding_;
        if (b.low[0] - a.high[0] > most) break;
        if (b.low[1] - a.high[1] > most || a.low[1] - b.high[1] > most || b.low[2] - a.high[2] > most ||
            a.low[2] - b.high[2] > most)
          continue;
        compare(std::min(a.rod, b.rod), std::max(a.rod, b.rod), t);
      }
  }

  Vec3 node(const VectorXd& q, int n) const { return q.segment<3>(3 * Index(n)); }
  double axis_distance(std::size_t a, std::size_t b) const {
    return segment_distance(node(q_, rods_[a].a), node(q_, rods_[a].b), node(q_, rods_[b].a),
                            node(q_, rods_[b].b));
  }

  double round_off_of(std::size_t a, std::size_t b) const {
    return 1e-12 * (axis_distance(a, b) + (node(q_, rods_[a].b) - node(q_, rods_[a].a)).norm());
  }

  // Along x, each with its radius.
  void sort_by_place() {
    boxes_.resize(rods_.size());
    for (std::size_t r = 0; r < rods_.size(); ++r) {
      Box& box = boxes_[r];
      box.rod = r;
      for (int k = 0; k < 3; ++k) {
        const double a = q_[3 * Index(rods_[r].a) + k], b = q_[3 * Index(rods_[r].b) + k];
        box.low[k] = std::min(a, b) - radius_[r];
        box.high[k] = std::max(a, b) + radius_[r];
      }
    }
    std::sort(boxes_.begin(), boxes_.end(), [](const Box& a, const Box& b) { return a.low[0] < b.low[0]; });
    constexpr double digits = 1e-12;  // whatever rounding says of a distance
    rounding_ = digits * q_.lpNorm<Eigen::Infinity>();
  }

  // In an end of each, or on a pin through both: a node that lies on either in every pose. Of rods that were
  // cut the wholes: one does not pass through itself.
  bool meet(std::size_t a, std::size_t b) {
    if (whole_of_[a] == whole_of_[b]) return true;
    const auto [at, is_new] = meeting_.try_emplace({whole_of_[a], whole_of_[b]}, false);
    if (!is_new) return at->second;
    const std::vector<int>&of_a = nodes_on(whole_of_[a]), &of_b = nodes_on(whole_of_[b]);
    return at->second = std::ranges::find_first_of(of_a, of_b) != of_a.end();
  }

  // That lie on a whole in every pose.
  const std::vector<int>& nodes_on(std::size_t whole) {
    constexpr double near = 1e-6;  // of a part's length
    const auto [at, is_new] = nodes_on_.try_emplace(whole);
    if (!is_new) return at->second;
    const std::vector<std::size_t>& parts = wholes_[whole];
    const VectorXd& first = poses_.front();
    const auto is_on = [&](int n, const VectorXd& q) {
      return std::ranges::any_of(parts, [&](std::size_t part) {
        const Vec3 low = node(q, rods_[part].a), high = node(q, rods_[part].b), p = node(q, n);
        return segment_distance(p, p, low, high) <= near * (high - low).norm();
      });
    };
    for (const std::size_t part : parts) {
      const Vec3 a = node(first, rods_[part].a), b = node(first, rods_[part].b);
      const double beside = 2 * near * (b - a).norm();
      const auto x = [&](int n) { return first[3 * Index(n)]; };
      for (auto n = std::ranges::lower_bound(along_, std::min(a.x(), b.x()) - beside, {}, x);
           n != along_.end() && x(*n) <= std::max(a.x(), b.x()) + beside; ++n)
        if (std::ranges::all_of(poses_, [&](const VectorXd& q) { return is_on(*n, q); }))
          at->second.push_back(*n);
    }
    return at->second;
  }

  void compare(std::size_t a, std::size_t b, double t) {
    const double axes = axis_distance(a, b), distance = axes - radius_[a] - radius_[b];
    if (!(distance < best_.distance) && !(distance < 0)) return;
    if (meet(a, b)) return;
    if (distance < 0) overlapping_.insert({a, b});
    // Round-off shall not say when or which: of those that are as near, the first.
    const auto pair = std::pair(static_cast<int>(a), static_cast<int>(b));
    const bool earlier = t == best_.t && pair < std::pair(best_.rod_a, best_.rod_b);
    const double round_off = round_off_of(a, b);
    if (found_ && distance >= best_.distance - (earlier ? -round_off : round_off)) return;
    found_ = true;
    best_.distance = distance;
    best_.axes = axes;
    std::tie(best_.rod_a, best_.rod_b) = pair;
    best_.t = t;
  }

  const Trajectory& trajectory_;
  const std::vector<RodCopy>& rods_;
  std::vector<double> radius_;
  double thinnest_ = std::numeric_limits<double>::infinity();  // of rods whose thickness is known
  // Rods that were cut have their parts one after the other: of each rod its whole, of each whole its parts.
  std::vector<std::size_t> whole_of_;
  std::vector<std::vector<std::size_t>> wholes_;
  std::string last_whole_;
  struct Box {
    double low[3], high[3];
    std::size_t rod;
  };
  std::vector<Box> boxes_;
  double rounding_ = 0;
  std::vector<VectorXd> poses_;  // the first, one in the middle, the last
  VectorXd q_;
  std::vector<int> along_;  // nodes by their place along x in the first
  std::map<std::size_t, std::vector<int>> nodes_on_;
  std::map<std::pair<std::size_t, std::size_t>, bool> meeting_;
  bool found_ = false;
  Clearance best_{.distance = std::numeric_limits<double>::infinity()};
  std::set<std::pair<std::size_t, std::size_t>> overlapping_;
};

}  // namespace

std::optional<Clearance> least_clearance(const Trajectory& trajectory, std::size_t states) {
  states = std::min(states, trajectory.size());
  if (states == 0) return std::nullopt;
  ClearanceScan scan(trajectory);
  for (std::size_t i = 0; i < states; ++i) {
    scan.look(i);
    if (i + 1 < states) scan.look_behind(i);
  }
  return scan.refined(states);
}

}  // namespace unfurl
