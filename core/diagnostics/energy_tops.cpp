// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/energy_tops.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace unfurl {

PeakInMotion top_of_energy(const Trajectory& run, const Diagnostics& d, const Series& energy, double sign,
                           bool (*joined)(const Trajectory&, std::size_t, std::size_t), PeakInMotion best) {
  constexpr double smooth = 0.2;  // of h P, what a power that does not jump leaves of the trapezium's rule
  constexpr std::string_view end = "energy_J";
  const std::string power = energy.name.substr(0, energy.name.size() - end.size()) + "power_W";
  const Series* rate = energy.name.ends_with("." + std::string(end)) ? d.find(power) : nullptr;
  if (!rate || energy.values.size() != run.size() || rate->values.size() != run.size()) return best;
  for (std::size_t i = 0; i + 1 < run.size(); ++i) {
    const double p = sign * rate->values[i], q = sign * rate->values[i + 1];
    if (!(p > 0 && q < 0) || !joined(run, i, i + 1)) continue;
    const double h = run.time(i + 1) - run.time(i), from = sign * energy.values[i],
                 gain = sign * energy.values[i + 1] - from;
    if (!(std::abs(gain - 0.5 * h * (p + q)) <= smooth * h * std::min(p, -q))) continue;
    // E = from + h (p u + c u^2 + e u^3), E' = 0 at the one u in between.
    const double c = 3 * gain / h - 2 * p - q, e = p + q - 2 * gain / h;
    double a = 0, b = 1;
    for (int it = 0; it < 60; ++it) {
      const double u = 0.5 * (a + b);
      (p + u * (2 * c + 3 * e * u) > 0 ? a : b) = u;
    }
    const double top = from + h * a * (p + a * (c + e * a));
    if (top > best.value) best = {top, run.time(i) + a * h};
  }
  return best;
}

}  // namespace unfurl
