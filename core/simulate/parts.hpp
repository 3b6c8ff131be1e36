// SPDX-License-Identifier: BSD-3-Clause
// Runs that are not kept: handed over part by part while they go on.
#pragma once

#include "core/simulate/stepper.hpp"

namespace unfurl {

struct Parts {
  std::size_t states = 4096;  // a part is handed over when so many are new
  std::size_t around = 64;    // states of the parts before and after that a window shows
  // Is given every window, with the stepper right behind it, which may be archived; not the last one.
  std::function<void(Stepper::Window, Stepper&)> take = {};
  // Is shown the run after every step: what it begins with may be looked at while it goes on. States at its
  // end may still be taken back.
  std::function<void(const Simulation&)> look = {};
  Archive* archived = nullptr;  // a stepper to go on with; null: from the start
};

// So many that a part takes about two megabytes, but 128 of a large model, of which each part asks for some
// ranks; and so few around it that they are a small share of that: for every model the same on every machine,
// since a run begins anew behind each part.
Parts parts_for(const Model& model);

// As simulate(); the result has what is behind the last part that was taken, whose states from `first_new` on
// no window had, and counts steps from the start.
Simulation simulate_in_parts(std::shared_ptr<const Model> model, const SolverOptions& options,
                             const SimulationHooks& hooks, const Parts& parts, std::size_t& first_new);

void archive_events(Archive& archive, std::vector<Event>& events);

}  // namespace unfurl
