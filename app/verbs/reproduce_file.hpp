// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/command.hpp"

namespace unfurl {

// `unfurl reproduce FILE`: runs the command of the file's receipt again and compares. Throws FileError where
// the file carries none.
int reproduce_file(const Arguments& arguments);

}  // namespace unfurl
