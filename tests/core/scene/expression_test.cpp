// SPDX-License-Identifier: BSD-3-Clause
// Arithmetic in scene files, against values known by themselves.
#include "core/scene/expression.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace unfurl;

namespace expression_test {

namespace {

double value(const std::string& text) {
  return evaluate(text, {{"n", 12.0}, {"radius_2", 0.75}});
}

// The message with the place before it: "3: no variable ...".
std::string mistake(const std::string& text) {
  try {
    value(text);
  } catch (const ExpressionError& error) {
    return std::to_string(error.place) + ": " + error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("operators bind as on paper") {
  CHECK(value("7-4-2") == 1.0);
  CHECK(value("24/4/3") == 2.0);
  CHECK(value("2+3*4-5") == 9.0);
  CHECK(value("-3^2") == -9.0);
  CHECK(value("2^3^2") == 512.0);
  CHECK(value("2^-2") == 0.25);
  CHECK(value("(2 + 3) * -4") == -20.0);
  CHECK(value("--5 - +3") == 2.0);
  CHECK(value("1.5e2 + .5") == 150.5);
}

TEST_CASE("a remainder has the sign of what is divided by") {
  CHECK(value("13 % n") == 1.0);
  CHECK(value("(0-1) % n") == 11.0);  // the neighbour before the first in a ring
  CHECK(value("5 % (0-3)") == -1.0);
  CHECK(value("24 % n") == 0.0);
}

TEST_CASE("names are variables, constants and functions") {
  CHECK(value("n*radius_2") == 9.0);
  CHECK(value("cos(60*deg)") == Approx(0.5).epsilon(1e-15));
  CHECK(value("4*atan(1)") == std::numbers::pi);
  CHECK(value("atan2(-1, -1)") == Approx(-3 * std::numbers::pi / 4).epsilon(1e-15));
  CHECK(value("hypot(3, 4) + sqrt(2.25)") == 6.5);
  CHECK(value("min(3, n) + max(3, n) + abs(-2)") == 17.0);
  CHECK(value("min(3, n, 0.5, 2) + max(-1, n, 2^4, 7)") == 16.5);
  CHECK(value("floor(-2.5) + ceil(2.2) + round(2.6)") == 3.0);
  CHECK(value("log(exp(1.25))") == Approx(1.25).epsilon(1e-15));
  CHECK(value("asin(sin(0.3)) + acos(cos(0.4)) + atan(tan(0.5))") == Approx(1.2).epsilon(1e-14));
}

TEST_CASE("mistakes are told with their place") {
  CHECK(mistake("2*m").starts_with("3: no variable 'm'; known: n, radius_2, sin, "));
  CHECK(mistake("radius_3") == "1: no variable 'radius_3'; did you mean 'radius_2'?");
  CHECK(mistake("2*(3+4") == "7: a ')' is missing here");
  CHECK(mistake("2 3") == "3: an operator is missing before this");
  CHECK(mistake("") == "1: a number or a name is missing here");
  CHECK(mistake("2+*3") == "3: a number or a name is missing here");
  CHECK(mistake("atan2(1)") == "8: a ',' is missing here");
  CHECK(mistake("max(1)") == "6: a ',' is missing here");
  CHECK(mistake("max(1, 2, 3") == "12: a ')' is missing here");
  CHECK(mistake("hypot(1, 2, 3)") == "11: a ')' is missing here");
  CHECK(mistake("1/0") == "1: the value is not a finite number");
  CHECK(mistake("sqrt(0-1)") == "1: the value is not a finite number");
  CHECK(mistake(std::string(100000, '(')) == "101: nested too deep");
  std::string powers = "2";
  for (int i = 0; i < 100000; ++i) powers += "^1";
  CHECK(mistake(powers).ends_with("nested too deep"));
}

TEST_CASE("what is not a number stays none, whatever is done with it") {
  CHECK(mistake("max(0.1, sqrt(1 - 1.5^2))") == "10: the value is not a finite number");
  for (const char* text : {"min(0/0, 2)", "max(2, 0/0)", "(0/0)^0", "1^(0/0)", "hypot(1/0, 3)", "atan(1/0)",
                           "1/(1/0)", "exp(-1/0)", "exp(1000)*0", "0*log(0)", "2 % 0", "(2%0)^0", "10^400*0",
                           "1/(1e308+1e308)", "min(1e308+1e308, 5)", "max(-1e308-1e308, 5)"})
    CHECK(mistake(text).ends_with("the value is not a finite number"));
  CHECK(value("exp(-1000) + 2^-2000 + atan2(0, 0) + 0^0") == 1.0);
}

TEST_CASE("what a variable may be called") {
  for (const char* name : {"n", "radius_2", "_x", "Pi"}) CHECK(is_variable_name(name));
  for (const char* name : {"", "2n", "a-b", "pi", "deg", "sin", "a b"}) CHECK_FALSE(is_variable_name(name));
}

}  // namespace expression_test
