// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/margin_loads.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// A measure that changes by less, of what it does in the mean of the way, is stationary: the end of the way
// is known to the root of round-off where it turns back.
constexpr double stationary_at_end = 1e-6;
constexpr double deployed_there = 1e-8;  // of what is left there
constexpr double same_rates = 1e-6;      // of the rates of latches

class EndLoads {
 public:
  EndLoads(const Structure& structure, const WayEnd& end) : structure_(structure), end_(end) {}

  // Of what changes by `rate` along the way there and by `change` from its start.
  MarginLoad one(std::string name, std::string kind, bool turns, double rate, double change) const {
    const bool bounded = rate > 0 && rate * end_.s >= stationary_at_end * change;
    const double load =
        bounded ? end_.push / rate : std::copysign(std::numeric_limits<double>::infinity(), end_.push);
    return {std::move(name),
            std::move(kind),
            turns,
            load,
            rate * end_.speed,
            0.5 * structure_.sectors * end_.speed * end_.speed};
  }

  MarginLoad latch(double change) const {
    const Deployment& d = structure_.deployment;
    const double range = d.measured ? std::abs(d.deployed - d.stowed) : 1.0;
    return one(d.measured ? "latch of the deployment" : "latch of the fold angle", "latch",
               !d.measured || is_angle(d.measure), range * std::abs(d.remaining_rate(end_.q, end_.dq)),
               range * change);
  }

  // The one of several that bears most, its share of the energy that of the work that it would do.
  MarginLoad share() const {
    const std::vector<LinearForm>& forms = structure_.deployment.latches;
    double most = 0, least = std::numeric_limits<double>::infinity(), sum = 0;
    for (const LinearForm& form : forms) {
      const double rate = std::abs(form.rate(end_.dq));
      most = std::max(most, rate);
      least = std::min(least, rate);
      sum += structure_.sectors * rate * rate;
    }
    const std::string all = std::to_string(std::lround(structure_.sectors * double(forms.size())));
    const bool same = most - least <= same_rates * most;
    return {(same ? "each of " : "most loaded of ") + all + " latches",
            "latch",
            false,
            end_.push * most / sum,
            most * end_.speed,
            0.5 * structure_.sectors * end_.speed * end_.speed * most * most / sum};
  }

 private:
  const Structure& structure_;
  const WayEnd& end_;
};

}  // namespace

std::vector<MarginLoad> loads_at_end(const Structure& structure, const MarginMotion& motion,
                                     const WayEnd& end, bool latches) {
  std::vector<MarginLoad> out;
  const EndLoads loads(structure, end);
  for (const MarginMotion::Met& met : motion.met(end.sense, end.s)) {
    out.push_back(loads.one(met.stop->name, met.stop->reeled ? "cable" : "stop",
                            met.stop->function.is_angle(), met.closing, met.change));
    out.back().load = std::max(out.back().load, 0.0);
  }
  const Deployment& deployment = structure.deployment;
  if (!latches || deployment.empty() || std::abs(deployment.remaining(end.q)) > deployed_there) return out;
  const VectorXd start = node_positions(structure);
  out.push_back(loads.latch(std::abs(deployment.remaining(start))));
  if (deployment.latches.size() > 1) out.push_back(loads.share());
  return out;
}

}  // namespace unfurl
