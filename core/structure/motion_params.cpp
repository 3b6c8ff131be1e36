// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/motion_params.hpp"

#include <limits>
#include <utility>

namespace unfurl {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<ParamSpec> motion_params(std::string_view unit, std::vector<std::string_view> before) {
  std::vector<std::string_view> motions = std::move(before);
  for (const std::string_view motion : {"hold", "rate", "smooth", "table"}) motions.push_back(motion);
  const std::string_view fallback = motions.front();
  return {
      choice_param("motion", fallback, std::move(motions),
                   "hold the value at t = 0, or drive it: at a constant rate, smoothly to a value, along a "
                   "table"),
      only_with("motion", {"rate"},
                real_param("rate",
                           unit == "m"     ? "m/s"
                           : unit == "deg" ? "deg/s"
                                           : "",
                           0.0, -infinite, infinite, "rate: per second")),
      only_with("motion", {"rate"},
                real_param("ramp", "s", 0.0, 0.0, infinite, "rate: how long it takes to reach the rate")),
      only_with("motion", {"smooth"},
                real_param("to", unit, not_given, -infinite, infinite, "smooth: the value in the end")),
      only_with("motion", {"rate", "smooth"},
                real_param("start", "s", 0.0, 0.0, infinite, "rate, smooth: when the motion begins")),
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
  } else if (motion == "table") {
    std::vector<double> points = values.vector("values");
    for (double& x : points) x *= unit;
    f = make_spline(values.vector("times"), std::move(points));
  }
  return f;
}

}  // namespace unfurl
