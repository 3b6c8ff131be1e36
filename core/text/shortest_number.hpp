// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace unfurl {

// The shortest text that reads as this double again, the nearest one of those, fixed where that is no longer:
// the bytes of std::to_chars, in half its time where 1e-38 < x < 2^53. For x > 0; with room for 31
// characters; returns the end of the text.
char* write_shortest(char* to, double x);

}  // namespace unfurl
