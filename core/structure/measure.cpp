// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/measure.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/twofold.hpp"
#include "core/structure/angle_sides.hpp"
#include "core/structure/change.hpp"
#include "core/structure/course.hpp"
#include "core/structure/dihedral.hpp"

namespace unfurl {
namespace {

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

// Hessian of atan2(s, c): with r^2 = s^2 + c^2
//   c/r^2 Hs - s/r^2 Hc + [ -2cs ds ds^T + (s^2 - c^2)(ds dc^T + dc ds^T) + 2cs dc dc^T ] / r^4
template <class Vector, class Matrix>
Matrix atan2_hessian(double s, double c, const Vector& ds, const Vector& dc, const Matrix& linear_part) {
  const double r4 = (s * s + c * c) * (s * s + c * c);
  const Matrix mixed = ds * dc.transpose();
  return linear_part + (2 * s * c * (dc * dc.transpose() - ds * ds.transpose()) +
                        (s * s - c * c) * (mixed + mixed.transpose())) /
                           r4;
}

// Of the sides of an angle, by |d_1 x d_2| and d_1 . d_2, but for rounding and what the place of an impact is
// known to: they have no axis.
bool in_line(double s, double c) {
  return s <= 1e-12 * std::abs(c);
}

double on_branch(double angle, double near) {
  return angle - 2 * pi * std::round((angle - near) / (2 * pi));
}

// A sum of terms of which angles have gone round many times: the turns, which may cancel each other (of
// gears, of a drum and its cable), are summed up exactly, so that what is left has the digits of one turn.
class TermSum {
 public:
  // c times the value, or times the angle a whole number of turns away that is within half a turn of `near`.
  void add(double c, double value, double near, bool counts) {
    within_ += c * value;
    const double turns = counts ? std::round((near - value) / (2 * pi)) : 0.0;
    if (turns != 0) turned_ = turned_ + Twofold(2 * pi) * Twofold(turns) * Twofold(c);
  }
  double value() const { return within_ + static_cast<double>(turned_); }

 private:
  double within_ = 0;
  Twofold turned_;
};

}  // namespace

bool counts_turns(const Measure& measure) {
  return measure.kind == MeasureKind::fold || measure.kind == MeasureKind::dihedral ||
         (measure.kind == MeasureKind::angle && !measure.axis.isZero(0.0));
}

bool is_angle(const Measure& measure) {
  if (measure.kind == MeasureKind::combination)
    return std::all_of(measure.terms.begin(), measure.terms.end(),
                       [](const MeasureTerm& term) { return is_angle(term.measure); });
  return measure.kind != MeasureKind::coordinate && measure.kind != MeasureKind::length;
}

MeasureRange range_of(const Measure& measure) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (measure.kind == MeasureKind::length) return {0.0, endless};
  if (measure.kind == MeasureKind::angle && !counts_turns(measure)) return {0.0, pi};
  if (measure.kind != MeasureKind::combination) return {-endless, endless};
  MeasureRange sum{0.0, 0.0};
  for (const MeasureTerm& term : measure.terms) {
    const MeasureRange range = range_of(term.measure);
    const double a = term.coefficient * range.low, b = term.coefficient * range.high;
    sum.low += std::min(a, b);
    sum.high += std::max(a, b);
  }
  return sum;
}

std::vector<Measure> turning_angles(const Measure& measure) {
  std::vector<Measure> out;
  if (counts_turns(measure)) out.push_back(measure);
  for (const MeasureTerm& term : measure.terms)
    if (counts_turns(term.measure)) out.push_back(term.measure);
  return out;
}

