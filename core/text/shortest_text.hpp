// SPDX-License-Identifier: BSD-3-Clause
// Numbers as the shortest text that reads back as the same double.
#pragma once

#include <cstddef>

namespace unfurl {

inline constexpr std::size_t longest_number = 31;  // characters, with a sign

// Writes the same characters as std::to_chars(text, text + longest_number, x), at a third of its price for
// the numbers of 1e-39 to 1e15 that tables hold; returns the end.
char* shortest_text(double x, char* text);

}  // namespace unfurl
