// SPDX-License-Identifier: BSD-3-Clause
// A run in one small JSON document, for scripts; its keys are stable.
#pragma once

#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "core/system/mobility.hpp"

namespace unfurl {

// How a run came about.
struct RunRecord {
  std::string command;     // as typed; empty: none
  std::string scene_hash;  // of the scene as run, with every key; empty: not known
  double wall_s = 0;       // from the program's start; 0: not known [s]
};

// Pretty-printed, ends with a line break. "nodes" and "rods" count the whole structure; coordinates,
// constraints and rank are those of the model that was solved. A number that is not finite is null.
std::string summary_json(const std::string& scene_name, const Simulation& run, const Diagnostics& diagnostics,
                         const Mobility& mobility, const RunRecord& record = {});

}  // namespace unfurl
