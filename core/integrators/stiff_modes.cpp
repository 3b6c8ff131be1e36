// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/stiff_modes.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

// l'' - |u_across|^2 / |d|: n . (a_b - a_a) of a rod whose length is that without force [m/s^2].
double length_acceleration(const Rod& rod, double t, const VectorXd& q, const VectorXd& v) {
  const Vec3 d = node_vector(q.data(), rod.b) - node_vector(q.data(), rod.a),
             u = node_vector(v.data(), rod.b) - node_vector(v.data(), rod.a);
  const double length = d.norm(), along = d.dot(u) / length;
  return rod.natural_length() * rod.warmed(t, 2) - (u.squaredNorm() - along * along) / length;
}

}  // namespace

const Rod& StiffModes::rod_at(Index k) const {
  return system_.elastic_rods()->rods()[static_cast<std::size_t>(rods_[static_cast<std::size_t>(k)])];
}

// Each held rod has a coordinate of its own besides, of mass 1, by which it gives: D x - kappa s = r with
// kappa = stiff sqrt(C) / h leaves x the share S = X / (1 + X) of r in a mode of X = (h omega / stiff)^2.
bool StiffModes::take(std::vector<Index> rods, double h, double stiff, const SparseRows& G,
                      const SparseRows& D) {
  rods_ = std::move(rods);
  if (rods_.empty()) return false;
  const Index n = G.cols(), m = G.rows(), count = std::ssize(rods_);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_row = [&](const SparseRows& A, Index from, Index to) {
    for (SparseRows::InnerIterator it(A, from); it; ++it)
      entries.emplace_back(static_cast<int>(to), static_cast<int>(it.col()), it.value());
  };
  for (Index r = 0; r < m; ++r) add_row(G, r, r);
  for (Index k = 0; k < count; ++k) {
    const Index rod = rods_[static_cast<std::size_t>(k)];
    add_row(D, rod, m + k);
    entries.emplace_back(static_cast<int>(m + k), static_cast<int>(n + k),
                         -stiff * std::sqrt(rod_at(k).compliance()) / std::abs(h));
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
  return rods_.clear(), false;
}

StiffModes::Answer StiffModes::stopping(double t, const VectorXd& w) const {
  VectorXd r = -rates_of(w);
  for (Index k = 0; k < r.size(); ++k) r[k] += rod_at(k).rest_rate(t);
  return answer(std::move(r));
}

void StiffModes::still(double t, VectorXd& w, VectorXd& mu) const {
  if (rods_.empty()) return;
  const Answer taken = stopping(t, w);
  w += taken.x, mu += taken.mu;
}

VectorXd StiffModes::impulse(double t, const VectorXd& w) const {
  VectorXd out = VectorXd::Zero(D_.rows());
  if (rods_.empty()) return out;
  const VectorXd nu = stopping(t, w).nu;
  for (Index k = 0; k < nu.size(); ++k) out[rods_[static_cast<std::size_t>(k)]] = nu[k];
  return out;
}

VectorXd StiffModes::rates_of(const VectorXd& w) const {
  VectorXd out = VectorXd::Zero(std::ssize(rods_));
  for (Index k = 0; k < out.size(); ++k)
    for (SparseRows::InnerIterator it(D_, rods_[static_cast<std::size_t>(k)]); it; ++it)
      out[k] += it.value() * w[it.col()];
  return out;
}

// P = 10 S^3 - 15 S^4 + 6 S^5: 10 X^3 of slow modes, all but 10 / X^3 of fast ones.
StiffModes::Answer StiffModes::answer(VectorXd r) const {
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

void StiffModes::find_forces(double t, const VectorXd& q, const VectorXd& v, VectorXd& force) {
  VectorXd f = VectorXd::Zero(q.size()), reduced(G_.cols()), bias(G_.rows()), a(G_.cols()), y(G_.rows());
  system_.add_other_force(t, q, v, force, 1.0, f);
  system_.elastic_rods()->add_forces(q.data(), force.data(), 1.0, f.data());
  system_.reduce_force(f, reduced);
  system_.constraint_bias(t, q, v, bias);
  if (!rigid_) rigid_ = std::make_unique<SaddleSolver>(system_.mass(), G_);
  if (!rigid_->factorise(G_)) return;
  rigid_->solve(reduced, -bias, a, y);
  VectorXd r = -rates_of(a);
  for (Index k = 0; k < r.size(); ++k) r[k] += length_acceleration(rod_at(k), t, q, v);
  const VectorXd change = answer(std::move(r)).nu;
  if (!change.allFinite()) return;
  for (Index k = 0; k < change.size(); ++k) force[rods_[static_cast<std::size_t>(k)]] += change[k];
}

VectorXd StiffModes::motion_of(const VectorXd& stretch, VectorXd& nu) const {
  VectorXd r(std::ssize(rods_));
  for (Index k = 0; k < r.size(); ++k) r[k] = stretch[rods_[static_cast<std::size_t>(k)]];
  const Answer asked = answer(std::move(r));
  for (Index k = 0; k < asked.nu.size(); ++k) nu[rods_[static_cast<std::size_t>(k)]] -= asked.nu[k];
  return asked.x;
}

}  // namespace unfurl
