// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/ticks.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace unfurl::plot {

using Values = std::vector<double>;
using Texts = std::vector<std::string>;

TEST_CASE("linear ticks are the multiples of 1, 2 or 5 that are allowed", "[ticks]") {
  const Ticks unit = linear_ticks(0, 1, 6);
  CHECK(unit.major == Values{0, 0.2, 0.4, 0.6, 0.8, 1.0});  // exact: decimals, not sums of 0.2
  CHECK(unit.labels == Texts{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(unit.note.empty());

  CHECK(linear_ticks(0, 4.92, 7).major == Values{0, 1, 2, 3, 4});
  CHECK(linear_ticks(-43, 44, 5).labels == Texts{"\u221240", "\u221220", "0", "20", "40"});
  CHECK(linear_ticks(0.3, 0.9, 3).major == Values{0.4, 0.6, 0.8});
}

TEST_CASE("there are never more ticks than asked for and never fewer than a third", "[ticks]") {
  for (const double hi : {1.0, 1.7, 2.3, 4.99, 5.0, 7.1, 9.99, 123.4, 3e-9, 8e250}) {
    for (int most = 3; most <= 10; ++most) {
      const auto n = static_cast<int>(linear_ticks(0, hi, most).major.size());
      CAPTURE(hi, most, n);
      CHECK(n <= most);
      CHECK(3 * n >= most);  // neighbouring steps differ by 2.5 at most, and the ends may cost a tick
    }
  }
}

TEST_CASE("minor ticks divide a step and lie between the major ones", "[ticks]") {
  const Ticks t = linear_ticks(0, 1, 3);  // step 0.5 in five parts
  REQUIRE(t.major == Values{0, 0.5, 1});
  REQUIRE(t.minor.size() == 8);
  for (std::size_t i = 0; i < 8; ++i)
    CHECK(t.minor[i] == Approx(0.1 * static_cast<double>(i + 1 + i / 4)).epsilon(1e-14));
}

TEST_CASE("long labels become short ones and a note", "[ticks]") {
  const Ticks big = linear_ticks(0, 1.2e6, 4);
  CHECK(big.note == "\u00D710\u2076");
  CHECK(big.labels == Texts{"0.0", "0.5", "1.0"});
  const Ticks tiny = linear_ticks(-3.5e-13, -3e-13, 3);
  CHECK(tiny.note == "\u00D710\u207B\u00B9\u2075");
  CHECK(tiny.labels == Texts{"\u2212340", "\u2212320", "\u2212300"});
  const Ticks far = linear_ticks(1000.25, 1000.2500004, 3);
  CHECK(far.note == "\u00D710\u207B\u2079 + 1000.25");
  CHECK(far.labels == Texts{"0", "200", "400"});
}

TEST_CASE("angles have ticks at 15, 30, 45 and 90 degrees", "[ticks]") {
  CHECK(degree_ticks(0, 90, 4).major == Values{0, 30, 60, 90});
  CHECK(degree_ticks(0, 90, 3).major == Values{0, 45, 90});
  CHECK(degree_ticks(-180, 180, 5).major == Values{-180, -90, 0, 90, 180});
  CHECK(degree_ticks(0, 90, 7).labels == Texts{"0", "15", "30", "45", "60", "75", "90"});
  CHECK(degree_ticks(0, 0.5, 6).labels.back() == "0.5");
}

TEST_CASE("log ticks are powers of ten with superscripts", "[ticks]") {
  const Ticks t = log_ticks(1e-17, 1e-14, 6);
  CHECK(t.labels == Texts{"10\u207B\u00B9\u2077", "10\u207B\u00B9\u2076", "10\u207B\u00B9\u2075",
                          "10\u207B\u00B9\u2074"});
  REQUIRE(t.major.size() == 4);
  for (int i = 0; i < 4; ++i)
    CHECK(t.major[static_cast<std::size_t>(i)] == Approx(std::pow(10.0, i - 17)).epsilon(1e-14));
  CHECK(t.minor.size() == 3 * 8);  // 2..9 in each decade
  CHECK(t.minor.front() == Approx(2e-17).epsilon(1e-14));
}

TEST_CASE("many decades are labelled at multiples of a stride", "[ticks]") {
  const Ticks t = log_ticks(1e-16, 1e-2, 8);
  CHECK(t.labels.size() == 8);
  CHECK(t.labels.front() == "10\u207B\u00B9\u2076");
  CHECK(t.labels[1] == "10\u207B\u00B9\u2074");
  CHECK(t.minor.size() == 7);  // the decades between
  CHECK(log_ticks(1e-300, 1e300, 6).labels.size() <= 7);
  CHECK(log_ticks(2, 7, 6).major == Values{2, 3, 4, 5, 6, 7});  // inside a decade: as on a linear axis
}

TEST_CASE("counts have ticks at whole numbers, labelled as such", "[ticks]") {
  CHECK(whole_ticks(0, 1.08, 6).major == std::vector<double>{0, 1});
  CHECK(whole_ticks(0, 1.08, 6).minor.empty());
  CHECK(whole_ticks(-0.5, 2.5, 8).labels == std::vector<std::string>{"0", "1", "2"});
  for (const double hi : {0.5, 1.08, 2.16, 3.3, 7.5, 21.0, 108.0, 5400.0, 3e6})
    for (int most = 1; most <= 12; ++most) {
      CAPTURE(hi, most);
      const Ticks ticks = whole_ticks(-0.5, hi, most);
      CHECK(std::ssize(ticks.major) <= most);
      CHECK(ticks.labels.size() == ticks.major.size());
      for (const auto* of : {&ticks.major, &ticks.minor})
        for (const double v : *of) CHECK(v == std::round(v));
    }
}

TEST_CASE("ranges without extent have no ticks", "[ticks]") {
  CHECK(linear_ticks(1, 1, 5).major.empty());
  CHECK(linear_ticks(2, 1, 5).major.empty());
  CHECK(linear_ticks(-1e308, 1e308, 5).major.empty());
  CHECK(linear_ticks(0, std::nan(""), 5).major.empty());
  CHECK(linear_ticks(0, 1e-310, 5).major.empty());
}

TEST_CASE("numbers are written as people write them", "[ticks]") {
  CHECK(superscript(-1234567890) == "\u207B\u00B9\u00B2\u00B3\u2074\u2075\u2076\u2077\u2078\u2079\u2070");
  CHECK(format_number(4.92, 6) == "4.92");
  CHECK(format_number(0.0125, 2) == "0.013");
  CHECK(format_number(2.220446049250313e-16, 2) == "2.2\u00D710\u207B\u00B9\u2076");
  CHECK(format_number(9.996, 3) == "10");
  CHECK(format_number(99999.6, 3) == "1\u00D710\u2075");
  CHECK(format_number(-2240, 4) == "\u22122240");
  CHECK(format_number(0, 3) == "0");
  CHECK(format_number(std::nan(""), 3) == "not a number");
  CHECK(format_fixed(-0.0004, 2) == "0.00");
  CHECK(format_fixed(-0.04, 2) == "\u22120.04");
}

TEST_CASE("a share that falls short of the whole is not called the whole", "[ticks]") {
  CHECK(format_share(0) == "0 %");
  CHECK(format_share(0.854) == "85 %");
  CHECK(format_share(-1) == "\u2212100 %");
  CHECK(format_share(0.994) == "99 %");
  CHECK(format_share(0.9971) == "99.7 %");
  CHECK(format_share(0.99999) == "99.9 %");
  CHECK(format_share(1 - 1e-12) == "100 %");  // deployed, but for rounding
  CHECK(format_share(1.004) == "100 %");
  CHECK(format_share(1.2) == "120 %");
}

}  // namespace unfurl::plot
