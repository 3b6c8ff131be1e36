// SPDX-License-Identifier: BSD-3-Clause
// What is written beside a picture says what is in it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/tolerance.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/plot/ticks.hpp"
#include "render/scene/color_map.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/look.hpp"
#include "render/scene/view.hpp"
#include "tests/support/color_distance.hpp"

using namespace unfurl;

namespace frame_overlay_test {

namespace {

using testing::distance;
using testing::told_apart;

DrawList picture(const std::string& structure, const std::string& render) {
  const Scene scene = read_scene_text(structure + "[render]\n" + render, "ring.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  style.width = 1280, style.height = 720;
  return FrameBuilder(run.trajectory, style).build(2.0);
}

DrawList ring(const std::string& render) {
  return picture("structure.kind = \"hoop\"\nstructure.fold_angle = 85.0\nsolver.end_time = 10.0\n", render);
}

bool overlap(const TextLabel& a, const TextLabel& b) {
  return a.y < b.y + b.height && b.y < a.y + a.height;
}

// "2", "5×10⁻¹⁰": as numbers.
double number_in(const std::string& text) {
  const std::size_t times = text.find("\u00D710");
  if (times == std::string::npos) return std::stod(text);
  for (int n = -30; n <= 30; ++n)
    if (text.substr(times).starts_with("\u00D7" + plot::power_of_ten(n) + " "))
      return std::stod(text.substr(0, times)) * std::pow(10.0, n);
  return 0;
}

const TextLabel* label(const DrawList& list, const std::string& end) {
  const auto found =
      std::ranges::find_if(list.labels, [&](const TextLabel& l) { return l.text.ends_with(end); });
  return found == list.labels.end() ? nullptr : &*found;
}

// Two balls 1 m from where they are deployed, for 2 s at a rate towards it [m/s].
DrawList flying_by(const std::string& rate) {
  return picture("structure.kind = 'custom'\nstructure.nodes = [{name='P',position=[0,0,0],velocity=[" +
                     rate + ",0,0]},{name='Q',position=[0,1,0],velocity=[" + rate + R"(,0,0]}]
structure.rods = [{nodes=["P","Q"],mass=1}]
deployment.measure = "1 coordinate P along 1 0 0"
deployment.deployed = 1
solver.end_time = 2
)",
                 "");
}

}  // namespace

TEST_CASE("a heading of many lines or in a small picture stands above the structure") {
  const std::string scene =
      "title = 'A ring of six bars with a title that takes two lines of a picture of this width, as some "
      "do'\n"
      "structure.kind = 'hoop'\nstructure.fold_angle = 85.0\nsolver.end_time = 2\n[render]\nmethod = true\n"
      "errors = true\n";
  const Scene read = read_scene_text(scene, "ring.toml");
  const Simulation run = simulate(build_model(read), read.solver);
  const Diagnostics diagnostics = diagnose(run);
  for (const auto& [width, height] : {std::pair(1280, 720), {640, 360}, {320, 180}, {400, 300}})
    for (const char* camera : {"", "follow"}) {
      CAPTURE(width, camera);
      FrameStyle style = film_style(read, run, diagnostics);
      style.width = width, style.height = height;
      style.options.follow = *camera != 0;
      const FrameBuilder builder(run.trajectory, style);
      for (const double t : {0.0, 1.0, 2.0}) {
        const DrawList list = builder.build(t);
        float heading = 0;
        for (const TextLabel& l : list.labels)
          if (l.y < 0.4f * static_cast<float>(height)) heading = std::max(heading, l.y + l.height);
        CHECK(heading > 0.16f * static_cast<float>(height));
        float highest = 1e9f;
        for (const Tube& tube : list.tubes)
          for (const Vec3f& end : {tube.a, tube.b})
            highest = std::min(highest, project(list.camera, width, height, end).y());
        CHECK(highest >= std::min(heading, 0.4f * static_cast<float>(height)) - 1);
      }
    }
}

TEST_CASE("a scale bar says for which depth it holds, but where it holds for all") {
  CHECK(label(ring("scale_bar = true\n"), " m in the middle"));
  const DrawList parallel = ring("scale_bar = true\nprojection = \"orthographic\"\n");
  CHECK_FALSE(label(parallel, " m in the middle"));
  CHECK(label(parallel, " m"));
}

// A chain of two rods and its motion are the same drawing in every unit of length: single precision moves the
// ends by a hundredth of a pixel.
TEST_CASE("a scale bar is as long of the smallest and of the largest structure") {
  const auto length = [](const std::string& unit) {
    const DrawList list = picture("structure.kind = 'custom'\nvariables.L = " + unit + R"(
structure.nodes = [{name="A",position=[0,0,0]},{name="B",position=["=L",0,0]},{name="C",position=["=2*L",0,0]}]
structure.rods = [{nodes=["A","B"],mass=1},{nodes=["B","C"],mass=1}]
constraints = [{kind="fixed",nodes=["A"]}]
gravity.acceleration = [0,0,"=-9.81*L"]
solver.end_time = 2
)",
                                  "scale_bar = true\n");
    const TextLabel* text = label(list, " m in the middle");
    REQUIRE(text);
    const auto bar = std::ranges::find_if(list.lines, [&](const OverlayLine& line) {
      return line.y0 == line.y1 && std::abs(0.5f * (line.x0 + line.x1) - text->x) < 0.01f;
    });
    REQUIRE(bar != list.lines.end());
    return std::pair(bar->x1 - bar->x0, number_in(text->text) / std::stod(unit));
  };
  const auto [metre, says] = length("1");
  for (const char* unit : {"1e-12", "1e-9", "1e-7", "1e6", "1e9"}) {
    CAPTURE(unit);
    const auto [bar, of] = length(unit);
    CHECK(std::abs(bar - metre) < 0.05f);
    CHECK(of == Approx(says));
  }
}

