// SPDX-License-Identifier: BSD-3-Clause
// What captions say: largest values are those of the motion, not of the ends of steps; of many events the
// first.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "render/plot/figures.hpp"
#include "tests/support/scene_run.hpp"

namespace unfurl::caption_peaks_test {

namespace {

using Catch::Contains;

Figure drawn(const std::string& figure, const std::string& scene) {
  const Simulation run = testing::run_scene(scene);
  return find_figure(figure)->make(run, diagnose(run));
}

std::string caption(const std::string& figure, const std::string& scene) {
  return drawn(figure, scene).caption;
}

double number_behind(const std::string& words, const std::string& text) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + words.size()));
}

// A uniform rod of 1 kg and 1 m, let go from the horizontal; it stands below its pin after 0.483 s, between
// two states, and between states at 0.45 s and 0.6 s its force is 1.6 % less at least.
std::string swing(double step) {
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = "
         "'P', position = [1, 0, 0]}]\nrods = [{nodes = ['O', 'P'], mass = 1, area = 1e-6, youngs_modulus = "
         "7e10, strength = 2e7}]\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nend_time = "
         "0.9\nstep = " +
         std::to_string(step);
}

}  // namespace

// At the lowest point w^2 = 3 g / L, and the mean over the rod of its tension is m w^2 L / 3 + m g / 2 =
// 1.5 m g = 14.715 N: 14.715 MPa, 0.73575 of the strength, a margin of 0.35916. The quintic through states
// 0.15 s apart, 0.8 rad of swing, misses the velocity by some 3e-4 of it.
TEST_CASE("captions of rods have the peaks of the motion", "[figures]") {
  for (const double step : {0.15, 0.005}) {
    INFO(step);
    const std::string strength = caption("rod_strength", swing(step)),
                      forces = caption("rod_forces", swing(step));
    CHECK(number_behind("Largest stress ", strength) == Approx(14.715).epsilon(1e-3));
    CHECK(number_behind("Largest share of the strength ", strength) == Approx(0.73575).epsilon(1.5e-3));
    CHECK(number_behind("a margin of ", strength) == Approx(0.35916).margin(2e-3));
    CHECK(number_behind("Largest magnitude ", forces) == Approx(14.715).epsilon(1e-3));
  }
  // A uniform rod of length L is below its pin after K(1/2) sqrt(2 L / (3 g)), K the complete elliptic
  // integral.
  for (const double step : {0.15, 0.005})
    CHECK(number_behind(" MPa (rod O-P at ", caption("rod_strength", swing(step))) ==
          Approx(1.8540746773013719 * std::sqrt(2 / (3 * 9.81))).margin(1e-4));
}

// Steps of 0.3 s have no state near the lowest point, which the curve then does not show.
TEST_CASE("a peak within a step is marked where the curves do not reach it", "[figures]") {
  for (const char* name : {"rod_forces", "rod_strength"})
    for (const double step : {0.005, 0.28}) {
      INFO(name << " " << step);
      const Figure f = drawn(name, swing(step));
      const auto& curves = f.panels[0].curves;
      const auto mark = std::ranges::find(curves, "largest, within a step", &Curve::label);
      REQUIRE((mark == curves.end()) == (step < 0.01));
      if (mark == curves.end()) continue;
      REQUIRE(mark->x.size() == 1);
      CHECK(mark->y[0] == Approx(14.715).epsilon(3e-3));  // some 1.5 rad of swing in a step
      CHECK(mark->x[0] == Approx(1.8540746773013719 * std::sqrt(2 / (3 * 9.81))).margin(2e-3));
    }
}

// A mass m moved by A in T along s(u) = 10 u^3 - 15 u^4 + 6 u^5 takes the power m A^2 / T^3 s'(u) s''(u).
TEST_CASE("captions of drives have the range of their power over the motion", "[figures]") {
  double most = 0;
  for (int k = 0; k <= 100000; ++k) {
    const double u = 1e-5 * k, rate = 30 * u * u * (1 - u) * (1 - u),
                 bend = 60 * u - 180 * u * u + 120 * u * u * u;
    most = std::max(most, rate * bend);
  }
  // Of 2.5 kg by 2 m in 1 s 66.6 W, to the six digits of the quintic through states 0.11 s apart.
  const std::string text = caption(
      "drives",
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, 0, 0], mass = 2.5}]\n"
      "rods = []\n[[constraints]]\nkind = 'coordinate'\nname = 'pull'\nnodes = ['P']\ndirection = [1, 0, 0]\n"
      "motion = 'smooth'\nto = 2\nduration = 1\n[solver]\nend_time = 1.1\nstep = 0.11\nstages = 4\n");
  CHECK(number_behind(" W and ", text) == Approx(10 * most).epsilon(1e-3));
  // s is the same from behind, and what was given comes back.
  CHECK_THAT(text, Contains("pull: between \u2212"));
  CHECK(number_behind("pull: between \u2212", text) == Approx(10 * most).epsilon(1e-3));
}

