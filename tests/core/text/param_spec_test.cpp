// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/param_spec.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>

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

TEST_CASE("every kind of parameter takes values of its own kind only") {
  const std::vector<ParamValue> values = {
      true, 3L, 2.5, std::string("a"), std::vector<double>{2, 3}, std::vector<std::string>{"a", "b"}};
  const std::vector<std::string> written = {"true", "3", "2.5", "\"a\"", "[2, 3]", "[\"a\", \"b\"]"};
  const struct {
    ParamSpec spec;
    std::vector<std::size_t> takes;  // which of the values
    std::string wanted;
  } rows[] = {{boolean_param("p", true, ""), {0}, "true or false"},
              {integer_param("p", 3, 2, 8, ""), {1}, "a whole number in [2, 8]"},
              {real_param("p", "m", 3, 2, 8, ""), {1, 2}, "a number in [2, 8] m"},
              {choice_param("p", "b", {"b", "a"}, ""), {3}, "one of b, a"},
              {text_param("p", "", ""), {3}, "text"},
              {vector_param("p", "N", {1, 1}, ""), {4}, "a list of 2 numbers in N"},
              {names_param("p", ""), {5}, "a list of names"}};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool taken = std::ranges::find(row.takes, i) != row.takes.end();
      CAPTURE(row.wanted, written[i]);
      CHECK(wanted_text(row.spec) == row.wanted);
      CHECK(range_error(row.spec, values[i]) ==
            (taken ? "" : "must be " + row.wanted + "; got " + written[i]));
    }
}

TEST_CASE("a parameter keeps its name and its unit and what it is for") {
  const ParamSpec specs[] = {
      real_param("p", "m", 3, 2, 8, "how far"), positive_param("p", "m", 3, "how far"),
      integer_param("p", 3, 2, 8, "how far"),   choice_param("p", "b", {"b"}, "how far"),
      boolean_param("p", true, "how far"),      vector_param("p", "m", {1, 1}, "how far"),
      text_param("p", "there", "how far"),      names_param("p", "how far")};
  for (const ParamSpec& spec : specs) {
    CHECK(spec.name == "p");
    CHECK(spec.help == "how far");
    const bool has_unit = spec.kind == ParamKind::real || spec.kind == ParamKind::vector;
    CHECK(spec.unit == (has_unit ? "m" : ""));
    CHECK_FALSE(spec.min_open == (&spec != specs + 1));
  }
  CHECK(std::get<std::string>(specs[6].fallback) == "there");
  CHECK(std::get<std::string>(specs[3].fallback) == "b");
}

TEST_CASE("lists have the length that is asked for, and some names") {
  ParamSpec pair = names_param("p", "");
  CHECK_FALSE(range_error(pair, std::vector<std::string>{}).empty());
  CHECK(range_error(pair, std::vector<std::string>(5, "a")).empty());
  pair.length = 2;
  CHECK(range_text(pair) == "2 names");
  ParamSpec any = vector_param("p", "", {1, 1}, "");
  any.length = 0;
  any.min = 0.5;
  any.max = 7;
  CHECK(range_text(any) == "numbers, each [0.5, 7]");
  CHECK(range_error(any, std::vector<double>{}).empty());
  CHECK(range_error(any, std::vector<double>{1, 7, 0.5}).empty());
  for (std::size_t n = 1; n < 4; ++n) {
    CHECK(range_error(pair, std::vector<std::string>(n, "a")).empty() == (n == 2));
    CHECK(range_error(vector_param("p", "", {1, 1}, ""), std::vector<double>(n, 1.5)).empty() == (n == 2));
    std::vector<double> one_out(3, 2.5);
    one_out[n - 1] = n == 2 ? 7.5 : 0.25;
    CHECK_FALSE(range_error(any, one_out).empty());
  }
}

TEST_CASE("ends of a range are in it, open ones are not, and both are in its words") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 16; ++k) {
    const bool low = k & 1, high = k & 2, low_open = k & 4, high_open = k & 8;
    ParamSpec spec = real_param("x", "", 3, low ? 2.5 : -infinity, high ? 7.5 : infinity, "");
    spec.min_open = low_open;
    spec.max_open = high_open;
    CAPTURE(low, high, low_open, high_open);
    CHECK(range_error(spec, 2.5).empty() == !(low && low_open));
    CHECK(range_error(spec, 7.5).empty() == !(high && high_open));
    CHECK(range_error(spec, 2.4).empty() == !low);
    CHECK(range_error(spec, 7.6).empty() == !high);
    CHECK(range_error(spec, 5.0).empty());
    const std::string words = low && high
                                  ? std::string(low_open ? "(" : "[") + "2.5, 7.5" + (high_open ? ")" : "]")
                              : low  ? std::string(low_open ? "> " : ">= ") + "2.5"
                              : high ? std::string(high_open ? "< " : "<= ") + "7.5"
                                     : "any number";
    CHECK(range_text(spec) == words);
    const std::string got = "; got nan";
    CHECK(range_error(spec, nan_value) == (low && high   ? "must be a finite number in " + words + got
                                           : low || high ? "must be a finite number " + words + got
                                                         : "must be a finite number" + got));
    // Asked for a number and given a text, a person is told that it is a number, too.
    CHECK(wanted_text(spec) == (low && high   ? "a number in " + words
                                : low || high ? "a number " + words
                                              : "a finite number"));
  }
  ParamSpec whole = integer_param("n", 3, 2, 8, "");
  whole.min = -infinity;
  whole.max = infinity;
  CHECK(range_text(whole) == "any whole number");
  CHECK(wanted_text(whole) == "a whole number");
}

