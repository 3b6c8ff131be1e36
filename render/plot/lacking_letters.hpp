// SPDX-License-Identifier: BSD-3-Clause
// What was to be written and no font has: noted where it is drawn, told at the end.
#pragma once

#include <string>
#include <string_view>

namespace unfurl::plot {

void note_lacking(std::string_view letter);  // one character in UTF-8; from any thread

// What to warn of, since it was last asked, in this process: "DejaVu Sans has no X, Y and 5 more: ...";
// empty: nothing lacked.
std::string take_lacking_letters();

}  // namespace unfurl::plot
