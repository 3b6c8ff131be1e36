// SPDX-License-Identifier: BSD-3-Clause
#include "tests/random/quantities.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace unfurl::random {

Matrix mass_matrix(const Mechanism& m) {
  const auto n = static_cast<Eigen::Index>(m.points.size());
  Matrix A = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) A(i, i) = m.points[static_cast<std::size_t>(i)].mass;
  for (const Bar& bar : m.bars) {
    // A uniform bar whose ends move with v_a, v_b: T = mu/6 (v_a^2 + v_a v_b + v_b^2).
    A(bar.a, bar.a) += m.lumped ? bar.mass / 2 : bar.mass / 3;
    A(bar.b, bar.b) += m.lumped ? bar.mass / 2 : bar.mass / 3;
    if (m.lumped) continue;
    A(bar.a, bar.b) += bar.mass / 6;
    A(bar.b, bar.a) += bar.mass / 6;
  }
  Matrix M = Matrix::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) M.block<3, 3>(3 * i, 3 * j) = A(i, j) * Eigen::Matrix3d::Identity();
  return M;
}

TwistTerms terms_of(const Twist& twist, const Vector& q, double near) {
  const Vec3 d = point(q, twist.a) - point(q, twist.hinge), e = point(q, twist.b) - point(q, twist.hinge);
  const double sine = d.cross(e).norm(), cosine = d.dot(e);
  if (!twist.axis.isZero()) {
    const double angle = std::atan2(twist.axis.dot(d.cross(e)), cosine);
    return {angle - 2 * M_PI * std::round((angle - near) / (2 * M_PI)),
            -twist.axis.cross(d) / d.squaredNorm(), twist.axis.cross(e) / e.squaredNorm()};
  }
  // Within the plane, across each arm, outwards: |grad| = 1/length.
  const Vec3 across_d = (d * (cosine / d.squaredNorm()) - e), across_e = (e * (cosine / e.squaredNorm()) - d);
  return {std::atan2(sine, cosine), across_d / sine, across_e / sine};
}

double kinetic_energy(const Mechanism& m, const Vector& v) {
  return 0.5 * v.dot(mass_matrix(m) * v);
}

double potential_energy(const Mechanism& m, const Vector& q) {
  double sum = 0;
  for (std::size_t i = 0; i < m.points.size(); ++i)
    sum -= m.points[i].mass * m.gravity.dot(point(q, static_cast<int>(i)));
  for (const Bar& bar : m.bars) sum -= bar.mass / 2 * m.gravity.dot(point(q, bar.a) + point(q, bar.b));
  for (const Spring& s : m.springs) {
    const double stretch = (point(q, s.b) - point(q, s.a)).norm() - s.free_length;
    if (!s.cable || stretch > 0) sum += 0.5 * s.stiffness * stretch * stretch;
  }
  for (const Twist& t : m.twists) {
    const double turn = terms_of(t, q, 0).angle - t.free_angle;
    sum += 0.5 * t.stiffness * turn * turn;
  }
  for (const Load& load : m.loads)
    if (load.times.empty()) sum -= load.force.dot(point(q, load.node));
  return sum;
}

Vec3 momentum(const Mechanism& m, const Vector& v) {
  const Vector p = mass_matrix(m) * v;
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < p.size(); i += 3) sum += p.segment<3>(i);
  return sum;
}

Vec3 angular_momentum(const Mechanism& m, const Vector& q, const Vector& v) {
  const Vector p = mass_matrix(m) * v;
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < p.size(); i += 3) sum += Vec3(q.segment<3>(i)).cross(Vec3(p.segment<3>(i)));
  return sum;
}

double load_factor(const Load& load, double t) {
  if (load.times.empty()) return 1;
  const auto &x = load.times, &y = load.values;
  if (t <= x.front()) return y.front();
  for (std::size_t i = 1; i < x.size(); ++i)
    if (t <= x[i]) return y[i - 1] + (y[i] - y[i - 1]) * (t - x[i - 1]) / (x[i] - x[i - 1]);
  return y.back();
}

double load_impulse(const Load& load, double t) {
  if (load.times.empty()) return t;
  std::vector<double> cuts = {0};
  for (const double x : load.times)
    if (x > 0 && x < t) cuts.push_back(x);
  cuts.push_back(t);
  double sum = 0;
  for (std::size_t i = 1; i < cuts.size(); ++i)
    sum += 0.5 * (cuts[i] - cuts[i - 1]) * (load_factor(load, cuts[i - 1]) + load_factor(load, cuts[i]));
  return sum;
}

}  // namespace unfurl::random
