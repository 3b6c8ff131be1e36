// SPDX-License-Identifier: BSD-3-Clause
// The longest beginning of a run that can be trusted; judge() takes it.
#pragma once

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

struct GoodPart {
  std::size_t states = 0;
  std::string why = {};                                    // it is not longer
  std::string text(const Diagnostics& diagnostics) const;  // "from t = 0.3 s on ..."; empty: all is good
};
GoodPart good_part(const Simulation& run, const Diagnostics& diagnostics);

void keep_states(std::size_t states, Simulation& run, Diagnostics& diagnostics);
// The run fails for this reason, in words of GoodPart::text().
void fail_for(const std::string& why, Simulation& run);

}  // namespace unfurl
