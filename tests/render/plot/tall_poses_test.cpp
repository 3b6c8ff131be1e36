// SPDX-License-Identifier: BSD-3-Clause
// Figures of structures that are tall, fast, pulled by cables or driven by several drives.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "render/plot/figures.hpp"
#include "render/plot/layout.hpp"
#include "render/plot/pose_painter.hpp"
#include "render/plot/style.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace tall_poses_test {

namespace {

Figure figure_of(const char* name, const std::string& scene) {
  const Simulation run = testing::run_scene(scene);
  return find_figure(name)->make(run, diagnose(run));
}

// Strokes by their pens: white ones part rods behind others.
class Strokes final : public plot::Canvas {
 public:
  void polyline(std::span<const plot::Point> points, const plot::Pen& pen) override {
    const double length = std::hypot(points.back().x - points.front().x, points.back().y - points.front().y);
    if (pen.color.r == 1 && pen.color.g == 1 && pen.color.b == 1)
      white += length * pen.width;
    else
      rods += length * pen.width;
  }
  void band(std::span<const plot::Point>, std::span<const plot::Point>, FigureColor) override {}
  void convex(std::span<const plot::Point>, FigureColor) override {}
  void circle(plot::Point, double, FigureColor) override {}
  void text(plot::Point, std::string_view, const plot::TextStyle&) override {}
  void begin_clip(const plot::Rect&) override {}
  void end_clip() override {}
  double white = 0, rods = 0;  // areas [points^2]
};

Strokes last_pose(const Figure& f) {
  const plot::FigureLayout layout = plot::lay_out(f, {});
  Strokes strokes;
  plot::paint_pose(f.panels.back(), layout.panels.back(), strokes);
  return strokes;
}

// Its rods cross at half of a right angle.
std::string mast(int bays) {
  return "[structure]\nkind = 'scissor_mast'\nsides = 3\nfold_angle = 50\ncells = " + std::to_string(bays) +
         "\n[solver]\nstep = 0.02\nend_time = 0.04\n";
}

}  // namespace

TEST_CASE("gaps where rods cross never take much of the rods", "[figures]") {
  // A gap is at most a fifth as wide as the shorter rod is long, and there is about one crossing for two
  // rods.
  for (const int bays : {3, 20, 60}) {
    const Strokes strokes = last_pose(figure_of("poses", mast(bays)));
    INFO(bays << " bays: " << strokes.white << " of " << strokes.rods);
    CHECK(strokes.white < 0.5 * strokes.rods);
  }
}

TEST_CASE("poses of a short run have times that differ", "[figures]") {
  const Figure f = figure_of("poses",
                             "[structure]\nkind = 'pendulum'\n[gravity]\nacceleration = [0, 0, -9.81]\n"
                             "[solver]\nstep = 5e-6\nend_time = 1e-4\n");
  std::set<std::string> titles;
  for (const Panel& panel : f.panels) titles.insert(panel.title);
  CHECK(titles.size() == 6);
}

TEST_CASE("the scale bar of poses is a good part of what a panel shows", "[figures]") {
  for (const int bays : {1, 3, 60}) {
    const Figure f = figure_of("poses", mast(bays));
    const plot::FigureLayout layout = plot::lay_out(f, {});
    const auto& scale = layout.panels.at(3).x.scale;
    const double shown = std::abs(scale.hi - scale.lo), bar = f.panels[3].scale_bar;
    INFO(bays << " bays: " << bar << " of " << shown);
    CHECK(bar > shown / 9);  // 1, 2 or 5 times a power of ten that is at most a third
    CHECK(bar < shown / 2);
  }
}

TEST_CASE("poses show cables and springs", "[figures]") {
  const std::string pair =
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'A'\nposition = [1, 0, 0]\n[[structure.nodes]]\nname = 'B'\nposition = "
      "[2, 0, 1]\nfixed = true\n[[structure.rods]]\nnodes = ['O', 'A']\nmass = 1\n[[forces]]\nkind = "
      "'spring'\n"
      "nodes = ['A', 'B']\nstiffness = 1\n[[forces]]\nkind = 'cable'\nnodes = ['O', 'A', "
      "'B']\naxial_stiffness = "
      "1\n"
      "[solver]\nstep = 0.02\nend_time = 0.04\n";
  const Figure f = figure_of("poses", pair);
  CHECK(f.panels.front().segments.size() == 1 + 1 + 2);
  std::set<std::string> names;
  for (const Curve& curve : f.panels.front().curves) names.insert(curve.label);
  CHECK(names == std::set<std::string>{"rod", "spring", "cable"});
}

TEST_CASE("colours after the eighth are others", "[figures]") {
  for (int i = 0; i < 2 * palette_size; ++i) {
    CHECK(plot::contrast_on_white(palette(i)) >= 3.0);  // WCAG 2.1, 1.4.11
    for (int j = 0; j < i; ++j) {
      const FigureColor a = palette(i), b = palette(j);
      INFO(i << ", " << j);
      CHECK(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 0.15f);
    }
  }
}

TEST_CASE("a drive has one colour in all panels of its figure", "[figures]") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1}, {name = "P", position = [0, 0, 1], fixed = true},
  {name = "O", position = [1, 0, 1], fixed = true}, {name = "Q", position = [0, 0, 2], mass = 1}]
rods = [{nodes = ["P", "Q"], mass = 0}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[constraints]]
kind = "plane"
nodes = ["Q"]
normal = [0, 1, 0]
[[constraints]]
kind = "coordinate"
name = "crane"
nodes = ["A"]
direction = [1, 0, 0]
motion = "smooth"
to = 0.4
duration = 0.2
[[constraints]]
kind = "angle"
name = "arm"
nodes = ["O", "P", "Q"]
motion = "smooth"
to = 70
duration = 0.2
[solver]
step = 0.05
end_time = 0.2
)");
  const Diagnostics d = diagnose(run);
  std::map<std::string, std::set<int>> colors;
  const Figure f = find_figure("drives")->make(run, d);
  REQUIRE(f.panels.size() == 3);
  for (const Panel& panel : f.panels)
    for (const Curve& curve : panel.curves) colors[curve.label].insert(curve.color);
  REQUIRE(colors.size() == 2);
  CHECK(colors["crane"].size() == 1);
  CHECK(colors["arm"].size() == 1);
  CHECK(colors["crane"] != colors["arm"]);
}

}  // namespace tall_poses_test
