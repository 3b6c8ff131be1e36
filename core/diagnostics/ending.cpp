// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/ending.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/simulate/singular_poses.hpp"

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

std::vector<std::string> notes_of(const Simulation& run, const Diagnostics& diagnostics) {
  std::vector<std::string> notes;
  if (std::string ending = ending_note(run, diagnostics); !ending.empty()) notes.push_back(std::move(ending));
  Index size = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const System& system = run.trajectory.model(i).system;
    if (system.constraints() > 0 && system.solved_coordinates() > 0)
      size = std::max({size, system.constraints(), system.solved_coordinates()});
  }
  if (size > max_singular_size)
    notes.push_back("singular poses were not looked for, which is done up to " +
                    std::to_string(max_singular_size) + " constraints or coordinates; the model has " +
                    std::to_string(size) +
                    ": a force that grows without bound beside one is told as it is at the states");
  return notes;
}

}  // namespace unfurl