// 3 kg let down at 0.5 m/s after a gentle start: the line holds back m (g - a) v, at most 14.715 W as a >= 0,
// and gives nothing at any time.
TEST_CASE("a drive that only brakes gives no power in its caption", "[figures]") {
  const std::string text = caption(
      "drives",
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
      "{name = 'B', position = [0, 0, -1], mass = 1}, {name = 'C', position = [0, 0, -2], mass = 1}]\n"
      "rods = [{nodes = ['B', 'C'], mass = 1}]\n[[constraints]]\nkind = 'length'\nname = 'hoist'\n"
      "nodes = ['A', 'B']\nmotion = 'rate'\nrate = 0.5\nramp = 1\nstart = 0.5\n[gravity]\n"
      "acceleration = [0, 0, -9.81]\n[solver]\nend_time = 3\n");
  CHECK_THAT(text, Contains("hoist: between \u221214.7") && Contains(" W and 0 W."));
  CHECK(number_behind("between \u2212", text) == Approx(14.715).epsilon(1e-3));  // four digits
}

// Three rods that drift together, without a load: exactly 0 in each, 1e-28 N of rounding.
TEST_CASE("what rounding leaves of forces is drawn and said as zero", "[figures]") {
  const std::string moving = ", velocity = [1, 0.3, 0.2]}", rod = "], mass = 1, area = 1e-4}";
  const Simulation run = testing::run_scene(
      "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nnodes = [{name = 'A', position = [0, 0, 0]" +
      moving + ", {name = 'B', position = [1, 0, 0]" + moving + ", {name = 'C', position = [0.3, 0.9, 0.1]" +
      moving + "]\nrods = [{nodes = ['B', 'C'" + rod + ", {nodes = ['A', 'B'" + rod + ", {nodes = ['A', 'C'" +
      rod + "]\n[solver]\nend_time = 2\n");
  const Diagnostics d = diagnose(run);
  REQUIRE(d.axial_force.cwiseAbs().maxCoeff() > 0);  // rounding there is
  for (const auto& [name, words] : {std::pair{"rod_forces", " Largest magnitude 0 N. Method"},
                                    std::pair{"rod_strength", " Largest stress 0 MPa. Method"}}) {
    const Figure f = find_figure(name)->make(run, d);
    CHECK_THAT(f.caption, Contains(words));
    for (const Panel& panel : f.panels)
      for (const Curve& curve : panel.curves)
        CHECK(std::ranges::all_of(curve.y, [](double y) { return y == 0; }));
  }
}

TEST_CASE("captions name the first events and count the others", "[figures]") {
  Simulation run = testing::run_scene("structure.kind = 'hoop'\nsolver.end_time = 0.2\n");
  const auto with_events = [&](int events) {
    run.events.clear();
    for (int k = 0; k < events; ++k) {
      Event event;
      event.name = "stop " + std::to_string(k), event.t = 0.01 * k;
      run.events.push_back(event);
    }
    return find_figure("deployment")->make(run, diagnose(run)).caption;
  };
  CHECK_THAT(with_events(5), Contains("\u201Cstop 4\u201D at 0.040000") && !Contains("more event"));
  CHECK_THAT(with_events(6), Contains(" One more event at 0.050000"));
  const std::string many = with_events(19);
  CHECK_THAT(many, Contains("\u201Cstop 4\u201D at") && !Contains("stop 5"));
  CHECK_THAT(many, Contains(" 14 more events from 0.050000") && Contains(" to 0.180000"));
  // In the order of time, whatever they are called.
  with_events(4);
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) run.events[k].name = "cable pulls";
  run.events[0].t = 1e-9;  // taut from the start, but for rounding
  CHECK_THAT(find_figure("deployment")->make(run, diagnose(run)).caption,
             Contains("\u201Ccable pulls\u201D at 0 s. Event \u201Cstop 1\u201D at 0.0100000 s. Event "
                      "\u201Ccable pulls\u201D at 0.0200000 s. Event \u201Cstop 3\u201D at 0.0300000 s."));
}

}  // namespace unfurl::caption_peaks_test