FollowedAngles followed_angles(const Structure& structure) {
  FollowedAngles out;
  const auto index = [&](const Measure& measure) {
    const std::size_t first = out.measures.size();
    for (Measure& angle : turning_angles(measure)) out.measures.push_back(std::move(angle));
    return out.measures.size() > first ? static_cast<int>(first) : -1;
  };
  if (structure.deployment.measured) index(structure.deployment.measure);
  for (const Force& force : structure.forces) out.of_force.push_back(index(force.measure));
  for (const Stop& stop : structure.stops) out.of_stop.push_back(index(stop.measure));
  for (const Constraint& c : structure.constraints)
    out.of_constraint.push_back(c.measure.kind == MeasureKind::combination ? index(c.measure) : -1);
  return out;
}

MeasureFunction::MeasureFunction(const Measure& measure, const Deployment& deployment)
    : angle_(unfurl::is_angle(measure)),
      turns_(counts_turns(measure)),
      kind_(measure.kind),
      axis_(measure.axis),
      reference_(measure.reference) {
  for (const MeasureTerm& term : measure.terms) {
    terms_.emplace_back(term.measure, deployment);
    coefficients_.push_back(term.coefficient);
    const std::vector<int>& own = terms_.back().stencil_;
    stencil_.insert(stencil_.end(), own.begin(), own.end());
  }
  const auto coordinates_of = [&](const std::vector<int>& nodes) {
    for (const int node : nodes)
      for (int k = 0; k < 3; ++k) stencil_.push_back(3 * node + k);
  };
  if (kind_ == MeasureKind::combination) return;
  if (kind_ != MeasureKind::fold) {
    coordinates_of(measure.nodes);
    if (kind_ != MeasureKind::coordinate) return;
    sine_.resize(static_cast<Index>(stencil_.size()));
    sine_.tail<3>() = axis_;
    if (measure.nodes.size() == 2) sine_.head<3>() = -axis_;
    return;
  }
  const LinearForm &s = deployment.fold_sine, &c = deployment.fold_cosine;
  std::vector<int> nodes = s.nodes;
  nodes.insert(nodes.end(), c.nodes.begin(), c.nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  coordinates_of(nodes);
  sine_offset_ = s.offset;
  cosine_offset_ = c.offset;
  const auto gather = [&](const LinearForm& form, VectorXd& out) {
    out.setZero(static_cast<Index>(stencil_.size()));
    for (std::size_t i = 0; i < form.nodes.size(); ++i) {
      const auto at = std::lower_bound(nodes.begin(), nodes.end(), form.nodes[i]) - nodes.begin();
      out.segment<3>(3 * at) += form.coefficients[i];
    }
  };
  gather(s, sine_);
  gather(c, cosine_);
}

// each(term, its coefficient, where its stencil begins, how many angles that count turns come before it)
template <class Each>
void MeasureFunction::each_term(const Each& each) const {
  std::size_t first = 0;
  int turn = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    each(terms_[i], coefficients_[i], first, turn);
    first += terms_[i].stencil_.size();
    turn += terms_[i].turns_ ? 1 : 0;
  }
}

double MeasureFunction::value(const double* q, const Moment& at, int followed) const {
  if (terms_.empty()) return value(q, at.near(followed, reference_));
  TermSum sum;
  each_term([&](const MeasureFunction& term, double c, std::size_t, int turn) {
    const double near = term.near(at, term.turns_ && followed >= 0 ? followed + turn : -1);
    sum.add(c, term.value(q, 0.0), near, term.turns_);
  });
  return sum.value();
}

double MeasureFunction::value_and_gradient(const double* q, double* gradient, const Moment& at,
                                           int followed) const {
  if (terms_.empty()) return value_and_gradient(q, gradient, at.near(followed, reference_));
  TermSum sum;
  each_term([&](const MeasureFunction& term, double c, std::size_t first, int turn) {
    double* const g = gradient + first;
    const double near = term.near(at, term.turns_ && followed >= 0 ? followed + turn : -1);
    sum.add(c, term.value_and_gradient(q, g, 0.0), near, term.turns_);
    for (std::size_t i = 0; i < term.stencil_.size(); ++i) g[i] *= c;
  });
  return sum.value();
}

