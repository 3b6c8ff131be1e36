// SPDX-License-Identifier: BSD-3-Clause
// The one file that is compiled again for a new version.
#include "core/text/version.hpp"

namespace unfurl {

std::string version() {
  return UNFURL_VERSION;
}

}  // namespace unfurl
