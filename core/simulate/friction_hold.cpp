// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/friction_hold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/box_complementarity.hpp"

namespace unfurl {
namespace {

constexpr double connected = 1e-9;  // of the largest share
constexpr double located = 1e-12;   // of a capacity
constexpr double met = 1e-11;       // of a load: what rounding leaves of it

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

// Is there an x for the load, A x = l, |x| <= tau? Least squares in the box say.
bool bears(const MatrixXd& A, const VectorXd& l, const VectorXd& tau) {
  const auto least = solve_box(A.transpose() * A, -A.transpose() * l, -tau, tau);
  return least && (A * least->x - l).lpNorm<Eigen::Infinity>() <= met * l.lpNorm<Eigen::Infinity>();
}

// The largest t with t l in reach, between what x_j = 0 gives and what each row by itself allows.
double most(const MatrixXd& A, const VectorXd& l, const VectorXd& tau) {
  const VectorXd alone = tau.head(l.size()), reach = A.cwiseAbs() * tau;
  double low = std::numeric_limits<double>::infinity(), high = low;
  for (Index i = 0; i < l.size(); ++i) {
    if (l[i] == 0) continue;
    low = std::min(low, alone[i] / std::abs(l[i]));
    high = std::min(high, reach[i] / std::abs(l[i]));
  }
  while (high - low > located * high) {
    const double t = 0.5 * (low + high);
    (bears(A, t * l, tau) ? low : high) = t;
  }
  return low;
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
    if (rows == 1)
      hold.capacity = A.row(0).cwiseAbs().dot(tau);
    else
      hold.capacity = hold.load > 0 ? most(A, l, tau) * hold.load : tau.sum();
    out.push_back(std::move(hold));
  }
  return out;
}

}  // namespace unfurl
