// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/simulate/one_sided.hpp"
#include "core/simulate/push_responses.hpp"

namespace unfurl {

// What acts in a state of `base`, cables and motors by their present laws, and what pushes of these sides do
// there; of limits that move the acceleration is that of `later`.
struct Acting {
  Acting(const OneSided& sides, const Model& base, const State& state, const std::vector<std::size_t>& rows,
         double later)
      : model(sides.without_holds(base)), system(model.system.at(state)), responses(system, state) {
    for (const std::size_t i : rows)
      if (responses.ok())
        responses.add(
            sides.measure(i), sides.sign(i), sides.near(i, state),
            {sides.limit_motion(i, state.t).rate, sides.limit_motion(i, state.t + later).acceleration});
  }
  const Model model;
  const System system;
  PushResponses responses;
};

}  // namespace unfurl
