// SPDX-License-Identifier: BSD-3-Clause
// The kinds of [[constraints]] that hold, drive or bound a measure: their parameters, and what each adds to a
// structure.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/scene/element_members.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/motion_params.hpp"

namespace unfurl {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double as_built = std::numeric_limits<double>::quiet_NaN();

std::vector<ParamSpec> operator+(std::vector<ParamSpec> a, const std::vector<ParamSpec>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

template <class Make>
const std::vector<ParamSpec>& measured_once(Make make) {
  static const std::vector<ParamSpec> params = make();
  return params;
}

const std::vector<ParamSpec>& length_params() {
  return measured_once([] { return motion_params("m"); });
}
const std::vector<ParamSpec>& coordinate_params() {
  return measured_once(
      [] { return std::vector{direction_param("direction", "of the coordinate")} + motion_params("m"); });
}
const std::vector<ParamSpec>& angle_params() {
  return measured_once([] {
    return std::vector{vector_param(
               "axis", "", {0, 0, 0},
               "of the hinge: the angle then has a sign and counts any number of turns; none: in [0, 180]")} +
           motion_params("deg");
  });
}

std::vector<ParamSpec> stop_params(std::string_view unit) {
  ParamSpec restitution =
      real_param("restitution", "", 0.0, 0.0, 1.0, "rebound speed over approach speed; 0: no rebound");
  return {real_param("min", unit, as_built, -infinity, infinity, "lower limit; none by default"),
          real_param("max", unit, as_built, -infinity, infinity, "upper limit; none by default"), restitution,
          only_given("restitution", real_param("rest_speed", unit == "m" ? "m/s" : "deg/s", 1e-3, 0.0,
                                               infinity, "rebounds slower than this rest on the stop"))};
}
const std::vector<ParamSpec>& length_stop_params() {
  return measured_once([] { return stop_params("m"); });
}
const std::vector<ParamSpec>& coordinate_stop_params() {
  return measured_once(
      [] { return std::vector{direction_param("direction", "of the coordinate")} + stop_params("m"); });
}
const std::vector<ParamSpec>& angle_stop_params() {
  return measured_once([] {
    return std::vector{vector_param("axis", "", {0, 0, 0}, "of the hinge, as for angle")} +
           stop_params("deg");
  });
}

const std::vector<ParamSpec>& clearance_params() {
  return measured_once([] {
    return std::vector{
        required(positive_param("clearance", "m", 1e-4,
                                "of the pin in its hole: the distance of the nodes at most")),
        real_param("restitution", "", 0.0, 0.0, 1.0, "rebound speed over approach speed; 0: no rebound"),
        only_given("restitution", real_param("rest_speed", "m/s", 1e-3, 0.0, infinity,
                                             "rebounds slower than this rest on the rim"))};
  });
}

// Of the scene's numbers in those of the measure.
double unit_of(const Measure& measure) {
  return is_angle(measure) ? radians_per_degree : 1.0;
}

// Ascending. Of a sine those of its last wave, or of the first that has grown to its size, and where it turns
// round there: no other wave goes farther.
std::vector<double> times_to_look_at(const TimeFunction& f, double end) {
  constexpr int samples = 4000;
  double begin = 0;
  if (f.kind == TimeFunction::Kind::sine) {
    end = std::min(end, f.start + f.ramp + f.duration);
    begin = std::max(0.0, end - f.duration);
  }
  std::vector<double> times;
  for (int i = 0; i <= samples; ++i) times.push_back(begin + (end - begin) * i / samples);
  if (f.kind != TimeFunction::Kind::sine) return times;
  for (const double turn : turning_times(f, begin, end)) times.push_back(turn);
  std::ranges::sort(times);
  return times;
}

// A drive that leaves the values that its measure can take is refused, with the time when it does: lengths
// stay above 0, angles without an axis between 0 and 180 degrees, where they have no direction to go on in.
void check_reach(const SceneElement& e, ElementAdder& to, const Measure& measure, const TimeFunction& f) {
  const MeasureRange range = range_of(measure);
  if ((!std::isfinite(range.low) && !std::isfinite(range.high)) || !f.moves()) return;
  // A run may end before a constant rate comes that far: where it is deployed.
  if (f.kind == TimeFunction::Kind::rate && to.may_end_before) return;
  for (const double t : times_to_look_at(f, to.end_time)) {
    const double value = f(t), rounding = 8 * std::numeric_limits<double>::epsilon() * std::abs(f.offset);
    if (value > range.low + rounding && value < range.high - rounding) continue;
    const char* key = f.kind == TimeFunction::Kind::rate     ? "rate"
                      : f.kind == TimeFunction::Kind::smooth ? "to"
                      : f.kind == TimeFunction::Kind::sine   ? "amplitude"
                                                             : "values";
    const bool path = e.kind == "cable" || e.kind == "telescope",
               sum = measure.kind == MeasureKind::combination && !path;
    std::ostringstream text;
    text.precision(4);
    text << "takes the "
         << (sum                 ? "sum"
             : is_angle(measure) ? "angle"
                                 : "length")
         << " to " << value / unit_of(measure) << (is_angle(measure) ? " deg" : " m") << " at t = " << t
         << " s: " << (sum || is_angle(measure) ? values_within(measure) : "it must stay > 0");
    return to.find.problem(e, key, text.str());
  }
}

void check_begin(const SceneElement& e, ElementAdder& to, const Measure& measure, double begin,
                 double initial) {
  double apart = begin - initial;
  if (counts_turns(measure)) apart = std::remainder(apart, 2 * pi);  // counted from another turn
  if (std::abs(apart) <= to.find.same(measure, initial)) return;
  std::ostringstream text;
  text.precision(15);
  text << "the table is at " << begin / unit_of(measure) << " when t = 0, the structure at "
       << initial / unit_of(measure) << ": they must agree";
  to.find.problem(e, "values", text.str());
}

void push_drive(const SceneElement& e, ElementAdder& to, const Measure& measure) {
  TimeFunction f = motion_of(e, to, measure, to.find.initial(measure));
  to.structure.constraints.push_back({"measure", e.name, measure.nodes, {}, 0.0, measure, std::move(f)});
}

void push_stop(const SceneElement& e, ElementAdder& to, Measure measure) {
  const double unit = unit_of(measure), minimum = unit * e.values.real("min"),
               maximum = unit * e.values.real("max");
  double initial = to.find.initial(measure);
  const double round_off = to.find.same(measure, initial);
  const auto within = [&](double x) { return !(x < minimum - round_off) && !(x > maximum + round_off); };
  if (std::isnan(minimum) && std::isnan(maximum))
    return to.find.problem(e, "min", "is missing, and so is max: a stop needs a limit");
  // Half a turn from zero is 180 degrees and -180: the limits say which.
  if (counts_turns(measure) && initial > pi - 1e-9 && !within(initial) && within(initial - 2 * pi)) {
    initial -= 2 * pi;
    measure.reference = initial;
  }
  Stop stop{.name = e.name, .measure = measure};
  for (const bool lower : {true, false}) {
    const char* key = lower ? "min" : "max";
    const double limit = lower ? minimum : maximum;
    if (std::isnan(limit)) continue;
    (lower ? stop.min : stop.max) = limit;
    // A limit at which the measure turns back is not passed, nor met.
    const MeasureRange range = range_of(measure);
    if (lower ? limit <= range.low || limit > range.high : limit >= range.high || limit < range.low)
      to.find.problem(e, key, "is never met: " + values_within(measure));
    if (lower ? initial >= limit - round_off : initial <= limit + round_off) continue;
    std::ostringstream text;
    text.precision(15);
    text << "is passed already at t = 0, where the value is " << initial / unit;
    to.find.problem(e, key, text.str());
  }
  stop.restitution = e.values.real("restitution");
  stop.rest_speed = unit * e.values.real("rest_speed");
  to.structure.stops.push_back(std::move(stop));
}

// The nodes may begin at one place: what acts is the rim, which they are not at.
std::optional<Measure> way_of_pin(const SceneElement& e, MemberFinder& find) {
  Measure measure;
  measure.nodes = find.nodes(e, false);
  if (measure.nodes.size() != 2) return {};
  return measure;
}

// |x_a - x_b| <= c.
void add_clearance(const SceneElement& e, ElementAdder& to) {
  const auto found = way_of_pin(e, to.find);
  if (!found) return;
  const Measure& measure = *found;
  const double clearance = e.values.real("clearance"), initial = to.find.initial(measure);
  if (initial > clearance + to.find.same(measure, clearance)) {
    std::ostringstream text;
    text.precision(15);
    text << "is passed already at t = 0, where the nodes are " << initial << " m apart";
    return to.find.problem(e, "clearance", text.str());
  }
  Stop stop{.name = e.name, .measure = measure};
  stop.max = clearance;
  stop.restitution = e.values.real("restitution");
  stop.rest_speed = e.values.real("rest_speed");
  to.structure.stops.push_back(std::move(stop));
}

template <std::optional<Measure> (*measured)(const SceneElement&, MemberFinder&)>
void add_drive(const SceneElement& e, ElementAdder& to) {
  if (const auto measure = measured(e, to.find)) push_drive(e, to, *measure);
}
template <std::optional<Measure> (*measured)(const SceneElement&, MemberFinder&)>
void add_stop(const SceneElement& e, ElementAdder& to) {
  if (const auto measure = measured(e, to.find)) push_stop(e, to, *measure);
}

}  // namespace

std::string values_within(const Measure& measure) {
  const MeasureRange range = range_of(measure);
  if (measure.kind == MeasureKind::length) return "a distance stays > 0";
  if (measure.kind == MeasureKind::angle)
    return "without an axis the angle stays between 0 and 180 deg; give the axis of the hinge";
  std::ostringstream text;
  text.precision(4);
  const char* unit = is_angle(measure) ? " deg" : " m";
  text << "it stays ";
  if (std::isfinite(range.low)) text << "> " << range.low / unit_of(measure) << unit;
  if (std::isfinite(range.low) && std::isfinite(range.high)) text << " and ";
  if (std::isfinite(range.high)) text << "< " << range.high / unit_of(measure) << unit;
  text << ", as distances stay > 0 and angles without an axis between 0 and 180 deg; give those their axis "
          "(angle A H B about X Y Z)";
  return text.str();
}

TimeFunction motion_of(const SceneElement& e, ElementAdder& to, const Measure& measure, double initial) {
  TimeFunction f = motion_function(e.values, initial, unit_of(measure));
  if (e.values.text("motion") == "table") check_begin(e, to, measure, f(0.0), initial);
  check_reach(e, to, measure, f);
  return f;
}

const std::vector<ElementKind>& measured_kinds() {
  static const std::vector<ElementKind> kinds = {
      {"length", "the distance of two nodes is held, or driven by an actuator", Members::two_nodes,
       length_params, add_drive<length_of>, length_of},
      {"coordinate", "a node's coordinate along a direction, or the difference of two, is held or driven",
       Members::node_list, coordinate_params, add_drive<coordinate_of>, coordinate_of},
      {"angle", "the angle between two rods, or the fold angle, is held or driven by a motor", Members::angle,
       angle_params, add_drive<driven_angle>, angle_of},
      {"length_stop", "end stop: the distance of two nodes stays within limits", Members::two_nodes,
       length_stop_params, add_stop<length_of>, length_of, true},
      {"coordinate_stop", "end stop: a node's coordinate, or the difference of two, stays within limits",
       Members::node_list, coordinate_stop_params, add_stop<coordinate_of>, coordinate_of, true},
      {"angle_stop", "end stop: the angle between two rods, or the fold angle, stays within limits",
       Members::angle, angle_stop_params, add_stop<driven_angle>, angle_of, true},
      {"clearance", "a pin with play: two nodes stay within a distance of each other", Members::two_nodes,
       clearance_params, add_clearance, way_of_pin, true},
  };
  return kinds;
}

}  // namespace unfurl