double MeasureFunction::value_and_gradient(const double* q, const double* v, double* gradient,
                                           const Moment& at, int followed) const {
  const double value = value_and_gradient(q, gradient, at, followed);
  turn_in_line(q, v, at.t > 0 ? 1.0 : -1.0, gradient);
  return value;
}

// A moment ago d_1 x d_2 was against its rate now; where a motion begins (scale -1) it will be along it. What
// turns slower than this rests.
void MeasureFunction::turn_in_line(const double* q, const double* v, double scale, double* gradient) const {
  constexpr double rounding = 1e-9, rest = 1e-12;  // shares of the velocities; rad/s
  each_term([&](const MeasureFunction& term, double c, std::size_t first, int) {
    term.turn_in_line(q, v, scale * c, gradient + first);
  });
  if (kind_ != MeasureKind::angle || turns_) return;
  const AngleSides sides(q, stencil_);
  const Vec3 &d1 = sides.d1(), &d2 = sides.d2();
  const double c = d1.dot(d2);
  if (!in_line(d1.cross(d2).norm(), c)) return;
  const Vec6 rate = sides.rate(v);
  const Vec3 v1 = rate.head<3>(), v2 = rate.tail<3>(), turning = d1.cross(v2) + v1.cross(d2);
  const double size = turning.norm(), most = d1.norm() * v2.norm() + v1.norm() * d2.norm();
  if (!(size > rounding * most && size > rest * std::abs(c))) return;
  const Vec3 n = -turning / size;
  Vec6 ds;
  ds << d2.cross(n), n.cross(d1);
  sides.gradient(scale / c * ds, Eigen::Map<VectorXd>(gradient, std::ssize(stencil_)));
}

void MeasureFunction::add_hessian(const double* q, double scale,
                                  std::vector<Eigen::Triplet<double>>& entries) const {
  each_term([&](const MeasureFunction& term, double c, std::size_t, int) {
    term.add_hessian(q, scale * c, entries);
  });
  if (!terms_.empty() || kind_ == MeasureKind::coordinate) return;
  std::vector<double> hess(stencil_.size() * stencil_.size());
  hessian(q, hess.data());
  const double* h = hess.data();
  for (const int j : stencil_)
    for (const int i : stencil_) entries.emplace_back(i, j, scale * *h++);
}

// To the first order the sides are off their line by |d_1 x d_2 / (d_1 . d_2)|, in whatever direction.
bool MeasureFunction::add_square_in_line(const double* q, double scale,
                                         std::vector<Eigen::Triplet<double>>& entries) const {
  if (terms_.size() == 1)
    return terms_[0].add_square_in_line(q, scale * coefficients_[0] * coefficients_[0], entries);
  if (kind_ != MeasureKind::angle || turns_) return false;
  const AngleSides sides(q, stencil_);
  const Vec3 &d1 = sides.d1(), &d2 = sides.d2();
  const double c = d1.dot(d2);
  if (c == 0 || !in_line(d1.cross(d2).norm(), c)) return false;
  Eigen::Matrix<double, 3, 6> turn;
  turn << -cross_matrix(d2) / c, cross_matrix(d1) / c;
  MatrixXd square(std::ssize(stencil_), std::ssize(stencil_));
  sides.hessian(Vec6::Zero(), turn.transpose() * turn, square);
  const double* h = square.data();
  for (const int j : stencil_)
    for (const int i : stencil_) entries.emplace_back(i, j, scale * *h++);
  return true;
}

void MeasureFunction::add_hessian_times(const double* q, const double* v, double scale, double* out) const {
  each_term([&](const MeasureFunction& term, double c, std::size_t first, int) {
    term.add_hessian_times(q, v, scale * c, out + first);
  });
  if (!terms_.empty() || kind_ == MeasureKind::coordinate) return;
  const std::size_t size = stencil_.size();
  std::vector<double> hess(size * size);
  hessian(q, hess.data());
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t i = 0; i < size; ++i) out[i] += scale * hess[j * size + i] * v[stencil_[j]];
}

