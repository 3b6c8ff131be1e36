// SPDX-License-Identifier: BSD-3-Clause
// Entries that sectors have in common: every field takes part in what makes two of them alike.
#include "core/path/entry_turns.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>

using namespace unfurl;

namespace entry_turns_test {

namespace {

// Calls `seen` with each field of x and its name; names of fields that may differ are left to the caller.
template <class Seen>
void fields(TimeFunction& x, const Seen& seen) {
  seen("kind", x.kind), seen("offset", x.offset), seen("rate", x.rate), seen("ramp", x.ramp);
  seen("rise", x.rise), seen("start", x.start), seen("duration", x.duration), seen("times", x.times);
  seen("values", x.values), seen("bends", x.bends);
}
template <class Seen>
void fields(Motor& x, const Seen& seen) {
  seen("stall", x.stall), seen("no_load_speed", x.no_load_speed), seen("gear_ratio", x.gear_ratio);
  seen("limit", x.limit), seen("control", x.control), seen("proportional", x.proportional);
  seen("integral", x.integral), seen("derivative", x.derivative), seen("command", x.command);
  seen("integrator", x.integrator), seen("regime", x.regime);
}
template <class Seen>
void fields(LinearForm& x, const Seen& seen) {
  seen("nodes", x.nodes), seen("coefficients", x.coefficients), seen("offset", x.offset);
}
template <class Seen>
void fields(Measure& x, const Seen& seen) {
  seen("kind", x.kind), seen("nodes", x.nodes), seen("axis", x.axis), seen("reference", x.reference);
  seen("terms", x.terms);
}
template <class Seen>
void fields(MeasureTerm& x, const Seen& seen) {
  seen("coefficient", x.coefficient), seen("measure", x.measure);
}
template <class Seen>
void fields(Force& x, const Seen& seen) {
  seen("kind", x.kind), seen("name", x.name), seen("nodes", x.nodes), seen("measure", x.measure);
  seen("stiffness", x.stiffness), seen("damping", x.damping), seen("rest", x.rest);
  seen("one_sided", x.one_sided), seen("slack", x.slack), seen("smoothing", x.smoothing);
  seen("axial_stiffness", x.axial_stiffness), seen("unstressed", x.unstressed), seen("motor", x.motor);
  seen("direction", x.direction), seen("size", x.size), seen("expansion", x.expansion), seen("form", x.form);
  seen("kinetic", x.kinetic), seen("holding", x.holding), seen("slip", x.slip), seen("rope", x.rope);
  seen("trolley", x.trolley);
}
template <class Seen>
void fields(Constraint& x, const Seen& seen) {
  seen("kind", x.kind), seen("name", x.name), seen("nodes", x.nodes), seen("vectors", x.vectors);
  seen("value", x.value), seen("measure", x.measure), seen("target", x.target), seen("symmetry", x.symmetry);
}
template <class Seen>
void fields(Rod& x, const Seen& seen) {
  seen("name", x.name), seen("a", x.a), seen("b", x.b), seen("mass", x.mass), seen("length", x.length);
  seen("group", x.group), seen("radius", x.radius), seen("multiplicity", x.multiplicity),
      seen("area", x.area);
  seen("youngs_modulus", x.youngs_modulus), seen("second_moment", x.second_moment);
  seen("strength", x.strength), seen("gives", x.gives), seen("damping_time", x.damping_time);
  seen("free_length", x.free_length), seen("expansion", x.expansion), seen("warming", x.warming);
  seen("parts", x.parts), seen("whole", x.whole);
}

using Look = std::function<void(const std::string& changed)>;

template <class T>
concept Struct = requires(T& x) {
  fields(x, [](const char*, auto&) {});
};

// x with one thing changed that is in it, one after the other; left as it was.
template <class T>
void change(T& x, const std::string& name, const Look& look) {
  const T before = x;
  const auto now = [&](const std::string& what) {
    look(name + what);
    x = before;
  };
  if constexpr (std::is_same_v<T, double>) {
    x = std::isfinite(x) ? x + 1e-7 * (x != 0 ? x : 1.0) : 1.5, now("");
  } else if constexpr (std::is_same_v<T, bool>) {
    x = !x, now("");
  } else if constexpr (std::is_same_v<T, int>) {
    x += 1, now("");
  } else if constexpr (std::is_same_v<T, std::string>) {
    x += "x", now("");
  } else if constexpr (std::is_enum_v<T>) {
    x = static_cast<T>(static_cast<int>(x) == 1 ? 2 : 1), now("");
  } else if constexpr (std::is_same_v<T, Vec3>) {
    for (int c = 0; c < 3; ++c) change(x[c], name + "." + "xyz"[c], look);
  } else if constexpr (Struct<T>) {
    fields(x, [&](const char* field, auto& value) { change(value, name + "." + field, look); });
  } else {
    for (std::size_t i = 0; i < x.size(); ++i) change(x[i], name + "[" + std::to_string(i) + "]", look);
    x.emplace_back(), now(" longer");
  }
}

TimeFunction motion(double size) {
  TimeFunction f;
  f.kind = TimeFunction::Kind::smooth;
  f.offset = 0.3 * size, f.rate = 0.7 * size, f.ramp = 0.4, f.rise = 1.9 * size, f.start = 0.2,
  f.duration = 2.3;
  f.times = {0.1, 0.6}, f.values = {2.5, 3.5}, f.bends = {0.2, 0.9};
  return f;
}

Measure angle() {
  return {MeasureKind::angle,
          {3, 5, 8, 2},
          Vec3(0.6, 0.0, 0.8),
          0.4,
          {{1.7, {MeasureKind::length, {4, 6}, Vec3::Zero(), 0.0, {}}}}};
}

Force force() {
  Force f;
  f.kind = "motor", f.name = "hinge", f.nodes = {1, 7}, f.measure = angle();
  f.stiffness = 31, f.damping = 0.7, f.rest = 1.1, f.smoothing = 0.02, f.axial_stiffness = 90;
  f.unstressed = motion(1.5);
  f.motor = {2.5,  7.5,  12,          1.5, Motor::Control::position, 3.5,
             0.25, 0.75, motion(0.9), 4,   Motor::Regime::forward};
  f.direction = Vec3(0.3, -0.4, 1.2), f.size = motion(2.5), f.expansion = 1e-5;
  f.kinetic = 0.8, f.holding = 1.3, f.slip = 1, f.rope = 4.5, f.trolley = Vec3(0.2, 0.5, 9);
  return f;
}

Constraint held() {
  return {"measure", "crank", {2, 6},      {Vec3(0.1, 0.9, 0.4), Vec3(1, 2, 3)},
          0.35,      angle(), motion(1.2), false};
}

Rod rod() {
  Rod r;
  r.name = "post", r.a = 3, r.b = 8, r.mass = 0.6, r.length = 1.7, r.group = "posts", r.radius = 0.02;
  r.multiplicity = 2, r.area = 3e-4, r.youngs_modulus = 7e10, r.second_moment = 2e-9, r.strength = 3e8;
  r.damping_time = 0.01, r.free_length = 1.6, r.expansion = 2e-5, r.warming = motion(40);
  return r;
}

// In a structure of a metre.
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, Force> || std::is_same_v<T, Constraint>)
    return same_entry(a, b, 1.0);
  else
    return same_entry(a, b);
}
bool same(const Measure& a, const Measure& b) {
  return same_entry(a, b);
}

