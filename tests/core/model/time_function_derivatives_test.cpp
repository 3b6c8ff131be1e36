// Every kind of time function: its derivatives are those of its value, and it goes where it says.
#include "core/model/time_function.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

namespace time_function_derivatives_test {

namespace {

struct Named {
  const char* name;
  TimeFunction f;
};

std::vector<Named> all_kinds() {
  TimeFunction constant;
  constant.offset = 2.3;
  TimeFunction rate = constant;
  rate.kind = TimeFunction::Kind::rate;
  rate.rate = -1.7, rate.ramp = 0.4, rate.start = 0.3;
  TimeFunction at_once = rate;
  at_once.ramp = 0;
  TimeFunction smooth = constant;
  smooth.kind = TimeFunction::Kind::smooth;
  smooth.rise = 3.1, smooth.start = 0.2, smooth.duration = 0.9;
  TimeFunction linear = constant;
  linear.kind = TimeFunction::Kind::linear;
  linear.times = {0.1, 0.5, 1.3}, linear.values = {1.5, -0.7, 2.2};
  return {{"constant", constant},    {"rate", rate},
          {"rate at once", at_once}, {"smooth", smooth},
          {"linear", linear},        {"spline", make_spline({0.1, 0.5, 0.8, 1.3}, {1.5, -0.7, 2.2, 0.4})}};
}

}  // namespace

TEST_CASE("time functions: derivatives are those of the value, away from knots") {
  // Centred differences with d = 1e-5: d^2 f'''/6 is below 1e-7 here (f''' up to some hundreds), round-off
  // 1e-16 / d = 1e-11.
  constexpr double d = 1e-5;
  for (const auto& [name, f] : all_kinds())
    for (const double t : {-0.35, 0.07, 0.26, 0.45, 0.62, 0.91, 1.21, 1.72}) {
      INFO(name << " at " << t);
      CHECK(f.derivative(1, t) == Approx((f(t + d) - f(t - d)) / (2 * d)).margin(2e-7));
      CHECK(f.derivative(2, t) ==
            Approx((f.derivative(1, t + d) - f.derivative(1, t - d)) / (2 * d)).margin(2e-6));
    }
}

TEST_CASE("time functions: where they begin and end") {
  const auto kinds = all_kinds();
  const TimeFunction &constant = kinds[0].f, &rate = kinds[1].f, &at_once = kinds[2].f, &smooth = kinds[3].f,
                     &linear = kinds[4].f, &spline = kinds[5].f;
  CHECK(constant(17.0) == 2.3);
  CHECK_FALSE(constant.moves());
  CHECK(rate.moves());
  CHECK(rate(0.3) == Approx(2.3));
  CHECK(rate(0.7) == Approx(2.3 - 1.7 * 0.2));  // the mean rate of a symmetric ramp is half of it
  CHECK(rate(1.7) == Approx(2.3 - 1.7 * 1.2));
  CHECK(at_once(1.7) == Approx(2.3 - 1.7 * 1.4));
  CHECK(at_once.derivative(1, 0.3) == -1.7);
  CHECK(smooth(0.1) == Approx(2.3));
  CHECK(smooth(0.65) == Approx(2.3 + 1.55));                // half way at half time
  CHECK(smooth(0.425) == Approx(2.3 + 3.1 * 0.103515625));  // u = 1/4: 10/64 - 15/256 + 6/1024
  CHECK(smooth(3.0) == Approx(2.3 + 3.1));
  CHECK(linear(0.3) == Approx(2.3 + 0.4));
  CHECK(linear(-1.0) == Approx(2.3 + 1.5));  // held beyond its ends
  CHECK(linear(9.0) == Approx(2.3 + 2.2));
  CHECK(linear.derivative(1, 9.0) == 0);
  for (std::size_t i = 0; i < spline.times.size(); ++i)
    CHECK(spline(spline.times[i]) == Approx(spline.values[i]));
}

TEST_CASE("time functions: a natural spline has no bend at its ends and none that jumps within") {
  const TimeFunction f = make_spline({0.1, 0.5, 0.8, 1.3}, {1.5, -0.7, 2.2, 0.4});
  CHECK(f.derivative(2, 0.1) == Approx(0).margin(1e-12));
  CHECK(f.derivative(2, 1.3) == Approx(0).margin(1e-12));
  for (const double knot : {0.5, 0.8})
    for (const int order : {0, 1, 2}) {
      INFO("knot " << knot << ", derivative " << order);  // third derivatives of some hundreds times 2e-9
      CHECK(f.derivative(order, knot - 1e-9) == Approx(f.derivative(order, knot + 1e-9)).margin(5e-6));
    }
  // A spline through a straight line is that line.
  const TimeFunction line = make_spline({0, 0.3, 1, 1.1}, {2, 2.9, 5, 5.3});
  CHECK(line(0.77) == Approx(2 + 3 * 0.77));
  CHECK(line.derivative(1, 0.05) == Approx(3));
}

}  // namespace time_function_derivatives_test
