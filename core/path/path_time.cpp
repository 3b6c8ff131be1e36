// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/math/chebyshev.hpp"
#include "core/math/golden_section.hpp"
#include "core/math/quadrature.hpp"

namespace unfurl {
namespace {

constexpr int gauss = 16;
using Panel = Eigen::Array<double, gauss, 1>;
// Two halves that agree so well with the whole are right to the square of that and more.
constexpr double agree = 1e-9;
constexpr int most_halvings_of_time = 40;

struct Rule16 {
  Panel node, weight;
};

const Rule16& rule16() {
  static const Rule16 made = [] {
    const Quadrature g = gauss_legendre(gauss);
    return Rule16{g.nodes.array(), g.weights.array()};
  }();
  return made;
}

// Part of the way within one piece: W = before + W_piece(s) - W_piece(entry), forwards in the sense of
// motion.
class Part {
 public:
  Part(const PathPiece& piece, const VectorXd& force, double sense, double start, double entry, double before)
      : sense_(sense), start_(start), a_(piece.a), b_(piece.b), before_(before) {
    const VectorXd Q = sense * (force.transpose() * piece.dq * chebyshev_transform(Path::degree)).transpose();
    W_ = 0.5 * (b_ - a_) * chebyshev_integral(Q);
    y_ = x_of(entry);
    first_ = entry == start;
  }

  // W at its other end.
  double leave(double exit) const {
    return before_ +
           sense_ * (x_of(exit) - y_) * chebyshev_divided_difference(W_.data(), W_.size(), x_of(exit), y_);
  }

  // Adds the time from x0 to x1 (roots of the distances from the start) to `sum`; false where W is not
  // positive.
  bool integrate(double x0, double x1, double& sum) const {
    double whole = 0;
    return panel(x0, x1, whole) && refine(x0, x1, whole, 0, sum);
  }

 private:
  double x_of(double s) const { return (2 * s - (a_ + b_)) / (b_ - a_); }

  bool refine(double x0, double x1, double whole, int depth, double& sum) const {
    const double middle = 0.5 * (x0 + x1);
    double left = 0, right = 0;
    if (depth > most_halvings_of_time || !panel(x0, middle, left) || !panel(middle, x1, right)) return false;
    if (std::abs(left + right - whole) <= agree * std::abs(whole)) {
      sum += left + right;
      return true;
    }
    return refine(x0, middle, left, depth + 1, sum) && refine(middle, x1, right, depth + 1, sum);
  }

  // At all points of the panel at once: Clenshaw's recurrence for the divided difference [x, y] of W.
  bool panel(double x0, double x1, double& out) const {
    const Panel way = x0 + (x1 - x0) * rule16().node;
    const Panel s = start_ + sense_ * way.square();
    const Panel x = ((2 * s) - (a_ + b_)) / (b_ - a_);
    double b1 = 0, b2 = 0;
    Panel d1 = Panel::Zero(), d2 = d1;
    for (Index k = W_.size() - 1; k > 0; --k) {
      const Panel d = 2 * b1 + 2 * x * d1 - d2;
      d2 = d1;
      d1 = d;
      const double b = W_[k] + 2 * y_ * b1 - b2;
      b2 = b1;
      b1 = b;
    }
    const Panel D = b1 + x * d1 - d2;  // by x of the piece
    // 2 x / sqrt(2 W); where W begins here, W = way^2 D 2 / (b - a) and `way` cancels.
    Panel W;
    if (first_) {
      W = 2 / (b_ - a_) * D;
      if (!(W > 0).all()) return false;
      out = (x1 - x0) * (rule16().weight * 2 / (2 * W).sqrt()).sum();
    } else {
      W = before_ + sense_ * (x - y_) * D;
      if (!(W > 0).all()) return false;
      out = (x1 - x0) * (rule16().weight * 2 * way / (2 * W).sqrt()).sum();
    }
    return true;
  }

  double sense_, start_, a_, b_, before_, y_ = 0;
  VectorXd W_;  // integral of Q ds over the piece, in the sense of motion
  bool first_ = false;
};

// What remains to the deployed pose, at a place of the path.
struct PathLook {
  double s = 0.0, left = 0.0;
  VectorXd angles;  // those that count turns
};

// Between two looks that are so near that no angle turns by half a turn. The poses are smooth there; what is
// measured need not be: an angle without an axis has a kink where its sides lie in line, a distance at zero.
class DeployedSearch {
 public:
  DeployedSearch(const Path& path, const Deployment& deployment, const ConstVec& start)
      : path_(path), deployment_(deployment), rounded_(deployment.rounded(start)) {}

