// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

namespace table_test {

TEST_CASE("short numbers are written as people write them") {
  CHECK(short_number(4.92) == "4.92");
  CHECK(short_number(0.0012345) == "0.00123");
  CHECK(short_number(1234.5) == "1234");  // no exponent for what can be counted
  CHECK(short_number(-99999.4) == "-99999");
  CHECK(short_number(1.234e-9) == "1.23e-9");
  CHECK(short_number(1e-6, 1) == "1e-6");
  CHECK(short_number(-2.5e-10) == "-2.5e-10");
  CHECK(short_number(3e8) == "3e8");
  CHECK(short_number(0.0) == "0");
  CHECK(short_number(-0.0) == "0");
  CHECK(short_number(std::nan("")) == "nan");
}

}  // namespace table_test
