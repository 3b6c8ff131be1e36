// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/time_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/math/types.hpp"

namespace unfurl {
namespace {

// Which share of `duration` is over at t: none and all of it also where that is so but for the rounding of
// times, of which a short ramp makes an acceleration.
double share_over(double start, double duration, double t) {
  const double s = t - start, rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
  return s <= rounding ? 0.0 : s >= duration - rounding ? 1.0 : s / duration;
}

double rate_part(const TimeFunction& f, int order, double t) {
  const double s = t - f.start;
  if (s <= 0 || f.ramp == 0)
    return s < 0 || (s == 0 && f.ramp > 0) || order == 2 ? 0.0 : order == 1 ? f.rate : f.rate * s;
  const double u = share_over(f.start, f.ramp, t);
  if (u == 1) return order == 0 ? f.rate * (s - 0.5 * f.ramp) : order == 1 ? f.rate : 0.0;
  if (order == 0) return f.rate * f.ramp * (u * u * u - 0.5 * u * u * u * u);
  return order == 1 ? f.rate * (3 * u * u - 2 * u * u * u) : f.rate / f.ramp * (6 * u - 6 * u * u);
}

// To `rise` within d seconds, of which the share u is over.
double rise_part(double rise, double d, int order, double u) {
  const double v = 1 - u;
  if (order == 0) return rise * u * u * u * (10 + u * (-15 + 6 * u));
  if (order == 1) return rise / d * 30 * u * u * v * v;
  return rise / (d * d) * 60 * u * v * (v - u);
}

double smooth_part(const TimeFunction& f, int order, double t) {
  return rise_part(f.rise, f.duration, order, share_over(f.start, f.duration, t));
}

// Whole waves are left out first: however many there were, their ends are where they began.
double waves(const TimeFunction& f, int order, double t) {
  const double w = 2 * pi / f.duration, turn = 2 * pi * std::remainder((t - f.start) / f.duration, 1.0);
  const double half = std::sin(0.5 * turn);
  if (order == 0) return f.rate / w * std::sin(turn) + f.rise * half * half;
  if (order == 1) return f.rate * std::cos(turn) + 0.5 * f.rise * w * std::sin(turn);
  return w * (0.5 * f.rise * w * std::cos(turn) - f.rate * std::sin(turn));
}

// (size waves)', (size waves)'' of size, size', size''.
double sized_waves(const TimeFunction& f, int order, double t, const std::array<double, 3>& size) {
  double sum = size[0] * waves(f, order, t);
  if (order > 0) sum += order * size[1] * waves(f, order - 1, t);
  return order == 2 ? sum + size[2] * waves(f, 0, t) : sum;
}

double sine_part(const TimeFunction& f, int order, double t) {
  if (t < f.start) return 0.0;
  const double u = f.ramp > 0 ? share_over(f.start, f.ramp, t) : 1.0;
  if (u == 1) return waves(f, order, t);
  const auto size = [&](int k) { return rise_part(1.0, f.ramp, k, u); };
  return sized_waves(f, order, t, {size(0), size(1), size(2)});
}

// The interval of t; before the first and behind the last point the nearest one.
std::size_t interval(const std::vector<double>& x, double t) {
  const auto i = std::upper_bound(x.begin() + 1, x.end() - 1, t) - x.begin();
  return static_cast<std::size_t>(i) - 1;
}

double linear_part(const TimeFunction& f, int order, double t) {
  const double inside = std::clamp(t, f.times.front(), f.times.back());
  if (order == 0 && t >= f.times.back()) return f.values.back();
  if (order == 0 && t < f.times.front()) return f.values.front();
  const std::size_t i = interval(f.times, inside);
  if (f.times[i] == f.times[i + 1]) return 0.0;  // the slope at a jump at an end
  const double slope = (f.values[i + 1] - f.values[i]) / (f.times[i + 1] - f.times[i]);
  if (order == 0) return f.values[i] + slope * (inside - f.times[i]);
  return order == 1 && inside == t ? slope : 0.0;
}

// Continuous from the right: at the last point the bend is already that of what is held.
double spline_part(const TimeFunction& f, int order, double t) {
  if (t < f.times.front()) return order == 0 ? f.values.front() : 0.0;
  if (t >= f.times.back()) return order == 0 ? f.values.back() : 0.0;
  const std::size_t i = interval(f.times, t);
  const double h = f.times[i + 1] - f.times[i], b = (t - f.times[i]) / h, a = 1 - b;
  const double p = f.bends[i], q = f.bends[i + 1];
  if (order == 2) return a * p + b * q;
  if (order == 1 && t == f.times.front()) return 0.0;  // clamped, without the rounding of the bends
  if (order == 1)
    return (f.values[i + 1] - f.values[i]) / h + h / 6 * ((1 - 3 * a * a) * p + (3 * b * b - 1) * q);
  return a * f.values[i] + b * f.values[i + 1] + h * h / 6 * (a * (a * a - 1) * p + b * (b * b - 1) * q);
}

double polynomial(const std::vector<double>& c, int order, double x) {
  double sum = 0;
  for (std::size_t k = c.size(); k-- > static_cast<std::size_t>(order);) {
    double factor = 1;
    for (int i = 0; i < order; ++i) factor *= static_cast<double>(k) - i;
    sum = sum * x + factor * c[k];
  }
  return sum;
}

std::vector<double> rate_piece(const TimeFunction& f, double t) {
  const double ramp = f.ramp;
  if (t < f.start) return {};
  if (ramp > 0 && t < f.start + ramp)
    return {0, 0, 0, f.rate / (ramp * ramp), -0.5 * f.rate / (ramp * ramp * ramp)};
  return {-0.5 * f.rate * ramp, f.rate};
}

// From 0 to `rise` within d from the start on.
std::vector<double> rise_piece(const TimeFunction& f, double rise, double d, double t) {
  if (t < f.start) return {};
  if (!(t < f.start + d)) return {rise};
  const double third = rise / (d * d * d);
  return {0, 0, 0, 10 * third, -15 * third / d, 6 * third / (d * d)};
}

// From the point before t on.
std::vector<double> piece_of_table(TimeFunction& f, double t) {
  const std::vector<double>&x = f.times, &y = f.values;
  if (t < x.front()) return {y.front()};
  if (t >= x.back()) return {y.back()};
  const std::size_t i = interval(x, t);
  const double h = x[i + 1] - x[i], slope = (y[i + 1] - y[i]) / h;
  f.start = x[i];
  if (f.bends.empty()) return {y[i], slope};
  const double p = f.bends[i], q = f.bends[i + 1];
  return {y[i], slope - h / 6 * (2 * p + q), 0.5 * p, (q - p) / (6 * h)};
}

}  // namespace

TimeFunction TimeFunction::piece_at(double t) const {
  t += 4 * std::numeric_limits<double>::epsilon() * std::abs(t);  // behind what rounding puts there
  TimeFunction f = *this;
  f.kind = Kind::piece;
  switch (kind) {
    case Kind::constant:
    case Kind::piece:
    case Kind::wave:
      return *this;
    case Kind::rate:
      f.values = rate_piece(f, t);
      break;
    case Kind::smooth:
      f.values = rise_piece(f, rise, duration, t);
      break;
    case Kind::sine:
      f.values = rise_piece(f, 1.0, ramp, t);
      f.kind = Kind::wave;
      break;
    case Kind::spline:
    case Kind::linear:
      f.values = piece_of_table(f, t);
      break;
  }
  return f;
}

double TimeFunction::derivative(int order, double t) const {
  const double base = order == 0 ? offset : 0.0;
  switch (kind) {
    case Kind::constant:
      return base;
    case Kind::rate:
      return base + rate_part(*this, order, t);
    case Kind::smooth:
      return base + smooth_part(*this, order, t);
    case Kind::spline:
      return base + spline_part(*this, order, t);
    case Kind::linear:
      return base + linear_part(*this, order, t);
    case Kind::piece:
      return base + polynomial(values, order, t - start);
    case Kind::sine:
      return base + sine_part(*this, order, t);
    case Kind::wave: {
      const double s = t - start;
      return base +
             sized_waves(*this, order, t,
                         {polynomial(values, 0, s), polynomial(values, 1, s), polynomial(values, 2, s)});
    }
  }
  return base;
}

bool make_jumps(TimeFunction& f, double near) {
  const bool rate = f.kind == TimeFunction::Kind::rate;
  if ((rate || f.kind == TimeFunction::Kind::sine) && (f.start + f.ramp) - f.start < near) {
    constexpr double at_once = 0.01;  // of that: no step ends between the start and that time
    if (rate) f.start += 0.5 * f.ramp;
    f.ramp = 0;
    if (std::abs(f.start) <= at_once * near) f.start = 0;
  }
  if (f.kind != TimeFunction::Kind::linear) return true;
  constexpr double short_of = 1e3;  // times a flank: what loses a part of itself where the flank moves
  const std::vector<double> t = f.times, &x = f.values;
  bool exact = true;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (i > 1 && t[i] - t[i - 2] < near) exact = false;
    const double flank = t[i] - t[i - 1];
    if (!(flank < near) || flank == 0) continue;
    // The means of what becomes longer before and behind, and of the flank.
    const double before = 0.5 * (x[i - 1] + (i > 1 ? x[i - 2] : x[i - 1])),
                 behind = 0.5 * (x[i] + (i + 1 < t.size() ? x[i + 1] : x[i])), own = 0.5 * (x[i - 1] + x[i]);
    const double share = before != behind ? (own - behind) / (before - behind) : 0.5;
    const bool beside_short = (i > 1 && t[i - 1] - t[i - 2] < short_of * flank) ||
                              (i + 1 < t.size() && t[i + 1] - t[i] < short_of * flank);
    if (!(share >= 0 && share <= 1) && beside_short) exact = false;
    f.times[i] = f.times[i - 1] = t[i - 1] + std::clamp(share, 0.0, 1.0) * flank;
  }
  return exact;
}