double MeasureFunction::linear(const VectorXd& coefficients, double offset, const double* q) const {
  double sum = offset;
  for (std::size_t i = 0; i < stencil_.size(); ++i)
    sum += coefficients[static_cast<Index>(i)] * q[stencil_[i]];
  return sum;
}

Vec3 MeasureFunction::edge(const double* q) const {
  const int a = stencil_[0], b = stencil_[3];
  return {q[b] - q[a], q[b + 1] - q[a + 1], q[b + 2] - q[a + 2]};
}

// s and c of the angle, their first derivatives by (d_1, d_2) and those of the angle.
struct MeasureFunction::Angle {
  AngleSides sides;
  double s, c;
  Vec6 ds, dc;

  Vec6 gradient() const { return (c * ds - s * dc) / (s * s + c * c); }
};

MeasureFunction::Angle MeasureFunction::angle_terms(const double* q) const {
  Angle a{AngleSides(q, stencil_), 0, 0, Vec6::Zero(), Vec6::Zero()};
  const Vec3 &d1 = a.sides.d1(), &d2 = a.sides.d2();
  const Vec3 normal = d1.cross(d2);
  if (axis_.isZero(0.0)) {
    a.s = normal.norm();
    a.c = d1.dot(d2);
    a.dc << d2, d1;
    const Vec3 n = in_line(a.s, a.c) ? Vec3::Zero() : Vec3(normal / a.s);
    a.ds << d2.cross(n), n.cross(d1);
  } else {
    const double h1 = axis_.dot(d1), h2 = axis_.dot(d2);
    a.s = axis_.dot(normal);
    a.c = d1.dot(d2) - h1 * h2;
    a.ds << d2.cross(axis_), axis_.cross(d1);
    a.dc << d2 - h2 * axis_, d1 - h1 * axis_;
  }
  return a;
}

double MeasureFunction::value_and_gradient(const double* q, double* gradient, double near) const {
  if (kind_ == MeasureKind::combination) return value_and_gradient(q, gradient, Moment(0.0), -1);
  const auto size = static_cast<Index>(stencil_.size());
  Eigen::Map<VectorXd> g(gradient, size);
  if (kind_ == MeasureKind::dihedral) return on_branch(dihedral(q, stencil_, gradient), near);
  if (kind_ == MeasureKind::coordinate) {
    g = sine_;
    return linear(sine_, 0.0, q);
  }
  if (kind_ == MeasureKind::length) {
    const Vec3 d = edge(q);
    const double length = d.norm();
    const Vec3 unit = length > 0 ? Vec3(d / length) : Vec3::Zero();
    g << -unit, unit;
    return length;
  }
  if (kind_ == MeasureKind::fold) {
    const double s = linear(sine_, sine_offset_, q), c = linear(cosine_, cosine_offset_, q);
    g = (c * sine_ - s * cosine_) / (s * s + c * c);
    return on_branch(std::atan2(s, c), near);
  }
  const Angle a = angle_terms(q);
  a.sides.gradient(a.gradient(), g);
  return axis_.isZero(0.0) ? std::atan2(a.s, a.c) : on_branch(std::atan2(a.s, a.c), near);
}

double MeasureFunction::value(const double* q, double near) const {
  if (kind_ == MeasureKind::combination) return value(q, Moment(0.0), -1);
  if (kind_ == MeasureKind::coordinate) return linear(sine_, 0.0, q);
  if (kind_ == MeasureKind::fold)
    return on_branch(std::atan2(linear(sine_, sine_offset_, q), linear(cosine_, cosine_offset_, q)), near);
  std::array<double, 18> unused{};
  return value_and_gradient(q, unused.data(), near);
}

