// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/pose_times.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <utility>

#include "core/diagnostics/clearance.hpp"

namespace unfurl {

namespace {

constexpr double moment_share = 1e-3;  // of the structure's size
constexpr int bold_halvings = 3;       // of a step that may turn twice
constexpr double rest_share = 1e-3;    // of what is allowed: what goes by less in a step is at rest

double diagonal(const VectorXd& pose) {
  if (pose.size() == 0) return 0;
  const Eigen::Map<const Eigen::Matrix3Xd> points(pose.data(), 3, pose.size() / 3);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

struct Stretch {
  double off;            // what its motion leaves its straight line by, about [m]
  std::size_t a, b;      // moments
  int halved = 0;        // times, from a whole step
  bool guessed = false;  // `off`, of a step whose ends do not tell of it
  bool operator<(const Stretch& other) const { return off < other.off; }
};

class MomentSearch {
 public:
  explicit MomentSearch(const Trajectory& run) : run_(run) {
    for (std::size_t i = 0; i < run.size(); ++i) add(run.time(i), run.positions(i));
    double size = 0;
    for (const VectorXd& pose : found_.poses) size = std::max(size, diagonal(pose));
    if (!(size > 0)) size = (found_.poses.back() - found_.poses.front()).norm();  // of one point: of its way
    allowed_ = moment_share * size;
    VectorXd before = run.velocities(0);
    bool rests = false, swings = false;
    for (std::size_t i = 0; i + 1 < run.size(); ++i) {
      VectorXd behind = run.velocities(i + 1);
      if (!(run.time(i + 1) > run.time(i))) {  // an impulse
        before = std::move(behind);
        continue;
      }
      const ByEnds ends = told_by_ends(i, before, behind);
      // A swing from rest to rest at one place: of several such steps the first one tells.
      const bool rested = std::exchange(rests, ends.way <= rest_share * allowed_);
      if (!rests || !rested)
        swings = rests && off_line(run.positions_at(moment_in({0, i, i + 1, 0, true})), i, i + 1) > allowed_;
      if (ends.off > allowed_)
        keep({ends.off, i, i + 1});
      else
        keep({swings ? size : ends.untold, i, i + 1, 0, true});
      before = std::move(behind);
    }
  }

  PosedMoments search() {
    // A moment costs as much as the structure is large.
    const auto nodes = static_cast<std::size_t>(std::max<Index>(found_.poses.front().size() / 3, 1));
    std::size_t left = std::clamp<std::size_t>(200000 / nodes, 200, 2000);
    for (; left > 0 && !stretches_.empty(); --left) {
      const Stretch s = stretches_.top();
      stretches_.pop();
      const double at = moment_in(s);
      if (!(at > found_.times[s.a] && at < found_.times[s.b])) continue;
      add(at, run_.positions_at(at));
      const std::size_t m = found_.times.size() - 1;
      const double off = off_line(found_.poses[m], s.a, s.b);
      if (s.guessed && off <= allowed_) continue;
      // What does not straighten in parts is no curve: at singular poses steps lead to either side.
      if (s.halved >= bold_halvings && off > 2 * s.off) continue;
      // A half leaves its line by a quarter of that. What turns twice is at its place in the middle.
      const double next = s.guessed ? 0.4 * off : 0.25 * std::max(s.off, off);
      const int halved = s.guessed ? 0 : s.halved + 1;
      keep({next, s.a, m, halved});
      keep({next, m, s.b, halved});
    }
    return in_order();
  }

 private:
  void add(double t, VectorXd pose) {
    found_.times.push_back(t);
    found_.poses.push_back(std::move(pose));
  }
  void keep(const Stretch& stretch) {
    if (stretch.off > allowed_) stretches_.push(stretch);
  }

  double off_line(const VectorXd& pose, std::size_t a, std::size_t b) const {
    double worst = 0;
    for (Index k = 0; k < pose.size(); k += 3) {
      const Vec3 at = pose.segment<3>(k);
      worst = std::max(
          worst, segment_distance(at, at, found_.poses[a].segment<3>(k), found_.poses[b].segment<3>(k)));
    }
    return worst;
  }

  // The middle; of what is guessed beside it, where what goes there and back, or round, is elsewhere.
  double moment_in(const Stretch& s) const {
    return std::lerp(found_.times[s.a], found_.times[s.b], s.guessed ? 0.4 : 0.5);
  }

  struct ByEnds {
    double off = 0;     // what Hermite's cubic through both states leaves their line by
    double untold = 0;  // what a node goes besides, where that is most of its way: as from rest to rest
    double way = 0;     // of the node that goes farthest
  };

  // What tells curved steps from straight ones without a step of the method.
  ByEnds told_by_ends(std::size_t i, const VectorXd& before, const VectorXd& behind) const {
    const double h = found_.times[i + 1] - found_.times[i];
    const VectorXd &from = found_.poses[i], &to = found_.poses[i + 1];
    const VectorXd first = h * before - (to - from), last = (to - from) - h * behind;
    ByEnds out;
    double most = 0;  // u (1 - u)^2 has no more than 4/27
    for (Index k = 0; k < from.size(); k += 3) {
      const Vec3 a = first.segment<3>(k), b = last.segment<3>(k);
      const double line = (to - from).segment<3>(k).norm(), untold = 0.5 * (a - b).norm();
      most = std::max(most, a.norm() + b.norm());
      if (untold > 0.5 * line) out.untold = std::max(out.untold, untold);
      out.way = std::max({out.way, line, h * before.segment<3>(k).norm(), h * behind.segment<3>(k).norm()});
    }
    if (!(4.0 / 27 * most > allowed_)) return out;
    for (const double u : {0.25, 0.5, 0.75}) {
      const double v = 1 - u;
      out.off = std::max(out.off, off_line(v * from + u * to + u * v * (v * first + u * last), i, i + 1));
    }
    return out;
  }

  PosedMoments in_order() {
    std::vector<std::size_t> order(found_.times.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Two states at one time, an impulse's, stay as they are.
    std::ranges::stable_sort(order, {}, [this](std::size_t k) { return found_.times[k]; });
    PosedMoments out;
    for (const std::size_t k : order) {
      out.times.push_back(found_.times[k]);
      out.poses.push_back(std::move(found_.poses[k]));
    }
    return out;
  }

  const Trajectory& run_;
  double allowed_ = 0;
  PosedMoments found_;  // the states, and behind them what lies between
  std::priority_queue<Stretch> stretches_;
};

// What all nodes have gone together at each pose.
std::vector<double> way_gone(const std::vector<VectorXd>& poses) {
  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < poses.size(); ++i) way.push_back(way.back() + (poses[i] - poses[i - 1]).norm());
  return way;
}

}  // namespace

PosedMoments posed_moments(const Trajectory& run) {
  return MomentSearch(run).search();
}

std::vector<std::size_t> equal_steps(const std::vector<VectorXd>& poses, std::size_t count) {
  const std::vector<double> way = way_gone(poses);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = way.back() * static_cast<double>(k) / static_cast<double>(count);
    const auto at = std::lower_bound(way.begin(), way.end(), wanted) - way.begin();
    if (chosen.empty() || static_cast<std::size_t>(at) > chosen.back())
      chosen.push_back(static_cast<std::size_t>(at));
  }
  return chosen;
}

std::vector<double> pose_times(const Trajectory& run, std::size_t count) {
  const PosedMoments moments = posed_moments(run);
  const std::vector<double> way = way_gone(moments.poses);
  std::vector<double> times;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(count - 1);
    if (k == 0 || !(way.back() > 0)) {  // at rest: equal steps of time
      times.push_back(run.start_time() + share * (run.end_time() - run.start_time()));
      continue;
    }
    // Between two moments the way is taken as even.
    const double wanted = way.back() * share;
    const auto i = static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(std::lower_bound(way.begin(), way.end(), wanted) - way.begin(), 1));
    const double u = (wanted - way[i - 1]) / (way[i] - way[i - 1]);
    times.push_back(moments.times[i - 1] + u * (moments.times[i] - moments.times[i - 1]));
  }
  times.push_back(run.end_time());
  return times;
}

}  // namespace unfurl
