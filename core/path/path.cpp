// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/chebyshev.hpp"
#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

constexpr int points = Path::degree + 1;
// A Newton correction of this share of the structure's size ends the iteration: what is left is its square.
constexpr double settled = 3e-15, nearly = 1e-10;
constexpr int most_corrections = 9;
// Poses before it that a pose is extrapolated from.
constexpr int remembered = 6;
// The tangent turns by no more than 60 degrees within a piece.
constexpr double least_cosine = 0.5;
// Tail of a series that is at round-off, as a share of the structure's size: with the last three of its 25
// coefficients there, those left out are smaller still. Next to singular poses round-off is larger, and known
// from what is cut off by its not falling: the coefficients before are hardly above it.
// An error d of a pose next to a singular one, where the least singular value is sigma, is one of d / sigma
// in the tangent, across the path: its length, and so s, has none of it.
constexpr double fine = 4e-15, rough = 3e-13, rough_tangent = 3e-10, flat = 30;
// Of many rods poses have more, however short a piece is: where no coefficient stands out it is nothing else.
constexpr double roughest = 3e-11, even = 3;
// Pieces shorter than this share of the first one: something ends the path.
constexpr double shortest_piece = 1e-6;
constexpr int tail = 3, plateau = 5, most_halvings = 30;
constexpr double first_turn = 0.3;  // of the first piece: the way of its fastest node over the mean size

// Of what no row holds, as a mass along a line, the way between its nodes.
double size_of(const System& system, const VectorXd& z) {
  const VectorXd& lengths = system.constraint_lengths();
  if (lengths.size() > 0) return lengths.maxCoeff();
  VectorXd q(system.coordinates());
  system.expand(z, q);
  const auto nodes = q.reshaped(3, q.size() / 3);
  const double wide = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).maxCoeff();
  return wide > 0 ? wide : 1.0;
}

// Largest of the last coefficients, and of those before.
struct Tail {
  double last = 0.0, before = 0.0;
  void add(const MatrixXd& c, double scale) {
    last = std::max(last, scale * c.rightCols(tail).cwiseAbs().maxCoeff());
    before = std::max(before, scale * c.middleCols(points - tail - plateau, plateau).cwiseAbs().maxCoeff());
  }
  // At round-off, or at noise up to that.
  bool ends(double fine_enough, double noise) const { return last <= fine_enough || is_noise(noise, flat); }
  bool is_noise(double most, double falls) const { return last <= most && before <= falls * last; }
};
struct Fit {
  Tail poses, tangents;
};

}  // namespace

// T_k'(x) = k U_{k-1}(x).
VectorXd PathPiece::bend(double x) const {
  VectorXd out = VectorXd::Zero(tangent.rows());
  double u = 1, before = 0;  // U_{k-1}, U_{k-2}
  for (Index k = 1; k < tangent.cols(); ++k) {
    out += static_cast<double>(k) * u * tangent.col(k);
    before = std::exchange(u, 2 * x * u - before);
  }
  return out * (2 / (b - a));
}

// Poses of one piece after the other.
class Path::Tracer {
 public:
  Tracer(const System& system, const VectorXd& z)
      : system_(system),
        G_(system.jacobian_pattern()),
        saddle_(system.mass(), G_, 1),
        size_(size_of(system, z)),
        grain_(size_),
        q_(system.coordinates()),
        phi_(system.constraints()),
        y_(phi_.size()),
        x_(system.solved_coordinates()),
        no_rows_(VectorXd::Zero(phi_.size())),
        no_force_(VectorXd::Zero(x_.size())),
        points_(chebyshev_points(degree)) {}

  double size() const { return size_; }
  double grain() const { return grain_; }
  // What round-off is a share of: the size, and of what moves far from the origin its coordinates there.
  void look_far(const VectorXd& z, const VectorXd& tangent) {
    constexpr double far = 300, still = 1e-12;
    VectorXd v(q_.size());
    system_.expand(z, q_);
    system_.expand_rate(tangent, v);
    const double fastest = still * v.lpNorm<Eigen::Infinity>();
    double reach = 0;
    for (Index i = 0; i < v.size(); ++i)
      if (std::abs(v[i]) > fastest) reach = std::max(reach, std::abs(q_[i]));
    grain_ = reach > far * size_ ? reach : size_;
  }
  void end_below(double length) { least_ = length; }  // of a piece

