// SPDX-License-Identifier: BSD-3-Clause
// Speed against accuracy beside the view: true errors, of the motion that is shown.
#include "app/panel/runs/trade.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "app/panel/panes/figure_cards.hpp"
#include "app/panel/runs/comparison.hpp"
#include "render/plot/ticks.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/support/four_bar_exact.hpp"

using namespace unfurl;

namespace trade_test {

namespace {

// The ladder of two windows over its first one and a half seconds, 1 m/s at the start.
struct LadderPanel : PanelDriver {
  LadderPanel() : PanelDriver(small(), "ladder") { change("solver.end_time", 1.5); }
  void change(const std::string& key, ParamValue value) {
    state().history.edit(key, std::move(value));
    settle();
  }
  const TradePoint& now() { return state().trade.back(); }
};

double true_error(const LiveRun& run, double speed) {
  return exact::largest_head_error({2, speed}, run.simulation.trajectory);
}

std::vector<Curve> labelled(const Figure& figure, const std::string& label) {
  std::vector<Curve> found;
  for (const Curve& curve : figure.panels.at(0).curves)
    if (curve.label == label) found.push_back(curve);
  return found;
}

TradePoint point(const char* method, const char* motion, double cpu_s, double position_error) {
  return {.method = method,
          .setting = method,
          .cpu_s = cpu_s,
          .error = 1e-3,
          .motion = std::make_shared<const std::string>(motion),
          .accuracy = std::isnan(position_error) ? Accuracy::waiting : Accuracy::known,
          .position_error = position_error,
          .uncertainty = 1e-14};
}

const double none = std::nan("");

}  // namespace

TEST_CASE("a pinned run's curves go to panels of their own quantity") {
  const auto panel_of = [](const std::string& quantity, double value) {
    Panel panel;
    panel.x.label = "time (s)";
    panel.y.label = quantity;
    Curve curve;
    curve.x = {0, 1};
    curve.y = {value, value};
    panel.curves.push_back(std::move(curve));
    return panel;
  };
  Figure now, pinned;
  now.panels = {panel_of("force (N)", 1), panel_of("travel (m)", 2), panel_of("travel (m)", 3)};
  pinned.panels = {panel_of("torque (N m)", -31), panel_of("travel (m)", 20), panel_of("travel (m)", 30)};
  const Figure both = with_pinned(now, pinned);
  REQUIRE(both.panels.at(0).curves.size() == 1);  // no torque among forces
  CHECK(both.panels[0].curves[0].y[0] == 1);
  for (const int i : {1, 2}) {
    REQUIRE(both.panels[static_cast<std::size_t>(i)].curves.size() == 2);
    CHECK(both.panels[static_cast<std::size_t>(i)].curves[0].y[0] == 10 * (i + 1));
  }
}

TEST_CASE("the trade's diamond is at the present run's CPU time and true position error") {
  LadderPanel panel;
  for (const long stages : {2L, 3L, 4L}) {
    panel.change("solver.stages", stages);
    REQUIRE(panel.now().accuracy == Accuracy::known);
    // What is left is round-off of the exact motion's own evaluation.
    CHECK(panel.now().position_error ==
          Approx(true_error(*panel.state().shown, 1.0)).margin(2 * panel.now().uncertainty + 1e-12));
    const Figure figure = trade_figure(panel.state().trade);
    CHECK(figure.panels.at(0).y.label == "position error (m)");
    const Curve diamond = labelled(figure, "now").at(0);
    CHECK(diamond.x.at(0) == panel.now().cpu_s);
    CHECK(diamond.y.at(0) == panel.now().position_error);
  }
  // More stages, smaller errors: what the user is to see.
  const auto& trade = panel.state().trade;
  const std::size_t n = trade.size();
  CHECK(trade[n - 3].position_error > 10 * trade[n - 2].position_error);
  CHECK(trade[n - 2].position_error > 10 * trade[n - 1].position_error);
  CHECK(point_caption(panel.now()).find("energy error") != std::string::npos);
  CHECK(point_caption(panel.now()).find("position error") != std::string::npos);
  CHECK(panel.panel().has_place("trade now"));
  CHECK(panel.panel().has_place("trade sentence"));
}

TEST_CASE("a change of the motion takes its own reference, and points of the old motion step back") {
  LadderPanel panel;
  panel.change("solver.stages", 3L);
  const std::size_t before = panel.state().trade.size();
  panel.change("structure.speed", 3.0);
  REQUIRE(panel.now().accuracy == Accuracy::known);
  CHECK(panel.now().position_error ==
        Approx(true_error(*panel.state().shown, 3.0)).margin(2 * panel.now().uncertainty + 1e-12));
  const Figure figure = trade_figure(panel.state().trade);
  CHECK(labelled(figure, "other motions").at(0).x.size() == 2 * before);  // each with a gap behind it
  CHECK(labelled(figure, "dvm").at(0).x.size() == 2);                     // the present one alone
  CHECK(figure.panels[0].curves.at(0).x.size() == 1);                     // and nothing for the trail to join
}

TEST_CASE("a comparison has the position errors of both runs") {
  LadderPanel panel;
  panel.key(Key::p);
  panel.change("solver.stages", 2L);
  const auto& trade = panel.state().trade;
  const TradePoint* a = point_of(trade, *panel.state().pinned);
  const TradePoint* b = point_of(trade, *panel.state().shown);
  REQUIRE(a);
  REQUIRE(b);
  const auto rows = compare(*panel.state().pinned, *panel.state().shown, a, b);
  const auto row =
      std::find_if(rows.begin(), rows.end(), [](const auto& r) { return r.label == "position error"; });
  REQUIRE(row != rows.end());
  CHECK(row->a == plot::format_number(a->position_error, 4) + " m");
  CHECK(row->b == plot::format_number(b->position_error, 4) + " m");
  CHECK(row->a != row->b);
  for (const auto& each : compare(*panel.state().pinned, *panel.state().shown))
    CHECK(each.label != "position error");
}

// The same path in half the time, in as many steps: four times the torque, eight times the power.
TEST_CASE("a comparison has what each drive gave") {
  PanelDriver panel(PanelDriver::small(), "hoop6_motor");
  panel.settle();
  panel.key(Key::p);
  std::set<std::string> labels;  // of a run beside itself: each row once
  for (const auto& row : compare(*panel.state().pinned, *panel.state().shown))
    CHECK(labels.insert(row.label).second);
  CHECK(labels.contains("peak motor torque"));
  const auto change = [&](const std::string& key, double value) {
    panel.state().history.edit(key, value);
    panel.settle();
  };
  change("constraints[0].duration", 2.5);
  change("solver.step", 0.005);
  change("solver.end_time", 3.0);
  const auto rows = compare(*panel.state().pinned, *panel.state().shown);
  const auto changed = [&](const std::string& label) {
    for (const auto& row : rows)
      if (row.label == label) return row.change;
    return "no row " + label;
  };
  CHECK(changed("peak motor torque") == "+300 %");
  CHECK(changed("peak motor power") == "+700 %");
  // From rest to rest: all that the motor gave it took back, and of what rounding left there is no per cent.
  CHECK(changed("motor energy").empty());
}

TEST_CASE(
    "while an error is measured the present run is a line at its CPU time, on the axis that was there") {
  std::vector<TradePoint> points{point("dvm", "m", 0.01, 1e-5), point("rk4", "m", 0.02, none)};
  Figure figure = trade_figure(points);
  CHECK(figure.panels.at(0).y.label == "position error (m)");
  CHECK(labelled(figure, "now").empty());
  REQUIRE(figure.panels[0].lines.size() == 1);
  CHECK_FALSE(figure.panels[0].lines[0].horizontal);
  CHECK(figure.panels[0].lines[0].value == 0.02);
  CHECK(std::isnan(mark_of(points[1], true, plot::PanelLayout()).y));
  // At first, with nothing measured yet, and where nothing can be measured, it is the energy's error.
  points = {point("dvm", "m", 0.01, none)};
  CHECK(trade_figure(points).panels.at(0).y.label == "energy error (relative)");
  points.push_back(point("rk4", "n", 0.02, 1e-6));
  points.push_back(point("rk4", "m", 0.02, none));
  points.back().run = 7;
  note_error(points, {.run = 7, .why = "it would take some 50 s of CPU time"});
  figure = trade_figure(points);
  CHECK(figure.panels.at(0).y.label == "energy error (relative)");
  CHECK(labelled(figure, "now").at(0).y.at(0) == 1e-3);
  CHECK(present_sentence(points.back()).find("it would take some 50 s") != std::string::npos);
  // A run that broke off has no error, but its motion's axis stays.
  points.push_back(point("rk4", "n", 0.02, none));
  points.back().run = 8;
  points.insert(points.end() - 1, point("dvm", "n", 0.03, 1e-7));
  note_error(points, {.run = 8, .uncertainty = 1e-14});
  CHECK(points.back().accuracy == Accuracy::no_answer);
  CHECK(trade_figure(points).panels.at(0).y.label == "position error (m)");
}

TEST_CASE("methods keep their colours whatever else is shown") {
  const Figure one = trade_figure({point("rk4", "m", 0.01, 1e-5)});
  const Figure two = trade_figure({point("dvm", "m", 0.01, 1e-5), point("rk4", "m", 0.01, 1e-5)});
  CHECK(labelled(one, "rk4").at(0).color == labelled(two, "rk4").at(0).color);
  CHECK(labelled(two, "dvm").at(0).color != labelled(two, "rk4").at(0).color);
}

TEST_CASE("an error below what is known of its reference is shown as that, not as known") {
  TradePoint below = point("dvm", "a", 0.2, 2.95e-12), above = point("dvm", "a", 0.3, 5e-9);
  below.uncertainty = above.uncertainty = 4e-11;
  CHECK(shown_error(below, true) == 4e-11);
  CHECK(shown_error(above, true) == 5e-9);
  CHECK(present_sentence(below).find("position error below " + plot::format_number(4e-11, 2) + " m") !=
        std::string::npos);
  CHECK(point_caption(below).find("position error below " + plot::format_number(4e-11, 2) + " m") !=
        std::string::npos);
  CHECK(present_sentence(above).find("position error " + plot::format_number(5e-9, 3) + " m") !=
        std::string::npos);
  for (const Curve& curve : labelled(trade_figure({above, below}), "now"))
    CHECK(curve.y == std::vector<double>{4e-11});  // on the line of the reference's uncertainty
}

}  // namespace trade_test
