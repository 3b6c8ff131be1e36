#include "app/film.hpp"

#include <array>
#include <cstdio>
#include <future>
#include <iostream>
#include <memory>
#include <optional>

#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "core/export/atomic_file.hpp"
#include "render/image/mp4_pipe.hpp"
#include "render/image/png.hpp"
#include "render/image/webp_animation.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"

namespace unfurl {

namespace {

constexpr double max_frames = 99999;  // five digits in the name, and more than a day of drawing

std::string frame_name(std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame_%05zu.png", index);
  return name.data();
}

// Takes frames in order and compresses them beside the drawing of the next one.
class FilmSink {
 public:
  FilmSink(const std::filesystem::path& directory, const RenderOptions& options, bool parallel)
      : frames_(directory / "frames"),
        webp_(directory / "animation.webp", options.width, options.height, options.fps),
        policy_(parallel ? std::launch::async : std::launch::deferred) {
    std::error_code error;
    std::filesystem::create_directories(frames_, error);
    if (error) throw FileError(frames_, error.value());
    if (ffmpeg_available())
      mp4_.emplace(directory / "animation.mp4", options.width, options.height, options.fps);
  }

  void add(std::size_t index, Image image) {
    wait();
    auto shared = std::make_shared<const Image>(std::move(image));
    png_ = std::async(policy_, [this, index, shared] { write_png(frames_ / frame_name(index), *shared); });
    film_ = std::async(policy_, [this, shared] {
      webp_.add(*shared);
      if (mp4_) mp4_->add(*shared);
    });
  }

  void finish() {
    wait();
    webp_.finish();
    const std::string warning = mp4_ ? mp4_->finish() : "";
    if (!warning.empty()) std::cerr << "unfurl: warning: " << warning << "\n";
  }

 private:
  void wait() {
    if (png_.valid()) png_.get();
    if (film_.valid()) film_.get();
  }

  std::filesystem::path frames_;
  WebpAnimation webp_;
  std::optional<Mp4Pipe> mp4_;
  std::launch policy_;
  std::future<void> png_, film_;  // last: they use the members above, and end before those do
};

}  // namespace

void check_film(const Scene& scene) {
  const RenderOptions& render = scene.render;
  if (scene.solver.end_time / render.speed * render.fps <= max_frames) return;
  const auto it = scene.locations.find("render.fps");
  const auto where = it == scene.locations.end() ? SourceLocation{scene.name, 0, 0} : it->second;
  throw SceneError({{where, "render.fps",
                     "the film would have more than 99999 frames; take fewer per second, a larger "
                     "render.speed or an earlier solver.end_time"}});
}

bool write_film(const std::filesystem::path& directory, const Scene& scene, const Simulation& run,
                GlContext& context, const Arguments& arguments) {
  FrameStyle style;
  style.width = scene.render.width;
  style.height = scene.render.height;
  style.title = scene.title;
  const FrameBuilder builder(run.trajectory, style);
  Renderer renderer(context, style.width, style.height);
  const auto times = frame_times(run.trajectory, scene.render.fps, scene.render.speed);
  FilmSink sink(directory, scene.render, arguments.threads != 1);
  Progress progress("drawing", arguments.quiet);
  std::size_t drawn = 0;
  for (; drawn < times.size() && !interrupted(); ++drawn) {
    progress.show(static_cast<double>(drawn) / static_cast<double>(times.size()));
    sink.add(drawn, renderer.draw(builder.build(times[drawn])));
  }
  sink.finish();
  return drawn == times.size();
}

}  // namespace unfurl
