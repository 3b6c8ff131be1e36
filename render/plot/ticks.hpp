// SPDX-License-Identifier: BSD-3-Clause
// Where an axis has its ticks and what they are called.
#pragma once

#include <string>
#include <vector>

#include "core/text/typeset_number.hpp"

namespace unfurl::plot {

struct Ticks {
  std::vector<double> major, minor;  // values in [lo, hi], ascending
  std::vector<std::string> labels;   // one per major tick
  // How to read the labels where they would be too long: "×10⁻³", "×10⁻⁹ + 1.5"; empty: as they are.
  std::string note;
};

// Ticks at multiples of 1, 2 or 5 times a power of ten, as many as `most` allows.
Ticks linear_ticks(double lo, double hi, int most);
// Ticks at multiples of 1, 2, 5, 10, 15, 30, 45, 90, ... degrees; below a degree as linear_ticks.
Ticks degree_ticks(double lo, double hi, int most);
// As linear_ticks, but at whole numbers only.
Ticks whole_ticks(double lo, double hi, int most);
// Ticks at powers of ten, every k-th where there are more than `most`; the minor ones are the powers between,
// or the multiples 2..9. 0 < lo < hi. A range inside one decade gets linear ticks.
Ticks log_ticks(double lo, double hi, int most);

using unfurl::format_fixed;
using unfurl::format_number;
using unfurl::format_share;
using unfurl::power_of_ten;
using unfurl::superscript;

}  // namespace unfurl::plot
