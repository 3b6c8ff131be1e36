// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace unfurl::plot {

// Values on a grid of points: value(i, j) at (x[i], y[j]); NaN where there is none.
struct Field {
  std::vector<double> x, y;    // ascending
  std::vector<double> values;  // [x.size() * y.size()], j runs fastest
  double value(std::size_t i, std::size_t j) const { return values[i * y.size() + j]; }
};

struct Segments {
  std::vector<double> x, y;  // pairs of points, each pair followed by NaN
};

// Where the field takes this value: marching squares with linear interpolation. Squares with a NaN have none.
Segments contour(const Field& field, double level);

// Bilinear value at (u, v) in square (i, j), u and v from 0 to 1; corners without weight, as they are on an
// edge, may have none.
double interpolate(const Field& field, std::size_t i, std::size_t j, double u, double v);

}  // namespace unfurl::plot
