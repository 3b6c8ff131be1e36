// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/still.hpp"

#include <algorithm>
#include <cmath>

#include "render/image/image_scale.hpp"
#include "render/scene/camera_path.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/look.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/shutter.hpp"

namespace unfurl {

Scene fitted(const Scene& scene, const Simulation& run) {
  Scene out = scene;
  RenderOptions& render = out.render;
  if (!render.fit) return out;
  FrameStyle style;
  style.width = render.width, style.height = render.height;
  style.options = render;
  style.options.inset.clear();
  style.options.colour_by = "group";
  style.labels = false;
  const double aspect = FrameBuilder(run.trajectory, style).fitting_aspect();
  const double pixels = static_cast<double>(render.width) * render.height;
  const auto even = [](double x) { return std::max(16, 2 * static_cast<int>(std::lround(0.5 * x))); };
  render.height = even(std::sqrt(pixels / aspect));
  render.width = even(std::sqrt(pixels * aspect));
  return out;
}

bool has_alpha(const RenderOptions& options) {
  const Look* look = find_look(options.look);
  return options.transparent || (look != nullptr && look->transparent);
}

Image without_alpha(const Image& image, const RenderOptions& options) {
  const Look* look = find_look(options.look);
  const Color wall = look != nullptr && look->ink.g > look->background_bottom.g ? look->background_bottom
                                                                                : Color{1, 1, 1, 1};
  const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(255 * x)); };
  return before_wall(image, {byte(wall.r), byte(wall.g), byte(wall.b)});
}

Image still(const Scene& scene, const Simulation& run, const Diagnostics& diagnostics, double t,
            GlContext& context, const std::function<void()>& between) {
  const Scene shown = fitted(scene, run);
  if (between) between();
  const RenderOptions& options = shown.render;
  const FrameStyle style = film_style(shown, run, diagnostics);
  const FrameBuilder builder(run.trajectory, style);
  if (between) between();
  Renderer renderer(context, style.width, style.height);
  const Image image =
      exposed(renderer, builder, shot_at(run.trajectory, options, t), options.depth_of_field, between);
  return options.supersample == 1 ? image : scaled_down(image, options.width, options.height);
}

}  // namespace unfurl
