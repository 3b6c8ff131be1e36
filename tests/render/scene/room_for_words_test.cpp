// SPDX-License-Identifier: BSD-3-Clause
// What is written over a small picture leaves the structure its place.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/scene/camera_path.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace room_for_words_test {

namespace {

struct Film {
  Scene scene;
  Simulation run = simulate(build_model(scene), scene.solver);
  Diagnostics diagnostics = diagnose(run);

  explicit Film(Scene read) : scene(std::move(read)) {}
  Film(const char* name, const std::vector<std::string>& changes)
      : Film(read_scene_file(find_scene(name), changes)) {}
  FrameStyle style(int width, int height) const {
    FrameStyle out = film_style(scene, run, diagnostics);
    out.width = width, out.height = height;
    return out;
  }
};

// The largest depth [pixels] of a rod's end within a box of the picture.
double deepest(const DrawList& list, int width, int height, float x0, float y0, float x1, float y1) {
  float most = 0;
  for (const Tube& tube : list.tubes)
    for (const Vec3f& end : {tube.a, tube.b}) {
      const Vec3f p = project(list.camera, width, height, end);
      most = std::max(most, std::min({p.x() - x0, x1 - p.x(), p.y() - y0, y1 - p.y()}));
    }
  return static_cast<double>(most);
}

const TextLabel* ending(const DrawList& list, const std::string& end) {
  const auto found =
      std::ranges::find_if(list.labels, [&](const TextLabel& l) { return l.text.ends_with(end); });
  return found == list.labels.end() ? nullptr : &*found;
}

}  // namespace

// A frame of four rods as wide as a picture, seen from the front, reaches into every corner that is free.
TEST_CASE("an inset lies beside or above the structure or is left out of a picture too small for it") {
  const Film film(read_scene_text(R"(
structure.kind = 'custom'
structure.nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1.6, 0, 0], fixed = true},
                   {name = 'C', position = [1.6, 0, 0.9], fixed = true}, {name = 'D', position = [0, 0, 0.9], mass = 1.0}]
structure.rods = [{nodes = ['A', 'B'], mass = 1.0}, {nodes = ['B', 'C'], mass = 1.0},
                  {nodes = ['C', 'D'], mass = 1.0}, {nodes = ['D', 'A'], mass = 1.0}]
solver.end_time = 0.1
render.camera = 'front'
render.inset = 'kinetic_energy_J'
)",
                                  "frame.toml"));
  for (const auto& [width, height] : {std::pair{1280, 720},
                                      {720, 405},
                                      {640, 360},
                                      {480, 270},
                                      {440, 250},
                                      {430, 242},
                                      {400, 300},
                                      {320, 180},
                                      {300, 400},
                                      {230, 520},
                                      {160, 600},
                                      {720, 1280},
                                      {200, 120}}) {
    CAPTURE(width);
    const DrawList list = FrameBuilder(film.run.trajectory, film.style(width, height)).build(0);
    const bool room = width >= 430 || (width >= 230 && height >= 320);
    CHECK((list.inset.figure != nullptr) == room);
    if (!list.inset.figure) continue;
    const Inset& in = list.inset;
    CHECK(deepest(list, width, height, in.x, in.y, in.x + in.width, in.y + in.height) == 0);
  }
}

// The line of the time takes half of such a picture and more. A camera that turns around the middle of it had
// nothing left and stood at no place at all: the film showed nothing or, with dimension lines, ended the
// program.
TEST_CASE("the smallest pictures show all of a structure to every camera") {
  for (const char* camera :
       {"render.turntable=1", "render.orbit=90", "render.follow=true", "render.projection='orthographic'"})
    for (const auto& [width, height] : {std::pair{64, 48}, {200, 32}, {16, 16}, {32, 200}}) {
      INFO(camera << " " << width << " x " << height);
      const Film film("pendulum", {"solver.end_time=0.3", "render.dimensions=true", camera});
      const FrameBuilder builder(film.run.trajectory, film.style(width, height));
      for (const Shot& shot : film_shots(film.run.trajectory, film.scene.render)) {
        const DrawList list = builder.build(shot);
        REQUIRE_FALSE(list.tubes.empty());
        for (const Tube& tube : list.tubes)
          for (const Vec3f& end : {tube.a, tube.b}) {
            const Vec3f p = project(list.camera, width, height, end);
            const Eigen::Array2f at = p.head<2>(), size(width, height);
            REQUIRE((at >= 0 && at <= size).all());
          }
      }
    }
}

