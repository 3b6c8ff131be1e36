// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace unfurl {
namespace {

constexpr int table_points = Path::degree;
// The last coefficients of a series are at round-off where they are this share of its scale; next to a
// singular pose, or where a piece cannot be cut any further, what is table_rough will do.
constexpr double table_resolved = 2e-14, table_rough = 3e-10, no_gain = 0.2;
constexpr int table_tail_size = 2, most_cuts = 12;

// A series of noise has coefficients of one size: it is off by so many times its last ones, and jumps by that
// to the next. What the tangent of a piece has of it a part of the piece resolves as if it were more.
constexpr double noise_of_tail = 5;

// The largest of the last coefficients as a share of its function's scale, and which function's.
std::pair<double, Index> table_tail(const MatrixXd& c, const VectorXd& scale) {
  std::pair<double, Index> most{0.0, 0};
  for (Index f = 0; f < c.cols(); ++f) {
    const double last = c.col(f).tail(table_tail_size).cwiseAbs().maxCoeff();
    if (last > 0 && last / scale[f] > most.first) most = {last / scale[f], f};
  }
  return most;
}

}  // namespace

ValueAndSlope PathTable::Segment::at(Index function, double s) const {
  ValueAndSlope f = chebyshev_value_and_slope(of(function), c.rows(), x_of(s));
  f.slope *= 2 / (b - a);
  return f;
}

PathTable::PathTable(const Path& path, const PathFunctions& functions) : path_(path), functions_(functions) {
  forward_.angles = backward_.angles = functions.first_angles();
}

const PathTable::Segment* PathTable::segment(double s) {
  const Segment* found = segment_within_reach(s);
  if (!found) refuse_rough(s >= 0 ? forward_ : backward_);
  return found;
}

void PathTable::refuse_rough(const Side& side) const {
  if (side.rough >= 0)
    throw PathRefused("what acts on the structure is not smooth along its path" +
                      functions_.whose(side.rough));
}

void PathTable::refuse_rough() const {
  refuse_rough(forward_);
  refuse_rough(backward_);
}

const PathTable::Segment* PathTable::segment_within_reach(double s) {
  if (last_ && s >= last_->a && s <= last_->b) return last_;
  if (!std::isfinite(s)) return nullptr;
  const bool ahead = s >= 0;
  Side& side = ahead ? forward_ : backward_;
  while (side.segments.empty() || (ahead ? s > side.segments.back().b : s < side.segments.back().a))
    if (!extend(side, ahead)) return nullptr;
  const auto found = std::partition_point(side.segments.begin(), side.segments.end(),
                                          [&](const Segment& p) { return ahead ? p.b < s : p.a > s; });
  return last_ = &*found;
}

ValueAndSlope PathTable::at(Index function, double s) {
  const Segment* found = segment(s);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return found ? found->at(function, s) : ValueAndSlope{nan, nan};
}

bool PathTable::extend(Side& side, bool forward) {
  const PathPiece* piece = path_.piece(forward ? side.pieces : -side.pieces - 1);
  if (!piece || side.rough >= 0) return false;
  ++side.pieces;
  const std::size_t before = side.segments.size();
  tabulate(*piece, forward ? -1.0 : 1.0, forward ? 1.0 : -1.0, {}, side, forward);
  return side.segments.size() > before;
}

// From x = `from` to `to` of the piece, outwards, as far as it is smooth.
bool PathTable::tabulate(const PathPiece& piece, double from, double to, Cut cut, Side& side, bool forward) {
  const bool whole = cut.depth == 0;
  static const VectorXd x = chebyshev_points(table_points);
  const double low = std::min(from, to), high = std::max(from, to);
  const System& system = path_.system();
  VectorXd angles = side.angles, q, dq, z, value(functions_.size()), scale(functions_.size());
  MatrixXd values(functions_.size(), table_points + 1);
  Segment out{piece.at(low),
              piece.at(high),
              {},
              VectorXd::Zero(functions_.size()),
              VectorXd::Zero(functions_.size())};
  if (whole) out.a = piece.a, out.b = piece.b;
  for (int i = 0; i <= table_points; ++i) {
    const int k = forward ? i : table_points - i;
    if (whole) {
      q = piece.q.col(k);
      dq = piece.dq.col(k);
    } else {
      const double at = low + 0.5 * (high - low) * (x[k] + 1);
      z.resize(piece.z.rows());
      q.resize(system.coordinates());
      dq.resize(system.coordinates());
      chebyshev_value(piece.z, at, z);
      system.expand(z, q);
      chebyshev_value(piece.tangent, at, z);
      system.expand_rate(z, dq);
    }
    functions_.evaluate(q, dq, angles, value, scale);
    values.col(k) = value;
    out.scale = out.scale.cwiseMax(scale);
  }
  out.c = (values * chebyshev_transform(table_points)).transpose();
  const auto [left, worst] = table_tail(out.c, out.scale);
  if (!(left <= table_resolved || (left <= table_rough && left > no_gain * cut.before))) {
    if (cut.depth == most_cuts || !values.allFinite()) return side.rough = worst, false;
    const Cut next{cut.depth + 1, left};
    return tabulate(piece, from, 0.5 * (from + to), next, side, forward) &&
           tabulate(piece, 0.5 * (from + to), to, next, side, forward);
  }
  for (Index f = 0; f < functions_.size(); ++f)
    out.noise[f] = noise_of_tail * std::max(out.c.col(f).tail(table_tail_size).cwiseAbs().maxCoeff(),
                                            piece.noise * out.scale[f]);
  side.angles = angles;
  side.segments.push_back(std::move(out));
  return true;
}

}  // namespace unfurl