// Two balls that fly away from where they are deployed, 1 m ahead: after 2 s at 0.5 m/s by -100 %.
TEST_CASE("what moves away from its deployed pose is deployed by less than nothing") {
  CHECK(label(flying_by("-0.5"), "deployed \u2212100 %"));
}

// 1 m from where it is deployed, at 0.4985 m/s for 2 s: 99.7 %, which `run` says as well.
TEST_CASE("what is not quite deployed is not deployed by 100 per cent") {
  CHECK(label(flying_by("0.4985"), "deployed 99.7 %"));
}

// A force of 0.2 MN pulls at a mass whose canister is larger than the arrow.
TEST_CASE("loads stand clear of the body at their node and are written as numbers are") {
  const DrawList list = picture(R"(structure.kind = 'custom'
structure.nodes = [{name="P",position=[0,0,0],mass=1e6},{name="Q",position=[0,2,0],mass=1e6}]
structure.rods = [{nodes=["P","Q"],mass=1}]
loads = [{nodes=["P"],force=[0,0,-2e5]}, {nodes=["Q"],force=[0,0,-5e4]}]
solver.end_time = 2
)",
                                "colour_by = 'axial_force'\nmethod = true\nerrors = true\n");
  REQUIRE(list.arrows.size() == 2);
  for (const Arrow& arrow : list.arrows)
    for (const Ball& ball : list.balls) CHECK((arrow.tail - ball.center).norm() > 0.99f * ball.radius);
  CHECK(label(list, "longest 2\u00D710\u2075 N"));
  for (const TextLabel& l : list.labels) {
    INFO(l.text);
    CHECK(l.text.find("e-") == std::string::npos);
    CHECK(l.text.find("e+") == std::string::npos);
  }
}

