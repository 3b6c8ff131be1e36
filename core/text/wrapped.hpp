// SPDX-License-Identifier: BSD-3-Clause
// Text in lines of a width, for terminals and for comments in files.
#pragma once

#include <string>
#include <string_view>

namespace unfurl {

// `text` in lines of at most `width` characters, broken at spaces; the first begins with `first`, the others
// with `next`, both counted. A word that is longer than a line has a line of its own. Ends with a newline.
std::string wrapped(std::string_view text, std::size_t width, std::string_view first = "",
                    std::string_view next = "");

// How many characters a UTF-8 text shows.
std::size_t characters_in(std::string_view text);

}  // namespace unfurl
