// SPDX-License-Identifier: BSD-3-Clause
// unfurl poster SCENE -o FILE.png: a strip of poses side by side.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/verbs/film.hpp"
#include "app/verbs/scene_run.hpp"
#include "render/image/image_scale.hpp"
#include "render/image/png.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/pose_times.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

// A poster has its title, and what its sizes and colours stand for, once. Each pose is a third as wide and
// half as high as a frame of the film, and all are drawn to one scale. What colours of a quantity stand for
// has a place as large beside the last one.
FrameStyle panel_style(const Scene& scene, const Simulation& run, const Diagnostics& diagnostics) {
  FrameStyle style = film_style(scene, run, diagnostics);
  style.width = std::max(16, scene.render.width / 3) * scene.render.supersample;
  style.height = std::max(16, scene.render.height / 2) * scene.render.supersample;
  style.options.title = style.options.legend = false;
  style.options.inset.clear();
  style.options.orbit = style.options.turntable = 0;
  style.options.follow = false;
  // From where a moving camera begins to look.
  std::vector<CameraKey>& keys = style.options.camera_keys;
  if (!keys.empty()) keys = {{0, keys.front().azimuth, keys.front().elevation, 1}};
  return style;
}

// A strip as wide as so many panels, drawn panel by panel: a picture may be wider than a driver draws.
Image draw_banner(const FrameBuilder::Banner& banner, const FrameStyle& style, int panels, int supersample,
                  GlContext& context) {
  Renderer renderer(context, style.width, banner.height);
  std::vector<Image> images;
  for (int k = 0; k < panels; ++k) {
    DrawList list = banner.list;
    list.stars = 0;
    const auto left = static_cast<float>(k * style.width);
    for (TextLabel& label : list.labels) label.x -= left;
    for (OverlayArea& area : list.areas) area.x0 -= left, area.x1 -= left;
    for (OverlayLine& line : list.lines) line.x0 -= left, line.x1 -= left;
    images.push_back(
        scaled_down(renderer.draw(list), style.width / supersample, banner.height / supersample));
  }
  return side_by_side(images);
}

// One scale bar and one set of axes hold for all poses: they stand in the first.
Image draw_poses(const FrameBuilder& builder, const FrameStyle& style, bool key, const Trajectory& run,
                 std::size_t poses, int supersample, GlContext& context) {
  FrameStyle plain = style;
  plain.measures = false;
  const bool differs = style.options.scale_bar || style.options.axes;
  std::optional<FrameBuilder> others;
  if (differs && poses > 1) others.emplace(run, plain);
  Renderer renderer(context, style.width, style.height);
  std::vector<Image> images;
  const auto add = [&](DrawList list) {
    list.ground.grid = false;  // its lines would break where two poses meet, as the Earth's limb would
    list.stars = list.planet_half_angle = 0;
    images.push_back(scaled_down(renderer.draw(list), style.width / supersample, style.height / supersample));
  };
  for (const double t : pose_times(run, poses)) {
    throw_if_interrupted();
    add((others && !images.empty() ? *others : builder).build(t));
  }
  if (key) add(builder.key(run.end_time()));
  return side_by_side(images);
}

}  // namespace

int cmd_poster(const Arguments& arguments) {
  const std::filesystem::path output(arguments.output);
  require_writable_png(output, "a poster");
  const Scene scene = scene_of(arguments);
  auto model = model_of(scene, arguments);
  check_film_names(scene, model->structure);
  const auto context = make_offscreen_context({arguments.threads, arguments.gpu});

  const InterruptGuard guard;
  Simulation run = simulate_scene(scene, std::move(model), arguments);
  throw_if_interrupted();
  const Diagnostics diagnostics = judge_run(run);
  const FrameStyle style = panel_style(scene, run, diagnostics);
  const bool key = scene.render.legend && scene.render.colour_by != "group";
  const FrameBuilder builder(run.trajectory, style);
  Image poster = draw_poses(builder, style, key, run.trajectory, static_cast<std::size_t>(arguments.poses),
                            scene.render.supersample, *context);
  const int panels = arguments.poses + (key ? 1 : 0);
  const bool legend = scene.render.legend;
  const FrameBuilder::Banner banner = builder.banner(run.trajectory.end_time(), scene.render.title, legend,
                                                     legend && !key, panels * style.width);
  if (banner.height > 0)
    poster = stacked(draw_banner(banner, style, panels, scene.render.supersample, *context), poster);
  write_png(output, poster, has_alpha(scene.render));
  report_run(run, diagnostics, arguments);
  return exit_code_of(run, diagnostics);
}

}  // namespace unfurl
