// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/elastic_stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/determined_rows.hpp"

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

// Factors are analysed anew where other rods are held than before.
void ElasticStages::stack(const SparseRows& G, const SparseRows& D) {
  const Index m = G.rows();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_row = [&](const SparseRows& A, Index from, Index to) {
    for (SparseRows::InnerIterator it(A, from); it; ++it)
      entries.emplace_back(static_cast<int>(to), static_cast<int>(it.col()), it.value());
  };
  for (Index r = 0; r < m; ++r) add_row(G, r, r);
  for (std::size_t k = 0; k < held_.size(); ++k) add_row(D, held_[k], m + static_cast<Index>(k));
  SparseRows rows(m + std::ssize(held_), G.cols());
  rows.setFromTriplets(entries.begin(), entries.end());
  const auto same_places = [&] {
    return rows.rows() == rows_.rows() && rows.nonZeros() == rows_.nonZeros() &&
           std::equal(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows(), rows_.outerIndexPtr()) &&
           std::equal(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros(), rows_.innerIndexPtr());
  };
  if (!saddle_ || !same_places()) saddle_ = std::make_unique<SaddleSolver>(system_.mass(), rows);
  rows_.swap(rows);
}

bool ElasticStages::take_as_rigid(std::vector<Index> rods, const SparseRows& G, const SparseRows& D) {
  if (rods.empty()) return held_.clear(), false;
  if (rods != stacked_) shared_.reset(), saddle_.reset(), stacked_ = rods;
  held_ = std::move(rods);
  stack(G, D);
  if (saddle_->factorise(rows_)) return true;
  return held_.clear(), false;
}

bool ElasticStages::still(double fast, double t, double h, const VectorXd& q, const Rigid& rigid, VectorXd& w,
                          VectorXd& mu) {
  if (!as_unknowns) return held_.clear(), false;
  std::vector<Index> fastest;
  const SparseRows D = system_.giving_rod_directions(q);
  for (Index i = 0; i < D.rows(); ++i)
    if (h_omega(i, h, D) > fast) fastest.push_back(i);
  if (!take_as_rigid(std::move(fastest), rigid.G, D)) return false;
  const Index m = rigid.G.rows();
  VectorXd rates(rows_.rows()), impulse(rows_.rows());
  rates.head(m) = rigid.rate;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Rod& rod = rods_->rods()[static_cast<std::size_t>(held_[k])];
    rates[m + static_cast<Index>(k)] = rod.rest_rate(t);
  }
  saddle_->solve(rigid.p, rates, w, impulse);
  mu = impulse.head(m);
  return true;
}

void ElasticStages::find_still_forces(double t, const VectorXd& q, const VectorXd& v, VectorXd& force) {
  const Index m = rows_.rows() - std::ssize(held_);
  VectorXd f = VectorXd::Zero(q.size()), reduced(rows_.cols()), bias(rows_.rows()), a(rows_.cols()),
           change(rows_.rows()), G_bias(m);
  system_.add_other_force(t, q, v, force, 1.0, f);
  rods_->add_forces(q.data(), force.data(), 1.0, f.data());
  system_.reduce_force(f, reduced);
  system_.constraint_bias(t, q, v, G_bias);
  bias.head(m) = -G_bias;
  for (std::size_t k = 0; k < held_.size(); ++k)
    bias[m + static_cast<Index>(k)] =
        length_acceleration(rods_->rods()[static_cast<std::size_t>(held_[k])], t, q, v);
  saddle_->solve(reduced, bias, a, change);
  if (!change.allFinite()) return;
  if (!shared_) {
    const std::vector<char> determined = determined_rows(rows_);
    shared_ = std::find(determined.begin(), determined.end(), 0) != determined.end();
    VectorXd compliance = VectorXd::Zero(rows_.rows());
    for (std::size_t k = 0; k < held_.size(); ++k)
      compliance[m + static_cast<Index>(k)] = compliance_[held_[k]];
    if (*shared_) least_ = std::make_unique<LeastEnergy>(rows_, compliance);
  }
  if (*shared_) least_->share(rows_, change);
  for (std::size_t k = 0; k < held_.size(); ++k) force[held_[k]] += change[m + static_cast<Index>(k)];
}

}  // namespace unfurl