  // Where it falls to zero.
  double crossing(const PathLook& above, const PathLook& below) const {
    double low = above.s, high = below.s;
    for (int it = 0; it < 60; ++it) {
      const double middle = 0.5 * (low + high);
      (left(middle, above.angles) > 0 ? low : high) = middle;
    }
    return high;
  }

  // Where it falls to zero, or is least and that is zero, between them.
  std::optional<double> dip(const PathLook& a, const PathLook& b) const {
    const double s = golden_section([&](double at) { return left(at, a.angles); }, a.s, b.s, 60);
    const PathLook least{s, left(s, a.angles), {}};
    if (least.left > rounded_) return std::nullopt;
    return least.left < -rounded_ ? crossing(a, least) : s;
  }

 private:
  double left(double s, VectorXd angles) const {
    VectorXd z, tangent, q(path_.system().coordinates());
    if (!path_.point(s, z, tangent)) return std::numeric_limits<double>::infinity();
    path_.system().expand(z, q);
    deployment_.count_on(q, angles);
    return deployment_.remaining(q, angles);
  }

  const Path& path_;
  const Deployment& deployment_;
  double rounded_;
};

}  // namespace

double time_from_rest(const Path& path, const VectorXd& force, double from, double to) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double sense = to > from ? 1.0 : -1.0;
  const auto first = path.piece_of(from), last = path.piece_of(to);
  if (!first || !last) return nan;
  double sum = 0, entry = from, before = 0;
  for (long k = *first;; k += (sense > 0 ? 1 : -1)) {
    const PathPiece& piece = *path.piece(k);
    const double end = sense > 0 ? std::min(piece.b, to) : std::max(piece.a, to);
    if (end != entry) {
      const Part part(piece, force, sense, from, entry, before);
      const double x0 = std::sqrt(std::abs(entry - from)), x1 = std::sqrt(std::abs(end - from));
      if (!part.integrate(x0, x1, sum)) return nan;
      before = part.leave(end);
      entry = end;
    }
    if (k == *last) return sum;
  }
}

std::optional<double> deployed_pose(const Path& path, const Deployment& deployment, bool forward,
                                    long most_pieces) {
  const VectorXd x = chebyshev_points(Path::degree);
  const PathPiece* first = path.piece(forward ? 0 : -1);
  if (!first) return std::nullopt;
  const DeployedSearch search(path, deployment, first->q.col(0));
  PathLook last{0, 0, deployment.first_angles()}, before = last;
  bool ahead = false;  // the deployment, at the last look
  for (long k = 0; k < most_pieces; ++k) {
    const PathPiece* piece = path.piece(forward ? k : -k - 1);
    if (!piece) return std::nullopt;
    for (Index i = k == 0 ? 0 : 1; i < x.size(); ++i) {  // a piece begins where the one before it ends
      const Index at = forward ? i : x.size() - 1 - i;
      PathLook now{piece->at(x[at]), 0, last.angles};
      deployment.count_on(piece->q.col(at), now.angles);
      now.left = deployment.remaining(piece->q.col(at), now.angles);
      // Through the opposite pose deployed comes from the other side.
      if (ahead && now.left <= 0 && deployment.is_passed(last.left, now.left))
        return search.crossing(last, now);
      if (ahead && last.left <= before.left && last.left < now.left)
        if (const auto dip = search.dip(before, now)) return dip;
      ahead = now.left > 0;
      before = std::exchange(last, std::move(now));
    }
  }
  return std::nullopt;
}

double first_time_above(const std::function<double(double t)>& f, double from, double until, double h,
                        const std::vector<TimeEdge>& edges) {
  auto edge = edge_after(edges, from);
  for (double a = from; a < until;) {
    while (edge != edges.end() && edge->t <= a) ++edge;
    double b = std::min({a + h, until, edge != edges.end() ? edge->t : until});
    // On an edge that jumps f is already that behind it.
    const double before = std::max(a, before_jump(b));
    const bool above_before = edge != edges.end() && edge->jump && b == edge->t && f(before) > 0;
    if (above_before) b = before;
    if (above_before || f(b) > 0) {
      double low = a, high = b;
      for (int it = 0; it < 60; ++it) (f(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
      return high;
    }
    if (!(b > a)) break;
    a = b;
  }
  return until;
}

}  // namespace unfurl