TEST_CASE("loads have no colour of the rods' ramp, and a word beside it") {
  for (const Look& look : looks()) {
    const double least = told_apart(look);
    for (const char* by : {"axial_force", "speed"}) {
      INFO(look.name << ", " << by);
      const DrawList list =
          ring("look = \"" + std::string(look.name) + "\"\ncolour_by = \"" + std::string(by) + "\"\n");
      REQUIRE_FALSE(list.arrows.empty());
      const Color& color = list.arrows.front().color;
      for (int k = 0; k <= 100; ++k)
        CHECK(distance(color, *by == 's' ? sequential_color(0.01 * k) : diverging_color(0.02 * k - 1)) >=
              least);
      const TextLabel *sign = label(list, "\u2192"),
                      *word = label(list, *by == 's' ? "load" : "load, longest 200 N");
      REQUIRE(sign);
      REQUIRE(word);
      CHECK(distance(sign->color, color) == 0);
      const std::string unit = *by == 's' ? "(m/s)" : "unique";
      REQUIRE(label(list, unit));
      CHECK_FALSE(overlap(*word, *label(list, unit)));
    }
  }
}

namespace {

// A chain whose rods are groups of their own.
std::string chain(int groups) {
  std::string text =
      "title = 'A title that is a good deal longer than a small picture is wide, as titles are'\n"
      "[structure]\nkind = 'custom'\n";
  for (int i = 0; i <= groups; ++i)
    text += "[[structure.nodes]]\nname = 'N" + std::to_string(i) + "'\nposition = [" + std::to_string(i) +
            ", 0, " + std::to_string(i % 2) + "]\n" + (i == 0 ? "fixed = true\n" : "");
  for (int i = 0; i < groups; ++i)
    text += "[[structure.rods]]\nnodes = ['N" + std::to_string(i) + "', 'N" + std::to_string(i + 1) +
            "']\nmass = 1\ngroup = 'group number " + std::to_string(i) + "'\n";
  return text + "[solver]\nstep = 0.1\nend_time = 0.1\n";
}

DrawList small_picture(const std::string& text, int width, int height, int fine = 1) {
  const Scene scene = read_scene_text(text, "s.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  style.width = fine * width, style.height = fine * height;
  style.options.supersample = fine;
  return FrameBuilder(run.trajectory, style).build(0.1);
}

struct Rectangle {
  double x0, y0, x1, y1;
};

// As wide as the layout takes it to be: glyphs are narrower, as a line is higher than its letters' size.
Rectangle box_of(const TextLabel& l) {
  const double wide = plot::text_width(l.text, static_cast<double>(l.height) / plot::line_height);
  const double x = static_cast<double>(l.x - l.align * static_cast<float>(wide)),
               y = static_cast<double>(l.y);
  return {x, y, x + wide, y + static_cast<double>(l.height)};
}

void check_texts(const DrawList& list, int width, int height) {
  for (const TextLabel& a : list.labels) {
    const Rectangle p = box_of(a);
    INFO(a.text);
    CHECK(p.x0 >= 0);
    CHECK(p.y0 >= 0);
    CHECK(p.x1 <= width);
    CHECK(p.y1 <= height);
    for (const TextLabel& b : list.labels) {
      if (&a == &b) continue;
      const Rectangle q = box_of(b);
      INFO(b.text);
      CHECK_FALSE((p.x0 < q.x1 && q.x0 < p.x1 && p.y0 < q.y1 && q.y0 < p.y1));
    }
  }
}

}  // namespace

TEST_CASE("texts stay in the picture and apart, however small it is and whatever it names") {
  const std::string all = "[render]\nscale_bar = true\naxes = true\nmethod = true\nerrors = true\n";
  for (const int groups : {2, 9, 60})
    for (const auto& [width, height] : {std::pair{1280, 720}, {480, 360}, {426, 360}, {300, 400}})
      for (const char* by : {"group", "axial_force", "stress"}) {
        INFO(groups << " groups, " << width << " x " << height << ", " << by);
        const DrawList list =
            small_picture(chain(groups) + all + "colour_by = '" + by + "'\n", width, height);
        check_texts(list, width, height);
        CHECK(label(list, " m in the middle"));
        if (*by == 'g')
          CHECK(label(list, groups > 9 ? " more" : "group number " + std::to_string(groups - 1)));
      }
  const std::string ring = "structure.kind = 'hoop'\nsolver.end_time = 0.2\n[render]\nscale_bar = true\n";
  for (const auto& [width, height] : {std::pair{480, 360}, {426, 360}}) {
    const DrawList list = small_picture(ring, width, height);
    check_texts(list, width, height);
    CHECK(label(list, "%"));
  }
}

// Whatever does not fit is left out, the least important things first.
TEST_CASE("texts of the smallest pictures are apart, and what matters most stays") {
  const std::string all =
      "[render]\nscale_bar = true\naxes = true\nmethod = true\nerrors = true\ninset = 'kinetic_energy_J'\n";
  for (const auto& [width, height] :
       {std::pair{160, 90}, {240, 135}, {240, 720}, {720, 120}, {200, 150}, {120, 160}, {96, 54}, {16, 16}})
    for (const char* by : {"group", "axial_force", "constraint_error", "stress"})
      for (const int groups : {1, 3, 9}) {
        INFO(width << " x " << height << ", " << by << ", " << groups << " groups");
        const DrawList list =
            small_picture(chain(groups) + all + "colour_by = '" + by + "'\n", width, height);
        if (width > 16) check_texts(list, width, height);  // the time is cut there
        CHECK(
            std::ranges::any_of(list.labels, [](const TextLabel& l) { return l.text.starts_with("t = "); }));
        if (width >= 120) CHECK(std::ranges::any_of(list.labels, [](const TextLabel& l) { return l.bold; }));
        for (const OverlayArea& area : list.areas) {
          CHECK(area.x0 >= 0);
          CHECK(area.x1 <= static_cast<float>(width));
        }
        const Inset& in = list.inset;
        if (!in.figure) continue;
        CHECK(in.x >= 0);
        for (const TextLabel& l : list.labels) {
          const Rectangle p = box_of(l);
          INFO(l.text);
          CHECK((p.x1 <= static_cast<double>(in.x) || p.x0 >= static_cast<double>(in.x + in.width) ||
                 p.y1 <= static_cast<double>(in.y) || p.y0 >= static_cast<double>(in.y + in.height)));
        }
      }
  // The bar of colours shrinks with the picture.
  const DrawList panel = small_picture(
      chain(2) + "[render]\ntitle = false\ncolour_by = 'axial_force'\ncolour_range = [-200, 200]\n", 160,
      135);
  CHECK(label(panel, "\u2212200"));
  CHECK(std::ranges::any_of(panel.labels,
                            [](const TextLabel& l) { return l.text.starts_with("axial force"); }));
  for (const OverlayArea& area : panel.areas) CHECK((area.x0 >= 0 && area.x1 <= 160));
  // Below the inset, not beside it in dots.
  const DrawList narrow = small_picture(chain(3) + all, 240, 720);
  REQUIRE(narrow.inset.figure);
  CHECK(std::ranges::none_of(narrow.labels, [](const TextLabel& l) { return l.text == "\u2026"; }));
  CHECK(label(narrow, " s"));
}

TEST_CASE("supersampling changes no size of what is written") {
  const std::string text = chain(3) + "[render]\nscale_bar = true\n";
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}, {426, 360}, {200, 150}}) {
    const DrawList plain = small_picture(text, width, height);
    for (const int fine : {2, 3}) {
      const DrawList list = small_picture(text, width, height, fine);
      REQUIRE(list.labels.size() == plain.labels.size());
      for (std::size_t i = 0; i < list.labels.size(); ++i)
        CHECK(list.labels[i].height == Approx(static_cast<float>(fine) * plain.labels[i].height));
    }
  }
}

