// SPDX-License-Identifier: BSD-3-Clause
// How the motion of a margin begins and ends, against closed forms: loads over time, stops, friction, cables.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "core/path/margin.hpp"
#include "core/path/path.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/table.hpp"

using namespace unfurl;

namespace margin_motion_test {

namespace {

Margin margin_in(const std::string& text, const std::map<std::string, double>& factors = {}) {
  const Scene scene = read_scene_text(text, "margin.toml");
  return margin_of(build_model(scene), scene.solver, factors);
}

// 1 kg on a line along x, from 0 to where it is deployed.
std::string slider(const std::string& more, double deployed = 1,
                   const std::string& solver = "end_time = 60") {
  return R"([structure]
kind = "custom"
nodes = [{name = "W", position = [-1, 0, 0], fixed = true}, {name = "A", position = [0, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[deployment]
measure = "coordinate A along 1 0 0"
deployed = )" +
         exact_number(deployed) + "\n" + more + "[solver]\n" + solver + "\n";
}

std::string over_time(const std::string& name, double force, const std::string& times,
                      const std::string& values) {
  return "[[forces]]\nname = \"" + name + "\"\nkind = \"load_over_time\"\nnodes = [\"A\"]\nforce = [" +
         std::to_string(force) + ", 0, 0]\ntimes = " + times + "\nvalues = " + values + "\n";
}

const std::string dry = R"([[forces]]
name = "dry"
kind = "friction"
nodes = ["A"]
direction = [1, 0, 0]
)";

// 1 kg on a rod of 1 m about the origin, in the plane z = 0, up to a height.
std::string pendulum(const std::string& at, double deployed, const std::string& more) {
  return R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "W", position = [-2, 0, 0], fixed = true},
  {name = "A", mass = 1, )" +
         at + R"(}]
rods = [{nodes = ["O", "A"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 0, 1]
[deployment]
measure = "coordinate A along 0 1 0"
deployed = )" +
         std::to_string(deployed) + "\n" + more;
}

}  // namespace

// Times and places follow from Taylor series of order 3 that the motion's steps hold exactly; places are
// bisected to rounding.
TEST_CASE("a structure waits at rest until a load over time exceeds what holds it") {
  const std::string ramp = over_time("ramp", 1, "[0, 9]", "[0, 9]");
  const Margin free = margin_in(slider(ramp));
  CHECK(free.arrives);
  CHECK(free.motion.back().t == Approx(std::cbrt(6.0)).epsilon(1e-10));  // x = t^3 / 6
  const Margin delayed = margin_in(slider(over_time("ramp", 1, "[0, 0.5, 9.5]", "[0, 0, 9]")));
  CHECK(delayed.arrives);
  CHECK(delayed.motion.back().t == Approx(0.5 + std::cbrt(6.0)).epsilon(1e-10));
  // It gives way at t = 0.3, where x'' = (t - 0.3) + 0.3 - 0.2 begins.
  const Margin held = margin_in(slider(ramp + dry + "kinetic = 0.2\nstatic = 0.3\n"));
  CHECK(held.arrives);
  const double t = held.motion.back().t - 0.3;
  CHECK(t * t * t / 6 + 0.05 * t * t == Approx(1).epsilon(1e-10));
  // Of work done on the way: that of the friction is all that resists.
  CHECK(held.motion.back().resisted == Approx(0.2).epsilon(1e-10));
  CHECK(held.dynamic_min ==
        Approx(0.3 / 0.2 - 1).epsilon(1e-9));  // as it sets out; more and more from there on
  // It never does.
  const Margin never = margin_in(slider(ramp + dry + "kinetic = 70\n"));
  CHECK(never.end == MarginEnd::stalls);
  CHECK(never.motion.size() == 1);
  CHECK(never.dynamic_min == -1);  // nothing drives it at first, against what holds
  // Pushed against a stop at first, let go of at t = 0.5, x'' = 2 (t - 0.5).
  const Margin lies = margin_in(slider(over_time("turns", 1, "[0, 1]", "[-1, 1]") + R"([[constraints]]
kind = "coordinate_stop"
nodes = ["A"]
direction = [1, 0, 0]
min = 0
)"));
  CHECK(lies.arrives);
  CHECK(lies.motion.front().t == 0);
  // 1/24 + ... : at t = 1 x = 0.5^3 / 3 with v = 1/4, and 1 N from there on.
  const double at_one = 0.125 / 3, rest = lies.motion.back().t - 1;
  CHECK(at_one + 0.25 * rest + 0.5 * rest * rest == Approx(1).epsilon(1e-10));
  // Without the stop it sets out the other way, and that is no stall.
  CHECK(margin_in(slider(over_time("turns", 1, "[0, 1]", "[-1, 1]"))).end == MarginEnd::other_way);
}

// 1 N against 0.4 N of friction until t = 0.5: x = 0.075, v = 0.3; without it to x = 0.1875 at t = 1.25; 2 N
// from t = 2 on. Places of jumps are known to rounding: 1e-9 of a margin.
TEST_CASE("a pose that was passed before the motion stood still has the loads of when it was passed") {
  const std::string push = over_time("push", 1, "[0, 0.5, 0.5, 2, 2, 9]", "[1, 1, 0, 0, 2, 2]");
  for (const double end_time : {1.9, 60.0}) {
    const Margin margin =
        margin_in(slider(push + dry + "kinetic = 0.4\n", 1, "end_time = " + exact_number(end_time)));
    CHECK(margin.arrives == (end_time > 2));
    const double load_behind = margin.arrives ? 2 : 0;  // by the end of a motion that does not get there
    int coasts = 0;
    for (const MarginPoint& point : margin.points) {
      CAPTURE(end_time, point.s, point.t);
      if (std::abs(point.s - 0.075) < 1e-6 || std::abs(point.s - 0.1875) < 1e-6) continue;
      const bool under_way = point.s > 0.075 && point.s < 0.1875;
      coasts += under_way;
      CHECK(point.margin == Approx((point.s < 0.075 ? 1
                                    : under_way     ? 0
                                                    : load_behind) /
                                       0.4 -
                                   1)
                                .margin(1e-9));
      if (under_way)  // x = 0.1875 - 0.2 (1.25 - t)^2
        CHECK(point.t == Approx(1.25 - std::sqrt((0.1875 - point.s) / 0.2)).margin(1e-6));
    }
    CHECK(coasts > 40);
  }
}

// Along -x as along x: loads that come late, friction, stops that bar the way or hold it at the start.
TEST_CASE("a motion the other way along its coordinate is the mirror image") {
  const auto check_mirrored = [](const std::function<std::string(double)>& with, MarginEnd end) {
    const Margin one = margin_in(with(1)), other = margin_in(with(-1));
    CHECK(one.end == end);
    CHECK(other.end == end);
    CHECK(other.stop == one.stop);
    const auto same = [](double a, double b) {
      CAPTURE(a, b);
      CHECK((a == b || std::abs(a - b) <= 1e-9));  // of metres, seconds and joules
    };
    same(other.motion.back().s, one.motion.back().s);
    same(other.motion.back().t, one.motion.back().t);
    same(other.motion.back().kinetic, one.motion.back().kinetic);
    same(other.points.back().s, one.points.back().s);
    same(other.worst.margin, one.worst.margin);
    same(other.end_s, one.end_s);
    same(other.dynamic_min, one.dynamic_min);
  };
  const std::string friction = dry + "kinetic = 0.2\nstatic = 0.3\n";
  const auto stop = [](double side, double at) {
    return "[[constraints]]\nname = \"bar\"\nkind = \"coordinate_stop\"\nnodes = [\"A\"]\ndirection = [1, 0, "
           "0]\n" +
           std::string(side > 0 ? "max = " : "min = ") + exact_number(side * at) + "\n";
  };
  const auto late = [](double side) { return over_time("late", side, "[0, 0.7, 9.7]", "[0, 0, 9]"); };
  check_mirrored([&](double side) { return slider(late(side), side); }, MarginEnd::arrives);
  check_mirrored([&](double side) { return slider(late(side) + friction, side); }, MarginEnd::arrives);
  check_mirrored([&](double side) { return slider(late(side) + friction, -side); }, MarginEnd::other_way);
  check_mirrored([&](double side) { return slider(late(side) + stop(side, 0.43), side); },
                 MarginEnd::stopped);
  check_mirrored([&](double side) { return slider(late(side) + stop(side, 0), side); }, MarginEnd::stopped);
}

TEST_CASE("the static margin has the loads over time of the moment at which the motion is in that pose") {
  const Margin margin = margin_in(
      slider(over_time("ramp", 1, "[0, 9]", "[0.5, 9.5]") + over_time("brake", -0.2, "[0, 9]", "[1, 1]")));
  for (std::size_t i = 3; i < margin.points.size(); i += 31) {
    const double t = margin.points[i].t;
    CHECK(0.15 * t * t + t * t * t / 6 == Approx(margin.points[i].s).epsilon(1e-9));
    CHECK(margin.points[i].margin == Approx((0.5 + t) / 0.2 - 1).epsilon(1e-9));
  }
}

TEST_CASE("an end stop bars the way: the path ends there, and so does the motion") {
  const std::string push = "[[loads]]\nnodes = [\"A\"]\nforce = [1, 0, 0]\n";
  const std::string stop =
      "[[constraints]]\nname = \"bar\"\nkind = \"coordinate_stop\"\nnodes = [\"A\"]\ndirection = [1, 0, 0]\n";
  const Margin margin = margin_in(slider(push + stop + "max = 0.4\n"));
  CHECK_FALSE(margin.arrives);
  CHECK(margin.end == MarginEnd::stopped);
  CHECK(margin.stop == "bar");
  CHECK(margin.points.back().s == Approx(0.4).epsilon(1e-10));
  CHECK(margin.motion.back().s == Approx(0.4).epsilon(1e-10));
  CHECK(margin.motion.back().kinetic == Approx(0.4).epsilon(1e-10));
  // In the deployed pose a stop is where it belongs.
  CHECK(margin_in(slider(push + stop + "max = 1\n")).arrives);
  // Behind where the motion stalls, it still bounds the poses.
  const std::string spring =
      "[[forces]]\nkind = \"spring\"\nnodes = [\"W\", \"A\"]\nstiffness = 10\nfree_length = 1\n";
  const Margin stalls = margin_in(slider(push + spring + stop + "max = 0.4\n"));
  CHECK(stalls.end == MarginEnd::stalls);
  CHECK(stalls.motion.back().s == Approx(0.2).epsilon(1e-9));  // x = 10 x^2 / 2
  CHECK(stalls.points.back().s == Approx(0.4).epsilon(1e-10));
  // What lies against it from the start ends there, where it is pushed on; not where it is pushed off it.
  const Margin lies = margin_in(slider(push + stop + "max = 0\n"));
  CHECK(lies.end == MarginEnd::stopped);
  CHECK(lies.stop == "bar");
  CHECK(lies.motion.back().s == 0);
  // Later, too, and where that jumps away at once: nothing but the stop has kept it there.
  for (const char* values : {"[0, 0, 3, 0]", "[-0.5, -0.5, 0.01, -1]"}) {
    const Margin later =
        margin_in(slider(over_time("push", 1, "[0, 0.5, 1, 1]", values) + stop + "max = 0\nmin = 0\n"));
    CHECK(later.end == MarginEnd::stopped);
    CHECK(later.stop == "bar");
    CHECK(later.dynamic_min == std::numeric_limits<double>::infinity());
  }
  CHECK(margin_in(slider(over_time("pull", 1, "[0, 1]", "[0, -1]") + stop + "max = 0\nmin = 0\n")).end ==
        MarginEnd::stalls);
}

// x (1.5 - 1) - x^2 / 2 = kinetic x.
TEST_CASE("a motion stalls by dry friction where its energy is used up") {
  const std::string spring =
      "[[forces]]\nkind = \"spring\"\nnodes = [\"W\", \"A\"]\nstiffness = 1\nfree_length = 1.5\n";
  for (const double kinetic : {0.07, 0.2, 0.29}) {
    const Margin margin =
        margin_in(slider(spring + dry + "kinetic = " + std::to_string(kinetic) + "\nstatic = 0.3\n", 0.99));
    INFO(kinetic);
    CHECK(margin.end == MarginEnd::stalls);
    CHECK(margin.motion.back().s == Approx(2 * (0.5 - kinetic)).epsilon(1e-9));
    CHECK(std::abs(margin.dynamic_min) <= 1e-9);
  }
}

TEST_CASE("a motion sees pulses of a load however short they are") {
  const std::string push = "[[loads]]\nnodes = [\"A\"]\nforce = [0.02, 0, 0]\n";
  const auto with = [&](double force) {
    return margin_in(slider(push + over_time("pulse", force, "[5, 5.001, 5.002]", "[0, 1, 0]")));
  };
  // At t = 5 it is in 0.25 m at 0.1 m/s; the pulse takes 1e-3 s of its force from that.
  const Margin stalls = with(-110);
  CHECK(stalls.end == MarginEnd::stalls);
  CHECK(stalls.motion.back().s > 0.25);
  CHECK(stalls.motion.back().s < 0.2502);
  const Margin passes = with(-55);
  CHECK(passes.arrives);
  // Behind it, of which the middle is at 5.001 s, as if it had been at once: 0.25 + 0.1 e + 0.01 e^2 there.
  const double e = 1e-3, at = 0.25 + 0.1 * e + 0.01 * e * e, v = 0.1 + 0.02 * e - 0.055;
  const double rest = passes.motion.back().t - 5 - e;
  CHECK(at + v * rest + 0.01 * rest * rest == Approx(1).epsilon(1e-9));
}

// Gone at 1 s: what holds 9.2 N has given way at 0.92 s, whichever steps end on the jump. Against 1 N it then
// goes on by v^2 / 2.
TEST_CASE("a load that jumps away at its peak sets a motion free before, and turns it round") {
  for (const char* step : {"0.01", "0.1", "0.125", "0.25", "3"}) {
    INFO(step);
    const Margin free = margin_in(
        slider(over_time("ramp", 1, "[0, 1, 1, 2]", "[0, 10, 0, 0]") + dry + "kinetic = 1\nstatic = 9.2\n",
               0.5, std::string("end_time = 2\nstep = ") + step));
    CHECK(free.end == MarginEnd::stalls);
    const double t = 0.92, v = 5 * (1 - t * t) - (1 - t),
                 x = 5 * ((1 - t * t * t) / 3 - t * t * (1 - t)) - 0.5 * (1 - t) * (1 - t);
    CHECK(free.motion.back().s == Approx(x + 0.5 * v * v).epsilon(1e-9));
  }
  // v0 - 0.95 t + t^2 / 2 is zero shortly before it is least at 0.95 s, and would rise again until the jump.
  const double before = std::sqrt(2e-4), at = 0.95 - before, v0 = 0.5 * 0.95 * 0.95 - 1e-4;
  std::string turned = slider(over_time("turn", 1, "[0, 1, 1, 9]", "[-0.95, 0.05, -0.01, 1]"));
  turned.insert(turned.find("mass = 1"), "velocity = [" + exact_number(v0) + ", 0, 0], ");
  const Margin turns = margin_in(turned);
  CHECK(turns.end == MarginEnd::stalls);
  CHECK(turns.motion.back().s == Approx(v0 * at - 0.475 * at * at + at * at * at / 6).epsilon(1e-9));
}

// A tether of 2.9999 m to a point 3 m away from the farthest pose is stretched for a short time only, by 0.1
// mm at most; the motion has 2 mJ.
TEST_CASE("a motion sees cables that are stretched for a short time") {
  const double angle = std::atan2(-0.9950041652780258, 0.09983341664682815);
  const auto with = [&](double stiffness) {
    return margin_in(
        pendulum("position = [0.09983341664682815, -0.9950041652780258, 0], "
                 "velocity = [0.06292958887266373, 0.006314019664010933, 0]",
                 0.95,
                 R"([[forces]]
name = "tether"
kind = "spring"
nodes = ["W", "A"]
free_length = 2.9999
tension_only = true
stiffness = )" + std::to_string(stiffness) +
                     "\n[solver]\nend_time = 60\n"));
  };
  const Margin stalls = with(4.5e5);
  CHECK(stalls.end == MarginEnd::stalls);
  const double at = angle + stalls.motion.back().s;
  const double stretch = std::hypot(2 + std::cos(at), std::sin(at)) - 2.9999;
  // A length near its largest, of some 1e-12 by round-off, of 1e-4.
  CHECK(0.5 * 4.5e5 * stretch * stretch == Approx(stalls.motion.front().kinetic).epsilon(1e-6));
  // It takes at most 1 mJ of twice as much.
  const Margin passes = with(2e5);
  CHECK(passes.arrives);
  CHECK(passes.dynamic_min == Approx(2 / 1.0 - 1).epsilon(1e-3));
  // Nothing drives it: where the tether is stretched the margin is -1, over a thousandth of the way.
  CHECK(passes.worst.margin == -1);
}

TEST_CASE(
    "all that one entry of a scene makes is one source, and names that mean two things have no factor") {
  const std::string nodes = R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [3, 0, 0], fixed = true},
  {name = "A", position = [0, 1, 0], mass = 1}, {name = "B", position = [2, 2, 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0.3}, {nodes = ["A", "B"], mass = 0.3}, {nodes = ["B", "P"], mass = 0.3}]
[[constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 0, 1]
[deployment]
measure = "angle O A B"
deployed = 130
[solver]
end_time = 60
)";
  const std::string brake = "[[forces]]\nkind = \"spring\"\nnodes = [\"O\", \"B\"]\nstiffness = 0.3\nname = ";
  const std::string load = "nodes = [\"A\", \"B\"]\nforce = [1, -3, 0]\n";
  const Margin over = margin_in(nodes + "[[forces]]\nkind = \"load_over_time\"\nname = \"wind\"\n" + load +
                                "times = [0, 1]\nvalues = [1, 1]\n" + brake + "\"brake\"\n");
  const Margin at_once = margin_in(nodes + "[[loads]]\n" + load + brake + "\"brake\"\n");
  REQUIRE(over.sources.size() == 2);
  CHECK(over.worst.margin == Approx(at_once.worst.margin).epsilon(1e-10));
  CHECK(over.dynamic_min == Approx(at_once.dynamic_min).epsilon(1e-8));
  const std::string two = nodes + "[[loads]]\n" + load + brake + "\"loads\"\n";
  CHECK(margin_in(two).sources.size() == 2);
  CHECK_THROWS_WITH(margin_in(two, {{"loads", 2.0}}), Catch::Contains("more than one thing that acts"));
}

// The height of a bob that hangs is least there: it says nothing of the way, the load does.
TEST_CASE("where the deployed measure is stationary at the start, the way is that of the motion") {
  for (const double side : {1.0, -1.0}) {
    const Margin margin = margin_in(pendulum("position = [0, -1, 0]", 0.5,
                                             "[[loads]]\nnodes = [\"A\"]\nforce = [" + std::to_string(side) +
                                                 ", 0.5, 0]\n[solver]\nend_time = 20\n"));
    CHECK(margin.arrives);
    CHECK(margin.points.front().forces[0] == Approx(1).epsilon(1e-9));
    // Of the load's work, up by 1.5 m and aside by cos(30 degrees).
    CHECK(margin.motion.back().kinetic == Approx(0.75 + std::sqrt(0.75)).epsilon(1e-9));
  }
}

TEST_CASE("a motion whose time is up has not stalled, nor one that sets out the other way") {
  const Scene scene = read_scene_file(find_scene("hoop6"), {"solver.end_time=2"});
  const Margin late = margin_of(build_model(scene), scene.solver);
  CHECK_FALSE(late.arrives);
  CHECK(late.end == MarginEnd::time);
  const Margin wrong =
      margin_in(pendulum("position = [1, 0, 0], velocity = [0, -0.5, 0]", 0.9,
                         "[[loads]]\nnodes = [\"A\"]\nforce = [0, 1, 0]\n[solver]\nend_time = 9\n"));
  CHECK(wrong.end == MarginEnd::other_way);
  CHECK(std::isnan(wrong.dynamic_min));
}

// 1 kg under a load of 1 N against a spring of k N/m passes x with 1 - k x / 2 of x J left, which is 2 / (k
// x) - 1 of what has been resisted, and turns at 2 / k. However close behind the deployed pose that is, it
// arrives: in one part of a step it is past the pose, has turned, and may be on this side of it again.
// Energies are those of steps that are resolved to 1e-13.
TEST_CASE("a motion that would turn just behind the deployed pose arrives there") {
  const std::string push = "[[loads]]\nnodes = [\"A\"]\nforce = [1, 0, 0]\n";
  for (const double deployed : {1.3, 0.7}) {
    for (const double behind : {0.3, 1e-2, 2e-3, 1e-3, 3e-4, 1e-5, 1e-7, 1e-9}) {
      const double k = 2 / (deployed * (1 + behind));
      const Margin margin = margin_in(slider(
          push + "[[forces]]\nkind = \"spring\"\nnodes = [\"W\", \"A\"]\nfree_length = 1\nstiffness = " +
              exact_number(k) + "\n",
          deployed));
      INFO(deployed << " " << behind);
      CHECK(margin.arrives);
      CHECK(margin.motion.back().s == Approx(deployed).epsilon(1e-12));
      CHECK(margin.dynamic_min == Approx(behind).epsilon(0).margin(2e-12));
    }
    // Just before it, it stalls.
    const Margin stalls = margin_in(
        slider(push + "[[forces]]\nkind = \"spring\"\nnodes = [\"W\", \"A\"]\nfree_length = 1\nstiffness = " +
                   exact_number(2 / (deployed * (1 - 1e-6))) + "\n",
               deployed));
    CHECK(stalls.end == MarginEnd::stalls);
    CHECK(stalls.motion.back().s == Approx(deployed * (1 - 1e-6)).epsilon(1e-11));
  }
  // Thrown up at 10 m/s against 10 m/s^2, to 5 m.
  for (const double deployed : {4.8, 4.9995, 4.9999999}) {
    const Margin margin = margin_in(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [0, 0, 10], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [0, 0, 1]
[gravity]
acceleration = [0, 0, -10]
[deployment]
measure = "coordinate A along 0 0 1"
deployed = )" + exact_number(deployed) +
                                    "\n[solver]\nend_time = 9\n");
    INFO(deployed);
    CHECK(margin.arrives);
    CHECK(margin.dynamic_min == Approx(5 / deployed - 1).epsilon(0).margin(1e-11));
  }
}

