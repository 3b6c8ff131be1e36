// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/prescribed_waves.hpp"

namespace unfurl {

PrescribedWave fastest_wave(const Structure& structure, double t) {
  PrescribedWave fastest;
  const auto look_at = [&](std::string_view name, const TimeFunction& f) {
    const bool begun =
        f.kind == TimeFunction::Kind::wave || (f.kind == TimeFunction::Kind::sine && f.start <= t);
    if (begun && (f.rate != 0 || f.rise != 0) && f.duration < fastest.period) fastest = {name, f.duration};
  };
  for (const Constraint& c : structure.constraints) look_at(c.name, c.target);
  for (const Stop& stop : structure.stops) look_at(stop.name, stop.reel);
  for (const Force& f : structure.forces)
    for (const TimeFunction* function : {&f.size, &f.unstressed, &f.motor.command})
      look_at(f.name, *function);
  return fastest;
}

}  // namespace unfurl
