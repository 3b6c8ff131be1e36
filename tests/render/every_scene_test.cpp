// SPDX-License-Identifier: BSD-3-Clause
// Every scene that comes with the program, found by listing the folder: its pictures are well framed, small
// and large, and its figures in order in every style.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "render/plot/figure_data.hpp"
#include "render/plot/figures.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/solid_mesh.hpp"
#include "render/scene/view.hpp"
#include "tests/render/plot/recording_canvas.hpp"

using namespace unfurl;

namespace every_scene_picture_test {

namespace {

struct Run {
  Scene scene;
  Simulation simulation;
  Diagnostics diagnostics;
};

const std::vector<Run>& runs() {
  static const std::vector<Run> all = [] {
    std::vector<Run> out;
    REQUIRE(library_scenes().size() >= 6);
    for (const LibraryScene& entry : library_scenes()) {
      Scene scene = read_scene_file(entry.path, {});
      Simulation simulation = simulate(build_model(scene), scene.solver);
      Diagnostics diagnostics = diagnose(simulation);
      out.push_back({std::move(scene), std::move(simulation), std::move(diagnostics)});
    }
    return out;
  }();
  return all;
}

// What bodies cover in the picture, in pixels.
struct Cover {
  float left = 1e9f, right = -1e9f, top = 1e9f, bottom = -1e9f, nearest = 1e9f;

  void add(const DrawList& list, const FrameStyle& style) {
    const Solids solids = solids_of(list);
    for (const auto* bodies : {&solids.capsules, &solids.balls, &solids.cylinders})
      for (const SolidInstance& body : *bodies) {
        add(list.camera, style, body.a, body.radius_a);
        add(list.camera, style, body.b, body.radius_b);
      }
  }
  // A ball's outline in perspective is a little larger than its middle's scale says: by less than 1 % for
  // balls of less than a tenth of their distance.
  void add(const Camera& camera, const FrameStyle& style, const Vec3f& at, float radius) {
    const Vec3f p = project(camera, style.width, style.height, at);
    const Vec3f up = camera.up.normalized();
    const Vec3f q = project(camera, style.width, style.height, at + radius * up);
    const float r = 1.01f * (p - q).head<2>().norm();
    left = std::min(left, p.x() - r), right = std::max(right, p.x() + r);
    top = std::min(top, p.y() - r), bottom = std::max(bottom, p.y() + r);
    nearest = std::min(nearest, p.z() - radius - camera.near_plane);
  }
};

constexpr int poses = 41;

FrameStyle style_of(const Run& run, int width, int height) {
  FrameStyle style;
  style.width = width, style.height = height;
  style.title = run.scene.title;
  style.options = run.scene.render;
  style.run = &run.simulation;
  style.diagnostics = &run.diagnostics;
  return style;
}

plot::Rect box_of(const TextLabel& label) {
  const auto width = static_cast<float>(plot::text_width(label.text, static_cast<double>(label.height)));
  const float x = label.x - label.align * width;
  return {x, label.y, x + width, label.y + label.height};
}

}  // namespace

TEST_CASE("every scene's motion is inside its pictures and fills them, small and large") {
  for (const Run& run : runs())
    for (const auto& [width, height] : {std::pair{640, 360}, std::pair{3840, 2160}}) {
      CAPTURE(run.scene.name, width);
      const FrameStyle style = style_of(run, width, height);
      const Trajectory& motion = run.simulation.trajectory;
      const FrameBuilder builder(motion, style);
      Cover cover;
      for (int k = 0; k < poses; ++k)
        cover.add(
            builder.build(motion.start_time() + (motion.end_time() - motion.start_time()) * k / (poses - 1)),
            style);
      const auto w = static_cast<float>(width), h = static_cast<float>(height);
      CHECK(cover.nearest > 0);
      CHECK(cover.left > 0.02f * w);
      CHECK(cover.right < 0.98f * w);
      CHECK(cover.top > 0.02f * h);
      CHECK(cover.bottom < 0.98f * h);
      CHECK(std::max((cover.right - cover.left) / w, (cover.bottom - cover.top) / h) > 0.5f);
    }
}

TEST_CASE("what is written on every scene's pictures is inside, apart and large enough to read") {
  for (const Run& run : runs())
    for (const auto& [width, height] : {std::pair{640, 360}, std::pair{3840, 2160}}) {
      CAPTURE(run.scene.name, width);
      const FrameBuilder builder(run.simulation.trajectory, style_of(run, width, height));
      const DrawList list = builder.build(run.simulation.trajectory.end_time());
      REQUIRE(list.labels.size() >= 2);
      for (std::size_t i = 0; i < list.labels.size(); ++i) {
        const TextLabel& label = list.labels[i];
        CAPTURE(label.text);
        // Twelve pixels are what screens show menus in; a thirtieth of a large picture is read from afar.
        CHECK(label.height >= std::max(12.0f, static_cast<float>(height) / 36));
        const plot::Rect box = box_of(label);
        CHECK(plot::Rect{0, 0, static_cast<double>(width), static_cast<double>(height)}.contains(box));
        for (std::size_t k = 0; k < i; ++k) CHECK_FALSE(box.overlaps(box_of(list.labels[k])));
      }
    }
}

TEST_CASE("every scene's figures are in order in every style, with their numbers and caption") {
  for (const Run& run : runs())
    for (const FigureKind& kind : figure_kinds()) {
      if (!kind.applies(run.simulation, run.diagnostics)) continue;
      CAPTURE(run.scene.name, kind.name);
      const Figure figure = kind.make(run.simulation, run.diagnostics);
      CHECK(plot::twins(figure) == std::vector<std::string>{});
      for (const FigureStyle& style : figure_styles()) {
        CAPTURE(style.name);
        CHECK(plot::faults(figure, style) == std::vector<std::string>{});
      }
      const std::string numbers = figure_csv(figure), caption = figure_caption(figure);
      CHECK(std::count(numbers.begin(), numbers.end(), '\n') > 2);  // the names, two steps at least
      CHECK(caption.find("nan") == std::string::npos);
      CHECK(caption.ends_with(".\n"));
    }
}

}  // namespace every_scene_picture_test
