// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/elastic_sharing.hpp"

#include <cstddef>
#include <limits>

#include "core/math/lagrange.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_before = 5;  // states that a limit is extrapolated from

// Told the row and 1 + e of every rigid rod that warms.
template <class Visit>
void for_each_warmed(const Structure& structure, const System& system, double t, const Visit& visit) {
  for (std::size_t r = 0; r < structure.rods.size(); ++r) {
    const Rod& rod = structure.rods[r];
    if (!rod.gives && rod.expansion != 0) visit(system.rod_rows()[r], 1 + rod.warmed(t));
  }
}

}  // namespace

VectorXd row_compliance(const Model& model) {
  const std::vector<Rod>& rods = model.structure.rods;
  VectorXd compliance = VectorXd::Zero(model.system.constraints());
  for (std::size_t r = 0; r < rods.size(); ++r)
    if (!rods[r].gives) compliance[model.system.rod_rows()[r]] = rods[r].compliance();
  return compliance.isZero(0.0) ? VectorXd() : compliance;
}

VectorXd row_compliance(const Model& model, double t) {
  VectorXd compliance = row_compliance(model);
  if (compliance.size() > 0)
    for_each_warmed(model.structure, model.system, t,
                    [&](int row, double longer) { compliance[row] *= longer * longer; });
  return compliance;
}

ElasticSharing::ElasticSharing(const Model& model, bool all_determined)
    : system_(model.system), structure_(model.structure) {
  VectorXd compliance = row_compliance(model);
  if (all_determined || compliance.size() == 0) return;
  G_ = system_.jacobian_pattern();
  least_ = std::make_unique<LeastEnergy>(G_, std::move(compliance));
}

void ElasticSharing::share(double t, const VectorXd& q, bool limit, VectorXd& lambda) {
  if (!least_) return;
  if (!lambda.allFinite()) {  // nobody knows the others' shares of what has no bound
    if (limit) lambda.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  if (limit) {
    if (!last_.empty()) lambda += at_limit(t);
    return;
  }
  const VectorXd given = lambda;
  system_.jacobian(q, G_, scratch_);
  // By axial forces and stretches, whose compliances stay.
  for_each_warmed(structure_, system_, t, [&](int row, double longer) {
    G_.row(row) /= longer;
    lambda[row] *= longer;
  });
  if (!least_->share(G_, lambda)) {
    lambda = given;
    return;
  }
  for_each_warmed(structure_, system_, t, [&](int row, double longer) { lambda[row] /= longer; });
  if (!last_.empty() && !(last_.back().t < t)) last_.clear();  // an impulse
  last_.push_back({t, lambda - given});
  if (last_.size() > most_before) last_.pop_front();
}

// The polynomial in time through the last changes.
VectorXd ElasticSharing::at_limit(double t) const {
  VectorXd sum = VectorXd::Zero(last_.back().lambda.size());
  const auto time = [&](std::size_t k) { return last_[k].t; };
  for (std::size_t k = 0; k < last_.size(); ++k)
    sum += lagrange_weight(k, last_.size(), t, time) * last_[k].lambda;
  return sum;
}

}  // namespace unfurl
