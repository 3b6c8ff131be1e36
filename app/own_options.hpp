// SPDX-License-Identifier: BSD-3-Clause
// Every option. To add one: a row in own_options.cpp and its name at the rows of the verbs that take it in
// command_table.cpp.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/command.hpp"

namespace unfurl {

// A key of the scene that the option is short for; without a value it sets it to true.
struct ShortKey {
  std::string_view key;
};

// Where the value goes.
using OptionTarget =
    std::variant<ShortKey, bool& (*)(Arguments&), int& (*)(Arguments&), double& (*)(Arguments&),
                 std::string& (*)(Arguments&), std::vector<std::string>& (*)(Arguments&)>;

struct OwnOption {
  std::string_view name;   // "--steps"
  std::string_view value;  // "LARGEST:SMALLEST", a list at commas where it ends in ",..."; empty: a flag
  std::string_view help;
  OptionTarget target;
  double low = 0, high = 0;  // range of a number
};

std::span<const OwnOption> own_options();
bool takes(const Command& command, std::string_view option);  // false: it would mean nothing there
bool shows(const Command& command, std::string_view option);  // it stands in the verb's help
// Which word of a command line is the first name behind the verb, words[0]: neither an option nor the value
// of one. 0: there is none.
std::size_t place_of_first_name(const std::vector<std::string>& words);

}  // namespace unfurl
