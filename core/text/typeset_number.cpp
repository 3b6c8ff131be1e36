// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/typeset_number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace unfurl {
namespace {

constexpr const char* minus = "\u2212";
constexpr const char* times = "\u00D7";

}  // namespace

std::string superscript(int n) {
  static constexpr std::array digits{"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string out;
  for (const char c : std::to_string(n))
    out += c == '-' ? "\u207B" : digits[static_cast<std::size_t>(c - '0')];
  return out;
}

std::string power_of_ten(int n) {
  return "10" + superscript(n);
}

std::string format_fixed(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string out = text;
  if (out.front() != '-') return out;
  out.erase(0, 1);
  return out.find_first_not_of("0.") == std::string::npos ? out : minus + out;
}

std::string format_share(double share) {
  constexpr double rounding = 1e-9;
  const bool short_of_whole = share >= 0.995 && share < 1 - rounding;
  return format_fixed(short_of_whole ? std::floor(1000 * share) / 10 : 100 * share, short_of_whole) + " %";
}

std::string format_number(double value, int digits) {
  if (!std::isfinite(value))
    return std::isnan(value) ? "not a number" : value > 0 ? "\u221E" : minus + std::string("\u221E");
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", std::max(digits, 1) - 1,
                value);  // rounds first: 9.996 has exponent 1
  const int exponent = std::atoi(std::string(text).substr(std::string(text).find('e') + 1).c_str());
  const bool plain = value == 0 || (exponent >= -3 && exponent < 5);
  std::string out =
      plain ? format_fixed(value, std::max(0, digits - 1 - exponent))
            : format_fixed(std::atof(std::string(text).substr(0, std::string(text).find('e')).c_str()),
                           digits - 1);
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return plain ? out : out + times + power_of_ten(exponent);
}

}  // namespace unfurl