  // The pose nearest to z and a direction, the projection of `wanted` on the null space of G there, of unit
  // length. False where there is none.
  bool settle(VectorXd& z, const VectorXd& wanted, VectorXd& tangent) {
    const VectorXd at = z, row = system_.mass() * wanted;
    double slope = 0;
    return correct(z, at, row, std::numeric_limits<double>::quiet_NaN(), tangent, slope);
  }

  // A direction in which the structure can move from z: the answer to a force without any symmetry, of a few
  // the largest; of one that can move in one way any will do.
  VectorXd any_tangent(const VectorXd& z) {
    VectorXd best = no_force_, f = no_force_;
    if (!place(z)) return best;
    double longest = 0;
    for (const double stride : {1.0, 2.3, 3.7}) {
      for (Index i = 0; i < f.size(); ++i)
        f[i] = std::sqrt(system_.mass().coeff(i, i)) * (1.5 + std::sin(stride * static_cast<double>(i + 1)));
      saddle_.solve(f, no_rows_, x_, y_);
      const double length = std::sqrt(x_.dot(system_.mass() * x_));
      if (length > longest) longest = length, best = x_ / length;
    }
    return best;
  }

  // From z along the tangent, both replaced by those at the piece's end; s counts from 0 outwards.
  bool trace(VectorXd& z, VectorXd& tangent, double& length, PathPiece& piece) {
    for (int halvings = 0; halvings < most_halvings && length > least_; ++halvings, length *= 0.47) {
      if (!solve_points(z, tangent, length)) continue;
      const Fit left = fit(piece);
      const bool ends = left.poses.ends(fine * grain_, rough * grain_) &&
                        left.tangents.ends(fine * grain_, rough_tangent * grain_);
      const bool noisy = left.poses.is_noise(roughest * grain_, even) &&
                         left.tangents.ends(fine * grain_, roughest * grain_);
      if (!ends && !noisy) continue;
      if (left.tangents.last > fine * grain_)
        piece.noise = left.tangents.last / ((piece.b - piece.a) * piece.tangent.cwiseAbs().maxCoeff());
      z = Z_.col(degree);
      tangent = T_.col(degree);
      const int used = coefficients_above(piece.z, std::max(fine * grain_, 3 * left.poses.last));
      if (used < 18) length *= used < 14 ? 1.7 : 1.25;
      return true;
    }
    return false;
  }

  void expand(PathPiece& piece) const {
    piece.q.resize(system_.coordinates(), points);
    piece.dq.resize(system_.coordinates(), points);
    VectorXd z(piece.z.rows()), q(system_.coordinates());
    for (Index k = 0; k < points; ++k) {
      chebyshev_value(piece.z, points_[k], z);
      system_.expand(z, q);
      piece.q.col(k) = q;
      chebyshev_value(piece.tangent, points_[k], z);
      system_.expand_rate(z, q);
      piece.dq.col(k) = q;
    }
  }

 private:
  bool place(const VectorXd& z) {
    system_.expand(z, q_);
    system_.jacobian(q_, G_, scratch_);
    return saddle_.factorise(G_);
  }

  // Newton's method for Phi(z) = 0 and row . (z - from) = u (NaN: the first alone). `tangent` comes out with
  // unit length, slope = row . tangent.
  bool correct(VectorXd& z, const VectorXd& from, const VectorXd& row, double u, VectorXd& tangent,
               double& slope) {
    double last = std::numeric_limits<double>::infinity();
    for (int it = 0; it < most_corrections; ++it) {
      if (!place(z)) return false;
      system_.constraint(0.0, q_, phi_);
      saddle_.solve(row, no_rows_, x_, y_);
      const double length = std::sqrt(x_.dot(system_.mass() * x_));
      if (!(length > 0) || !std::isfinite(length)) return false;
      tangent = x_ / length;
      // What rounding left in directions that are nearly free is known from G t, which should be zero.
      phi_rate_.noalias() = G_ * tangent;
      saddle_.solve(no_force_, phi_rate_, x_, y_, 2);
      tangent -= x_;
      tangent /= std::sqrt(tangent.dot(system_.mass() * tangent));
      slope = row.dot(tangent);
      saddle_.solve(no_force_, -phi_, x_, y_, 2);
      if (!std::isnan(u)) x_ += (u - row.dot(z - from) - row.dot(x_)) / slope * tangent;
      if (!x_.allFinite()) return false;
      z += x_;
      const double change = x_.size() ? x_.lpNorm<Eigen::Infinity>() : 0.0;
      if (change <= settled * grain_ || (change <= nearly * grain_ && change > 0.25 * last)) return true;
      last = change;
    }
    return false;
  }

