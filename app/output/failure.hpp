// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

namespace unfurl {

// Inside a catch block: one clear message about the exception in flight, and the ExitCode that stands for it.
int report_failure(std::ostream& out);

// From now on also where no exception can be caught: a line on stderr and exit_internal instead of a crash.
void end_in_words();

}  // namespace unfurl
