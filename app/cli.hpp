// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace unfurl {

// The whole program: `words` are the arguments without the program's name. Prints one clear error to stderr
// where something is wrong. Returns an ExitCode.
int run_command_line(const std::vector<std::string>& words);

}  // namespace unfurl