TEST_CASE("the time of a short run has decimals that change") {
  const DrawList list = small_picture(
      chain(2).substr(0, chain(2).find("[solver]")) + "[solver]\nstep = 1e-6\nend_time = 2e-5\n", 640, 360);
  CHECK(label(list, "t = 0.0000200 s"));  // a two hundredth of the run is 1e-7 s
}

TEST_CASE("a bar of colours has no numbers where nothing is known") {
  const DrawList list = small_picture(chain(2) + "[render]\ncolour_by = 'stress'\n", 640, 360);
  CHECK(label(list, "not known, no rod has a youngs_modulus"));
  for (const TextLabel& l : list.labels) CHECK(l.text.find("e-") == std::string::npos);
}

TEST_CASE("a picture without rods has no words of a bar") {
  const std::string scene =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 1], mass = 1}]\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 2\n";
  CHECK_FALSE(label(picture(scene, "colour_by = 'speed'\n"), "speed (m/s)"));
  CHECK(label(ring("colour_by = 'speed'\n"), "speed (m/s)"));
}

TEST_CASE("a heading names how the run was solved, a path as one, adaptive steps as bounded") {
  const std::string hoop = "structure.kind = 'hoop'\nstructure.fold_angle = 85.0\nsolver.end_time = 2.0\n";
  const auto heading = [&](const std::string& solver) {
    const Scene scene = read_scene_text(hoop + solver + "[render]\nmethod = true\n", "ring.toml");
    const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
    const Diagnostics diagnostics = diagnose(run);
    FrameStyle style = film_style(scene, run, diagnostics);
    style.width = 1280, style.height = 720;
    return FrameBuilder(run.trajectory, style).build(1.0);
  };
  CHECK(label(heading(""), "dvm, s = 3, h = 0.01 s"));
  CHECK(label(heading("solver.adaptive = true\n"), "dvm, s = 3, h \u2264 0.01 s"));
  const DrawList path = heading("solver.model = 'path'\n");
  CHECK(label(path, "solved along its path"));
  CHECK_FALSE(label(path, "h = 0.01 s"));
}

