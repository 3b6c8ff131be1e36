// SPDX-License-Identifier: BSD-3-Clause
// Motions of one coordinate whose solution is known in closed form, and what they cost.
#include "core/path/scalar_motion.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace unfurl;

namespace scalar_motion_test {

namespace {

struct Law final : ScalarLaw {
  std::function<Value(double s, double v, double t)> law;
  mutable long asked = 0;
  Value at(double s, double v, double t) const override {
    ++asked;
    return law(s, v, t);
  }
};

struct Followed {
  std::vector<ScalarStep> steps;
  double s = 0, v = 0, h = 0;
  bool ended = false;  // no step could be solved
};

Followed follow(const ScalarLaw& law, double t, double s, double v, double latest, double h) {
  Followed out{{}, s, v, h, false};
  while (t < latest && out.steps.size() < 2000) {
    ScalarStep step;
    out.ended = !scalar_step(law, t, out.s, out.v, latest, out.h, step);
    if (out.ended) break;
    CHECK(step.t0 == t);
    CHECK(step.end() <= latest + 1e-15 * latest);
    t = latest - step.end() <= 1e-15 * latest ? latest : step.end();
    step.at(step.end(), out.s, out.v);
    out.steps.push_back(step);
  }
  return out;
}

// s'' = -w^2 s - 2 g s' + f cos(p t) by its particular and its free solution.
struct Oscillator {
  double w, g, f, p;
  std::pair<double, double> at(double t, double t0, double s0, double v0) const {
    const double d = w * w - p * p, size = f / (d * d + 4 * g * g * p * p);
    const auto driven = [&](double x) { return size * (d * std::cos(p * x) + 2 * g * p * std::sin(p * x)); };
    const auto rate = [&](double x) {
      return size * p * (-d * std::sin(p * x) + 2 * g * p * std::cos(p * x));
    };
    const double a = s0 - driven(t0), W = std::sqrt(w * w - g * g), b = (v0 - rate(t0) + g * a) / W;
    const double x = t - t0, e = std::exp(-g * x), c = std::cos(W * x), s = std::sin(W * x);
    return {driven(t) + e * (a * c + b * s), rate(t) + e * ((b * W - g * a) * c - (a * W + g * b) * s)};
  }
};

}  // namespace

TEST_CASE("a driven oscillator is where its closed form is, within every step, by few and long ones") {
  const Oscillator o{3.1, 0.35, 2.2, 1.7};
  Law law;
  law.law = [&](double s, double v, double t) {
    const double parts[] = {-o.w * o.w * s, -2 * o.g * v, o.f * std::cos(o.p * t)};
    return ScalarLaw::Value{parts[0] + parts[1] + parts[2], -o.w * o.w, -2 * o.g,
                            std::abs(parts[0]) + std::abs(parts[1]) + std::abs(parts[2])};
  };
  for (const double first : {1e-6, 0.3, 40.0}) {
    law.asked = 0;
    const Followed run = follow(law, 0.4, 0.9, -1.3, 9.7, first);
    REQUIRE_FALSE(run.ended);
    for (const ScalarStep& step : run.steps)
      for (const double u : {0.0, 0.13, 0.5, 0.77, 1.0}) {
        double s = 0, v = 0;
        step.at(step.t0 + u * step.h, s, v);
        const auto [exact_s, exact_v] = o.at(step.t0 + u * step.h, 0.4, 0.9, -1.3);
        // Tails of s'' below 1e-13 of some 10 m/s^2, over a step of a second; more than ten steps add up.
        CHECK(s == Approx(exact_s).epsilon(0).margin(1e-11));
        CHECK(v == Approx(exact_v).epsilon(0).margin(1e-11));
      }
    // A wave of w over a step of length h has the Legendre coefficients (2 n + 1) j_n(w h / 2) of s'', some
    // z^n / (2 n - 1)!! with z = w h / 2: a tenth of the tenth, which is larger than the eleventh, is 1e-13
    // of them at z = 0.48. With 0.85 of that a step is 0.263 s long: 35 of them, and what the first one
    // costs: from 1e-6 s on they grow by 1.4, while their tails are round-off.
    CHECK(run.steps.size() >= 33);
    CHECK(run.steps.size() <= (first < 1e-3 ? 80 : 38));
    // Linear: Newton's method is there at once, and sees it a second time; what it found wanting is tried
    // again.
    for (const ScalarStep& step : run.steps) CHECK(step.iterations <= 4);
    CHECK(law.asked <= 13 * 4 * 2 * static_cast<long>(run.steps.size()));
  }
}

// The pendulum that just reaches its top: s = 4 atan(e^t) - pi.
TEST_CASE("a pendulum takes for ever to its top, and is where it should be until then") {
  Law law;
  law.law = [](double s, double, double) {
    return ScalarLaw::Value{-std::sin(s), -std::cos(s), 0.0, std::abs(std::sin(s))};
  };
  const auto angle = [](double t) { return 4 * std::atan(std::exp(t)) - std::acos(-1.0); };
  const Followed run = follow(law, -3.0, angle(-3), 2 / std::cosh(3.0), 4.0, 0.05);
  REQUIRE_FALSE(run.ended);
  // What is off grows with e^t behind the lowest point.
  CHECK(run.s == Approx(angle(4)).epsilon(0).margin(1e-10));
  CHECK(run.v == Approx(2 / std::cosh(4.0)).epsilon(0).margin(1e-10));
  CHECK(run.steps.size() <= 35);  // by the same count, and a few that are tried shorter
  for (const ScalarStep& step : run.steps) CHECK(step.iterations <= 7);
}

TEST_CASE("a step ends where it is told, and says what length could have been") {
  Law law;
  law.law = [](double s, double, double) { return ScalarLaw::Value{-s, -1.0, 0.0, std::abs(s)}; };
  ScalarStep step;
  double h = 0.5;
  REQUIRE(scalar_step(law, 2.0, 0.3, 0.4, 2.1, h, step));
  CHECK(step.h == Approx(0.1).epsilon(1e-14));
  CHECK(h >=
        0.3 * (1 - 1e-14));  // what was cut short could be three times as long, and half a second was asked
  h = 0.0995;                // within a hundredth of the end: one step, no sliver behind it
  REQUIRE(scalar_step(law, 2.0, 0.3, 0.4, 2.1, h, step));
  CHECK(step.h == Approx(0.1).epsilon(1e-14));
  h = 0.09;
  REQUIRE(scalar_step(law, 2.0, 0.3, 0.4, 2.1, h, step));
  CHECK(step.h == Approx(0.09).epsilon(1e-14));
  h = 0.5;
  CHECK_FALSE(scalar_step(law, 2.0, 0.3, 0.4, 2.0, h, step));
  CHECK_FALSE(scalar_step(law, 2.0, 0.3, 0.4, 1.9, h, step));
  law.law = [](double, double, double) { return ScalarLaw::Value{}; };
  h = 0.01;  // without a force a step grows to three times the last
  REQUIRE(scalar_step(law, 2.0, 0.3, 0.4, 9.0, h, step));
  CHECK(h == Approx(0.03).epsilon(1e-12));
}

TEST_CASE("a motion is followed up to where its law ends, and hardly further") {
  // s = 0.2 + 0.7 t + 0.3 t^2 reaches 1.5 at t = 1.2196.
  Law law;
  constexpr double reach = 1.5, nan_value = std::numeric_limits<double>::quiet_NaN();
  law.law = [&](double s, double, double) {
    return s <= reach ? ScalarLaw::Value{0.6, 0, 0, 0.6}
                      : ScalarLaw::Value{nan_value, nan_value, nan_value, 0};
  };
  const Followed run = follow(law, 0.0, 0.2, 0.7, 5.0, 0.1);
  CHECK(run.ended);
  const double end = (-0.7 + std::sqrt(0.49 + 4 * 0.3 * 1.3)) / 0.6;
  // The last of a step's points lies at 0.9908 of it: that much of the last step is beyond what was asked.
  CHECK(run.steps.back().t0 <= end);
  CHECK(run.steps.back().t0 + 0.99 * run.steps.back().h <= end);
  CHECK(run.steps.back().end() == Approx(end).epsilon(0).margin(0.02));
  CHECK(run.steps.size() < 80);  // each failure takes six tenths of what is left to try
}

TEST_CASE("a spring and a damper far stiffer than a step is long do not shorten it") {
  // s'' = -k (s - cos t) - c (s' + sin t) - cos t keeps to cos t; k h^2 is some thousand.
  Law law;
  law.law = [](double s, double v, double t) {
    constexpr double k = 4e4, c = 3e2;
    return ScalarLaw::Value{-k * (s - std::cos(t)) - c * (v + std::sin(t)) - std::cos(t), -k, -c, k + c + 1};
  };
  const Followed run = follow(law, 0.0, 1.0, 0.0, 5.0, 0.1);
  REQUIRE_FALSE(run.ended);
  CHECK(run.s == Approx(std::cos(5.0)).epsilon(0).margin(1e-13));
  CHECK(run.v == Approx(-std::sin(5.0)).epsilon(0).margin(1e-12));
  CHECK(run.steps.size() <= 30);
}

}  // namespace scalar_motion_test
