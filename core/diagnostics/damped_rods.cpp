// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/damped_rods.hpp"

#include <cmath>

#include "core/forces/elastic_rods.hpp"
#include "core/math/barycentric.hpp"
#include "core/math/factors.hpp"

namespace unfurl {
namespace {

Vec3 across_rod(const Rod& rod, const VectorXd& x) {
  return x.segment<3>(3 * static_cast<Index>(rod.b)) - x.segment<3>(3 * static_cast<Index>(rod.a));
}

double rate_of_stretch(const Rod& rod, double t, const VectorXd& q, const VectorXd& v) {
  return across_rod(rod, q).normalized().dot(across_rod(rod, v)) - rod.rest_rate(t);
}

}  // namespace

DampedRods::DampedRods(const System& system) {
  if (!system.elastic_rods()) return;
  rods_ = system.elastic_rods()->rods();
  for (const Rod& rod : rods_) coefficients_.push_back(rod.damping_time / rod.compliance());
}

double DampedRods::power(double t, const VectorXd& q, const VectorXd& v) const {
  double sum = 0;
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    const double rate = rate_of_stretch(rods_[i], t, q, v);
    sum += coefficients_[i] * rate * rate;
  }
  return sum;
}

SparseRows DampedRods::derivative(const System& system, const VectorXd& q) const {
  const SparseRows directions = system.giving_rod_directions(q);
  const Eigen::Map<const VectorXd> c(coefficients_.data(), std::ssize(coefficients_));
  const SparseRows pulls = (-c).asDiagonal() * directions, turned = directions.transpose();
  return turned * pulls;
}

double DampedRods::taken(const System& system, const State& a, const State& b, const Quadrature& rule) const {
  const Index points = rule.nodes.size();
  const double h = b.t - a.t;
  VectorXd q(system.coordinates()), nodes(points + 1);
  system.expand(a.z, q);
  nodes << 0.0, rule.nodes;
  const MatrixXd slope = Barycentric(nodes).derivative_matrix() / h;
  const MatrixXd of_points = slope.bottomRightCorner(points, points);
  const VectorXd of_start = slope.col(0).tail(points);
  double sum = 0;
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    const Rod& rod = rods_[i];
    if (!(rod.damping_time > 0)) continue;
    const auto row = static_cast<Index>(i);
    const double start = across_rod(rod, q).norm() - rod.rest_length(a.t);
    const MatrixXd both = MatrixXd::Identity(points, points) + rod.damping_time * of_points;
    DenseLu factors;
    factors.compute(both);
    const VectorXd stretch = factors.solve(VectorXd(rod.compliance() * b.stage_tension.row(row).transpose() -
                                                    rod.damping_time * start * of_start));
    const VectorXd rate = of_points * stretch + start * of_start;
    sum += h * coefficients_[i] * rule.weights.dot(rate.cwiseAbs2());
  }
  return sum;
}

}  // namespace unfurl
