// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/film.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include "app/output/command_line.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/progress.hpp"
#include "app/verbs/frame_range.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/size_limits.hpp"
#include "render/image/image_scale.hpp"
#include "render/image/png.hpp"
#include "render/image/task_queue.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/shutter.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

constexpr double max_frames = 99999;  // five digits in the name, and more than a day of drawing

constexpr std::size_t frames_of_a_piece = 4;  // that a worker of a team takes at once

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

}  // namespace

void check_film(const Scene& scene) {
  const RenderOptions& render = scene.render;
  if (most_shots(scene.solver.end_time, render) <= max_frames) return;
  throw SceneError({{place_of(scene, "render.fps"), "render.fps",
                     "the film would have more than 99999 frames; take fewer per second, a larger "
                     "render.speed or an earlier solver.end_time"}});
}

void require_all_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run,
                        const Arguments& arguments) {
  const std::size_t frames = film_shots(run.trajectory, scene.render).size();
  std::vector<std::string> again = without_option(arguments.words, "--frames");
  std::erase(again, "--encode-only");
  std::string commands;
  std::size_t missing = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    if (folder.finished(k)) continue;
    const std::size_t first = k;
    while (k < frames && !folder.finished(k)) ++k;
    missing += k - first;
    commands += "\n  " + as_typed(again) + " --frames " + std::to_string(first) + ":" + std::to_string(k);
  }
  if (missing > 0)
    throw FileError(folder.frame(0).parent_path(), std::to_string(missing) + " of " + std::to_string(frames) +
                                                       " frames are missing; these draw them:" + commands);
}

bool all_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run) {
  const std::size_t frames = film_shots(run.trajectory, scene.render).size();
  for (std::size_t k = 0; k < frames; ++k)
    if (!folder.finished(k)) return false;
  return true;
}

void FrameMemory::keep(std::size_t frame, std::shared_ptr<const Image> image) {
  static const double room = std::min(0.2 * machine_memory(), 1e9);
  const bool held = !frames_.empty() && frames_.rbegin()->second == image;  // the same picture again
  if (!held) bytes_ += static_cast<double>(image->rgba.size());
  if (bytes_ < room) frames_[frame] = std::move(image);
}

std::shared_ptr<const Image> FrameMemory::find(std::size_t frame) const {
  const auto found = frames_.find(frame);
  return found == frames_.end() ? nullptr : found->second;
}

bool draw_frames(const FilmFolder& folder, const Scene& scene, const Simulation& run,
                 const Diagnostics& diagnostics, GlContext& context, const Arguments& arguments,
                 FrameMemory& memory, Team* team) {
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
  std::shared_ptr<const Image> image;
  Shot drawn;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (interrupted()) {
      writers.finish();
      return false;
    }
    const std::string piece = "frames-" + std::to_string(missing[i] / frames_of_a_piece);
    if (team && (!team->takes(piece) || folder.finished(missing[i]))) continue;
    progress.show(i, missing.size(), "frames");
    const Shot& shot = shots[missing[i]];
    if (!image || !(shot == drawn))  // a picture that is held is drawn once
      image = std::make_shared<const Image>(exposed(renderer, builder, shot, options.depth_of_field));
    drawn = shot;
    if (options.supersample == 1 && !alpha) memory.keep(missing[i], image);
    writers.add([image, path = folder.frame(missing[i]), &options, alpha] {
      if (options.supersample == 1) return write_png(path, *image, alpha, Flush::later);
      write_png(path, scaled_down(*image, options.width, options.height), alpha, Flush::later);
    });
  }
  writers.finish();
  flush_files(folder.frame(0).parent_path());
  return true;
}

}  // namespace unfurl
