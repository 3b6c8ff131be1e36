// SPDX-License-Identifier: BSD-3-Clause
// A command line as words, for whoever repeats it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

// A word of any characters in single quotes of a shell: 'it'\''s'.
std::string in_shell_quotes(std::string_view text);

// For a shell to take again: words with anything unusual stand in quotes.
std::string as_typed(const std::vector<std::string>& words);

// Without this option and its value, however often it is given ("--merge DIR", "--merge=DIR").
std::vector<std::string> without_option(const std::vector<std::string>& words, const std::string& option);

}  // namespace unfurl
