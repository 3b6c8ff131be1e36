// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/param_spec.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

namespace param_spec_test {

namespace {

const double nan_value = std::nan("");

}  // namespace

TEST_CASE("a range in words") {
  CHECK(range_text(positive_param("l", "m", 1, "")) == "> 0 m");
  CHECK(range_text(real_param("x", "deg", 1, 0.5, 90, "")) == "[0.5, 90] deg");
  CHECK(range_text(integer_param("n", 3, 2, 100000, "")) == "[2, 100000]");
  CHECK(range_text(choice_param("c", "a", {"a", "b"}, "")) == "one of a, b");
  CHECK(range_text(boolean_param("b", true, "")) == "true or false");
  CHECK(range_text(vector_param("v", "m", {0, 0, 0}, "")) == "3 numbers in m");
  CHECK(range_text(text_param("t", "", "")) == "text");
}

TEST_CASE("values inside their range are accepted, also a whole number for a real one") {
  CHECK(range_error(positive_param("l", "m", 1, ""), 1e-300).empty());
  CHECK(range_error(positive_param("l", "m", 1, ""), 3L).empty());
  CHECK(range_error(real_param("x", "", 1, 0, 1, ""), 0.0).empty());
  CHECK(range_error(integer_param("n", 3, 2, 8, ""), 8L).empty());
  CHECK(range_error(choice_param("c", "a", {"a", "b"}, ""), std::string("b")).empty());
  CHECK(range_error(vector_param("v", "", {0, 0}, ""), std::vector<double>{1, 2}).empty());
}

TEST_CASE("values outside their range are refused with the range and what was given") {
  CHECK(range_error(positive_param("l", "m", 1, ""), -3L) == "must be > 0 m; got -3");
  CHECK(range_error(positive_param("l", "m", 1, ""), 0.0) == "must be > 0 m; got 0");
  CHECK(range_error(real_param("x", "", 1, 0, 1, ""), 1.5) == "must be in [0, 1]; got 1.5");
  CHECK(range_error(real_param("x", "", 1, 0, 1, ""), std::string("a")) ==
        "must be a number in [0, 1]; got \"a\"");
  CHECK(range_error(integer_param("n", 3, 2, 8, ""), 9L) == "must be a whole number in [2, 8]; got 9");
  CHECK(range_error(integer_param("n", 3, 2, 8, ""), 2.5) == "must be a whole number in [2, 8]; got 2.5");
  CHECK(range_error(boolean_param("b", true, ""), 1L) == "must be true or false; got 1");
  CHECK(range_error(vector_param("v", "m", {0, 0}, ""), std::vector<double>{1}) ==
        "must be a list of 2 numbers in m; got [1]");
}

TEST_CASE("an open end of a range is outside it") {
  ParamSpec spec = real_param("x", "", 1, 0, 1, "");
  spec.max_open = true;
  CHECK(range_text(spec) == "[0, 1)");
  CHECK(range_error(spec, 0.0).empty());
  CHECK_FALSE(range_error(spec, 1.0).empty());
}

TEST_CASE("what is not finite is in no range") {
  const double infinity = std::numeric_limits<double>::infinity();
  const ParamSpec free = real_param("x", "", 0, -infinity, infinity, "");
  CHECK(range_error(free, nan_value) == "must be a finite number; got nan");
  CHECK(range_error(free, -infinity) == "must be a finite number; got -inf");
  CHECK_FALSE(range_error(positive_param("l", "m", 1, ""), infinity).empty());
  CHECK_FALSE(range_error(vector_param("v", "", {0, 0}, ""), std::vector<double>{0, nan_value}).empty());
}

TEST_CASE("a set of parameters starts at the defaults and knows its kinds") {
  ParamSet set(
      {positive_param("l", "m", 1.5, ""), integer_param("n", 3, 2, 8, ""), boolean_param("b", true, "")});
  CHECK(set.real("l") == 1.5);
  CHECK(set.integer("n") == 3);
  CHECK(set.real("n") == 3.0);
  CHECK(set.boolean("b"));
  set.set("l", 2L);
  CHECK(set.real("l") == 2.0);
  CHECK_FALSE(set.has("x"));
  CHECK_THROWS_AS(set.real("x"), std::logic_error);
  CHECK_THROWS_AS(set.text("l"), std::logic_error);
}

}  // namespace param_spec_test
