#pragma once

#include <ostream>

namespace unfurl {

// Inside a catch block: one clear message about the exception in flight, and the ExitCode that stands for it.
int report_failure(std::ostream& out);

}  // namespace unfurl
