// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/force_uniqueness.hpp"

namespace unfurl {

// Of diagnose() only energies and constraint errors, and no rod forces: a run's books, at a tenth of the
// price.
Diagnostics diagnose_books(const Simulation& run);

// The same without what goes in or out, of which the other energies are the sums: of kinetic and potential
// energies only.
Diagnostics diagnose_energies(const Simulation& run);

// All but what is unique and what goes in or out, of which energies are the sums: those columns mean nothing.
// `reactions`: with those of supports, which are most of the columns where many nodes are held.
Diagnostics diagnose_states(const Simulation& run, bool reactions);

// diagnose() of one window of a long run (simulate/parts.hpp). `known`: what the window before it found,
// whose last states are of the model that this one begins with; then what this one found. goes_on: it is not
// the last window.
Diagnostics diagnose_window(const Simulation& window, bool goes_on, KnownUniqueness& known,
                            const std::function<bool()>& cancelled = {});

// What the energy balance may be off by rounding alone, at every state of the run [J]. Coordinates are known
// to some `levels` = 64 units of round-off of their largest, x; a force F works |F| levels ulp x along that,
// a mass m that moves so within a step h has the energy m (levels ulp x / h)^2 (h: the mean, since a step may
// end at an event right behind its start); sums of large energies are rounded as those; gravity and loads
// count by themselves, whatever balances them. Errors of n states add up like sqrt(n).
std::vector<double> energy_round_off(const Simulation& run);

// What waves of rods that give may have taken with them where a step stops them, at every state of the run
// [J]: loaded at once, a rod that comes to rest has lost as much as it stores, C N^2 / 2 with N beside its
// force at the start; one that swings has up to four times that.
std::vector<double> energy_of_stopped_waves(const Simulation& run);

}  // namespace unfurl