  // Neville's extrapolation of the poses before k; Hermite's first steps.
  VectorXd predicted(int k, const VectorXd& u) const {
    if (k == 1) return Z_.col(0) + (u[1] - u[0]) / slope_[0] * T_.col(0);
    if (k < 4) {
      const double h = u[k - 1] - u[k - 2], r = (u[k] - u[k - 2]) / h, p = r - 1;
      return (1 + 2 * r) * p * p * Z_.col(k - 2) + r * r * (3 - 2 * r) * Z_.col(k - 1) +
             r * p * p * h / slope_[k - 2] * T_.col(k - 2) + r * r * p * h / slope_[k - 1] * T_.col(k - 1);
    }
    const int first = std::max(0, k - remembered), count = k - first;
    MatrixXd column = Z_.middleCols(first, count);
    for (int level = 1; level < count; ++level)
      for (int i = 0; i + level < count; ++i)
        column.col(i) =
            ((u[k] - u[first + i]) * column.col(i + 1) + (u[first + i + level] - u[k]) * column.col(i)) /
            (u[first + i + level] - u[first + i]);
    return column.col(0);
  }

  bool solve_points(const VectorXd& z, const VectorXd& tangent, double length) {
    const VectorXd row = system_.mass() * tangent;
    const VectorXd u = 0.5 * length * (points_.array() + 1);
    Z_.resize(z.size(), points);
    T_.resize(z.size(), points);
    slope_.resize(points);
    Z_.col(0) = z;
    T_.col(0) = tangent;
    slope_[0] = row.dot(tangent);
    VectorXd at, direction;
    for (int k = 1; k < points; ++k) {
      at = predicted(k, u);
      if (!correct(at, z, row, u[k], direction, slope_[k]) || !(slope_[k] > least_cosine)) return false;
      Z_.col(k) = at;
      T_.col(k) = direction;
    }
    u_length_ = length;
    return true;
  }

  // From series in u to series in s = integral of du / slope.
  Fit fit(PathPiece& piece) {
    const MatrixXd& transform = chebyshev_transform(degree);
    const MatrixXd z = Z_ * transform;
    const MatrixXd t = T_ * transform;
    const VectorXd speed = (slope_.cwiseInverse().transpose() * transform).transpose();
    const VectorXd s = 0.5 * u_length_ * chebyshev_integral(speed);  // of x, from 0
    const double whole = chebyshev_value(s.data(), s.size(), 1.0);
    MatrixXd z_s(z.rows(), points), t_s(z.rows(), points);
    VectorXd at(z.rows());
    for (int k = 0; k < points; ++k) {
      double x = points_[k];
      const double wanted = 0.5 * whole * (points_[k] + 1);
      for (int it = 0; k > 0 && k < degree && it < 20; ++it) {
        const ValueAndSlope f = chebyshev_value_and_slope(s.data(), s.size(), x);
        const double change = (wanted - f.value) / f.slope;
        x = std::clamp(x + change, -1.0, 1.0);
        if (std::abs(change) < 1e-16) break;
      }
      chebyshev_value(z, x, at);
      z_s.col(k) = at;
      chebyshev_value(t, x, at);
      t_s.col(k) = at;
    }
    piece.a = 0;
    piece.b = whole;
    piece.z = z_s * transform;
    piece.tangent = t_s * transform;
    // A tangent's coefficients times the length are those of a way.
    Fit out;
    out.poses.add(z, 1.0);
    out.poses.add(piece.z, 1.0);
    out.tangents.add(piece.tangent, whole);
    return out;
  }

  static int coefficients_above(const MatrixXd& c, double least) {
    for (int k = degree; k > 0; --k)
      if (c.col(k).cwiseAbs().maxCoeff() > least) return k + 1;
    return 1;
  }

  const System& system_;
  SparseRows G_;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  double size_, grain_;
  VectorXd q_, phi_, phi_rate_, y_, x_, no_rows_, no_force_, points_;
  MatrixXd Z_, T_;  // of the points of the present piece
  VectorXd slope_;
  double u_length_ = 0, least_ = 0;
};

Path::Path(std::shared_ptr<const System> system, const VectorXd& z)
    : system_(std::move(system)), tracer_(std::make_unique<Tracer>(*system_, z)) {
  VectorXd pose = z, tangent;
  const VectorXd wanted = tracer_->any_tangent(z);
  tracer_->look_far(z, wanted);
  if (!(wanted.squaredNorm() > 0) || !tracer_->settle(pose, wanted, tangent))
    throw PathRefused("no path leads on from the pose at the start");
  VectorXd v(system_->coordinates());
  system_->expand_rate(tangent, v);
  forward_.z = backward_.z = pose;
  forward_.tangent = tangent;
  backward_.tangent = -tangent;
  unit_ = tracer_->size() / v.lpNorm<Eigen::Infinity>();
  forward_.length = backward_.length = first_turn * tracer_->size() / v.lpNorm<Eigen::Infinity>();
  tracer_->end_below(shortest_piece * forward_.length);
}

