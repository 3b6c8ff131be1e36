// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/push_responses.hpp"

#include <algorithm>
#include <cmath>

#include "core/integrators/independent_parts.hpp"
#include "core/integrators/index1.hpp"
#include "core/math/factors.hpp"
#include "core/simulate/force_sizes.hpp"

namespace unfurl {

PushResponses::PushResponses(const System& system, const State& state)
    : system_(system), G_(system.jacobian_pattern()), saddle_(system.mass(), G_), q_(system.coordinates()) {
  std::vector<double> scratch;
  system.expand(state.z, q_);
  system.jacobian(q_, G_, scratch);
  ok_ = saddle_.factorise(G_);
}

void PushResponses::add(const MeasureFunction& s, double sign, double near, const LimitMotion& limit) {
  const auto& stencil = s.stencil();
  VectorXd gradient(static_cast<Index>(stencil.size())), node_force = VectorXd::Zero(q_.size()),
                                                         of_nodes = node_force;
  s.value_and_gradient(q_.data(), gradient.data(), near);
  for (std::size_t k = 0; k < stencil.size(); ++k)
    node_force[stencil[k]] += sign * gradient[static_cast<Index>(k)];
  // A coordinate's share of a gradient is rounded as its node's whole one.
  for (const int k : stencil) {
    const Index x = k - k % 3;
    of_nodes.segment(x, 3).setConstant(node_force.segment(x, 3).lpNorm<Eigen::Infinity>());
  }
  const Index n = system_.solved_coordinates();
  VectorXd sizes(n);
  system_.reduce_sizes(of_nodes, sizes);
  Row row{.measure = &s,
          .sign = sign,
          .n = VectorXd(n),
          .a = VectorXd(n),
          .mu = VectorXd(system_.constraints()),
          .size = n > 0 ? sizes.maxCoeff() : 0.0,
          .limit = limit};
  system_.reduce_force(node_force, row.n);
  saddle_.solve(row.n, VectorXd::Zero(row.mu.size()), row.a, row.mu);
  rows_.push_back(std::move(row));
}

MatrixXd PushResponses::matrix() const {
  MatrixXd D(size(), size());
  for (Index i = 0; i < size(); ++i)
    for (Index j = 0; j < size(); ++j) {
      const Row &r = rows_[static_cast<std::size_t>(i)], &c = rows_[static_cast<std::size_t>(j)];
      D(i, j) = 0.5 * (r.n.dot(c.a) + c.n.dot(r.a));
    }
  return D;
}

bool PushResponses::movable(Index i) const {
  const Row& row = rows_[static_cast<std::size_t>(i)];
  if (row.n.size() == 0) return false;
  constexpr double of_rounding = 1e-9;  // of a gradient: what linear constraints leave of it
  const double most = row.n.lpNorm<Eigen::Infinity>();
  return most > of_rounding * row.size &&
         row.n.dot(row.a) > 1e-12 * most * most / system_.mass().diagonal().maxCoeff();
}

VectorXd PushResponses::rates(const VectorXd& w) const {
  VectorXd out(size());
  for (Index i = 0; i < size(); ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    out[i] = row.n.dot(w) - row.sign * row.limit.rate;
  }
  return out;
}

double PushResponses::at_most(Index i, const VectorXd& w) const {
  return rows_[static_cast<std::size_t>(i)].n.lpNorm<1>() * w.lpNorm<Eigen::Infinity>();
}

double PushResponses::taken(Index i, const VectorXd& w) const {
  const Row& row = rows_[static_cast<std::size_t>(i)];
  const double rate = rates(w)[i];
  return rate * rate / (row.n.dot(row.a) * w.dot(system_.mass() * w));
}

void PushResponses::give(const VectorXd& P, VectorXd& w) const {
  for (Index i = 0; i < size(); ++i)
    if (P[i] != 0.0) w += P[i] * rows_[static_cast<std::size_t>(i)].a;
}

VectorXd PushResponses::impulses_of(const VectorXd& dw, VectorXd& lambda, double& unexplained) const {
  VectorXd x(dw.size()), P = VectorXd::Zero(size());
  lambda.resize(system_.constraints());
  saddle_.solve(VectorXd::Zero(dw.size()), G_ * dw, x, lambda);
  VectorXd rest = dw - x;
  std::vector<Index> rows;
  for (Index i = 0; i < size(); ++i)
    if (movable(i)) rows.push_back(i);
  if (!rows.empty()) {
    VectorXd rates(size());
    for (Index i = 0; i < size(); ++i) rates[i] = rows_[static_cast<std::size_t>(i)].n.dot(rest);
    const MatrixXd D = matrix();
    P(rows) = least_squares(D(rows, rows), rates(rows));
  }
  for (const Index i : rows) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    rest -= P[i] * row.a;
    lambda += P[i] * row.mu;
  }
  const double all = dw.dot(system_.mass() * dw);
  unexplained = all > 0 ? std::sqrt(rest.dot(system_.mass() * rest) / all) : 0.0;
  return P;
}