void MeasureFunction::hessian(const double* q, double* hess) const {
  switch (kind_) {
    case MeasureKind::coordinate:
      std::fill_n(hess, stencil_.size() * stencil_.size(), 0.0);
      return;
    case MeasureKind::length:
      return length_hessian(q, hess);
    case MeasureKind::angle:
      return angle_hessian(q, hess);
    case MeasureKind::fold:
      return fold_hessian(q, hess);
    case MeasureKind::dihedral:
      return dihedral_hessian(q, stencil_, hess);
    case MeasureKind::combination:
      return combination_hessian(q, hess);
  }
}

// The blocks of the terms, one after the other.
void MeasureFunction::combination_hessian(const double* q, double* hess) const {
  const auto all = static_cast<Index>(stencil_.size());
  Eigen::Map<MatrixXd> out(hess, all, all);
  out.setZero();
  std::vector<double> own;
  each_term([&](const MeasureFunction& term, double c, std::size_t first, int) {
    const auto size = static_cast<Index>(term.stencil_.size()), at = static_cast<Index>(first);
    own.resize(term.stencil_.size() * term.stencil_.size());
    term.hessian(q, own.data());
    out.block(at, at, size, size) = c * Eigen::Map<const MatrixXd>(own.data(), size, size);
  });
}

double MeasureFunction::curvature_along(const double* q, const double* v) const {
  switch (kind_) {
    case MeasureKind::coordinate:
      return 0.0;
    case MeasureKind::length: {
      const Vec3 d = edge(q), rate = edge(v);
      const Course square = dot(d, rate, d, rate);
      return square.value > 0 ? root(square).second : 0.0;
    }
    case MeasureKind::angle:
      return angle_curvature(q, v);
    case MeasureKind::fold:
      return second_of_angle({linear(sine_, sine_offset_, q), linear(sine_, 0.0, v), 0.0},
                             {linear(cosine_, cosine_offset_, q), linear(cosine_, 0.0, v), 0.0});
    case MeasureKind::dihedral:
      return dihedral_curvature(q, v, stencil_);
    case MeasureKind::combination:
      break;
  }
  double total = 0;
  each_term([&](const MeasureFunction& term, double c, std::size_t, int) {
    total += c * term.curvature_along(q, v);
  });
  return total;
}

double MeasureFunction::angle_curvature(const double* q, const double* v) const {
  const AngleSides sides(q, stencil_);
  const Vec6 rate = sides.rate(v), second = sides.second_rate(v);
  const Vec3 &d1 = sides.d1(), &d2 = sides.d2();
  const Vec3 v1 = rate.head<3>(), v2 = rate.tail<3>(), a1 = second.head<3>(), a2 = second.tail<3>();
  const Vec3 n = d1.cross(d2), n1 = d1.cross(v2) + v1.cross(d2),
             n2 = 2 * v1.cross(v2) + (d1.cross(a2) + a1.cross(d2));
  Course c = dot(d1, v1, d2, v2);
  c.second += d1.dot(a2) + a1.dot(d2);
  if (!axis_.isZero(0.0)) {
    const Course h1{axis_.dot(d1), axis_.dot(v1), axis_.dot(a1)};
    const Course h2{axis_.dot(d2), axis_.dot(v2), axis_.dot(a2)};
    return second_of_angle({axis_.dot(n), axis_.dot(n1), axis_.dot(n2)}, c - h1 * h2);
  }
  const double s = n.norm();
  if (in_line(s, c.value)) return second_of_angle({s, 0, 0}, c);
  const double s1 = n.dot(n1) / s;
  return second_of_angle({s, s1, (n1.squaredNorm() + n.dot(n2) - s1 * s1) / s}, c);
}

double MeasureFunction::change(const double* q, const double* u) const {
  switch (kind_) {
    case MeasureKind::coordinate:
      return linear(sine_, 0.0, u);
    case MeasureKind::length: {
      const Vec3 d = edge(q), by = edge(u);
      return root(dot_change(d, by, d, by)).change;
    }
    case MeasureKind::angle:
      return angle_change(q, u);
    case MeasureKind::fold:
      return change_of_angle({linear(sine_, sine_offset_, q), linear(sine_, 0.0, u)},
                             {linear(cosine_, cosine_offset_, q), linear(cosine_, 0.0, u)});
    case MeasureKind::dihedral:
      return dihedral_change(q, u, stencil_);
    case MeasureKind::combination:
      break;
  }
  double total = 0;
  each_term([&](const MeasureFunction& term, double c, std::size_t, int) { total += c * term.change(q, u); });
  return total;
}

