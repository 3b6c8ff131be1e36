// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace unfurl::plot {
namespace {

constexpr const char* minus = "\u2212";
constexpr const char* times = "\u00D7";
constexpr double hair = 1e-9;  // a tick this close to the range's end, in steps, still counts as inside

// mantissa * 10^exponent, exact for what a decimal can be: 3 * 10^-1 is 0.3 and not 0.30000000000000004.
double decimal(double mantissa, int exponent) {
  return exponent < 0 ? mantissa / std::pow(10.0, -exponent) : mantissa * std::pow(10.0, exponent);
}

// Step m * 10^k; `parts`: minor intervals in a step.
struct Step {
  int m, k, parts;
  double size() const { return decimal(m, k); }
  double multiple(double i) const { return decimal(i * m, k); }
};

// How many multiples of the step lie in [lo, hi].
double count(double lo, double hi, const Step& s) {
  return std::floor(hi / s.size() + hair) - std::ceil(lo / s.size() - hair) + 1;
}

Step nice_step(double lo, double hi, int most) {
  const int k = static_cast<int>(std::floor(std::log10((hi - lo) / (std::max(most, 1) + 1.0))));
  for (const Step s :
       {Step{1, k, 5}, Step{2, k, 4}, Step{5, k, 5}, Step{1, k + 1, 5}, Step{2, k + 1, 4}, Step{5, k + 1, 5}})
    if (count(lo, hi, s) <= std::max(most, 1)) return s;
  return {1, k + 2, 5};
}

void fill_multiples(double lo, double hi, const Step& s, Ticks& out) {
  const double fine = s.size() / s.parts;
  const double first = std::ceil(lo / fine - hair), last = std::floor(hi / fine + hair);
  for (double i = first; i <= last; ++i) {
    const double major = std::round(i / s.parts);
    if (std::abs(i - major * s.parts) < 0.5)
      out.major.push_back(s.multiple(major) + 0.0);
    else
      out.minor.push_back(i * fine);
  }
}

// "×10³ + 1.5" and the labels that go with it.
void label_linear(double lo, double hi, const Step& s, Ticks& out) {
  const double largest = std::max(std::abs(lo), std::abs(hi));
  double offset = 0;
  if (largest / s.size() > 2e5) {  // labels would differ in their seventh digit
    const int p = static_cast<int>(std::ceil(std::log10(hi - lo)));
    offset = decimal(std::floor(decimal(lo, -p)), p);
    const int digits = static_cast<int>(std::ceil(std::log10(largest))) - p + 1;
    const std::string text = format_number(std::abs(offset), std::clamp(digits, 1, 15));
    out.note = std::string(offset < 0 ? minus : "+") + " " + text;
  }
  const double span = std::max(std::abs(lo - offset), std::abs(hi - offset));
  int exponent = 0;
  if (span >= 1e5 || s.k < -3) exponent = 3 * static_cast<int>(std::floor(std::log10(span * (1 + hair)) / 3));
  if (exponent != 0) out.note = times + power_of_ten(exponent) + (out.note.empty() ? "" : " " + out.note);
  for (const double v : out.major)
    out.labels.push_back(format_fixed(decimal(v - offset, -exponent), std::max(0, exponent - s.k)));
}

}  // namespace

Ticks linear_ticks(double lo, double hi, int most) {
  Ticks out;
  if (!(hi - lo > 1e-295 && std::isfinite(hi - lo))) return out;
  const Step s = nice_step(lo, hi, most);
  fill_multiples(lo, hi, s, out);
  label_linear(lo, hi, s, out);
  return out;
}

Ticks whole_ticks(double lo, double hi, int most) {
  Ticks out = linear_ticks(lo, hi, most);
  const auto broken = [](double v) { return v != std::round(v); };
  std::erase_if(out.minor, broken);
  if (std::ranges::none_of(out.major, broken)) return out;
  // Steps below 1: whole numbers are fewer.
  out = {};
  for (double v = std::ceil(lo); v <= hi; ++v) {
    out.major.push_back(v + 0.0);
    out.labels.push_back(format_fixed(v, 0));
  }
  return out;
}

Ticks degree_ticks(double lo, double hi, int most) {
  static constexpr std::array choices{Step{1, 0, 2},   Step{2, 0, 2},   Step{5, 0, 5},  Step{10, 0, 2},
                                      Step{15, 0, 3},  Step{30, 0, 3},  Step{45, 0, 3}, Step{90, 0, 3},
                                      Step{180, 0, 2}, Step{360, 0, 4}, Step{720, 0, 2}};
  if (!(hi - lo > 1) || !std::isfinite(hi - lo)) return linear_ticks(lo, hi, most);
  const auto* s = std::find_if(choices.begin(), choices.end(),
                               [&](const Step& c) { return count(lo, hi, c) <= std::max(most, 1); });
  if (s == choices.end()) return linear_ticks(lo, hi, most);
  Ticks out;
  fill_multiples(lo, hi, *s, out);
  label_linear(lo, hi, *s, out);
  return out;
}

Ticks log_ticks(double lo, double hi, int most) {
  const int first = static_cast<int>(std::ceil(std::log10(lo) - hair));
  const int last = static_cast<int>(std::floor(std::log10(hi) + hair));
  if (last <= first) return linear_ticks(lo, hi, most);
  int stride = 100;  // the most that doubles need: 10^-308 to 10^308 in seven
  for (const int s : {50, 20, 10, 5, 4, 3, 2, 1})
    if ((last - first) / s + 1 <= std::max(most, 2)) stride = s;
  const int fine = stride <= 10 ? 1 : stride / 5;
  Ticks out;
  for (int k = first - 1; k <= last; ++k) {
    const double power = decimal(1, k);
    if (k >= first && k % stride == 0) {
      out.major.push_back(power);
      out.labels.push_back(power_of_ten(k));
    } else if (k >= first && k % fine == 0) {
      out.minor.push_back(power);
    }
    for (int m = 2; m <= 9 && stride == 1; ++m)
      if (m * power > lo * (1 + hair) && m * power < hi * (1 - hair)) out.minor.push_back(decimal(m, k));
  }
  return out;
}

}  // namespace unfurl::plot
