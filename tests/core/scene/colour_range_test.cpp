// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

namespace unfurl::colour_range_test {

TEST_CASE("a range of colours that cannot be one is refused") {
  const auto error = [](const std::string& range, const std::string& by = "axial_force") {
    return testing::error_of("structure.kind = 'hoop'\n[render]\ncolour_by = '" + by +
                             "'\ncolour_range = " + range + "\n");
  };
  for (const char* range : {"[0, 0]", "[0, 0.5]", "[-3, 2]", "[-7, -6.5]"}) CHECK(error(range).empty());
  for (const char* range : {"[5, 1]", "[5, 5]", "[0, -1]"}) {
    CHECK_THAT(error(range), Catch::Contains("render.colour_range"));
    CHECK_THAT(error(range), Catch::Contains("the second is larger"));
  }
  for (const char* range : {"[0, 1]", "[-1, 1]"})
    CHECK_THAT(error(range, "constraint_error"), Catch::Contains("above 0"));
  CHECK(error("[1e-12, 1e-8]", "constraint_error").empty());
  CHECK(error("[0, 0]", "constraint_error").empty());
}

}  // namespace unfurl::colour_range_test
