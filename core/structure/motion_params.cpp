// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/motion_params.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "core/math/types.hpp"

namespace unfurl {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

struct SineAndCosine {
  double sine, cosine;
};

// Of degrees: exactly 0, 1 and -1 at whole quarter turns, of which drives set out from rest.
SineAndCosine sine_and_cosine(double degrees) {
  const double within = std::remainder(degrees, 360.0), quarters = std::nearbyint(within / 90);
  const double rest = (within - 90 * quarters) * radians_per_degree, s = std::sin(rest), c = std::cos(rest);
  if (quarters == 0) return {s, c};
  if (std::abs(quarters) == 2) return {-s, -c};
  return quarters > 0 ? SineAndCosine{c, -s} : SineAndCosine{-c, s};
}

}  // namespace

std::vector<ParamSpec> motion_params(std::string_view unit, std::vector<std::string_view> before) {
  std::vector<std::string_view> motions = std::move(before);
  for (const std::string_view motion : {"hold", "rate", "smooth", "sine", "table"}) motions.push_back(motion);
  const std::string_view fallback = motions.front();
  return {
      choice_param(
          "motion", fallback, std::move(motions),
          "hold the value at t = 0, or drive it: at a constant rate, smoothly to a value, as a sine, "
          "along a table"),
      only_with("motion", {"rate"},
                real_param("rate",
                           unit == "m"     ? "m/s"
                           : unit == "deg" ? "deg/s"
                                           : "",
                           0.0, -infinite, infinite, "rate: per second")),
      only_with(
          "motion", {"sine"},
          real_param("amplitude", unit, not_given, -infinite, infinite,
                     "sine: the value is that at t = 0 + amplitude (sin(360 deg frequency (t - start) + "
                     "phase) - sin(phase))")),
      only_with("motion", {"sine"}, positive_param("frequency", "Hz", not_given, "sine: waves per second")),
      only_with("motion", {"sine"},
                real_param("phase", "deg", 0.0, -infinite, infinite,
                           "sine: where in the wave it begins: 90 and -90 set out from rest, at a turning "
                           "point")),
      only_with("motion", {"rate", "sine"},
                real_param("ramp", "s", 0.0, 0.0, infinite,
                           "rate: how long it takes to reach the rate; sine: the amplitude")),
      only_with("motion", {"smooth"},
                real_param("to", unit, not_given, -infinite, infinite, "smooth: the value in the end")),
      only_with("motion", {"rate", "smooth", "sine"},
                real_param("start", "s", 0.0, 0.0, infinite, "rate, smooth, sine: when the motion begins")),
      only_with("motion", {"smooth"},
                positive_param("duration", "s", 1.0, "smooth: how long the motion takes")),
      only_with("motion", {"table"}, vector_param("times", "s", {}, "table: ascending, with values")),
      only_with("motion", {"table"},
                vector_param("values", unit, {},
                             "table: at the times; a clamped cubic spline goes through them, at rest at both "
                             "ends, held before "
                             "and behind them")),
      only_with("motion", {"table"},
                text_param("table", "",
                           "table: CSV file beside the scene, in place of times and values: t,value"))};
}

TimeFunction motion_function(const ParamSet& values, double initial, double unit) {
  const std::string& motion = values.text("motion");
  TimeFunction f;
  f.offset = initial;
  f.start = values.real("start");
  if (motion == "rate") {
    f.kind = TimeFunction::Kind::rate;
    f.rate = unit * values.real("rate");
    f.ramp = values.real("ramp");
  } else if (motion == "smooth") {
    f.kind = TimeFunction::Kind::smooth;
    f.rise = unit * values.real("to") - initial;
    f.duration = values.real("duration");
  } else if (motion == "sine") {
    f.kind = TimeFunction::Kind::sine;
    f.duration = 1 / values.real("frequency");
    f.ramp = values.real("ramp");
    const SineAndCosine phase = sine_and_cosine(values.real("phase"));
    f.rate = unit * values.real("amplitude") * phase.cosine * 2 * pi / f.duration;
    f.rise = -2 * unit * values.real("amplitude") * phase.sine;
  } else if (motion == "table") {
    std::vector<double> points = values.vector("values");
    for (double& x : points) x *= unit;
    f = make_spline(values.vector("times"), std::move(points));
  }
  return f;
}

}  // namespace unfurl
