// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/touched_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/forces/spring.hpp"
#include "core/simulate/stops.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

std::vector<std::string> touched_limits(const Model& model, const State& pose) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  const Structure& structure = model.structure;
  const Stops stops(structure);
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (!stops.is_held(i, structure) &&
        std::abs(stops.gap(i, model.system, pose)) <= stops.touching(stops[i].function))
      add(stops[i].name);
  VectorXd q(model.system.coordinates());
  model.system.expand(pose.z, q);
  for (const Force& force : structure.forces) {
    if (!force.one_sided || force.smoothing > 0) continue;  // a smoothed one begins to pull evenly
    const SpringLaw law = spring_law(force, pose.t, q.data());
    const MeasureFunction length(force.measure, structure.deployment);
    // No more than rounding: a stiff one that pulls is stretched by little.
    const double rounding =
        8 * std::numeric_limits<double>::epsilon() * (law.rest + q.lpNorm<Eigen::Infinity>());
    if (law.stiffness > 0 && std::abs(length.value(q.data()) - law.rest) <= rounding) add(force.name);
  }
  return names;
}

}  // namespace unfurl
