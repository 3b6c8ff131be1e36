// SPDX-License-Identifier: BSD-3-Clause
// What the figures of a run say in common: its curves over time, its events, its method.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/simulation.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

Curve over_time(const Diagnostics& diagnostics, std::vector<double> values, std::string label, int color);
// Over time, with a dashed line at each event; of many events of one name only the first is labelled.
Panel time_panel(const Simulation& run, std::string y_label);
// " Event "deployed" at 4.920000 s." for every event, many of one name in one sentence; a leading blank.
std::string events_sentence(const Simulation& run);
// Of a panel and the one below: the time axis has its labels below only, events have their names above only.
void share_time_axis(Panel& upper, Panel& lower);

double largest_magnitude(const std::vector<double>& values);  // NaN aside
std::vector<double> magnitudes(const std::vector<double>& values);

// "Method dvm with 3 lobatto stages, step 0.01 s.", or that it was solved along its path, and why the run
// ended early where it did.
std::string method_sentence(const Simulation& run);
// "The 12 exact zeros are drawn at the bottom edge." or nothing; a leading blank.
std::string zeros_sentence(const std::vector<double>& values);

}  // namespace unfurl
