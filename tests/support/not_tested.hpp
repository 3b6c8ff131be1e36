// SPDX-License-Identifier: BSD-3-Clause
// What a test needs and not every machine has: a program, a right, a typeface.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>
#include <string_view>

namespace unfurl::testing {

inline bool installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

// Is `what` missing? Where CI=true that is a failure of the test that asks, elsewhere a warning: what is not
// tested must not look like what passed.
inline bool lacks(bool present, const std::string& what) {
  if (present) return false;
  const char* ci = std::getenv("CI");
  if (ci && std::string_view(ci) == "true") FAIL("not tested, and CI tests everything: " << what);
  WARN("not tested: " << what);
  SUCCEED();
  return true;
}

}  // namespace unfurl::testing