double MeasureFunction::angle_change(const double* q, const double* u) const {
  const AngleSides sides(q, stencil_);
  const Vec6 by = sides.change(u);
  const Vec3 &d1 = sides.d1(), &d2 = sides.d2();
  const Vec3 u1 = by.head<3>(), u2 = by.tail<3>();
  const Vec3 n = d1.cross(d2), n_by = d1.cross(u2) + u1.cross(d2 + u2);
  const Change c = dot_change(d1, u1, d2, u2);
  if (axis_.isZero(0.0)) return change_of_angle(root(dot_change(n, n_by, n, n_by)), c);
  const Change h1{axis_.dot(d1), axis_.dot(u1)}, h2{axis_.dot(d2), axis_.dot(u2)};
  return change_of_angle({axis_.dot(n), axis_.dot(n_by)}, c - h1 * h2);
}

// (I - n n^T) / length, n the unit direction.
void MeasureFunction::length_hessian(const double* q, double* hess) const {
  Vec6 g;
  const double length = value_and_gradient(q, g.data());
  const Vec3 n = g.tail<3>();
  const Mat3 block = length > 0 ? Mat3((Mat3::Identity() - n * n.transpose()) / length) : Mat3(Mat3::Zero());
  Eigen::Map<Mat6> out(hess);
  out << block, -block, -block, block;
}

void MeasureFunction::fold_hessian(const double* q, double* hess) const {
  const auto size = static_cast<Index>(stencil_.size());
  const double s = linear(sine_, sine_offset_, q), c = linear(cosine_, cosine_offset_, q);
  Eigen::Map<MatrixXd>(hess, size, size) =
      atan2_hessian(s, c, sine_, cosine_, MatrixXd(MatrixXd::Zero(size, size)));
}

void MeasureFunction::angle_hessian(const double* q, double* hess) const {
  const Angle a = angle_terms(q);
  const Vec3 &d1 = a.sides.d1(), &d2 = a.sides.d2();
  const double square = a.s * a.s + a.c * a.c;
  Mat6 hs = Mat6::Zero(), hc = Mat6::Zero();
  if (axis_.isZero(0.0)) {
    // s = sqrt(w), w = |d_1|^2 |d_2|^2 - c^2: Hs = Hw / (2 s) - ds ds^T / s
    const Mat3 unit = Mat3::Identity();
    const double c = a.c;
    hc << Mat3::Zero(), unit, unit, Mat3::Zero();
    const Mat3 h12 = 2 * d1 * d2.transpose() - d2 * d1.transpose() - c * unit;
    if (!in_line(a.s, c)) {
      hs << d2.squaredNorm() * unit - d2 * d2.transpose(), h12, h12.transpose(),
          d1.squaredNorm() * unit - d1 * d1.transpose();
      hs = ((hs - a.ds * a.ds.transpose()) / a.s).eval();
    }
  } else {
    const Mat3 across = Mat3::Identity() - axis_ * axis_.transpose(), turn = -cross_matrix(axis_);
    hs << Mat3::Zero(), turn, turn.transpose(), Mat3::Zero();
    hc << Mat3::Zero(), across, across, Mat3::Zero();
  }
  const Mat6 linear_part = (a.c * hs - a.s * hc) / square;
  const auto size = static_cast<Index>(stencil_.size());
  a.sides.hessian(a.gradient(), atan2_hessian(a.s, a.c, a.ds, a.dc, linear_part),
                  Eigen::Map<MatrixXd>(hess, size, size));
}

}  // namespace unfurl
