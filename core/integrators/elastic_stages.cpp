// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/elastic_stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

double reach_of(const Rod& rod, const VectorXd& x) {
  return std::max(x.segment<3>(3 * rod.a).lpNorm<Eigen::Infinity>(),
                  x.segment<3>(3 * rod.b).lpNorm<Eigen::Infinity>());
}

}  // namespace

ElasticStages::ElasticStages(const System& system, const GalerkinCoefficients& coefficients)
    : system_(system), c_(coefficients), rods_(system.elastic_rods()) {
  if (!rods_) return;
  const auto count = std::ssize(rods_->rods());
  compliance_.resize(count);
  for (Index i = 0; i < count; ++i) compliance_[i] = rods_->rods()[static_cast<std::size_t>(i)].compliance();
  stretch_.resize(count);
  tension.setZero(count, c_.tau.size());
  residual.setZero(count, c_.tau.size());
}

void ElasticStages::evaluate(Index j, double t, const VectorXd& q, const VectorXd& v, MutVec f) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  rods_->add_forces(q.data(), tension.col(j).data(), 1.0, f.data());
  rods_->stretches(t, q.data(), v.data(), stretch_.data());
  residual.col(j) = stretch_ - compliance_.cwiseProduct(tension.col(j));
  for (Index i = 0; i < stretch_.size(); ++i) {
    const Rod& rod = rods_->rods()[static_cast<std::size_t>(i)];
    const double length = std::max(rod.length, reach_of(rod, q));
    // Of coordinates and of velocities, which are differences of these over a step; and of the terms.
    const double noise = 2 * epsilon * (length + rod.damping_time * (reach_of(rod, v))) +
                         epsilon * std::abs(compliance_[i] * tension(i, j));
    const double level = std::abs(residual(i, j)) / noise;
    level_ = level <= level_ ? level_ : level;  // not finite: taken
  }
}

void ElasticStages::take_from_lengths(Index j, double t, const VectorXd& q, const VectorXd& v) {
  rods_->forces(t, q.data(), v.data(), stretch_.data());
  tension.col(j) = stretch_;
}

void ElasticStages::add_sizes(double h, VectorXd& f) const {
  for (Index i = 0; i < tension.rows(); ++i) {
    const Rod& rod = rods_->rods()[static_cast<std::size_t>(i)];
    const double size = std::abs(h) * tension.row(i).lpNorm<Eigen::Infinity>();
    for (const int node : {rod.a, rod.b}) f.segment<3>(3 * node).array() += size;
  }
}

double ElasticStages::h_omega(Index i, double h, const SparseRows& directions) const {
  double sum = 0;
  for (SparseRows::InnerIterator it(directions, static_cast<int>(i)); it; ++it)
    sum += std::abs(it.value()) / std::sqrt(system_.mass().coeff(it.col(), it.col()));
  return std::abs(h) * sum / std::sqrt(compliance_[i]);
}

bool ElasticStages::still(double fast, double t, double h, const VectorXd& q, const Rigid& rigid, VectorXd& w,
                          VectorXd& mu) const {
  if (!as_unknowns) return false;
  const SparseRows D = system_.giving_rod_directions(q);
  const Index m = rigid.G.rows();
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> rates(rigid.rate.begin(), rigid.rate.end());
  const auto add_row = [&](const SparseRows& A, Index from, Index to) {
    for (SparseRows::InnerIterator it(A, from); it; ++it)
      entries.emplace_back(static_cast<int>(to), static_cast<int>(it.col()), it.value());
  };
  for (Index r = 0; r < m; ++r) add_row(rigid.G, r, r);
  for (Index i = 0; i < D.rows(); ++i) {
    if (!(h_omega(i, h, D) > fast)) continue;
    const Rod& rod = rods_->rods()[static_cast<std::size_t>(i)];
    add_row(D, i, std::ssize(rates));
    rates.push_back(rod.natural_length() * rod.warmed(t, 1));
  }
  if (std::ssize(rates) == m) return false;
  SparseRows rows(std::ssize(rates), D.cols());
  rows.setFromTriplets(entries.begin(), entries.end());
  SaddleSolver saddle(system_.mass(), rows);
  if (!saddle.factorise(rows)) return false;
  VectorXd impulse(rows.rows());
  saddle.solve(rigid.p, Eigen::Map<const VectorXd>(rates.data(), std::ssize(rates)), w, impulse);
  mu = impulse.head(m);
  return true;
}

}  // namespace unfurl
