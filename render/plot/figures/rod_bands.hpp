// SPDX-License-Identifier: BSD-3-Clause
// A quantity of every rod over time.
#pragma once

#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

inline constexpr const char* open_force = ", not unique";

// values [states x solved rods], NaN where nothing is known: a curve for every rod where there are few, else
// for every group one curve or the range between the extremes; dashed or dotted where forces are not unique.
void add_rod_curves(const Structure& structure, const Diagnostics& diagnostics, const MatrixXd& values,
                    Panel& panel);
// " (rod B0-Mb0 at 1.25 s, not unique)": which rod has a peak of the motion, and when, as the states show it.
// Of a peak within the steps, which no state has to four digits: " (rod B0-Mb0 near 1.25 s)".
struct RodPeak {
  double peak, at_state;
  Index rod;
  double t;  // [s]
  bool unique;
};
std::string whose_peak(const Structure& structure, const RodPeak& peak);
// A mark where a peak that the caption names lies beyond all that the panel draws: within a step.
void mark_peak(double t, double value, Panel& panel);
bool each_rod_alone(const Structure& structure);
double largest_finite(const MatrixXd& values);  // magnitude; 0 where there is none

}  // namespace unfurl
