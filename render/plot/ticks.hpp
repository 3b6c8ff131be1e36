// SPDX-License-Identifier: BSD-3-Clause
// Where an axis has its ticks and what they are called.
#pragma once

#include <string>
#include <vector>

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

std::string superscript(int n);   // "⁻¹⁵"
std::string power_of_ten(int n);  // "10⁻¹⁵"
// With so many significant digits, as people write it: "4.92", "0.013", "2.2×10⁻¹⁶"; trailing zeros are
// dropped.
std::string format_number(double value, int digits);
// With so many decimals and a true minus sign; never "−0".
std::string format_fixed(double value, int decimals);
// A share of 1 in whole per cents, "85 %"; what falls short of the whole is never "100 %" but "99.7 %".
std::string format_share(double share);

}  // namespace unfurl::plot