TEST_CASE("the first eighteen groups have colours of their own in every look") {
  for (const Look& look : looks())
    for (std::size_t i = 0; i < 18; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        INFO(look.name << ": " << i << ", " << j);
        CHECK(distance(look.group(i), look.group(j)) > 0.05);
      }
}

TEST_CASE("the numbers of a bar of colours tell its ends and its middle apart") {
  const auto numbers = [](const std::string& range) {
    const DrawList list = small_picture(
        chain(2) + "[render]\ncolour_by = 'axial_force'\ncolour_range = " + range + "\n", 1280, 720);
    std::string all = "|";
    for (const TextLabel& l : list.labels) all += l.text + "|";
    return all;
  };
  CHECK_THAT(numbers("[1234, 1240]"), Catch::Contains("1234|1237|1240|") || Catch::Contains("1234|1237|"));
  CHECK_THAT(numbers("[-2000, 2000]"), Catch::Contains("|\u22122000|0|2000|"));
  CHECK_THAT(numbers("[0, 0.5]"), Catch::Contains("|0.25|0.5|"));
}

TEST_CASE("time and deployed fraction are whole in the panels of a small poster") {
  const std::string ring = "structure.kind = 'hoop'\nsolver.end_time = 0.2\n[render]\nlegend = false\n";
  for (const auto& [width, height] : {std::pair{213, 180}, {100, 100}, {66, 75}})
    for (const int fine : {1, 2}) {
      CAPTURE(width, height, fine);
      const DrawList list = small_picture(ring, width, height, fine);
      check_texts(list, fine * width, fine * height);
      CHECK(label(list, "%"));
      CHECK(label(list, width > 200 ? "%" : " s"));
    }
}