Path::~Path() = default;

const PathPiece* Path::outward(Side& side, double sign, std::size_t number) const {
  while (side.pieces.size() <= number && !side.ended) {
    PathPiece piece;
    if (!tracer_->trace(side.z, side.tangent, side.length, piece)) {
      side.ended = true;
      break;
    }
    const double from = side.pieces.empty() ? 0.0 : sign > 0 ? side.pieces.back().b : side.pieces.back().a;
    if (sign > 0) {
      piece.a = from;
      piece.b += from;
    } else {  // T_k(-x) = (-1)^k T_k(x), and the tangent points back
      for (Index k = 1; k < piece.z.cols(); k += 2) piece.z.col(k) *= -1;
      for (Index k = 0; k < piece.tangent.cols(); k += 2) piece.tangent.col(k) *= -1;
      piece.a = from - piece.b;
      piece.b = from;
    }
    tracer_->expand(piece);
    side.pieces.push_back(std::move(piece));
  }
  return number < side.pieces.size() ? &side.pieces[number] : nullptr;
}

const PathPiece* Path::piece(long number) const {
  const std::lock_guard lock(mutex_);
  return number >= 0 ? outward(forward_, 1.0, static_cast<std::size_t>(number))
                     : outward(backward_, -1.0, static_cast<std::size_t>(-number - 1));
}

std::optional<long> Path::piece_of(double s) const {
  if (!std::isfinite(s)) return std::nullopt;
  const bool ahead = s >= 0;
  const auto known = [&] {
    const std::lock_guard lock(mutex_);
    const std::deque<PathPiece>& pieces = (ahead ? forward_ : backward_).pieces;
    return std::partition_point(pieces.begin(), pieces.end(),
                                [&](const PathPiece& p) { return ahead ? p.b < s : p.a > s; }) -
           pieces.begin();
  };
  for (long k = known();; ++k) {  // behind those, further ones
    const PathPiece* at = piece(ahead ? k : -k - 1);
    if (!at) return std::nullopt;
    if (ahead ? s <= at->b : s >= at->a) return ahead ? k : -k - 1;
  }
}

bool Path::point(double s, VectorXd& z, VectorXd& tangent) const {
  const auto number = piece_of(s);
  if (!number) return false;
  const PathPiece& at = *piece(*number);
  z.resize(at.z.rows());
  tangent.resize(at.z.rows());
  chebyshev_value(at.z, at.x_of(s), z);
  chebyshev_value(at.tangent, at.x_of(s), tangent);
  return true;
}

std::optional<double> Path::locate(const VectorXd& z, long most) const {
  VectorXd at(z.size()), tangent(z.size());
  const double touching = 1e-12 * tracer_->grain();
  for (long i = 0; i < 2 * most; ++i) {
    const long out = i / 2;
    const bool ahead = i % 2 == 0;
    const PathPiece* p = piece(ahead ? out : -out - 1);
    if (!p) continue;
    // s is the length in the mass metric: the pose is no farther from the middle than half of the piece.
    const double reach = 0.51 * (p->b - p->a);
    chebyshev_value(p->z, 0.0, at);
    at -= z;
    if (at.dot(system_->mass() * at) > reach * reach) continue;
    // Newton's method for the foot of the perpendicular, from the nearest of a few points.
    double x = 0, nearest = std::numeric_limits<double>::infinity();
    for (const double start : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      chebyshev_value(p->z, start, at);
      if (const double d = (z - at).squaredNorm(); d < nearest) nearest = d, x = start;
    }
    for (int it = 0; it < 12; ++it) {
      chebyshev_value(p->z, x, at);
      chebyshev_value(p->tangent, x, tangent);
      const double change = tangent.dot(system_->mass() * (z - at)) / (0.5 * (p->b - p->a));
      x = std::clamp(x + change, -1.0, 1.0);
      if (std::abs(change) < 1e-15) break;
    }
    chebyshev_value(p->z, x, at);
    if ((z - at).lpNorm<Eigen::Infinity>() <= touching) return p->at(x);
  }
  return std::nullopt;
}

}  // namespace unfurl
