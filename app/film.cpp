// SPDX-License-Identifier: BSD-3-Clause
#include "app/film.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include "app/frame_range.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "core/export/atomic_file.hpp"
#include "core/structures/name_index.hpp"
#include "core/text/nearest_name.hpp"
#include "render/image/image_scale.hpp"
#include "render/image/png.hpp"
#include "render/image/task_queue.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"

namespace unfurl {

namespace {

constexpr double max_frames = 99999;  // five digits in the name, and more than a day of drawing

// PNG files are compressed beside the drawing of the next pictures.
int writer_threads(const Arguments& arguments) {
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int threads = arguments.threads > 0 ? arguments.threads : cores;
  return threads == 1 ? 0 : std::min(threads, 16);
}

SourceLocation place_of(const Scene& scene, const std::string& key) {
  const auto it = scene.locations.find(key);
  return it == scene.locations.end() ? SourceLocation{scene.name, 0, 0} : it->second;
}

// The inset's column is one that only the run can tell to be there.
void check_inset(const Scene& scene, const Diagnostics& diagnostics) {
  const std::string& inset = scene.render.inset;
  if (inset.empty() || diagnostics.find(inset)) return;
  std::vector<std::string_view> names;
  for (const Series& series : diagnostics.columns) names.push_back(series.name);
  throw SceneError({{place_of(scene, "render.inset"), "render.inset",
                     "no column " + in_quotes(inset) + did_you_mean(inset, names)}});
}

std::vector<int> trail_nodes(const Scene& scene, const Structure& structure) {
  const std::string& pattern = scene.render.trails;
  if (pattern.empty()) return {};
  NameIndex nodes;
  for (const NodeCopy& copy : structure.node_copies) nodes.add(copy.name);
  std::vector<int> found = nodes.matching(pattern);
  if (found.empty())
    throw SceneError({{place_of(scene, "render.trails"), "render.trails",
                       "no node matches " + in_quotes(pattern) + did_you_mean(pattern, nodes.names())}});
  return found;
}

}  // namespace

FrameStyle film_style(const Scene& scene, const Simulation& run, const Diagnostics& diagnostics) {
  const RenderOptions& options = scene.render;
  FrameStyle style;
  style.width = options.width * options.supersample;
  style.height = options.height * options.supersample;
  style.title = scene.title;
  check_inset(scene, diagnostics);
  style.options = options;
  style.trails = trail_nodes(scene, run.trajectory.structure());
  style.run = &run;
  style.diagnostics = &diagnostics;
  return style;
}

void check_film(const Scene& scene) {
  const RenderOptions& render = scene.render;
  if (most_shots(scene.solver.end_time, render) <= max_frames) return;
  throw SceneError({{place_of(scene, "render.fps"), "render.fps",
                     "the film would have more than 99999 frames; take fewer per second, a larger "
                     "render.speed or an earlier solver.end_time"}});
}

bool has_alpha(const RenderOptions& options) {
  const Look* look = find_look(options.look);
  return options.transparent || (look != nullptr && look->transparent);
}

bool draw_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run,
                 const Diagnostics& diagnostics, GlContext& context, const Arguments& arguments) {
  const RenderOptions& options = scene.render;
  const std::vector<Shot> shots = film_shots(run.trajectory, options);
  const FrameRange range = frame_range(arguments.frames, shots.size());
  std::vector<std::size_t> missing;
  for (std::size_t k = range.first; k < range.end; ++k)
    if (!folder.finished(k)) missing.push_back(k);
  if (missing.empty()) return true;
  folder.forget_films();
  const bool alpha = has_alpha(options);
  const FrameStyle style = film_style(scene, run, diagnostics);
  const FrameBuilder builder(run.trajectory, style);
  Renderer renderer(context, style.width, style.height);
  TaskQueue writers(writer_threads(arguments));
  Progress progress("drawing", arguments.quiet);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (interrupted()) {
      writers.finish();
      return false;
    }
    progress.show(static_cast<double>(i) / static_cast<double>(missing.size()));
    auto image = std::make_shared<const Image>(renderer.draw(builder.build(shots[missing[i]])));
    writers.add([image = std::move(image), path = folder.frame(missing[i]), &options, alpha] {
      if (options.supersample == 1) return write_png(path, *image, alpha, Flush::later);
      write_png(path, scaled_down(*image, options.width, options.height), alpha, Flush::later);
    });
  }
  writers.finish();
  flush_files(folder.frame(0).parent_path());
  return true;
}

}  // namespace unfurl
