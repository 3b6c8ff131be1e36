// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/ending.hpp"

#include <cmath>
#include <sstream>

namespace unfurl {

std::string ending_note(const Simulation& run, const Diagnostics& diagnostics) {
  const Series* fraction = diagnostics.find("deployed_fraction");
  if (run.status != RunStatus::completed || !fraction || fraction->values.empty()) return "";
  for (const Event& event : run.events)
    if (event.name == "deployed") return "";
  // Rounded down: what is not deployed is never called 100 %. What has not moved may be off zero by rounding.
  constexpr double rounding = 1e-9;
  const double last = fraction->values.back();
  const double percent = std::abs(last) <= rounding ? 0.0 : std::floor(1000 * last) / 10;
  if (!(percent < 100)) return "";
  std::ostringstream text;
  text << percent << " % deployed when end_time = " << run.options.end_time << " s was reached";
  return text.str();
}

}  // namespace unfurl
