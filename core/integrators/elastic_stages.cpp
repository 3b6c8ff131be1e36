// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/elastic_stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

double reach_of(const Rod& rod, const VectorXd& x) {
  return std::max(x.segment<3>(3 * rod.a).lpNorm<Eigen::Infinity>(),
                  x.segment<3>(3 * rod.b).lpNorm<Eigen::Infinity>());
}

}  // namespace

ElasticStages::ElasticStages(const System& system, const GalerkinCoefficients& coefficients)
    : held(system), unresolved(system), system_(system), c_(coefficients), rods_(system.elastic_rods()) {
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

double ElasticStages::rate_over_omega(Index i, double t, const VectorXd& w, const SparseRows& D) const {
  const Rod& rod = rods_->rods()[static_cast<std::size_t>(i)];
  double square = 0, rate = -rod.rest_rate(t);
  for (SparseRows::InnerIterator it(D, static_cast<int>(i)); it; ++it) {
    square += it.value() * it.value() / system_.mass().coeff(it.col(), it.col());
    rate += it.value() * w[it.col()];
  }
  return square > 0 ? rate / std::sqrt(square * compliance_[i]) : 0.0;
}

void ElasticStages::still(double fast, double stiff, double t, double h, const VectorXd& q,
                          const SparseRows& G, VectorXd& w, VectorXd& mu) {
  held.clear();
  if (!rods_) return;
  std::vector<Index> fastest;
  const SparseRows D = system_.giving_rod_directions(q);
  for (Index i = 0; i < D.rows(); ++i)
    if (h_omega(i, h, D) > fast) fastest.push_back(i);
  if (held.take(std::move(fastest), h, stiff, G, D)) held.still(t, w, mu);
}

VectorXd ElasticStages::towards(double t, const VectorXd& q, const VectorXd& v, const VectorXd& force,
                                VectorXd& nu) {
  rods_->stretches(t, q.data(), v.data(), stretch_.data());
  stretch_ -= compliance_.cwiseProduct(force);
  return held.motion_of(-stretch_, nu);
}

VectorXd ElasticStages::turned(const VectorXd& q, const VectorXd& v, const VectorXd& nu) const {
  VectorXd f = VectorXd::Zero(q.size()), out(system_.solved_coordinates());
  for (Index i = 0; i < nu.size(); ++i) {
    const Rod& rod = rods_->rods()[static_cast<std::size_t>(i)];
    const Vec3 d = node_vector(q.data(), rod.b) - node_vector(q.data(), rod.a),
               u = node_vector(v.data(), rod.b) - node_vector(v.data(), rod.a), n = d.normalized();
    const Vec3 turn = nu[i] / d.norm() * (u - n.dot(u) * n);
    f.segment<3>(3 * rod.a) -= turn;
    f.segment<3>(3 * rod.b) += turn;
  }
  system_.reduce_force(f, out);
  return out;
}

}  // namespace unfurl
