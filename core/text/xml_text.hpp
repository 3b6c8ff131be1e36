// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace unfurl {

// UTF-8 as the text of an element, or the value of an attribute in double quotes, of XML 1.0 or HTML 5: & < >
// and " become entities; what no document may hold (control characters, bytes that are not UTF-8) is left
// out.
std::string xml_text(std::string_view text);

// For terminals and Markdown: what is no character but a command (escape sequences, bells, marks that turn
// the direction of text) or no UTF-8 stands there as "\\x1b" or "\\u202e"; line breaks and tabs stay.
std::string printable_text(std::string_view text);

}  // namespace unfurl
