// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/least_energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/math/determined_rows.hpp"

namespace unfurl {
namespace {

// p: of the mean compliance, or of the smallest one, of which a direction has some share. Small: few steps;
// but coordinates that members alone hold then show as singular values of sqrt(p), which the solver must tell
// from none, be they as soft as they may.
constexpr double of_mean = 1e-5, of_stiffest = 0.1, least_proximal = 1e-13;
constexpr int most_steps = 60, most_small_steps = 300;
// Change of a guide's force in a step, of the largest force: done, or, after so many steps, round-off. Of
// small steps: from how little on growth is round-off, and what may be left where it has grown so many times.
constexpr double settled = 1e-15, nearly = 1e-9, small = 1e-6, rough = 1e-2;
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
  M = (compliance.array() > 0).select(compliance, p).matrix().asDiagonal();
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
  const SparseRows across = without_round_off_transposed(unit);
  if (!solver_.factorise(across)) return false;
  solver_.weakest_pivot(weak);
  const double size = y.lpNorm<Eigen::Infinity>();
  const bool alike = !(proximal(compliance_) < of_mean);
  if (!(alike && by_whole_steps(y, size)) && !by_small_steps(across, y, size)) return false;
  y += change_.cwiseQuotient(norm_);
  return true;
}

// The whole change again in every step, until two of them agree.
bool LeastEnergy::by_whole_steps(const MutVec& y, double size) {
  const VectorXd none = VectorXd::Zero(displacement_.size());
  step_.setZero();
  double moved = std::numeric_limits<double>::infinity();
  for (int step = 0; step < most_steps && !(moved <= settled * size); ++step) {
    for (Index i = 0; i < y.size(); ++i)
      force_[i] = compliance_[i] > 0 ? -compliance_[i] * y[i] : of_mean * step_[i];
    solver_.solve(force_, none, change_, displacement_);
    if (!change_.allFinite()) return false;
    moved = 0;
    for (Index i = 0; i < y.size(); ++i)
      if (compliance_[i] == 0) moved = std::max(moved, std::abs(change_[i] - step_[i]));
    step_ = change_;
  }
  return moved <= nearly * size;
}

// Each step by itself, of what is not shared and not balanced yet: what soft members have in the first one
// leaves no round-off in what stiff ones have in the last.
bool LeastEnergy::by_small_steps(const SparseRows& across, const MutVec& y, double size) {
  change_.setZero();
  double moved = std::numeric_limits<double>::infinity();
  int grown = 0, step = 0;
  for (; step < most_small_steps && moved > settled * size && grown < most_grown; ++step) {
    for (Index i = 0; i < y.size(); ++i) force_[i] = -compliance_[i] * (y[i] + change_[i]);
    solver_.solve(force_, -(across * change_), step_, displacement_);
    if (!step_.allFinite()) return false;
    const double next = step_.lpNorm<Eigen::Infinity>();
    if (next >= moved && moved <= small * size) break;
    grown += next >= moved ? 1 : 0;
    moved = next;
    change_ += step_;
  }
  return moved <= (step < most_small_steps ? rough : nearly) * size;
}

}  // namespace unfurl
