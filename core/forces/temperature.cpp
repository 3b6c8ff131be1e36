// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/temperature.hpp"

#include <limits>

namespace unfurl {

std::unique_ptr<ForceBlock> no_block(const Structure&, const SparseRows&) {
  return nullptr;
}

const std::vector<ParamSpec>& temperature_params() {
  static const std::vector<ParamSpec> params = [] {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return std::vector<ParamSpec>{
        required(
            real_param("expansion", "1/K", 0.0, -1.0, 1.0, "coefficient of thermal expansion of the rods")),
        real_param(
            "change", "K", 1.0, -infinity, infinity,
            "above the temperature at which the rods have their lengths, times the factor of the time"),
        vector_param("times", "s", {},
                     "with values: the change over time, a smooth curve through the points, which goes "
                     "beyond them beside a steep part: points there keep it close"),
        vector_param("values", "", {}, "factors of the change at the times"),
        text_param("table", "", "CSV file beside the scene, in place of times and values: t,value")};
  }();
  return params;
}

void fill_temperature(const ParamSet& values, Force& force) {
  force.expansion = values.real("expansion");
  const double change = values.real("change");
  if (values.vector("times").empty()) {
    force.size = {};
    force.size.offset = change;
    return;
  }
  std::vector<double> kelvin = values.vector("values");
  for (double& x : kelvin) x *= change;
  force.size = make_spline(values.vector("times"), std::move(kelvin));
}

}  // namespace unfurl