// Whether each change of one field is seen; those whose name begins so are free.
template <class T>
void every_field_counts(const T& entry, const std::vector<std::string>& free, int at_least) {
  T other = entry;
  CHECK(same(entry, other));
  int count = 0;
  change(other, "", [&](const std::string& what) {
    ++count;
    const bool may =
        std::any_of(free.begin(), free.end(), [&](const auto& f) { return what.starts_with(f); });
    INFO(what);
    CHECK(same(entry, other) == may);
    CHECK(same(other, entry) == may);
  });
  CHECK(count >= at_least);
}

}  // namespace

TEST_CASE("entries are alike where all of their fields are, but for their names and looks") {
  every_field_counts(angle(), {}, 20);
  every_field_counts(force(), {".name", ".form.offset", ".form.coeff"}, 80);  // of no nodes
  every_field_counts(held(), {".name"}, 40);
  every_field_counts(rod(), {".name", ".group", ".radius", ".whole"}, 30);
}

TEST_CASE("rounding makes no entries unlike, and what has no direction may be turned round") {
  constexpr double ulps = 1 + 1e-15;
  Force f = force();
  f.direction *= ulps, f.rest *= ulps, f.trolley *= ulps, f.measure.axis *= ulps;
  f.measure.terms[0].coefficient *= ulps;
  f.measure.reference += 1e-10;  // it only says which turn is meant
  CHECK(same(force(), f));
  Constraint c = held();
  c.value *= ulps, c.vectors[1] *= ulps, c.target.offset += 1e-14, c.target.rise -= 1e-14;
  CHECK(same(held(), c));
  Rod r = rod();
  r.mass *= ulps, r.length *= ulps, r.free_length *= ulps, r.damping_time *= ulps;
  std::swap(r.a, r.b);
  CHECK(same(rod(), r));
  Force nowhere = force();
  nowhere.trolley.setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(same(nowhere, nowhere));
  CHECK_FALSE(same(nowhere, force()));
  for (const MeasureKind kind : {MeasureKind::length, MeasureKind::coordinate}) {
    const Measure one{kind, {4, 6}, Vec3::Zero(), 0.0, {}}, other{kind, {6, 4}, Vec3::Zero(), 0.0, {}},
        third{kind, {6, 5}, Vec3::Zero(), 0.0, {}};
    CHECK(same(one, other) == (kind == MeasureKind::length));
    CHECK_FALSE(same(one, third));
    CHECK_FALSE(same(one, {kind, {5, 4}, Vec3::Zero(), 0.0, {}}));
  }
  Force latched = force();
  latched.form = {{1}, {Vec3(1, 2, 3)}, 0.0};
  CHECK_FALSE(same(latched, latched));  // a form is never that of two entries
  Constraint later = held();
  later.target.offset += 1e-9;
  CHECK_FALSE(same(held(), later));
}