// A mass on a line under 1 N, past a spring beside it of V(x) = k/2 (L - L_0)^2, L^2 = (x - 2)^2 + 1, which
// resists until it snaps through at x = 2 and drives from there on. Until then driven / resisted is
// (x - 1) / (V(x) - V(1)), least on the way; behind it nothing resists any more.
TEST_CASE("the dynamic margin is the least of the motion, between its states too") {
  for (const double mass : {0.3, 2.0})
    for (const double free_length : {std::sqrt(2.0), 1.5})
      for (const double k : {2.0, 3.7, 5.0}) {
        const Margin margin = margin_in(R"([structure]
kind = "custom"
nodes = [{name = "B", position = [2, 1, 0], fixed = true}, {name = "A", position = [1, 0, 0], mass = )" +
                                        exact_number(mass) + R"(}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[loads]]
nodes = ["A"]
force = [1, 0, 0]
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 3
[[forces]]
kind = "spring"
nodes = ["B", "A"]
stiffness = )" + exact_number(k) + "\nfree_length = " +
                                        exact_number(free_length) + "\n[solver]\nend_time = 60\n");
        const auto V = [&](double x) { return 0.5 * k * std::pow(std::hypot(x - 2, 1) - free_length, 2); };
        double least = 1e300, at = 0;
        // A hundred thousand places, next to the least a parabola: 1e-10 of it.
        for (double x = 1.00001; x < 2; x += 1e-5)
          if (const double m = (x - 1) / (V(x) - V(1)) - 1; m < least) least = m, at = x;
        INFO(mass << " " << free_length << " " << k);
        REQUIRE(margin.arrives);
        REQUIRE(at > 1.1);
        CHECK(margin.dynamic_min == Approx(least).epsilon(1e-9));
        // The place of a least value is known to the root of its error.
        CHECK(margin.dynamic_at == Approx((at - 1) * std::sqrt(mass)).epsilon(1e-4));
        // Where the spring turns from a resistance to a drive is no state of the motion either.
        CHECK(margin.motion.back().resisted == Approx(V(2) - V(1)).epsilon(1e-11));
        CHECK(margin.motion.back().driven == Approx(2 + V(2) - V(3)).epsilon(1e-11));
      }
}

