// SPDX-License-Identifier: BSD-3-Clause
// Every option. To add one: a row in own_options.cpp, its name at the rows of the verbs that take it in
// command_table.cpp, and where it goes in cli.cpp.
#pragma once

#include <span>
#include <string_view>

#include "app/command.hpp"

namespace unfurl {

struct OwnOption {
  std::string_view name;   // "--steps"
  std::string_view value;  // "LARGEST:SMALLEST"; empty: a flag
  std::string_view help;
};

std::span<const OwnOption> own_options();
bool takes(const Command& command, std::string_view option);  // false: it would mean nothing there
bool shows(const Command& command, std::string_view option);  // it stands in the verb's help

}  // namespace unfurl