TEST_CASE("no end is a number only where it is the default, and only that one") {
  const double infinity = std::numeric_limits<double>::infinity();
  const ParamSpec endless = real_param("t", "s", infinity, 0.5, infinity, "");
  CHECK(range_error(endless, infinity).empty());
  CHECK_FALSE(range_error(endless, -infinity).empty());
  CHECK_FALSE(range_error(endless, nan_value).empty());
  CHECK_FALSE(range_error(endless, 0.25).empty());
  CHECK_FALSE(range_error(real_param("t", "s", 3.5, 0.5, infinity, ""), infinity).empty());
}

TEST_CASE("numbers in messages read back as they are, whole ones without an exponent") {
  const auto got = [](double x) {
    const std::string text = range_error(boolean_param("b", true, ""), x),
                      head = "must be true or false; got ";
    REQUIRE(text.substr(0, head.size()) == head);
    return text.substr(head.size());
  };
  std::mt19937_64 dice(17);
  for (int trial = 0; trial < 2000; ++trial) {
    double x = static_cast<double>(dice()) * std::pow(10.0, static_cast<double>(dice() % 50) - 35);
    if (trial % 2) x = -x;
    if (trial % 5 == 0) x = std::round(std::fmod(x, 3e7));
    const std::string text = got(x);
    double again = 0;
    std::from_chars(text.data(), text.data() + text.size(), again);
    CHECK(again == x);
    if (x == std::round(x) && std::abs(x) < 1e7) CHECK(text.find('e') == std::string::npos);
  }
  CHECK(got(9999999) == "9999999");
  CHECK(got(1e7) == "1e+07");
  CHECK(got(-100000) == "-100000");
  CHECK(got(0.1) == "0.1");
  CHECK(got(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(got(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(got(nan_value) == "nan");
}

TEST_CASE("a parameter that belongs to a value of another means something only with it") {
  const ParamSpec law = choice_param("law", "ramp", {"ramp", "pulse", "sine"}, "");
  const ParamSpec rise = only_with("law", {"ramp", "sine"}, positive_param("rise", "s", 2.5, ""));
  const ParamSpec depth = only_with("held", {"true"}, positive_param("depth", "m", 2.5, ""));
  const std::vector<ParamSpec> specs{law, rise, boolean_param("held", false, ""), depth};
  ParamSet set(specs);
  CHECK(means_something(law, specs, set));
  for (const std::string value : {"ramp", "pulse", "sine"}) {
    set.set("law", value);
    CHECK(means_something(rise, specs, set) == (value != "pulse"));
  }
  CHECK_FALSE(means_something(depth, specs, set));
  CHECK(idle_reason(depth, specs, set) == "with held = false");
  set.set("held", true);
  CHECK(means_something(depth, specs, set));
  CHECK(idle_reason(depth, specs, set).empty());
  CHECK(means_something(depth, {law}, ParamSet({law})));  // nobody says that it does not
  CHECK(rise.name == "rise");
  CHECK(required(rise).required);
  CHECK_FALSE(rise.required);
  CHECK(names_param("n", "").required);
}

TEST_CASE(
    "a parameter that goes with a number means something where that is given, has an end and is not 0") {
  const double endless = std::numeric_limits<double>::infinity();
  const std::vector<ParamSpec> specs{positive_param("limit", "A", endless, ""),
                                     only_given("limit", positive_param("per_ampere", "N m/A", 3, "")),
                                     integer_param("parts", 0, 0, 9, ""),
                                     only_given("parts", positive_param("gap", "m", 3, ""))};
  ParamSet set(specs);
  for (const double nothing : {endless, -endless, nan_value, 0.0}) {
    set.set("limit", nothing);
    CHECK_FALSE(means_something(specs[1], specs, set));
    CHECK(idle_reason(specs[1], specs, set) == (nothing == 0 ? "with limit = 0" : "without limit"));
  }
  for (const double some : {-2.5, 1e-300}) {
    set.set("limit", some);
    CHECK(means_something(specs[1], specs, set));
  }
  CHECK(idle_reason(specs[3], specs, set) == "with parts = 0");
  set.set("parts", 4L);
  CHECK(means_something(specs[3], specs, set));
}

TEST_CASE(
    "what goes with a parameter that means nothing means nothing, and either of two conditions is enough") {
  const std::vector<ParamSpec> specs{
      choice_param("control", "none", {"none", "follow"}, ""),
      only_with("control", {"follow"}, choice_param("motion", "hold", {"hold", "smooth"}, "")),
      only_with("motion", {"smooth"}, real_param("to", "deg", 0, -9, 9, "")),
      real_param("stiffness", "N/m", 0, 0, 9, ""),
      boolean_param("slack", false, ""),
      only_with("slack", {"true"}, only_given("stiffness", real_param("free", "m", 0, 0, 9, "")))};
  const ParamSpec &motion = specs[1], &to = specs[2], &free = specs[5];
  ParamSet set(specs);
  CHECK(idle_reason(to, specs, set) == "with motion = 'hold'");
  set.set("motion", std::string("smooth"));
  CHECK(idle_reason(motion, specs, set) == "with control = 'none'");
  CHECK(idle_reason(to, specs, set) == "with control = 'none'");  // what is in its way, not what is met
  set.set("control", std::string("follow"));
  CHECK(means_something(to, specs, set));
  CHECK(idle_reason(free, specs, set) == "with stiffness = 0 and with slack = false");
  set.set("stiffness", 2.5);
  CHECK(means_something(free, specs, set));
  set.set("stiffness", 0.0);
  set.set("slack", true);
  CHECK(means_something(free, specs, set));
}

}  // namespace param_spec_test
