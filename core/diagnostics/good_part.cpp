// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/good_part.hpp"

#include <sstream>

namespace unfurl {

std::string GoodPart::text(const Diagnostics& d) const {
  std::ostringstream out;
  if (states < d.t.size() - d.left_open) out << "from t = " << d.t[states] << " s on " << why;
  return out.str();
}

void keep_states(std::size_t states, Simulation& run, Diagnostics& d) {
  while (run.trajectory.size() > states) run.trajectory.pop_back();
  d.t.resize(states);
  for (Series& column : d.columns) column.values.resize(states);
  d.axial_force.conservativeResize(static_cast<Index>(states), Eigen::NoChange);
  d.force_unique.conservativeResize(static_cast<Index>(states), Eigen::NoChange);
  std::erase_if(d.found, [&](const FoundWithin& x) { return x.peak.t > run.trajectory.end_time(); });
  std::erase_if(run.events, [&](const Event& event) { return event.t > run.trajectory.end_time(); });
}

void fail_for(const std::string& why, Simulation& run) {
  run.message =
      (run.status == RunStatus::failed ? run.message + "; " : "") + why + ": what follows is left out";
  run.status = RunStatus::failed;
}

}  // namespace unfurl
