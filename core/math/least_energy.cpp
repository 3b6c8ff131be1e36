// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/least_energy.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/math/determined_rows.hpp"

namespace unfurl {
namespace {

// p: of the mean compliance, or of the smallest one, of which a direction has some share. Small: few steps;
// but coordinates that members alone hold then show as singular values of sqrt(p), which the solver must tell
// from none, be they as soft as they may.
constexpr double of_mean = 1e-5, of_stiffest = 0.1, least_proximal = 1e-13;
constexpr int most_steps = 300;
// Change in a step, of the largest force: done; and where it goes on, or has grown so many times, which is
// round-off, what may be left.
constexpr double settled = 1e-15, nearly = 1e-9, rough = 1e-2;
constexpr int most_grown = 3;
constexpr double weak = 1e-11;  // pivots below this are solved for in twice the digits

VectorXd relative(VectorXd compliance) {
  const double mean = compliance.sum() / static_cast<double>((compliance.array() > 0).count());
  return compliance / mean;
}

double proximal(const VectorXd& compliance) {
  double stiffest = 1;
  for (const double c : compliance)
    if (c > 0) stiffest = std::min(stiffest, c);
  return std::max(std::min(of_mean, of_stiffest * stiffest), least_proximal);
}

SparseRows weights(const VectorXd& compliance) {
  const double p = proximal(compliance);
  SparseRows M(compliance.size(), compliance.size());
  M.setIdentity();
  for (Index i = 0; i < compliance.size(); ++i) M.coeffRef(i, i) = compliance[i] > 0 ? compliance[i] : p;
  return M;
}

}  // namespace

LeastEnergy::LeastEnergy(const SparseRows& G, VectorXd compliance)
    : compliance_(relative(std::move(compliance))),
      solver_(weights(compliance_), SparseRows(G.transpose())),
      norm_(VectorXd::Ones(G.rows())),
      force_(G.rows()),
      change_(G.rows()),
      step_(G.rows()),
      displacement_(G.cols()) {}

// Guides are taken in rows of unit length, forces on them accordingly. Each step is solved for by itself, of
// what is not shared and not balanced yet: what soft members have in the first one leaves no round-off in
// what stiff ones have in the last.
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
  const SparseRows across = without_round_off_transposed(unit);
  if (!solver_.factorise(across)) return false;
  solver_.weakest_pivot(weak);
  const double size = y.lpNorm<Eigen::Infinity>();
  change_.setZero();
  double moved = std::numeric_limits<double>::infinity();
  int grown = 0;
  for (int step = 0; step < most_steps && moved > settled * size && grown < most_grown; ++step) {
    for (Index i = 0; i < y.size(); ++i) force_[i] = -compliance_[i] * (y[i] + change_[i]);
    solver_.solve(force_, -(across * change_), step_, displacement_);
    if (!step_.allFinite()) return false;
    change_ += step_;
    const double before = moved;
    moved = step_.lpNorm<Eigen::Infinity>();
    grown += moved >= before ? 1 : 0;
  }
  if (!(moved <= (grown < most_grown ? nearly : rough) * size)) return false;
  y += change_.cwiseQuotient(norm_);
  return true;
}

}  // namespace unfurl
