// SPDX-License-Identifier: BSD-3-Clause
// What stands below the figure of a margin.
#include <catch2/catch.hpp>
#include <limits>

#include "render/plot/figures/margin_figure.hpp"

namespace unfurl::margin_caption_test {

namespace {

std::string caption(MarginEnd end, double dynamic_min, const char* unit = "N m") {
  Margin margin;
  margin.sources = {{"loads", "load"}};
  margin.unit = unit;
  margin.points = {{0.0, 1.2, VectorXd::Constant(1, 2.0), 0.7}, {0.5, 0.6, VectorXd::Constant(1, 3.0), 0.4}};
  margin.worst = margin.points[1];
  margin.motion = {{0.0, 0.0, 1.2, 0.1, 0.2, 0.1}, {0.25, 0.3, 0.9 * radians_per_degree, 0.2, 0.3, 0.1}};
  margin.end = end;
  margin.arrives = end == MarginEnd::arrives;
  margin.stop = "bar";
  margin.dynamic_min = dynamic_min;
  return margin_figure(margin, "a scene").caption;
}

}  // namespace

TEST_CASE("the caption of a margin says how the motion ends, and none where there is no dynamic margin",
          "[figure]") {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::string other = caption(MarginEnd::other_way, std::numeric_limits<double>::quiet_NaN());
  CHECK_THAT(other, Catch::Contains("least dynamic margin none; the motion sets out the other way."));
  CHECK_THAT(caption(MarginEnd::arrives, infinite),
             Catch::Contains("least dynamic margin without bound; the motion arrives."));
  CHECK_THAT(caption(MarginEnd::stalls, 0.0), Catch::Contains("margin 0; the motion stalls at 0.9\u00B0."));
  CHECK_THAT(caption(MarginEnd::stopped, 0.25),
             Catch::Contains("margin 0.25; the motion ends at 0.9\u00B0, on the end stop bar."));
  CHECK_THAT(caption(MarginEnd::time, 0.25), Catch::Contains("at 0.9\u00B0 when its time is up."));
  // Without a fold angle both places are on the way along the path: 0.5 and 0.25.
  CHECK_THAT(caption(MarginEnd::time, 0.25, "N/kg^1/2"),
             Catch::Contains("0.4 at 0.5 m \u221Akg, least") &&
                 Catch::Contains("at 0.25 m \u221Akg when its time is up."));
}

TEST_CASE("where no margin can be drawn there is no axis of margins", "[figure]") {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const double least : {infinite, 21.0, 19.0}) {
    CAPTURE(least);
    Margin margin;
    margin.sources = {{"loads", "load"}};
    margin.points = {{0.0, 1.2, VectorXd::Constant(1, 2.0), infinite},
                     {0.5, 0.6, VectorXd::Constant(1, 3.0), least}};
    margin.worst = margin.points[1];
    margin.motion = {{0.0, 0.0, 1.2, 0.1, 0.2, 0.0}};  // nothing is taken up: without bound
    margin.dynamic_min = infinite;
    const Figure figure = margin_figure(margin, "a scene");
    CHECK(figure.panels.size() == (least > 20 ? 1 : 2));
    CHECK(static_cast<std::size_t>(figure.rows) == figure.panels.size());
    CHECK(figure.panels.back().x.shown);
    CHECK((figure.caption.find("No margin is as low as 20") != std::string::npos) == (least > 20));
  }
}

TEST_CASE("a motion that does not set out has no dynamic margin to draw and none that is too high",
          "[figure]") {
  for (const double least : {0.7, 40.0}) {
    Margin margin;
    margin.sources = {{"loads", "load"}};
    margin.points = {{0.0, 1.2, VectorXd::Constant(1, 2.0), least + 1},
                     {0.5, 0.6, VectorXd::Constant(1, 3.0), least}};
    margin.worst = margin.points[1];
    margin.motion = {{0.0, 0.0, 1.2, 0.0, 0.0, 0.0}};
    margin.dynamic_min = -0.1;
    margin.end = MarginEnd::stalls;
    const std::string caption = margin_figure(margin, "a scene").caption;
    CHECK_THAT(caption, Catch::Contains(" The motion does not set out, and no dynamic margin is drawn."));
    CHECK(caption.find("No dynamic margin is as low") == std::string::npos);
    CHECK(caption.find("No margin is as low") == std::string::npos);
    CHECK((caption.find(" No static margin is as low as 20") != std::string::npos) == (least > 20));
  }
}

TEST_CASE("the legend of margins names what is drawn", "[figure]") {
  for (const bool high : {false, true}) {
    Margin margin;
    margin.sources = {{"loads", "load"}, {"gravity", "gravity"}};
    const VectorXd forces{{2.0, -3e-30}};  // gravity has no share but of rounding
    margin.points = {{0.0, 1.2, forces, high ? 40.0 : 4.0}, {0.5, 0.6, forces, high ? 41.0 : 5.0}};
    margin.worst = margin.points[0];
    margin.motion = {{0.0, 0.0, 1.2, 0.1, 0.2, 0.1}, {0.25, 0.3, 0.9, 0.2, 0.3, 0.1}};
    const Figure figure = margin_figure(margin, "a scene");
    REQUIRE(figure.panels[0].bands.size() == 1);
    CHECK(figure.panels[0].bands[0].label == "loads");
    CHECK(figure.panels[1].curves.size() == (high ? 1 : 2));
    CHECK(figure.panels[1].curves.back().label == "dynamic, along the motion");
    CHECK((figure.caption.find(" No static margin is as low as 20, and none is drawn.") !=
           std::string::npos) == high);
  }
}

TEST_CASE("the caption of a margin tells what stops and latches bear", "[figure]") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Margin margin;
  margin.points = {{0.0, 1.2, VectorXd(0), 0.7}};
  margin.worst = margin.points[0];
  margin.motion = {{0.0, 0.0, 1.2, 0.1, 0.2, 0.1}};
  margin.loads = {{"bar", "stop", true, 12.5, 0.4, 3.0}, {"latch", "latch", false, -7.0, none, none}};
  const std::string caption = margin_figure(margin, "a scene").caption;
  CHECK_THAT(caption, Catch::Contains("Stop bar bears 12.5 N m at rest, and is met at 0.4 rad/s with 3 J."));
  CHECK_THAT(caption, Catch::Contains("latch holds 7 N back at rest, and is not reached."));
}

}  // namespace unfurl::margin_caption_test
