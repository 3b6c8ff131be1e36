// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/python/run_files.hpp"
#include "core/export/atomic_file.hpp"
#include "core/text/nearest_name.hpp"
#include "render/gl/context.hpp"
#include "render/image/gif_animation.hpp"
#include "render/image/image_scale.hpp"
#include "render/image/mp4_pipe.hpp"
#include "render/image/webp_animation.hpp"
#include "render/scene/camera_path.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/shutter.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_frames = 99999;   // as many as a film of the program has
constexpr std::size_t palette_samples = 24;  // frames that a GIF's colours are chosen from, as there

using Frame = std::shared_ptr<const Image>;

// The film's frames one by one, of its size.
class FrameSource {
 public:
  FrameSource(const JudgedRun& run, const Between& between)
      : scene_(fitted(run.scene, run.simulation)),
        shots_(film_shots(run.simulation.trajectory, scene_.render)),
        style_(film_style(scene_, run.simulation, run.diagnostics)),
        builder_(run.simulation.trajectory, style_),
        context_(make_offscreen_context()),
        renderer_(*context_, style_.width, style_.height),
        between_(between) {
    if (shots_.size() > most_frames)
      throw StudyError(
          "the film would have more than 99999 frames; take fewer per second, a larger render.speed or an "
          "earlier solver.end_time");
  }

  const RenderOptions& options() const { return scene_.render; }
  std::size_t size() const { return shots_.size(); }
  // A picture that is held is drawn once.
  Frame frame(std::size_t k) {
    between_();
    if (drawn_ && shots_[k] == shot_) return drawn_;
    Image image = exposed(renderer_, builder_, shots_[k], options().depth_of_field, between_);
    if (options().supersample != 1) image = scaled_down(image, options().width, options().height);
    shot_ = shots_[k];
    return drawn_ = std::make_shared<const Image>(std::move(image));
  }

 private:
  Scene scene_;
  std::vector<Shot> shots_;
  FrameStyle style_;
  FrameBuilder builder_;
  std::unique_ptr<GlContext> context_;
  Renderer renderer_;
  const Between& between_;
  Shot shot_;
  Frame drawn_;
};

void write_webp(FrameSource& frames, const std::string& file) {
  const RenderOptions& o = frames.options();
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  WebpAnimation webp(file, o.width, o.height, o.fps, has_alpha(o), cores == 1 ? 0 : std::min(cores, 4));
  for (std::size_t k = 0; k < frames.size(); ++k) webp.add(frames.frame(k));
  webp.finish();
}

void write_gif(FrameSource& frames, const std::string& file) {
  const RenderOptions& o = frames.options();
  const int width = std::min(o.width, o.gif_width),
            height = std::max(1, (o.height * width + o.width / 2) / o.width);
  GifAnimation gif(file, width, height, o.fps);
  const std::size_t stride = std::max<std::size_t>(1, frames.size() / palette_samples);
  for (std::size_t k = 0; k < frames.size(); k += stride)
    gif.sample(scaled_down(*frames.frame(k), width, height));
  for (std::size_t k = 0; k < frames.size(); ++k) gif.add(scaled_down(*frames.frame(k), width, height));
  gif.finish();
}

void write_mp4(FrameSource& frames, const std::string& file) {
  const RenderOptions& o = frames.options();
  if (!ffmpeg_available()) throw FileError(file, "an MP4 is made by ffmpeg, which is not in the PATH");
  Mp4Pipe mp4(file, o.width, o.height, o.fps);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Frame frame = frames.frame(k);
    mp4.add(has_alpha(o) ? without_alpha(*frame, o) : *frame);
  }
  if (const std::string problem = mp4.finish(); !problem.empty()) throw FileError(file, problem);
}

}  // namespace

void write_film(const JudgedRun& run, const std::string& file, const Between& between) {
  const std::string extension = std::filesystem::path(file).extension().string();
  const bool webp = extension == ".webp", gif = extension == ".gif", mp4 = extension == ".mp4";
  if (!webp && !gif && !mp4)
    throw StudyError("a film is written as .mp4, .webp or .gif, not " + in_quotes(extension));
  FrameSource frames(run, between);
  const RunReceipt receipt(run, "film()", file);
  if (webp) write_webp(frames, file);
  if (gif) write_gif(frames, file);
  if (mp4) write_mp4(frames, file);
}

}  // namespace unfurl
