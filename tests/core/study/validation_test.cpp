// SPDX-License-Identifier: BSD-3-Clause
// Published digits: what `unfurl reproduce --validation` prints.
#include "core/study/validation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

TEST_CASE("published benchmarks are met to the digits that they print") {
  const auto rows = validate({});
  CHECK(rows.size() >= 14);
  for (const ValidationRow& row : rows) {
    INFO(row.problem << ", " << row.quantity << ": " << row.ours << ", published " << row.published);
    CHECK(row.holds());
  }
}

TEST_CASE("a benchmark that was not reached does not hold") {
  ValidationRow row{"", "", "", "1.25", std::nan(""), 1e9};
  CHECK_FALSE(row.holds());
  row.ours = 1.5;
  CHECK(row.difference() == 0.25);
  CHECK(row.holds());
  row.allowed = 0.2;
  CHECK_FALSE(row.holds());
}
