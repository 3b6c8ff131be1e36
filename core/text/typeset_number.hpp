// SPDX-License-Identifier: BSD-3-Clause
// Numbers as they stand in pictures and on pages.
#pragma once

#include <string>

namespace unfurl {

std::string superscript(int n);   // "⁻¹⁵"
std::string power_of_ten(int n);  // "10⁻¹⁵"
// With so many significant digits, as people write it: "4.92", "0.013", "2.2×10⁻¹⁶"; trailing zeros are
// dropped.
std::string format_number(double value, int digits);
// With so many decimals and a true minus sign; never "−0".
std::string format_fixed(double value, int decimals);
// A share of 1 in whole per cents, "85 %"; what falls short of the whole is never "100 %" but "99.7 %".
std::string format_share(double share);

}  // namespace unfurl
