// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace unfurl {

std::string version();  // "0.1.0"; counts as CHANGELOG.md says

}  // namespace unfurl