double PushResponses::spread(Index i) const {
  const Row& row = rows_[static_cast<std::size_t>(i)];
  return std::max(row.size, row.n.lpNorm<Eigen::Infinity>()) * row.a.lpNorm<Eigen::Infinity>() /
         row.n.dot(row.a);
}

VectorXd PushResponses::largest_multipliers(const State& state, const VectorXd& lambda) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < size(); ++i)
    for (Index k = 0; k < system_.solved_coordinates(); ++k)
      if (const double n = rows_[static_cast<std::size_t>(i)].n[k]; n != 0)
        entries.emplace_back(static_cast<int>(i), static_cast<int>(k), n);
  SparseRows pushes(size(), system_.solved_coordinates());
  pushes.setFromTriplets(entries.begin(), entries.end());
  IndependentParts parts(system_);
  VectorXd v(q_.size());
  system_.expand_rate(state.w, v);
  parts.join_by_forces(system_, state.t, q_, v);
  parts.join(pushes);
  const VectorXd most = parts.largest_of_rows(lambda);
  VectorXd out = VectorXd::Constant(size(), lambda.lpNorm<Eigen::Infinity>());
  for (int i = 0; i < pushes.outerSize(); ++i)
    if (const SparseRows::InnerIterator it(pushes, i); it) out[i] = most[parts.of(it.col())];
  return out;
}

// n . w' = a . F + ..., and by what rounds in F it is off.
PushResponses::Accelerations PushResponses::accelerations(const Structure& structure,
                                                          const State& state) const {
  VectorXd acceleration(state.w.size()), lambda = VectorXd::Zero(system_.constraints()), v(q_.size());
  Index1 index1(system_);
  if (!index1.evaluate(state, acceleration, lambda)) return {};
  system_.expand_rate(state.w, v);
  const VectorXd sizes = force_sizes(system_, structure, state, lambda);
  const double fastest = acceleration.lpNorm<Eigen::Infinity>();
  const double freely =
      sizes.size() > 0 ? sizes.cwiseQuotient(VectorXd(system_.mass().diagonal())).maxCoeff() : 0.0;
  Accelerations out{VectorXd(size()), VectorXd(size()), VectorXd(size()), VectorXd(size()),
                    largest_multipliers(state, lambda)};
  for (Index i = 0; i < size(); ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    const double curvature = row.measure->curvature_along(q_.data(), v.data());
    out.value[i] = row.n.dot(acceleration) + row.sign * (curvature - row.limit.acceleration);
    out.of_coordinates[i] = row.n.lpNorm<1>() * fastest;
    out.uncancelled[i] = row.n.lpNorm<1>() * freely;
    out.terms[i] = row.a.cwiseAbs().dot(sizes) + row.n.cwiseAbs().dot(acceleration.cwiseAbs()) +
                   std::abs(curvature) + std::abs(row.limit.acceleration);
  }
  return out;
}

}  // namespace unfurl