TEST_CASE(
    "what rounding leaves of a length is a share of the structure's size and of an angle one of a radian") {
  Constraint here = held();
  here.measure = {MeasureKind::length, {4, 6}, Vec3::Zero(), 0.0, {}};
  here.target.offset = here.target.rise = 0;
  Force pull = force();
  pull.measure = here.measure;
  pull.rest = 0;
  Constraint there = here;
  Force other = pull;
  // 1e-13 is what counts as rounding: of a structure of 10 m, 1 m and 1e-5 m.
  there.target.offset = other.rest = 3e-13;
  CHECK(same_entry(here, there, 10));
  CHECK_FALSE(same_entry(here, there, 1));
  CHECK(same_entry(pull, other, 10));
  CHECK_FALSE(same_entry(pull, other, 1));
  there.target.offset = 3e-17;
  CHECK_FALSE(same_entry(here, there, 1e-5));
  there.target.offset = 0, there.target.rise = 3e-17;
  CHECK_FALSE(same_entry(here, there, 1e-5));
  CHECK(same_entry(here, there, 1e-3));
  for (Constraint* one : {&here, &there}) one->measure.kind = MeasureKind::angle;
  CHECK(same_entry(here, there, 1e-5));
}

TEST_CASE("forms are alike where they weigh every node alike, in whatever order") {
  const LinearForm form{{4, 2, 4}, {Vec3(1, 2, 3), Vec3(-1, 0.5, 2), Vec3(0.25, 0, -1)}, 0.7};
  CHECK(same_form(form, {{2, 4}, {Vec3(-1, 0.5, 2), Vec3(1.25, 2, 2)}, 0.7}));
  CHECK_FALSE(same_form(form, {{2, 4}, {Vec3(-1, 0.5, 2), Vec3(1.25, 2, 2)}, 0.8}));
  CHECK_FALSE(same_form(form, {{2, 4}, {Vec3(-1, 0.5, 2), Vec3(1.25, 2, 2.1)}, 0.7}));
  CHECK_FALSE(same_form(form, {{2, 5}, {Vec3(-1, 0.5, 2), Vec3(1.25, 2, 2)}, 0.7}));
  CHECK_FALSE(same_form(form, {{2}, {Vec3(-1, 0.5, 2)}, 0.7}));
}

// A quarter of a turn about z takes (x, y, z) to (-y, x, z).
TEST_CASE("a turn takes nodes and directions along, and leaves all else") {
  const auto quarter = [](const Vec3& v) { return Vec3(-v.y(), v.x(), v.z()); };
  NodeTurn turn;
  turn.turn = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()).toRotationMatrix();
  turn.to = {3, 0, 7, 1, 8, 2, 5, 4, 6};
  CHECK(turn.nodes({2, 5, 2}) == std::vector<int>{7, 2, 7});
  const auto turned_angle = [&](Measure m) {
    m.nodes = {1, 2, 6, 7};
    m.axis = quarter(m.axis);
    m.terms[0].measure.nodes = {8, 5};
    return m;
  };
  CHECK(same(turn.measure(angle()), turned_angle(angle())));
  Force f = force();
  f.nodes = {0, 4};
  f.measure = turned_angle(f.measure);
  f.direction = quarter(f.direction);
  CHECK(same(turn.force(force()), f));
  Constraint c = held();
  c.nodes = {7, 5};
  c.measure = turned_angle(c.measure);
  for (Vec3& v : c.vectors) v = quarter(v);
  CHECK(same(turn.constraint(held()), c));
  CHECK(same_form(turn.form({{4, 2}, {Vec3(1, 2, 3), Vec3(-1, 0.5, 2)}, 0.7}),
                  {{8, 7}, {Vec3(-2, 1, 3), Vec3(-0.5, -1, 2)}, 0.7}));
}

}  // namespace entry_turns_test
