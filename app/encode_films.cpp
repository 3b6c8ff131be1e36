// The animations, made of finished frames.
#include <algorithm>
#include <future>
#include <iostream>
#include <memory>
#include <optional>

#include "app/film.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "core/export/atomic_file.hpp"
#include "render/image/gif_animation.hpp"
#include "render/image/image_scale.hpp"
#include "render/image/mp4_pipe.hpp"
#include "render/image/png.hpp"
#include "render/image/webp_animation.hpp"
#include "render/scene/frame_builder.hpp"

namespace unfurl {

namespace {

constexpr std::size_t palette_samples = 24;  // frames that the GIF's colours are chosen from

// Takes frames in order and feeds every format that is wanted, side by side.
class FilmEncoders {
 public:
  FilmEncoders(const std::filesystem::path& directory, const RenderOptions& options, bool parallel)
      : options_(options), policy_(parallel ? std::launch::async : std::launch::deferred) {
    gif_width_ = std::min(options.width, options.gif_width);
    gif_height_ = std::max(1, (options.height * gif_width_ + options.width / 2) / options.width);
    if (options.webp)
      webp_.emplace(directory / "animation.webp", options.width, options.height, options.fps,
                    has_alpha(options));
    if (options.gif) gif_.emplace(directory / "animation.gif", gif_width_, gif_height_, options.fps);
    if (options.mp4 && ffmpeg_available())
      mp4_.emplace(directory / "animation.mp4", options.width, options.height, options.fps);
  }

  bool wants_samples() const { return gif_.has_value(); }
  void sample(const Image& image) { gif_->sample(scaled_down(image, gif_width_, gif_height_)); }

  void add(Image image) {
    wait();
    auto frame = std::make_shared<const Image>(std::move(image));
    if (webp_) busy_.push_back(std::async(policy_, [this, frame] { webp_->add(*frame); }));
    if (gif_)
      busy_.push_back(
          std::async(policy_, [this, frame] { gif_->add(scaled_down(*frame, gif_width_, gif_height_)); }));
    if (mp4_)
      busy_.push_back(
          std::async(policy_, [this, frame] { mp4_->add(has_alpha(options_) ? on_white(*frame) : *frame); }));
  }

  void finish() {
    wait();
    if (webp_) webp_->finish();
    if (gif_) gif_->finish();
    const std::string warning = mp4_ ? mp4_->finish() : "";
    if (!warning.empty()) std::cerr << "unfurl: warning: " << warning << "\n";
  }

 private:
  void wait() {
    for (auto& task : busy_) task.get();
    busy_.clear();
  }

  const RenderOptions& options_;
  int gif_width_ = 0, gif_height_ = 0;
  std::optional<WebpAnimation> webp_;
  std::optional<GifAnimation> gif_;
  std::optional<Mp4Pipe> mp4_;
  std::launch policy_;
  std::vector<std::future<void>> busy_;  // last: they use the members above, and end before those do
};

// A frame of the film's size.
Image finished_frame(const FilmFolder& folder, std::size_t index, const RenderOptions& options) {
  Image image = read_png(folder.frame(index));
  if (image.width != options.width || image.height != options.height)
    throw FileError(folder.frame(index), "is not a frame of this film");
  return image;
}

}  // namespace

bool encode_films(const std::filesystem::path& directory, const FilmFolder& folder, const Scene& scene,
                  const Simulation& run, const Arguments& arguments) {
  const RenderOptions& options = scene.render;
  if (folder.encoded() || !(options.webp || options.gif || options.mp4)) return true;
  const std::size_t frames = film_shots(run.trajectory, options).size();
  std::size_t finished = 0;
  for (std::size_t k = 0; k < frames; ++k) finished += folder.finished(k);
  if (finished < frames) {
    if (!arguments.quiet)
      std::cerr << finished << " of " << frames << " frames are there; the animations follow when all are\n";
    return true;
  }
  FilmEncoders encoders(directory, options, arguments.threads != 1);
  Progress progress("encoding", arguments.quiet);
  const std::size_t stride = std::max<std::size_t>(1, frames / palette_samples);
  for (std::size_t k = 0; encoders.wants_samples() && k < frames && !interrupted(); k += stride)
    encoders.sample(finished_frame(folder, k, options));
  for (std::size_t k = 0; k < frames; ++k) {
    if (interrupted()) return false;
    progress.show(static_cast<double>(k) / static_cast<double>(frames));
    encoders.add(finished_frame(folder, k, options));
  }
  encoders.finish();
  folder.set_encoded(true);
  return true;
}

}  // namespace unfurl
