// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/elastic_sharing.hpp"

#include <limits>

namespace unfurl {

namespace {

constexpr std::size_t most_before = 5;  // states that a limit is extrapolated from

}  // namespace

VectorXd row_compliance(const Model& model) {
  const std::vector<Rod>& rods = model.structure.rods;
  VectorXd compliance = VectorXd::Zero(model.system.constraints());
  for (std::size_t r = 0; r < rods.size(); ++r)
    if (!rods[r].gives) compliance[model.system.rod_rows()[r]] = rods[r].compliance();
  return compliance.isZero(0.0) ? VectorXd() : compliance;
}

ElasticSharing::ElasticSharing(const Model& model, bool all_determined) : system_(model.system) {
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
  if (!least_->share(G_, lambda)) return;
  if (!last_.empty() && !(last_.back().t < t)) last_.clear();  // an impulse
  last_.push_back({t, lambda - given});
  if (last_.size() > most_before) last_.pop_front();
}

// Lagrange's polynomial in time through the last changes.
VectorXd ElasticSharing::at_limit(double t) const {
  VectorXd sum = VectorXd::Zero(last_.back().lambda.size());
  for (const Change& at : last_) {
    double weight = 1;
    for (const Change& other : last_)
      if (&other != &at) weight *= (t - other.t) / (at.t - other.t);
    sum += weight * at.lambda;
  }
  return sum;
}

}  // namespace unfurl
