// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/friction_hold.hpp"

#include <algorithm>
#include <cmath>

#include "core/math/box_complementarity.hpp"

namespace unfurl {
namespace {

constexpr double connected = 1e-9;  // of the largest share
constexpr double met = 1e-11;       // of a load: what rounding leaves of it

VectorXd bounded(const VectorXd& tau) {
  return tau.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

// Those that `held` is connected with, by turns over the resting and the held ones.
void collect(const MatrixXd& linked, Index held, std::vector<Index>& all, std::vector<Index>& resting) {
  std::vector<bool> seen(static_cast<std::size_t>(linked.rows()), false);
  all = {held};
  for (std::size_t k = 0; k < all.size(); ++k)
    for (Index j = 0; j < linked.rows(); ++j) {
      if (linked(j, all[k]) == 0 || seen[static_cast<std::size_t>(j)]) continue;
      seen[static_cast<std::size_t>(j)] = true;
      resting.push_back(j);
      for (Index i = 0; i < linked.cols(); ++i)
        if (linked(j, i) != 0 && std::find(all.begin(), all.end(), i) == all.end()) all.push_back(i);
    }
}

// The largest t for which t l = A x has an x with |x| <= tau, or x >= 0 where tau has no bound. Where t is
// too large, what the nearest x of those leaves, r = t l - A x, is normal to a plane that bounds all A x: r .
// A x <= sum tau_j |a_j . r| over the bounded ones, where t is tried next. The bounds are faces of a
// polyhedron, so that this ends. What needs no friction counts as held up to far beyond all friction.
double most(const MatrixXd& A, const VectorXd& l, const VectorXd& tau) {
  constexpr double far = 100;
  const VectorXd most_of_each = bounded(tau), low = -most_of_each;
  const double size = l.lpNorm<Eigen::Infinity>();
  const auto bound = [&](const VectorXd& r) {
    return (A.transpose() * r).cwiseAbs().dot(most_of_each) / l.dot(r);
  };
  double t = tau.allFinite() ? bound(l) : far * most_of_each.sum() / size;
  for (;;) {
    const auto nearest = solve_box(A.transpose() * A, -t * (A.transpose() * l), low, tau);
    if (!nearest) return t;
    const VectorXd r = t * l - A * nearest->x;
    if (r.lpNorm<Eigen::Infinity>() <= met * t * size) return t;
    const double next = bound(r);
    if (!(next < t)) return t;
    t = next;
  }
}

}  // namespace

std::vector<FrictionHold> friction_holds(const MatrixXd& c, const VectorXd& lambda, const VectorXd& tau_held,
                                         const VectorXd& tau_resting) {
  const double least = c.size() > 0 ? connected * c.cwiseAbs().maxCoeff() : 0.0;
  const MatrixXd linked = c.unaryExpr([&](double x) { return std::abs(x) > least ? x : 0.0; });
  std::vector<FrictionHold> out;
  std::vector<bool> done(static_cast<std::size_t>(lambda.size()), false);
  for (Index i = 0; i < lambda.size(); ++i) {
    if (done[static_cast<std::size_t>(i)]) continue;
    FrictionHold hold;
    std::vector<Index> resting;
    collect(linked, i, hold.held, resting);
    for (const Index k : hold.held) done[static_cast<std::size_t>(k)] = true;
    const auto rows = std::ssize(hold.held), all = rows + std::ssize(resting);
    MatrixXd A(rows, all);
    A << MatrixXd::Identity(rows, rows), linked(resting, hold.held).transpose();
    VectorXd tau(all);
    tau << tau_held(hold.held), tau_resting(resting);
    const VectorXd l = lambda(hold.held);
    hold.load = l.lpNorm<Eigen::Infinity>();
    if (rows == 1 && tau.allFinite())
      hold.capacity = A.row(0).cwiseAbs().dot(tau);
    else
      hold.capacity = hold.load > 0 ? most(A, l, tau) * hold.load : bounded(tau).sum();
    out.push_back(std::move(hold));
  }
  return out;
}

}  // namespace unfurl
