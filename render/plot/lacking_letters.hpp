// SPDX-License-Identifier: BSD-3-Clause
// What was to be written and no font has: noted where it is drawn, told once at the end.
#pragma once

#include <string>
#include <string_view>

namespace unfurl::plot {

void note_lacking(std::string_view letter);  // one character in UTF-8; from any thread

// "X, Y and 5 more", of this process; empty: nothing lacked.
std::string lacking_letters();

}  // namespace unfurl::plot