TEST_CASE("a scale bar stands below the structure, in panels of posters too, which are all of one scale") {
  const Film film("mesh_reflector", {"solver.end_time=0.2", "render.scale_bar=true", "render.title=false",
                                     "render.legend=false"});
  constexpr int width = 320, height = 270;
  FrameStyle style = film.style(width, height);
  const DrawList first = FrameBuilder(film.run.trajectory, style).build(0);
  const TextLabel* words = ending(first, " m in the middle");
  REQUIRE(words);
  CHECK(deepest(first, width, height, 0, words->y, width, height) == 0);
  style.measures = false;
  const DrawList other = FrameBuilder(film.run.trajectory, style).build(0);
  CHECK_FALSE(ending(other, " m in the middle"));
  CHECK(other.camera.eye == first.camera.eye);
}

TEST_CASE("dimension lines begin below the headings") {
  const Film film("scissor_mast", {"solver.step=0.05", "render.look=blueprint"});
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}}) {
    CAPTURE(width);
    const FrameBuilder frames(film.run.trajectory, film.style(width, height));
    for (double u = 0; u <= 1; u += 0.125) {
      const DrawList list = frames.build(u * film.run.trajectory.end_time());
      const TextLabel* heading = ending(list, " as thick");
      if (!heading) heading = ending(list, film.scene.title);
      REQUIRE(heading);
      REQUIRE_FALSE(list.lines.empty());
      for (const OverlayLine& line : list.lines)
        CHECK(std::min(line.y0, line.y1) >= heading->y + heading->height);
    }
  }
}

TEST_CASE("no rod passes behind a heading or a legend") {
  struct Shown {
    const char *scene, *change;
    int width, height;
  };
  for (const auto& [name, change, width, height] : {Shown{"pendulum", "render.zoom=1", 320, 180},
                                                    {"double_pendulum", "render.follow=true", 320, 180},
                                                    {"chain", "render.follow=true", 400, 300},
                                                    {"hoberman", "render.orbit=90", 320, 180},
                                                    {"hoberman", "render.zoom=1", 320, 180},
                                                    {"reentrant_sheet", "render.camera=front", 400, 300},
                                                    {"reentrant_sheet", "render.zoom=1", 400, 300}}) {
    CAPTURE(name, change);
    const Film film(name, {change, "solver.step=0.02"});
    const FrameBuilder frames(film.run.trajectory, film.style(width, height));
    float deep = 0;  // [pixels]
    for (double u = 0; u <= 1; u += 0.0625) {
      const DrawList list = frames.build(u * film.run.trajectory.end_time());
      for (const TextLabel& label : list.labels) {
        const auto wide = static_cast<float>(
            plot::text_width(label.text, static_cast<double>(label.height) / plot::line_height));
        const float x0 = label.x - label.align * wide;
        for (const Tube& tube : list.tubes)
          for (float along = 0; along <= 1; along += 0.0625f) {
            const Vec3f p = project(list.camera, width, height, tube.a + along * (tube.b - tube.a));
            deep = std::max(deep, std::min({p.x() - x0, x0 + wide - p.x(), p.y() - label.y,
                                            label.y + label.height - p.y()}));
          }
      }
    }
    CHECK(deep < 1);
  }
}

// As posters have them: a third as wide and half as high as a small picture.
TEST_CASE("what is written above and within small poses leaves most of the picture to them") {
  Film film("hoop6", {"solver.step=0.02"});
  film.scene.render.legend = film.scene.render.title = false;
  for (const auto& [width, height] : {std::pair{80, 67}, {66, 60}, {120, 90}, {53, 45}, {400, 360}}) {
    CAPTURE(width);
    const FrameBuilder frames(film.run.trajectory, film.style(width, height));
    for (const int poses : {1, 3, 5}) {
      const FrameBuilder::Banner banner = frames.banner(0, true, true, true, poses * width);
      const auto title = static_cast<int>(std::ranges::count(banner.list.labels, true, &TextLabel::bold));
      CHECK((title > 0 || poses * width < 110));  // of less room dots alone would be left
      // One line of the title has its room in any.
      if (title > 1 || banner.list.labels.size() > 1) CHECK(banner.height <= 0.7 * height);
    }
    if (width < 60) continue;  // words of five pixels and a pose have no room there
    for (const double t : {0.0, 2.0, film.run.trajectory.end_time()}) {
      const DrawList list = frames.build(t);
      const TextLabel* words = ending(list, " s");
      if (!words) words = ending(list, " %");
      REQUIRE(words);
      CHECK(deepest(list, width, height, 0, words->y, static_cast<float>(width), static_cast<float>(height)) <
            1);
    }
  }
}

}  // namespace room_for_words_test
