// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// A run is trusted as far as its energy balance is off by no more than this share of the energy that was
// turned over until then, no constraint by more than this share of a rod's length, and every number is
// finite. Of a method that damps what a step does not resolve, the balance may fall: its largest rise counts,
// and what it fell by is only warned of.
inline constexpr double trusted_share = 0.1;

// The energy turned over in a motion: the largest kinetic energy or, where that is more, the span between the
// smallest and the largest potential energy, work of the loads or drives, or energy taken by dampers and
// impacts [J]. A constant added to a potential does not count. Given state by state.
class EnergyTurnedOver {
 public:
  void add(double kinetic, std::span<const double> others);  // the same others in every state
  double value() const;

 private:
  double kinetic_ = 0;
  std::vector<double> low_, high_;
};
double energy_turned_over(const Diagnostics& diagnostics);

// diagnose(), and what is known about the run decides its end: the longest beginning of it that can be
// trusted is kept, in trajectory, events and diagnostics; where that is not all, its status is `failed` and
// its message says when and why. `cancelled` as for diagnose(): states that were left open are not judged.
Diagnostics judge(Simulation& run, const std::function<bool()>& cancelled = {}, const KnownAhead& ahead = {});

// "from t = 0.3 s on ...": why judge() would not keep all of the run; empty where it would.
std::string mistrust(const Simulation& run, const Diagnostics& diagnostics);

// What a finished run says against itself: an energy balance or a constraint error too large for the result
// to be trusted blindly. Each text names the size and the cure; empty where nothing is wrong.
std::vector<std::string> accuracy_warnings(const Simulation& run, const Diagnostics& diagnostics);

// Of a run that goes through singular poses, whether the force of a rod grows without bound there, and when
// its largest is; no text where none does.
struct Rise {
  std::string text = {};
  double t = 0, force_N = 0;  // [s]; its size
};
Rise rise_on_the_way(const Simulation& run, const Diagnostics& diagnostics);

// The first state of quasi-static rods that is shown without what they give, though they bear something; the
// number of states where there is none.
std::size_t first_unstretched(const Simulation& run, const Diagnostics& diagnostics);

// What warnings of a run look for the largest of: how fast a rod turns [rad/s]; how far quasi-static rods
// move a node, as a share of the structure's size.
using StateSize = double (*)(const Trajectory& trajectory, std::size_t i);
double turning_rate(const Trajectory& trajectory, std::size_t i);
double stretch_share(const Trajectory& trajectory, std::size_t i);
// With its state; 0 of the first one where there is none.
std::pair<double, std::size_t> largest_of_states(const Trajectory& trajectory, StateSize size);

// What was said while it ran, and that. Without diagnostics (of no state) the former alone.
std::vector<std::string> warnings_of(const Simulation& run, const Diagnostics& diagnostics);

// The constraint error relative to rod length up to which a step's Newton iteration goes on: some units of
// the round-off of coordinates, which are as large as the structure; 0 for methods without one. Taken at the
// end of the run, for the shortest rod or other length.
double constraint_tolerance(const Simulation& run);

}  // namespace unfurl
