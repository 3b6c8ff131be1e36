// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/part_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

PartSizes::PartSizes(const System& system) : IndependentParts(system), system_(system) {
  if (several()) felt_ = system.felt_coordinates();
}

void PartSizes::look(double t, const VectorXd& q, const VectorXd& v) {
  if (!several() || system_.constant_forces()) return;
  felt_ = system_.felt_coordinates(t, q, v);
  join_by_forces(system_, t, q, v);
  if (q_.size() > 0) place();
}

void PartSizes::start(const VectorXd& q) {
  q_ = q;
  place();
}

void PartSizes::place() {
  reaches_.setZero(felt_.rows());
  for (int i = 0; i < felt_.outerSize(); ++i)
    for (SparseRows::InnerIterator it(felt_, i); it; ++it)
      reaches_[i] = std::max(reaches_[i], std::abs(q_[it.col()]));
  part_reach_ = largest(reaches_.data());
  least_mass_ = largest(system_.mass().diagonal().cwiseInverse().eval().data()).cwiseInverse();
  shortest_ = largest_of_rows(system_.constraint_lengths().cwiseInverse()).cwiseInverse();
}

// In a part on which nothing acts the residual is the only term: none but zero would be round-off.
VectorXd PartSizes::least(double scale) const {
  constexpr double least_reach = 1e-9, trifle = 1e-6;
  const double whole = part_reach_.maxCoeff();
  const VectorXd reach = part_reach_.cwiseMax(least_reach * whole);
  return spread((trifle * harmless_noise / scale) * least_mass_.cwiseProduct(reach));
}

PartSizes::Care PartSizes::care(const SaddleSolver& saddle, const VectorXd& motion, double harmless,
                                double strong) const {
  constexpr double unit = std::numeric_limits<double>::epsilon();
  const VectorXd& lengths = system_.constraint_lengths();
  const VectorXd length = largest_of_rows(lengths), row = largest_of_rows(saddle.row_scale()),
                 column = largest(saddle.column_scale().data());
  const double whole = q_.lpNorm<Eigen::Infinity>();
  Care out;
  for (Index r = 0; r < lengths.size(); ++r) {
    const Index p = of_row(r);
    const double far = whole <= far_reach * shortest_[p] ? whole : part_reach_[p],
                 reach = std::max(far, length[p]),
                 sigma = row[p] * column[p] * 2 * unit * reach / std::max(harmless * motion[p], 1e-300),
                 own = std::pow(std::min(sigma, strong), 2);
    out.always = out.always || (sigma > 1 && motion[p] > unit * reach);
    if (own > out.pivot && saddle.may_be_below(r, own)) out.pivot = own;
  }
  return out;
}

}  // namespace unfurl
