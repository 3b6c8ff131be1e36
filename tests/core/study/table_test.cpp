// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/table.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

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

TEST_CASE("short numbers have the digits that are asked for, and no number that can be counted an exponent") {
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> exponent(-12, 12), mantissa(1, 10);
  for (int trial = 0; trial < 3000; ++trial) {
    const int digits = 1 + trial % 9;
    const double x = (trial % 2 ? -1 : 1) * mantissa(dice) * std::pow(10.0, std::round(exponent(dice)));
    const std::string text = short_number(x, digits);
    CAPTURE(x, digits, text);
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(x))) + 1 - digits);
    // Half of the last digit, or of one, where what can be counted is written out.
    const double least = std::abs(x) >= 1 && std::abs(x) < 1e6 ? std::min(unit, 1.0) : unit;
    CHECK(std::abs(number_of(text) - x) <= 0.5000001 * least);
    if (std::abs(x) >= 1 && std::abs(x) < 999999) CHECK(text.find('e') == std::string::npos);
    if (const auto e = text.find('e'); e != std::string::npos) {
      CHECK(text[e + 1] != '+');
      CHECK(text.find_first_of("123456789", e) == e + (text[e + 1] == '-' ? 2 : 1));
    }
    std::size_t shown = 0;
    bool leading = true;
    for (const char c : text.substr(0, text.find('e'))) {
      leading = leading && (c == '0' || c == '.' || c == '-');
      shown += !leading && c != '.' ? 1 : 0;
    }
    if (std::abs(x) < 1 || std::abs(x) >= 1e6) CHECK(static_cast<int>(shown) <= digits);
    CHECK(number_of(exact_number(x)) == x);
  }
  CHECK(short_number(1e6, 3) == "1e6");
  CHECK(short_number(999999.0, 3) == "999999");
  CHECK(short_number(1000.0, 3) == "1000");
  CHECK(short_number(1e100, 3) == "1e100");
  CHECK(exact_number(-0.0) == "0");
}

TEST_CASE("what is a number is read to its end, what is none is none") {
  CHECK(number_of("-1.5e3") == -1500);
  for (const char* text : {"", " 1", "1 ", "1.5m", "x", "1e999", "--1"}) {
    CHECK(std::isnan(number_of(text)));
    CHECK_FALSE(is_number(text));
  }
  CHECK(is_number("nan"));
  CHECK(is_number("-inf"));
  CHECK(is_number("0"));
}

TEST_CASE("a table is the same in CSV and in Markdown, and nothing in it is markup") {
  const Table table{{"name", "n", "m|s", "few"},
                    {{"a,b", "1.5", "x|y", ""}, {"<b>&", "-2e-3", "&amp;", "3"}}};
  CHECK(csv_text(table) == "name,n,m|s,few\n\"a,b\",1.5,x|y,\n<b>&,-2e-3,&amp;,3\n");
  CHECK(markdown_text(table) ==
        "| name | n | m\\|s | few |\n|---|---:|---|---:|\n| a,b | 1.5 | x\\|y |  |\n"
        "| &lt;b>& | -2e-3 | &amp;amp; | 3 |\n");
  CHECK(markdown_text({{"a"}, {}}) == "| a |\n|---|\n");
  CHECK(table.column("m|s") == 2);
  CHECK(table.column("name") == 0);
  CHECK_THROWS_AS(table.column("m"), std::out_of_range);
  CHECK(markdown_line("a < b & c\n</p> <!-- <?x <a <1 &#1; &1 <") ==
        "a < b & c &lt;/p> &lt;!-- &lt;?x &lt;a <1 &amp;#1; &1 <");
  CHECK(markdown_line("&") == "&");
  CHECK(markdown_line("\x1b[1m") == "\\x1b[1m");
}

}  // namespace table_test
