// SPDX-License-Identifier: BSD-3-Clause
// Curves on their way to the page: values to points, breaks at NaN, thinned to what a page can show.
#pragma once

#include <vector>

#include "render/plot/canvas.hpp"
#include "render/plot/scale.hpp"

namespace unfurl::plot {

using Polyline = std::vector<Point>;

struct TraceRules {
  Scale x, y;
  bool zeros_at_floor =
      false;  // y == 0 on a log axis is drawn at y.at_lo; else it breaks the line, as values < 0 do
};

// The unbroken pieces of a curve in points. x and y may differ in length: what has no partner is left out.
std::vector<Polyline> trace(const std::vector<double>& x, const std::vector<double>& y,
                            const TraceRules& rules);

// The pieces of a band: pairwise as many points, at the same x.
struct BandTrace {
  std::vector<Polyline> lower, upper;
};
BandTrace trace_band(const std::vector<double>& x, const std::vector<double>& lower,
                     const std::vector<double>& upper, const TraceRules& rules);

// In every column of the page of this width that holds more than four points in a row: the first, lowest,
// highest and last one. The picture is the same to within a column; a spike never disappears.
Polyline thinned(const Polyline& line, double column);

inline constexpr double trace_column = 0.25;  // [points]: about a pixel at 300 dpi

}  // namespace unfurl::plot
