// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "core/integrators/integrator.hpp"

namespace unfurl {

// A step of size h from `state` that failed as a whole: once more in 2, 4, ... 64 equal parts, for motion
// that is too fast for it, then in two uneven ones. Where it passes a singular pose, the iteration fails if a
// node or an end of a part lies too close to that, and short parts have more of them; which lengths get
// through is seen by trying. `step(state, length)` takes a part and reports; `state` is left as it was where
// none does.
template <class Step>
StepReport step_in_parts(Integrator& integrator, State& state, double h, const Step& step) {
  constexpr std::array uneven{0.61, 0.41, 0.83, 0.23, 0.71, 0.31, 0.91, 0.11, 0.53, 0.77, 0.17, 0.97};
  const State start = state;
  StepReport report;
  const auto begin = [&] {
    state = start, report = StepReport{};
    integrator.restart();
  };
  for (int count = 2; count <= 64; count *= 2) {
    begin();
    for (int i = 0; i < count && report.ok(); ++i) report = step(state, h / count);
    if (report.ok()) return report;
  }
  for (const double share : uneven) {
    begin();
    report = step(state, share * h);
    if (report.ok()) report = step(state, (1 - share) * h);
    if (report.ok()) return report;
  }
  state = start;
  return report;
}

}  // namespace unfurl
