// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/motion_keys.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <queue>

namespace unfurl {
namespace {

constexpr double node_share = 1e-3, rod_share = 1e-2;  // of the structure's size, of a rod's length
constexpr double fewest = 200;                         // intervals, where there are as many states
constexpr double closest = 2e-6;  // of the run, two keys: files have their times in single precision

struct Span {
  double off = 0;  // of what it may be off by
  double a = 0, b = 0;
  VectorXd from, middle, to;
  bool operator<(const Span& other) const { return off < other.off; }
};

double extent(const VectorXd& pose) {
  if (pose.size() == 0) return 0;
  const Eigen::Map<const Eigen::Matrix3Xd> points(pose.data(), 3, pose.size() / 3);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

class KeySearch {
 public:
  KeySearch(const Trajectory& run, double interval, std::size_t most, const std::function<void()>& between)
      : run_(run),
        most_(std::max<std::size_t>(most, 2)),
        length_(run.end_time() - run.start_time()),
        between_(between) {
    const double asked = std::max(std::ceil(length_ / interval - 1e-9), 1.0);
    const double wanted = std::min(fewest, static_cast<double>(run.size() - 1));
    interval_ = std::min(interval, length_) / std::max(std::ceil(wanted / asked), 1.0);
    // Half of the keys are kept for where they matter.
    const double bearable = std::max(std::floor(0.5 * static_cast<double>(most_)), 1.0);
    if (length_ / interval_ > bearable) interval_ = length_ / bearable;
  }

  MotionKeys search() {
    lay_first();
    for (Span& span : first_) {
      look(span);
      spans_.push(std::move(span));
    }
    while (spans_.top().off > 1 && spans_.size() + 1 < most_) {
      Span span = spans_.top();
      spans_.pop();
      const double middle = 0.5 * (span.a + span.b);
      Span left{0, span.a, middle, span.from, {}, span.middle},
          right{0, middle, span.b, span.middle, {}, span.to};
      for (Span* half : {&left, &right}) {
        look(*half);
        spans_.push(std::move(*half));
      }
    }
    return found();
  }

 private:
  void lay_first() {
    // What is left behind the last one is at least as long as two keys are apart, or belongs to it.
    const auto count = static_cast<long>(std::max(std::ceil((1 - closest) * length_ / interval_), 1.0));
    VectorXd before = run_.positions_at(run_.start_time());
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (long i = 1; i <= count; ++i) {
      if (between_) between_();
      const double a = first_.empty() ? run_.start_time() : first_.back().b;
      const double b = i == count ? run_.end_time() : run_.start_time() + interval_ * static_cast<double>(i);
      VectorXd to = run_.positions_at(b);
      size_ = std::max({size_, extent(before), extent(to)});
      for (const VectorXd* pose : {&before, &to})
        for (Index n = 0; n < pose->size() / 3; ++n) {
          low = low.cwiseMin(pose->segment<3>(3 * n));
          high = high.cwiseMax(pose->segment<3>(3 * n));
        }
      first_.push_back({0, a, b, before, {}, to});
      before = std::move(to);
    }
    if (!(size_ > 0)) size_ = std::max((high - low).norm(), 0.0);  // of one point: of its way
  }

  // In the middle, and at some states in between: what turns once from key to key is at its place in the
  // middle of them, too. Within one step nothing turns as far.
  void look(Span& span) const {
    if (between_) between_();
    span.middle = run_.positions_at(0.5 * (span.a + span.b));
    if (span.b - span.a < 2 * closest * length_) return;
    span.off = off(span, 0.5, span.middle);
    const std::size_t first = run_.state_before(span.a) + 1, end = run_.state_before(span.b);
    if (first >= end) return;
    for (const double share : {0.191, 0.382, 0.618, 0.809}) {  // no small multiples of one another
      const double between = share * static_cast<double>(end - first);
      const std::size_t i = first + static_cast<std::size_t>(between);
      const double u = (run_.time(i) - span.a) / (span.b - span.a);
      if (u > 0 && u < 1) span.off = std::max(span.off, off(span, u, run_.positions(i)));
    }
  }

  double off(const Span& span, double u, const VectorXd& pose) const {
    const VectorXd line = (1 - u) * span.from + u * span.to;
    double worst = 0;
    if (size_ > 0)
      for (Index n = 0; n < pose.size() / 3; ++n)
        worst = std::max(worst, (pose - line).segment<3>(3 * n).norm() / (node_share * size_));
    for (const RodCopy& rod : run_.structure().rod_copies) {
      const auto length = [&](const VectorXd& x) {
        return (x.segment<3>(3 * rod.b) - x.segment<3>(3 * rod.a)).norm();
      };
      const double is = length(pose);
      if (is > node_share * size_) worst = std::max(worst, std::abs(length(line) - is) / (rod_share * is));
    }
    return worst;
  }

  MotionKeys found() {
    MotionKeys keys;
    keys.off = spans_.top().off;
    std::vector<Span> all;
    for (; !spans_.empty(); spans_.pop()) all.push_back(spans_.top());
    std::ranges::sort(all, {}, &Span::a);
    keys.times.push_back(all.front().a);
    keys.poses.push_back(all.front().from);
    for (Span& span : all) {
      keys.times.push_back(span.b);
      keys.poses.push_back(std::move(span.to));
    }
    return keys;
  }

  const Trajectory& run_;
  std::size_t most_;
  double length_, interval_ = 0, size_ = 0;
  const std::function<void()>& between_;
  std::vector<Span> first_;
  std::priority_queue<Span> spans_;
};

// Between two keys the state at which straight lines are worst.
struct Gap {
  double a = 0, b = 0, off = 0;
  std::size_t worst = 0;
  bool operator<(const Gap& other) const { return off < other.off; }
};

double between(double a, double b, double u) {
  if (u <= 0 || (std::isnan(b) && u < 1)) return a;
  return u >= 1 || std::isnan(a) ? b : (1 - u) * a + u * b;
}

Gap gap_between(const Trajectory& run, const MatrixXd& values, double a, double b) {
  Gap gap{a, b};
  const VectorXd from = values_at(run, values, a), to = values_at(run, values, b);
  const std::size_t first = run.state_before(a) + 1, end = run.state_before(b) + 1;
  for (Index r = 0; r < values.cols(); ++r)
    for (std::size_t i = first; i < end && run.time(i) < b; ++i) {
      const double line = between(from[r], to[r], (run.time(i) - a) / (b - a)),
                   off = std::abs(values(static_cast<Index>(i), r) - line);
      if (off > gap.off) gap.off = off, gap.worst = i;
    }
  return gap;
}

}  // namespace

MotionKeys motion_keys(const Trajectory& run, double interval, std::size_t most,
                       const std::function<void()>& between) {
  if (!(run.end_time() > run.start_time())) return {{run.end_time()}, {run.positions_at(run.end_time())}, 0};
  return KeySearch(run, interval, most, between).search();
}

VectorXd values_at(const Trajectory& run, const MatrixXd& values, double t) {
  const std::size_t i = run.state_before(t), next = std::min(i + 1, run.size() - 1);
  const double gap = run.time(next) - run.time(i), u = gap > 0 ? (t - run.time(i)) / gap : 0;
  VectorXd out(values.cols());
  for (Index r = 0; r < out.size(); ++r)
    out[r] = between(values(static_cast<Index>(i), r), values(static_cast<Index>(next), r), u);
  return out;
}

double add_value_keys(const Trajectory& run, const MatrixXd& values, double bearable, std::size_t most,
                      MotionKeys& keys) {
  std::priority_queue<Gap> gaps;
  for (std::size_t k = 1; k < keys.times.size(); ++k)
    gaps.push(gap_between(run, values, keys.times[k - 1], keys.times[k]));
  std::vector<double> times = keys.times;
  while (!gaps.empty() && gaps.top().off > bearable && times.size() < most) {
    const Gap gap = gaps.top();
    gaps.pop();
    times.push_back(run.time(gap.worst));
    gaps.push(gap_between(run, values, gap.a, times.back()));
    gaps.push(gap_between(run, values, times.back(), gap.b));
  }
  std::ranges::sort(times);
  std::vector<VectorXd> poses;
  std::size_t old = 0;
  for (const double t : times)
    poses.push_back(t == keys.times[old] ? std::move(keys.poses[old++]) : run.positions_at(t));
  keys.times = std::move(times), keys.poses = std::move(poses);
  return gaps.empty() ? 0 : gaps.top().off;
}

std::string too_few_keys(const MotionKeys& keys, std::string_view file) {
  if (!(keys.off > 1)) return {};
  std::array<char, 32> times{};
  std::snprintf(times.data(), times.size(), "%.2g", keys.off);
  return std::string(file) + " has " + std::to_string(keys.times.size()) +
         " poses, too few for this motion: between two of them it is drawn up to " + times.data() +
         " times as far from its place as a thousandth of its size or a hundredth of a rod's length; an "
         "earlier "
         "solver.end_time needs fewer";
}

}  // namespace unfurl
