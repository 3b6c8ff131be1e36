// SPDX-License-Identifier: BSD-3-Clause
// Functions over time: their derivatives, and what tables of motion are at and beyond their ends.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/math/lagrange.hpp"
#include "core/math/types.hpp"
#include "core/structure/time_function.hpp"

using namespace unfurl;

namespace time_function_test {

namespace {

// Away from its knots, derivatives against central differences: truncation step^2 times the next but one
// derivative, of order 100 here, round-off 1e-16 / step.
void check_derivatives(const TimeFunction& f, const std::vector<double>& times) {
  const double step = 1e-5;
  for (const double t : times)
    for (const int order : {1, 2})
      CHECK((f.derivative(order - 1, t + step) - f.derivative(order - 1, t - step)) / (2 * step) ==
            Approx(f.derivative(order, t)).epsilon(0).margin(1e-6));
}

}  // namespace

TEST_CASE("every kind of function over time has the derivatives that it says") {
  TimeFunction rate;
  rate.kind = TimeFunction::Kind::rate, rate.offset = 0.3, rate.rate = -1.7, rate.ramp = 0.6,
  rate.start = 0.2;
  check_derivatives(rate, {0.1, 0.35, 0.7, 0.9, 2.0});
  CHECK(rate(0.1) == 0.3);
  CHECK(rate.derivative(1, 2.0) == -1.7);
  CHECK(rate(2.0) == Approx(0.3 - 1.7 * (1.8 - 0.3)));  // the ramp costs half of its time
  TimeFunction smooth;
  smooth.kind = TimeFunction::Kind::smooth, smooth.offset = 0.3, smooth.rise = 1.1, smooth.start = 0.2;
  smooth.duration = 0.9;
  check_derivatives(smooth, {0.1, 0.4, 0.65, 1.0, 1.4});
  CHECK(smooth(5) == Approx(1.4));
  TimeFunction linear;
  linear.kind = TimeFunction::Kind::linear, linear.times = {0.1, 0.5, 1.3}, linear.values = {2, 1, 4};
  check_derivatives(linear, {0.05, 0.3, 0.9, 1.5});
  CHECK(linear(9) == 4);
  check_derivatives(make_spline({0.1, 0.5, 1.3, 1.4}, {2, 1, 4, 3.7}), {0.05, 0.3, 0.9, 1.35, 1.5});
}

// Within a piece it is the function; all over, what six of its values there say, of which a piece has no
// higher degree: Lagrange's weights at three lengths of it outside are some 1e5.
TEST_CASE("a piece of a function over time goes on before and behind it") {
  TimeFunction rate, smooth, linear;
  rate.kind = TimeFunction::Kind::rate, rate.offset = 0.3, rate.rate = -1.7, rate.ramp = 0.6,
  rate.start = 0.2;
  smooth.kind = TimeFunction::Kind::smooth, smooth.offset = 0.3, smooth.rise = 1.1, smooth.start = 0.2;
  smooth.duration = 0.6;
  linear.kind = TimeFunction::Kind::linear, linear.times = {0.2, 0.2, 0.8, 0.8}, linear.values = {2, 1, 4, 3};
  for (const TimeFunction& f : {rate, smooth, linear, make_spline({0.2, 0.8, 1.3}, {2, 1, 4})})
    for (const auto& [begin, end] : {std::array{-1.0, 0.2}, std::array{0.2, 0.8}, std::array{1.3, 2.0}}) {
      const TimeFunction piece = f.piece_at(begin);
      const auto node = [from = begin, length = end - begin](std::size_t i) {
        return from + length * (0.05 + 0.18 * static_cast<double>(i));
      };
      for (const double t : {node(0), node(3), node(5)})
        for (const int order : {0, 1, 2})
          CHECK(piece.derivative(order, t) == Approx(f.derivative(order, t)).epsilon(0).margin(1e-13));
      for (const double t : {-2.0, 0.0, 0.5, 1.0, 3.0}) {
        double told = 0;
        for (std::size_t k = 0; k < 6; ++k) told += lagrange_weight(k, 6, t, node) * f(node(k));
        CHECK(piece(t) == Approx(told).epsilon(1e-9).margin(1e-9));
      }
    }
}

namespace {

// A (sin(w s + phase) - sin(phase)) by what it does at the start and half a wave later.
TimeFunction sine_of(double A, double frequency, double phase, double start, double ramp) {
  TimeFunction f;
  f.kind = TimeFunction::Kind::sine, f.offset = 0.3, f.start = start, f.ramp = ramp;
  f.duration = 1 / frequency, f.rate = A * 2 * pi * frequency * std::cos(phase),
  f.rise = -2 * A * std::sin(phase);
  return f;
}

Approx near(double x) {
  return Approx(x).epsilon(0).margin(1e-12);
}

}  // namespace

// The closed form itself; what rounds is 1e-16 of the terms of each derivative, of A w^2 = 70 at most, times
// a phase w t of 60.
TEST_CASE("a sine is what it says with and without a ramp") {
  const double A = 0.2, w = 2 * pi * 3, start = 0.2, ramp = 0.7;
  for (const double phase : {0.0, 0.4, 0.5 * pi, 3.0, -1.1}) {
    const TimeFunction at_once = sine_of(A, 3, phase, start, 0.0), f = sine_of(A, 3, phase, start, ramp);
    for (const double t : {0.0, 0.1999, 0.2001, 0.31, 0.77, 0.8999, 0.9001, 1.7, 3.3}) {
      const double s = t - start, u = std::min(s / ramp, 1.0), v = 1 - u;
      const double g = A * (std::sin(w * s + phase) - std::sin(phase)), dg = A * w * std::cos(w * s + phase),
                   ddg = -A * w * w * std::sin(w * s + phase);
      const double e = u * u * u * (10 - 15 * u + 6 * u * u), de = 30 * u * u * v * v / ramp,
                   dde = 60 * u * v * (v - u) / (ramp * ramp);
      const auto there = [s](double x) { return s < 0 ? 0.0 : x; };
      CHECK(at_once(t) == near(0.3 + there(g)));
      CHECK(at_once.derivative(1, t) == near(there(dg)));
      CHECK(at_once.derivative(2, t) == near(there(ddg)));
      CHECK(f(t) == near(0.3 + there(e * g)));
      CHECK(f.derivative(1, t) == near(there(de * g + e * dg)));
      CHECK(f.derivative(2, t) == near(there(dde * g + 2 * de * dg + e * ddg)));
    }
    // Twice continuously differentiable where the ramp begins and ends: the third derivative is below A w^3
    // + 60 A / ramp^3, of order 1e3, over 1e-9 s.
    for (const double edge : {start, start + ramp})
      for (const int order : {0, 1, 2})
        CHECK(f.derivative(order, edge - 5e-10) ==
              Approx(f.derivative(order, edge + 5e-10)).epsilon(0).margin(1e-5));
  }
}

// A piece goes on as it is: before the start as waves do, in a ramp as its polynomial.
TEST_CASE("a piece of a sine is a sine at all times") {
  const TimeFunction f = sine_of(0.2, 3, 0.4, 0.2, 0.7), waves = f.piece_at(0.9);
  for (const double t : {-1.0, 0.1, 0.5, 4.0}) {
    CHECK(waves(t) == near(0.3 + 0.2 * (std::sin(6 * pi * (t - 0.2) + 0.4) - std::sin(0.4))));
    CHECK(f.piece_at(0.1)(t) == 0.3);
    for (const int order : {0, 1, 2})
      CHECK(waves.piece_at(7).derivative(order, t) == waves.derivative(order, t));
  }
  for (const double t : {0.21, 0.5, 0.89})
    for (const int order : {0, 1, 2})
      CHECK(f.piece_at(0.2).derivative(order, t) == near(f.derivative(order, t)));
  check_derivatives(waves, {-1.0, 0.1, 0.5, 4.0});
  check_derivatives(f.piece_at(0.2), {0.1, 0.5, 1.0});
}

// Of a million waves none is lost: a phase of 6e6 rounds to 1e-9, whole waves to nothing but the time's own.
TEST_CASE("whole waves of a sine end where they began") {
  const TimeFunction f = sine_of(0.2, 4, 0.3, 0.5, 0.0);
  for (const double waves : {1.0, 7.0, 1000000.0}) CHECK(f(0.5 + waves / 4) == 0.3);
  const TimeFunction rests = sine_of(0.2, 4, 0.5 * pi, 0.5, 0.0);
  CHECK(rests(0.5 + 0.125) == Approx(0.3 - 0.4).epsilon(1e-15));
}

TEST_CASE("a table of motion begins and ends at rest, and holds its last value") {
  const TimeFunction f = make_spline({0.2, 0.7, 1.1, 2.0}, {1.5, 1.7, 2.9, 2.4});
  for (const auto& [t, value] : {std::pair{0.2, 1.5}, {0.7, 1.7}, {1.1, 2.9}, {2.0, 2.4}})
    CHECK(f(t) == Approx(value).epsilon(1e-14));
  for (const double end : {0.2, 2.0}) CHECK(f.derivative(1, end) == Approx(0).epsilon(0).margin(1e-14));
  for (const double before : {-3.0, 0.0, 0.19}) CHECK(f(before) == 1.5);
  for (const double behind : {2.1, 50.0}) {
    CHECK(f(behind) == 2.4);
    CHECK(f.derivative(1, behind) == 0);
    CHECK(f.derivative(2, behind) == 0);
  }
  for (const double knot : {0.7, 1.1})  // twice continuously differentiable
    for (const int order : {0, 1, 2})
      CHECK(f.derivative(order, knot - 1e-12) ==
            Approx(f.derivative(order, knot + 1e-12)).epsilon(0).margin(1e-9));
}

TEST_CASE("the spline through a cubic that rests at both ends is that cubic") {
  const double from = 0.3, T = 1.7, rise = -2.2;
  const auto cubic = [&](double t) {
    const double u = (t - from) / T;
    return 0.4 + rise * u * u * (3 - 2 * u);
  };
  std::vector<double> times, values;
  for (const double share : {0.0, 0.13, 0.4, 0.81, 1.0}) {
    times.push_back(from + share * T);
    values.push_back(cubic(times.back()));
  }
  const TimeFunction f = make_spline(times, values);
  for (double t = from; t < from + T; t += 0.0731) CHECK(f(t) == Approx(cubic(t)).epsilon(1e-13));
  const TimeFunction two = make_spline({from, from + T}, {cubic(from), cubic(from + T)});
  for (double t = from; t < from + T; t += 0.0731) CHECK(two(t) == Approx(cubic(t)).epsilon(1e-13));
}

// What is rounded of start + duration is 1e-16 of the time, of a ramp of 1e-9 s 1e-6: without care an
// acceleration of 1e-6 rate / ramp.
TEST_CASE("a short ramp has no acceleration left at its end as doubles add it") {
  for (int i = 1; i < 200; ++i)
    for (const double ramp : {1.1e-9, 3.3e-8, 1e-6}) {
      TimeFunction f;
      f.kind = TimeFunction::Kind::rate, f.start = 0.1 * i, f.rate = 2, f.ramp = ramp;
      const double end = f.start + ramp;
      CHECK(f.derivative(2, end) == 0);
      CHECK(f.derivative(1, end) == 2);
      CHECK(f.derivative(2, f.start) == 0);
      CHECK(f.derivative(2, f.start + 0.5 * ramp) == Approx(3 / ramp).epsilon(1e-4));
      f.kind = TimeFunction::Kind::smooth, f.rise = 0.3, f.duration = ramp;
      CHECK(f.derivative(2, end) == 0);
      CHECK(f(end) == 0.3);
    }
}

// Half of a ramp is lost, whatever its form: without it, it begins that much later, and is the same behind
// it.
TEST_CASE("what is made a jump is behind it what it was") {
  const double near = 1e-3;
  TimeFunction rate;
  rate.kind = TimeFunction::Kind::rate, rate.offset = 0.3, rate.rate = -1.7, rate.ramp = 4e-4,
  rate.start = 0.2;
  TimeFunction jumps = rate;
  CHECK(make_jumps(jumps, near));
  CHECK(jumps.ramp == 0);
  for (const double t : {0.1, 0.201, 0.9, 3.0})
    for (const int order : {0, 1, 2})
      CHECK(jumps.derivative(order, t) == Approx(rate.derivative(order, t)).epsilon(0).margin(1e-15));
  CHECK(make_jumps(rate, 3e-4));  // a ramp of that length is none of these
  CHECK(rate.ramp == 4e-4);
}

// A spike of 5 between what falls to 0 and what falls to -4 is not made up by one jump of the same area
// within its flank; of neighbours a thousand times as long as that the share that it costs is a thousandth.
TEST_CASE("a line that jumps keeps its area or is said not to where that can be seen") {
  const auto line = [](double before, double flank, double behind, const std::vector<double>& values) {
    TimeFunction f;
    f.kind = TimeFunction::Kind::linear;
    f.times = {0.2, 0.2 + before, 0.2 + before + flank, 0.2 + before + flank + behind};
    f.values = values;
    return f;
  };
  const auto area = [](const TimeFunction& f) {
    double sum = 0;
    for (std::size_t i = 1; i < f.times.size(); ++i)
      sum += 0.5 * (f.times[i] - f.times[i - 1]) * (f.values[i] + f.values[i - 1]);
    return sum;
  };
  const double near = 1e-3;
  for (const double before : {0.7, 0.03})
    for (const double behind : {0.4, 0.05}) {
      TimeFunction f = line(before, 2e-4, behind, {0.3, 0.7, 5.1, 4.2});
      const double wanted = area(f);
      CHECK(make_jumps(f, near));
      CHECK(f.times[1] == f.times[2]);
      CHECK(area(f) == Approx(wanted).epsilon(1e-13));
      TimeFunction spike = line(before, 2e-4, behind, {0.1, 0.2, 5.0, -4.0});
      CHECK(make_jumps(spike, near) == (before > 0.2 && behind > 0.2));
    }
}

}  // namespace time_function_test
