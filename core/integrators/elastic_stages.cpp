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

// l'' - |u_across|^2 / |d|: n . (a_b - a_a) of a rod whose length is that without force [m/s^2].
double length_acceleration(const Rod& rod, double t, const VectorXd& q, const VectorXd& v) {
  const Vec3 d = node_vector(q.data(), rod.b) - node_vector(q.data(), rod.a),
             u = node_vector(v.data(), rod.b) - node_vector(v.data(), rod.a);
  const double length = d.norm(), along = d.dot(u) / length;
  return rod.natural_length() * rod.warmed(t, 2) - (u.squaredNorm() - along * along) / length;
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

double ElasticStages::rate_over_omega(Index i, double t, const VectorXd& w, const SparseRows& D) const {
  const Rod& rod = rods_->rods()[static_cast<std::size_t>(i)];
  double square = 0, rate = -rod.rest_rate(t);
  for (SparseRows::InnerIterator it(D, static_cast<int>(i)); it; ++it) {
    square += it.value() * it.value() / system_.mass().coeff(it.col(), it.col());
    rate += it.value() * w[it.col()];
  }
  return square > 0 ? rate / std::sqrt(square * compliance_[i]) : 0.0;
}

// Each held rod has a coordinate of its own besides, of mass 1, by which it gives: D x - kappa s = r with
// kappa = stiff sqrt(C) / h leaves x the share S = X / (1 + X) of r in a mode of X = (h omega / stiff)^2.
bool ElasticStages::take_as_stiff(std::vector<Index> rods, double h, double stiff, const SparseRows& G,
                                  const SparseRows& D) {
  held_ = std::move(rods);
  if (held_.empty()) return false;
  const Index n = G.cols(), m = G.rows(), count = std::ssize(held_);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_row = [&](const SparseRows& A, Index from, Index to) {
    for (SparseRows::InnerIterator it(A, from); it; ++it)
      entries.emplace_back(static_cast<int>(to), static_cast<int>(it.col()), it.value());
  };
  for (Index r = 0; r < m; ++r) add_row(G, r, r);
  for (Index k = 0; k < count; ++k) {
    const Index rod = held_[static_cast<std::size_t>(k)];
    add_row(D, rod, m + k);
    entries.emplace_back(static_cast<int>(m + k), static_cast<int>(n + k),
                         -stiff * std::sqrt(compliance_[rod]) / std::abs(h));
  }
  SparseRows rows(m + count, n + count);
  rows.setFromTriplets(entries.begin(), entries.end());
  const auto same_places = [&] {
    return rows.rows() == rows_.rows() && rows.nonZeros() == rows_.nonZeros() &&
           std::equal(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows(), rows_.outerIndexPtr()) &&
           std::equal(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros(), rows_.innerIndexPtr());
  };
  if (!saddle_ || !same_places()) {
    const SparseRows& own = system_.mass();
    std::vector<Eigen::Triplet<double>> masses;
    for (Index i = 0; i < n; ++i)
      for (SparseRows::InnerIterator it(own, i); it; ++it)
        masses.emplace_back(static_cast<int>(i), static_cast<int>(it.col()), it.value());
    for (Index k = n; k < n + count; ++k) masses.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.0);
    SparseRows mass(n + count, n + count);
    mass.setFromTriplets(masses.begin(), masses.end());
    saddle_ = std::make_unique<SaddleSolver>(mass, rows);
  }
  rows_.swap(rows);
  G_ = G, D_ = D;
  if (saddle_->factorise(rows_)) return true;
  return held_.clear(), false;
}

VectorXd ElasticStages::rates_of(const VectorXd& w) const {
  VectorXd out = VectorXd::Zero(std::ssize(held_));
  for (Index k = 0; k < out.size(); ++k)
    for (SparseRows::InnerIterator it(D_, held_[static_cast<std::size_t>(k)]); it; ++it)
      out[k] += it.value() * w[it.col()];
  return out;
}

// P = 10 S^3 - 15 S^4 + 6 S^5: 10 X^3 of slow modes, all but 10 / X^3 of fast ones.
ElasticStages::Answer ElasticStages::answer(VectorXd r) const {
  constexpr double share[] = {0, 0, 10, -15, 6};
  const Index n = G_.cols(), m = G_.rows(), count = r.size();
  const VectorXd none = VectorXd::Zero(n + count);
  Answer out{VectorXd::Zero(n), VectorXd::Zero(m), VectorXd::Zero(count)};
  VectorXd x(n + count), y(m + count), g = VectorXd::Zero(m + count);
  for (const double c : share) {
    g.tail(count) = r;
    saddle_->solve(none, g, x, y);
    r = rates_of(x.head(n));
    out.x += c * x.head(n), out.mu += c * y.head(m), out.nu += c * y.tail(count);
  }
  return out;
}

void ElasticStages::still(double fast, double stiff, double t, double h, const VectorXd& q,
                          const SparseRows& G, VectorXd& w, VectorXd& mu) {
  if (!as_unknowns) return held_.clear();
  std::vector<Index> fastest;
  const SparseRows D = system_.giving_rod_directions(q);
  for (Index i = 0; i < D.rows(); ++i)
    if (h_omega(i, h, D) > fast) fastest.push_back(i);
  if (!take_as_stiff(std::move(fastest), h, stiff, G, D)) return;
  VectorXd r = -rates_of(w);
  for (std::size_t k = 0; k < held_.size(); ++k)
    r[static_cast<Index>(k)] += rods_->rods()[static_cast<std::size_t>(held_[k])].rest_rate(t);
  const Answer taken = answer(std::move(r));
  w += taken.x, mu += taken.mu;
}

void ElasticStages::find_still_forces(double t, const VectorXd& q, const VectorXd& v, VectorXd& force) {
  VectorXd f = VectorXd::Zero(q.size()), reduced(G_.cols()), bias(G_.rows()), a(G_.cols()), y(G_.rows());
  system_.add_other_force(t, q, v, force, 1.0, f);
  rods_->add_forces(q.data(), force.data(), 1.0, f.data());
  system_.reduce_force(f, reduced);
  system_.constraint_bias(t, q, v, bias);
  if (!rigid_) rigid_ = std::make_unique<SaddleSolver>(system_.mass(), G_);
  if (!rigid_->factorise(G_)) return;
  rigid_->solve(reduced, -bias, a, y);
  VectorXd r = -rates_of(a);
  for (std::size_t k = 0; k < held_.size(); ++k)
    r[static_cast<Index>(k)] +=
        length_acceleration(rods_->rods()[static_cast<std::size_t>(held_[k])], t, q, v);
  const VectorXd change = answer(std::move(r)).nu;
  if (!change.allFinite()) return;
  for (std::size_t k = 0; k < held_.size(); ++k) force[held_[k]] += change[static_cast<Index>(k)];
}

}  // namespace unfurl
