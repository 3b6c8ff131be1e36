// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "app/command.hpp"

namespace unfurl {

std::string usage_line(const Command& command);    // "unfurl run SCENE -o DIR"
std::string command_help(const Command& command);  // what `unfurl run --help` prints
std::string program_help();                        // what `unfurl --help` prints

}  // namespace unfurl
