// SPDX-License-Identifier: BSD-3-Clause
// Values at equal distances of time, and where between them the largest may lie.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/diagnostics/peaks.hpp"

namespace unfurl {

inline constexpr std::size_t most_tops = 3;  // that are looked at more closely

// Of the parabola through three points, within their times; the middle one where there is none.
inline PeakInMotion vertex(const std::array<double, 3>& t, const std::array<double, 3>& x) {
  const double left = (x[1] - x[0]) / (t[1] - t[0]), right = (x[2] - x[1]) / (t[2] - t[1]);
  const double bend = (right - left) / (t[2] - t[0]);
  if (!(bend < 0)) return {x[1], t[1]};
  const double at = std::clamp(0.5 * (t[0] + t[1]) - left / (2 * bend), t[0], t[2]);
  return {x[0] + (at - t[0]) * (left + bend * (at - t[1])), at};
}

// Where two lines meet between value k and the next, through the values before and behind them: of a
// magnitude that passes zero, or the largest of several. NaN where the values bend beside that, too: a
// parabola tells. `leads` says whether a smooth curve leads from a value to the next, `time` when it is.
template <typename Leads, typename Time>
PeakInMotion corner_in(const std::vector<double>& x, std::size_t k, const Leads& leads, const Time& time) {
  const PeakInMotion none;
  constexpr double bent = 0.25;  // of what bends between them; a parabola bends half as much beside it
  if (k == 0 || !leads(k - 1) || !leads(k) || !leads(k + 1)) return none;
  const auto slope = [&](std::size_t j) { return (x[j + 1] - x[j]) / (time(j + 1) - time(j)); };
  const double rise = slope(k - 1), fall = slope(k + 1), h = time(k + 1) - time(k);
  if (!(rise > 0 && fall < 0)) return none;
  if (k > 1 && leads(k - 2) && std::abs(rise - slope(k - 2)) > bent * (rise - fall)) return none;
  if (leads(k + 2) && std::abs(fall - slope(k + 2)) > bent * (rise - fall)) return none;
  const double in = std::clamp((x[k + 1] - x[k] - fall * h) / (rise - fall), 0.0, h);
  return {x[k] + rise * in, time(k) + in};
}

// At 9 times of a span, both ends among them.
struct PeakSamples {
  PeakSamples(double begin, double end) {
    for (int k = 0; k <= 8; ++k) t.push_back(begin + (end - begin) * k / 8);
  }
  // The largest, and those that are no smaller than their neighbours and could reach `best` beside them; the
  // highest first.
  std::vector<std::size_t> tops(double best) const {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (std::isnan(x[k]) || (k > 0 && x[k - 1] > x[k]) || (k + 1 < x.size() && x[k + 1] > x[k])) continue;
      const double reach = has_both(k) ? std::max(x[k], parabola(k).value) : x[k];
      found.push_back({reach, k});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < std::min(found.size(), most_tops); ++k)
      if (k == 0 || found[k].first >= best) out.push_back(found[k].second);
    return out;
  }
  // Whether there is no more to be found beside value k than rounding of it: its neighbours are the same; or
  // it is at an end, to which the values rise on a polynomial through five of them, within a thousandth of
  // the last rise.
  bool is_known(std::size_t k) const {
    constexpr double round_off = 1e-9, on_polynomial = 1e-3;
    const auto flat = [&](std::size_t j) { return std::abs(x[k] - x[j]) <= round_off * std::abs(x[k]); };
    const std::size_t last = x.size() - 1;
    if ((k == 0 || flat(k - 1)) && (k == last || flat(k + 1))) return true;
    if (last < 4 || (k > 0 && k < last)) return false;
    std::array<double, 5> d{};  // backward differences
    for (std::size_t j = 0; j < d.size(); ++j) d[j] = x[k > 0 ? k - j : j];
    for (std::size_t order = 1; order < d.size(); ++order)
      for (std::size_t j = d.size() - 1; j >= order; --j) d[j] = d[j - 1] - d[j];
    return d[1] > 2 * (std::abs(d[2]) + std::abs(d[3])) && std::abs(d[4]) <= on_polynomial * d[1];
  }
  bool has_both(std::size_t k) const {
    return k > 0 && k + 1 < x.size() && std::isfinite(x[k - 1]) && std::isfinite(x[k + 1]);
  }
  PeakInMotion parabola(std::size_t k) const {
    return vertex({t[k - 1], t[k], t[k + 1]}, {x[k - 1], x[k], x[k + 1]});
  }
  // Whether two smooth curves meet beside it: it bends otherwise than its neighbours do.
  bool is_corner(std::size_t at) const {
    constexpr double told = 1e-9;  // of the value: less is rounding of it
    if (!has_both(at) || std::isnan(x[at])) return false;
    const auto bend = [&](std::size_t k) { return x[k + 1] - 2 * x[k] + x[k - 1]; };
    const double rounding = told * std::abs(x[at]);
    const auto unlike = [&](std::size_t k) {
      return has_both(k) && std::abs(bend(k) - bend(at)) >
                                std::max(0.75 * std::max(std::abs(bend(k)), std::abs(bend(at))), rounding);
    };
    return unlike(at - 1) || unlike(at + 1);
  }
  // Of one beside value k, on its higher side; NaN: none.
  PeakInMotion corner(std::size_t k) const {
    const auto time = [&](std::size_t i) { return t[i]; };
    const auto leads = [&](std::size_t i) {
      return i + 1 < x.size() && std::isfinite(x[i]) && std::isfinite(x[i + 1]);
    };
    const PeakInMotion before = k > 0 ? corner_in(x, k - 1, leads, time) : PeakInMotion(),
                       behind = corner_in(x, k, leads, time);
    return before.value > behind.value || std::isnan(behind.value) ? before : behind;
  }
  std::optional<std::size_t> largest() const {
    std::optional<std::size_t> top;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!std::isnan(x[k]) && (!top || x[k] > x[*top])) top = k;
    return top;
  }
  std::vector<double> t, x;
};

}  // namespace unfurl
