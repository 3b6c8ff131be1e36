// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl::plot {
namespace {

constexpr double largest = 1e300;    // differences of values up to it are finite
constexpr double smallest = 1e-290;  // ticks of a smaller range would underflow

struct Extent {
  bool log = false;
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  bool zeros = false;

  void add(double v) {
    if (!std::isfinite(v)) return;
    if (v == 0) zeros = true;
    if (log && v <= 0) return;
    v = std::clamp(v, -largest, largest);
    lo = std::min(lo, v);
    hi = std::max(hi, v);
  }
  void add(const std::vector<double>& values) {
    for (const double v : values) add(v);
  }
  bool empty() const { return lo > hi; }
};

Extent data_extent(const Panel& panel, AxisOf which, bool log) {
  Extent e{.log = log};
  for (const Curve& c : panel.curves) {
    if (which == AxisOf::x) e.add(c.x);
    if (which != AxisOf::x && c.right_axis == (which == AxisOf::y2)) e.add(c.y);
  }
  for (const Band& b : panel.bands) {
    if (which == AxisOf::x) e.add(b.x);
    if (which == AxisOf::y) e.add(b.lower), e.add(b.upper);
  }
  for (const ReferenceLine& l : panel.lines)
    if (which == (l.horizontal ? AxisOf::y : AxisOf::x)) e.add(l.value);
  if (which == AxisOf::y2) return e;
  for (const Segment& s : panel.segments)
    e.add(which == AxisOf::x ? s.x0 : s.y0), e.add(which == AxisOf::x ? s.x1 : s.y1);
  for (const Dot& d : panel.dots) e.add(which == AxisOf::x ? d.x : d.y);
  return e;
}

// With some air where two powers of ten or more remain inside; else, and always in y, whole decades, at least
// one, and another one below where zeros sit on the floor.
Limits log_limits(const Extent& e, AxisOf which, bool zeros_at_floor) {
  if (e.empty() && e.zeros && zeros_at_floor) return {1e-17, 1e-15};  // errors of nothing, about round-off
  if (e.empty()) return {0.1, 10.0};
  if (which == AxisOf::x && e.lo > 1e-290) {
    const double air = std::pow(e.hi / e.lo, 0.03), lo = e.lo / air, hi = e.hi * air;
    if (std::floor(std::log10(hi)) - std::ceil(std::log10(lo)) >= 1 && std::isfinite(hi)) return {lo, hi};
  }
  double first = std::floor(std::log10(e.lo) + 1e-9), last = std::ceil(std::log10(e.hi) - 1e-9);
  if (zeros_at_floor && e.zeros && std::log10(e.lo) - first < 0.5) first -= 1;
  if (last <= first) first = last - 1;
  first = std::clamp(first, -307.0, 306.0);
  return {std::pow(10.0, first), std::pow(10.0, std::clamp(last, first + 1, 307.0))};
}

Limits linear_limits(Extent e, AxisOf which) {
  if (e.empty()) return {0.0, 1.0};
  if (e.lo == 0 && e.hi == 0) e.hi = 1;  // nothing but zeros, of what is never negative more often than not
  const double size = std::max(std::abs(e.lo), std::abs(e.hi)), range = e.hi - e.lo;
  const double rounding = which == AxisOf::x ? 1e-12 : 1e-9;  // of values, of what computed them
  if (range <= rounding * size || range < smallest) {
    const double air = size > smallest ? 0.1 * size : 1.0;
    return {e.lo - air, e.hi + air};
  }
  const double air = (which == AxisOf::x ? 0.015 : 0.05) * range;
  // An axis that starts at zero keeps its corner, unless a curve would crawl along the edge.
  const bool keep_zero = which == AxisOf::x && e.lo == 0;
  return {keep_zero ? 0.0 : e.lo - air, e.hi + air};
}

const Axis& axis_of(const Panel& panel, AxisOf which) {
  return which == AxisOf::x ? panel.x : which == AxisOf::y ? panel.y : panel.y2;
}

}  // namespace

Limits axis_limits(const Panel& panel, AxisOf which) {
  const Axis& axis = axis_of(panel, which);
  const bool usable =
      std::abs(axis.min) <= largest && std::abs(axis.max) <= largest && (!axis.log || axis.min > 0);
  if (usable && axis.max - axis.min > smallest) return {axis.min, axis.max};
  const Extent e = data_extent(panel, which, axis.log);
  return axis.log ? log_limits(e, which, axis.zeros_at_floor) : linear_limits(e, which);
}

bool has_floored_zeros(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(), [&](const Curve& c) {
    const Axis& axis = c.right_axis ? panel.y2 : panel.y;
    return axis.log && axis.zeros_at_floor && std::find(c.y.begin(), c.y.end(), 0.0) != c.y.end();
  });
}

}  // namespace unfurl::plot
