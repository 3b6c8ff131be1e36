// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/text/error.hpp"

namespace unfurl {

// What the program returns to the shell; scripts rely on these.
enum ExitCode {
  exit_ok = 0,
  exit_internal = 1,
  exit_usage = 2,
  exit_scene_invalid = 3,
  exit_solver_failed = 4,  // the good part is saved
  exit_file_error = 5,
  exit_no_graphics = 6,
  exit_verification_failed = 7,
  exit_interrupted = 130,  // finished data and frames are kept
};

// The command line cannot be followed.
struct UsageError : Error {
  using Error::Error;
};

}  // namespace unfurl