namespace {

FrameBuilder::Banner banner_of(const std::string& text, const FrameStyle& size, int panels, bool title = true,
                               bool legend = true) {
  const Scene scene = read_scene_text(text, "s.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  style.width = size.width, style.height = size.height;
  style.options.supersample = size.options.supersample;
  return FrameBuilder(run.trajectory, style)
      .banner(run.trajectory.end_time(), title, legend, legend, panels * size.width);
}

FrameStyle panel(int width, int height, int fine = 1) {
  FrameStyle size;
  size.width = fine * width, size.height = fine * height;
  size.options.supersample = fine;
  return size;
}

}  // namespace

TEST_CASE("above a poster are its title, its legend and how thick rods are drawn") {
  const std::string ring =
      "title = 'Six units'\nstructure.kind = 'hoop'\nsolver.end_time = 0.2\nrender.rod_scale = 3\n";
  const FrameBuilder::Banner both = banner_of(ring, panel(320, 270), 5),
                             plain = banner_of(ring, panel(320, 270), 5, false, true),
                             titled = banner_of(ring, panel(320, 270), 5, true, false);
  for (const char* text : {"Six units", "post", "chord", "load", "rods drawn 3.0 \u00D7 as thick"}) {
    CAPTURE(text);
    const bool title = std::string(text) == "Six units";
    CHECK(label(both.list, text));
    CHECK((label(plain.list, text) == nullptr) == title);
    CHECK((label(titled.list, text) == nullptr) != title);
  }
  CHECK(plain.height > 0);
  CHECK(both.height > plain.height);
  CHECK(both.height < 270 / 3);  // less than the poses
  CHECK(banner_of(ring, panel(320, 270), 5, false, false).height == 0);
  // Nothing is written on a ground of its own: the strip's is even.
  for (const TextLabel& l : both.list.labels) CHECK(l.backing.a == 0);
  CHECK(both.list.tubes.empty());
  CHECK(both.list.arrows.empty());
}

TEST_CASE("what is above a poster is whole at every size") {
  const std::string ring = "title = 'Six units'\nstructure.kind = 'hoop'\nsolver.end_time = 0.2\n";
  for (const std::string& scene : {ring, chain(14)})
    for (const auto& [width, height] : {std::pair{16, 16}, {53, 45}, {213, 180}, {1280, 1080}})
      for (const int panels : {1, 3, 5})
        for (const int fine : {1, 2}) {
          CAPTURE(scene.substr(0, 20), width, height, panels, fine);
          const FrameBuilder::Banner banner = banner_of(scene, panel(width, height, fine), panels);
          CHECK(banner.height % fine == 0);
          check_texts(banner.list, fine * panels * width, banner.height);
          CHECK((banner.height == 0) == banner.list.labels.empty());
          if (panels * width < 500) continue;
          CHECK(label(banner.list, scene == ring ? "load" : "group number 13"));
          CHECK(label(banner.list, scene == ring ? "post" : "group number 0"));
        }
}

TEST_CASE("the factor of thickness is whole and said once above the poses of a narrow poster") {
  const Scene scene = read_scene_text(
      "structure.kind = 'hoop'\nsolver.end_time = 0.2\n[render]\nrod_scale = 3\ncolour_by = 'speed'\n",
      "s.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  for (const auto& [width, height] : {std::pair{120, 320}, {100, 200}, {320, 270}}) {
    CAPTURE(width, height);
    style.width = width, style.height = height;
    const FrameBuilder frames(run.trajectory, style);
    const auto said = [&](const DrawList& list, int wide, int high) {
      std::string all;
      for (const TextLabel& l : list.labels) all += l.text + " ";
      check_texts(list, wide, high);
      return all;
    };
    const double end = run.trajectory.end_time();
    const FrameBuilder::Banner banner = frames.banner(end, true, true, false, 4 * width);
    CHECK_THAT(said(banner.list, 4 * width, banner.height),
               Catch::Contains("rods drawn 3.0 \u00D7 as thick"));
    CHECK_THAT(said(frames.key(end), width, height), !Catch::Contains("rods"));
  }
}

}  // namespace frame_overlay_test