// 2 N drive a mass of 1 kg all the way; a pulse resists for a moment: while 30 ms of 3 N turn nothing round
// yet, or over 0.6 ms, a thousandth of the way. Static margins are ratios of forces.
TEST_CASE("the static margin sees pulses of loads however short they are") {
  const std::string push = "[[loads]]\nnodes = [\"A\"]\nforce = [2, 0, 0]\n";
  const Margin early = margin_in(
      slider(push + over_time("pulse", -3, "[0, 0.02, 0.02, 0.05, 0.05, 9]", "[0, 0, 1, 1, 0, 0]")));
  CHECK(early.arrives);
  CHECK(early.worst.margin == Approx(2.0 / 3 - 1).epsilon(1e-12));
  for (const char* at : {"0.3", "0.51", "0.7", "0.913"}) {
    const std::string begin = at, end = exact_number(std::stod(at) + 6e-4);
    const Margin margin = margin_in(
        slider(push + over_time("pulse", -6, "[0, " + begin + ", " + begin + ", " + end + ", " + end + ", 9]",
                                "[0, 0, 1, 1, 0, 0]")));
    INFO(at);
    CHECK(margin.arrives);
    CHECK(margin.worst.margin == Approx(2.0 / 6 - 1).epsilon(1e-12));
    // At 2 m/s^2 until then.
    CHECK(margin.worst.s == Approx(std::pow(std::stod(at), 2)).epsilon(3e-3));
    double most = 0;
    for (const MarginPoint& p : margin.points) most = std::min(most, p.forces[1]);
    for (std::size_t i = 1; i < margin.points.size(); ++i) CHECK(margin.points[i].s > margin.points[i - 1].s);
    CHECK(most == Approx(-6).epsilon(1e-12));
  }
}

}  // namespace margin_motion_test
