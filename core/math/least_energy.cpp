// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/least_energy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/determined_rows.hpp"

namespace unfurl {
namespace {

// p, relative to the mean compliance. Small: few steps; but coordinates that members alone hold then show as
// singular values of sqrt(p), which the solver must tell from none.
constexpr double proximal = 1e-5;
constexpr int most_steps = 60;
constexpr double settled = 1e-15;  // change of a guide's force in a step, of the largest force
constexpr double weak = 1e-11;     // pivots below this are solved for in twice the digits

VectorXd relative(VectorXd compliance) {
  const double mean = compliance.sum() / static_cast<double>((compliance.array() > 0).count());
  return compliance / mean;
}

SparseRows weights(const VectorXd& compliance) {
  SparseRows M(compliance.size(), compliance.size());
  M.setIdentity();
  for (Index i = 0; i < compliance.size(); ++i)
    M.coeffRef(i, i) = compliance[i] > 0 ? compliance[i] : proximal;
  return M;
}

}  // namespace

LeastEnergy::LeastEnergy(const SparseRows& G, VectorXd compliance)
    : compliance_(relative(std::move(compliance))),
      solver_(weights(compliance_), SparseRows(G.transpose())),
      norm_(VectorXd::Ones(G.rows())),
      force_(G.rows()),
      change_(G.rows()),
      before_(G.rows()),
      displacement_(G.cols()) {}

// Guides are taken in rows of unit length, forces on them accordingly.
bool LeastEnergy::share(const SparseRows& G, MutVec y) {
  if (G.cols() == 0) {  // no equation asks for a force
    for (Index i = 0; i < y.size(); ++i)
      if (compliance_[i] > 0) y[i] = 0;
    return true;
  }
  SparseRows unit = G;
  for (Index i = 0; i < unit.rows(); ++i)
    if (const double norm = unit.row(i).norm(); norm > 0 && compliance_[i] == 0) {
      unit.row(i) /= norm;
      norm_[i] = norm;
    }
  if (!solver_.factorise(without_round_off_transposed(unit))) return false;
  solver_.weakest_pivot(weak);
  const VectorXd none = VectorXd::Zero(G.cols());
  const double size = y.lpNorm<Eigen::Infinity>();
  before_.setZero();
  for (int step = 0; step < most_steps; ++step) {
    for (Index i = 0; i < y.size(); ++i)
      force_[i] = compliance_[i] > 0 ? -compliance_[i] * y[i] : proximal * before_[i];
    solver_.solve(force_, none, change_, displacement_);
    if (!change_.allFinite()) return false;
    double moved = 0;
    for (Index i = 0; i < y.size(); ++i)
      if (compliance_[i] == 0) moved = std::max(moved, std::abs(change_[i] - before_[i]));
    before_ = change_;
    if (moved <= settled * size) break;
  }
  y += change_.cwiseQuotient(norm_);
  return true;
}

}  // namespace unfurl
