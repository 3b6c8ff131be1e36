// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/part_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

PartSizes::PartSizes(const System& system) : IndependentParts(system), system_(system) {}

// Rows go by the reach of their part, or of their own nodes where that is far beyond the shortest length.
void PartSizes::start(const RowNoise& rows) {
  const VectorXd& lengths = system_.constraint_lengths();
  part_reach_ = largest(rows.coordinates().data());
  least_mass_ = largest(system_.mass().diagonal().cwiseInverse().eval().data()).cwiseInverse();
  const VectorXd shortest = largest_of_rows(lengths.cwiseInverse()).cwiseInverse();
  row_reach_.resize(lengths.size());
  for (Index r = 0; r < lengths.size(); ++r) {
    const Index p = of_row(r);
    row_reach_[r] = part_reach_[p] <= far_reach * shortest[p] ? part_reach_[p] : rows.reach(r);
  }
}

// In a part on which nothing acts the residual is the only term: none but zero would be round-off.
VectorXd PartSizes::harmless(const VectorXd& of_rows, double scale) const {
  constexpr double least_reach = 1e-9, trifle = 1e-6;
  const double whole = part_reach_.size() > 0 ? part_reach_.maxCoeff() : 0.0;
  VectorXd out = largest(of_rows.data());
  for (Index p = 0; p < out.size(); ++p) {
    const double most =
        harmless_noise * least_mass_[p] * std::max(part_reach_[p], least_reach * whole) / scale;
    out[p] = std::max(out[p] <= most ? out[p] : 0.0, trifle * most);
  }
  return out;
}

PartSizes::Care PartSizes::care(const SaddleSolver& saddle, const VectorXd& motion, double harmless,
                                double strong) const {
  constexpr double unit = std::numeric_limits<double>::epsilon();
  const VectorXd& lengths = system_.constraint_lengths();
  const VectorXd length = largest_of_rows(lengths), row = largest_of_rows(saddle.row_scale()),
                 column = largest(saddle.column_scale().data());
  Care out;
  for (Index r = 0; r < lengths.size(); ++r) {
    const Index p = of_row(r);
    const double reach = std::max(part_reach_[p], length[p]),
                 sigma = row[p] * column[p] * 2 * unit * reach / std::max(harmless * motion[p], 1e-300),
                 own = std::pow(std::min(sigma, strong), 2);
    out.always = out.always || (sigma > 1 && motion[p] > unit * reach);
    if (own > out.pivot && saddle.may_be_below(r, own)) out.pivot = own;
  }
  return out;
}

}  // namespace unfurl