// rate cos(w s) + rise w / 2 sin(w s) = 0, once in half a wave. Times next to each other may be farther apart
// than waves.
std::vector<double> turning_times(const TimeFunction& f, double from, double to) {
  if (!(from + 0.25 * f.duration > from) || !std::isfinite(f.duration)) return {};
  const double turn = std::atan2(-f.rate, f.rise * pi / f.duration) / (2 * pi);
  std::vector<double> times;
  for (double k = std::ceil(2 * ((from - f.start) / f.duration - turn));; ++k) {
    const double t = f.start + f.duration * (turn + 0.5 * k);
    if (!(t <= to)) return times;
    times.push_back(t);
  }
}

// Clamped spline: the bends f'' from the tridiagonal system of continuous slopes, which are zero at both
// ends,
//
//     h_{i-1} f''_{i-1} + 2 (h_{i-1} + h_i) f''_i + h_i f''_{i+1} = 6 (s_i - s_{i-1}),   s_i = (y_{i+1} -
//     y_i) / h_i
//
// with h_{-1} = h_{n-1} = s_{-1} = s_{n-1} = 0.
TimeFunction make_spline(std::vector<double> times, std::vector<double> values) {
  const auto n = static_cast<Index>(times.size());
  const Eigen::Map<const VectorXd> x(times.data(), n), y(values.data(), n);
  VectorXd diagonal(n), right(n), upper = VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) {
    const double h0 = i > 0 ? x[i] - x[i - 1] : 0.0, s0 = i > 0 ? (y[i] - y[i - 1]) / h0 : 0.0;
    const double h1 = i + 1 < n ? x[i + 1] - x[i] : 0.0, s1 = i + 1 < n ? (y[i + 1] - y[i]) / h1 : 0.0;
    const double factor = i > 0 ? h0 / diagonal[i - 1] : 0.0;
    upper[i] = h1;
    diagonal[i] = 2 * (h0 + h1) - (i > 0 ? factor * upper[i - 1] : 0.0);
    right[i] = 6 * (s1 - s0) - (i > 0 ? factor * right[i - 1] : 0.0);
  }
  TimeFunction f;
  f.kind = TimeFunction::Kind::spline;
  f.bends.assign(times.size(), 0.0);
  const Eigen::Map<VectorXd> bend(f.bends.data(), n);
  for (Index i = n - 1; i >= 0; --i)
    f.bends[static_cast<std::size_t>(i)] =
        (right[i] - (i + 1 < n ? upper[i] * bend[i + 1] : 0.0)) / diagonal[i];
  f.times = std::move(times);
  f.values = std::move(values);
  return f;
}

}  // namespace unfurl
