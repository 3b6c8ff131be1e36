// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl::plot {
namespace {

// NaN where the value has no place on the axis.
double place(const Scale& scale, double value, bool zeros_at_floor) {
  if (scale.log && value == 0 && zeros_at_floor) return scale.at_lo;
  if (!std::isfinite(value) || (scale.log && value <= 0)) return std::numeric_limits<double>::quiet_NaN();
  return scale(value);
}

}  // namespace

std::vector<Polyline> trace(const std::vector<double>& x, const std::vector<double>& y,
                            const TraceRules& rules) {
  std::vector<Polyline> pieces;
  Polyline piece;
  const std::size_t n = std::min(x.size(), y.size());
  for (std::size_t i = 0; i <= n; ++i) {
    const Point p = i < n ? Point{place(rules.x, x[i], false), place(rules.y, y[i], rules.zeros_at_floor)}
                          : Point{std::nan(""), 0};
    if (!std::isnan(p.x) && !std::isnan(p.y)) {
      piece.push_back(p);
    } else if (!piece.empty()) {
      pieces.push_back(thinned(piece, trace_column));
      piece.clear();
    }
  }
  return pieces;
}

BandTrace trace_band(const std::vector<double>& x, const std::vector<double>& lower,
                     const std::vector<double>& upper, const TraceRules& rules) {
  BandTrace out;
  bool open = false;
  const std::size_t n = std::min({x.size(), lower.size(), upper.size()});
  for (std::size_t i = 0; i < n; ++i) {
    const double at = place(rules.x, x[i], false);
    const double a = place(rules.y, lower[i], rules.zeros_at_floor),
                 b = place(rules.y, upper[i], rules.zeros_at_floor);
    if (std::isnan(at) || std::isnan(a) || std::isnan(b)) {
      open = false;
      continue;
    }
    if (!open) out.lower.emplace_back(), out.upper.emplace_back();
    open = true;
    Polyline &low = out.lower.back(), &high = out.upper.back();
    // Within a column the widest extent; y grows downwards.
    if (low.size() > 1 && std::floor(low.back().x / trace_column) == std::floor(at / trace_column)) {
      low.back().y = std::max(low.back().y, a);
      high.back().y = std::min(high.back().y, b);
    } else {
      low.push_back({at, a});
      high.push_back({at, b});
    }
  }
  return out;
}

Polyline thinned(const Polyline& line, double column) {
  Polyline out;
  for (std::size_t begin = 0; begin < line.size();) {
    const double index = std::floor(line[begin].x / column);
    std::size_t end = begin + 1;
    while (end < line.size() && std::floor(line[end].x / column) == index) ++end;
    if (end - begin <= 4) {
      out.insert(out.end(), line.begin() + static_cast<std::ptrdiff_t>(begin),
                 line.begin() + static_cast<std::ptrdiff_t>(end));
    } else {
      const auto first = line.begin() + static_cast<std::ptrdiff_t>(begin),
                 last = line.begin() + static_cast<std::ptrdiff_t>(end) - 1;
      const auto lower = [](const Point& a, const Point& b) { return a.y < b.y; };
      auto [low, high] = std::minmax_element(first, last + 1, lower);
      if (high < low) std::swap(low, high);
      out.push_back(*first);
      if (low != first && low != last) out.push_back(*low);
      if (high != low && high != first && high != last) out.push_back(*high);
      out.push_back(*last);
    }
    begin = end;
  }
  return out;
}

}  // namespace unfurl::plot
