// SPDX-License-Identifier: BSD-3-Clause
// The animations, made of finished frames.
#include <algorithm>
#include <exception>
#include <future>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "app/output/command_line.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/progress.hpp"
#include "app/verbs/film.hpp"
#include "core/export/atomic_file.hpp"
#include "render/image/gif_animation.hpp"
#include "render/image/image_scale.hpp"
#include "render/image/mp4_pipe.hpp"
#include "render/image/png.hpp"
#include "render/image/webp_animation.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

constexpr std::size_t palette_samples = 24;  // frames that the GIF's colours are chosen from

// What a person types who has the frames and wants this film of them.
std::string command_by_hand(const std::filesystem::path& given, const std::string& film, double fps) {
  // "a:b" would be a protocol, "-o" an option.
  const std::filesystem::path directory = given.is_relative() ? "." / given : given;
  std::ostringstream text;
  std::string folder = (directory / "frames").string();
  for (std::size_t i = 0; (i = folder.find('%', i)) != std::string::npos; i += 2) folder.insert(i, 1, '%');
  text << "ffmpeg -framerate " << fps << " -i " << in_shell_quotes(folder + "/frame_%05d.png");
  if (film.ends_with(".mp4"))
    text << " -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' -c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart";
  if (film.ends_with(".webp")) text << " -c:v libwebp_anim -loop 0";
  text << " " << in_shell_quotes((directory / film).string());
  return text.str();
}

// Of segments of the WebP, beside the other films: each holds some frames.
int webp_threads(const Arguments& arguments) {
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int threads = arguments.threads > 0 ? arguments.threads : cores;
  return threads == 1 ? 0 : std::min(threads, 4);
}

// One animation: what fails is told at the end, and does not keep the others from being made.
class FilmEncoder {
 public:
  FilmEncoder(const std::filesystem::path& directory, std::string film)
      : film_(std::move(film)), target_(directory / film_) {}
  virtual ~FilmEncoder() = default;
  FilmEncoder(const FilmEncoder&) = delete;
  FilmEncoder& operator=(const FilmEncoder&) = delete;

  void sample(const Image& frame) {
    tried([&] { sample_frame(frame); });
  }
  void add(const std::shared_ptr<const Image>& frame) {
    tried([&] { add_frame(frame); });
  }
  void finish() {
    tried([&] { finish_film(); });
  }

  virtual bool wants_samples() const { return false; }
  const std::string& film() const { return film_; }
  const std::filesystem::path& target() const { return target_; }
  const std::string& problem() const { return problem_; }  // empty: all is well

 protected:
  virtual void sample_frame(const Image&) {}
  virtual void add_frame(const std::shared_ptr<const Image>& frame) = 0;
  virtual void finish_film() = 0;
  template <class Work>
  void tried(const Work& work) {
    if (!problem_.empty()) return;
    try {
      work();
    } catch (const std::exception& error) {
      problem_ = error.what();
    }
  }

 private:
  std::string film_;
  std::filesystem::path target_;
  std::string problem_;
};

class WebpFilm final : public FilmEncoder {
 public:
  WebpFilm(const std::filesystem::path& directory, const RenderOptions& o, int threads)
      : FilmEncoder(directory, "animation.webp") {
    tried([&] { webp_.emplace(target(), o.width, o.height, o.fps, has_alpha(o), threads); });
  }

 private:
  void add_frame(const std::shared_ptr<const Image>& frame) override { webp_->add(frame); }
  void finish_film() override { webp_->finish(); }
  std::optional<WebpAnimation> webp_;
};

class GifFilm final : public FilmEncoder {
 public:
  GifFilm(const std::filesystem::path& directory, const RenderOptions& o)
      : FilmEncoder(directory, "animation.gif"),
        width_(std::min(o.width, o.gif_width)),
        height_(std::max(1, (o.height * width_ + o.width / 2) / o.width)),
        gif_(target(), width_, height_, o.fps) {}
  bool wants_samples() const override { return true; }

 private:
  void sample_frame(const Image& frame) override { gif_.sample(scaled_down(frame, width_, height_)); }
  void add_frame(const std::shared_ptr<const Image>& frame) override {
    gif_.add(scaled_down(*frame, width_, height_));
  }
  void finish_film() override { gif_.finish(); }
  int width_, height_;
  GifAnimation gif_;
};

class Mp4Film final : public FilmEncoder {
 public:
  Mp4Film(const std::filesystem::path& directory, const RenderOptions& o)
      : FilmEncoder(directory, "animation.mp4"),
        options_(o),
        alpha_(has_alpha(o)),
        mp4_(target(), o.width, o.height, o.fps) {}

 private:
  void add_frame(const std::shared_ptr<const Image>& frame) override {
    mp4_.add(alpha_ ? without_alpha(*frame, options_) : *frame);
  }
  void finish_film() override {
    if (const std::string problem = mp4_.finish(); !problem.empty()) throw std::runtime_error(problem);
  }
  RenderOptions options_;
  bool alpha_;
  Mp4Pipe mp4_;
};

// Takes frames in order and feeds every film side by side.
class FilmEncoders {
 public:
  // One after the other where no thread can be started.
  static constexpr std::launch at_once = std::launch::async | std::launch::deferred;
  explicit FilmEncoders(bool parallel) : policy_(parallel ? at_once : std::launch::deferred) {}

  void begin(std::unique_ptr<FilmEncoder> film) { films_.push_back(std::move(film)); }
  bool wants_samples() const {
    return std::any_of(films_.begin(), films_.end(), [](const auto& film) { return film->wants_samples(); });
  }
  void sample(const Image& frame) {
    for (const auto& film : films_) film->sample(frame);
  }
  void add(const std::shared_ptr<const Image>& frame) {
    wait();
    for (const auto& film : films_)
      busy_.push_back(std::async(policy_, [&film = *film, frame] { film.add(frame); }));
  }
  const std::vector<std::unique_ptr<FilmEncoder>>& finish() {
    wait();
    for (const auto& film : films_) film->finish();
    return films_;
  }

 private:
  void wait() {
    for (auto& task : busy_) task.get();
    busy_.clear();
  }

  std::launch policy_;
  std::vector<std::unique_ptr<FilmEncoder>> films_;
  std::vector<std::future<void>> busy_;  // last: they use the members above, and end before those do
};

// An MP4 is made where there is an ffmpeg; who asked for one by name wants to know that there is none.
bool can_make_mp4(const std::filesystem::path& directory, const Scene& scene, const Arguments& arguments) {
  if (ffmpeg_available()) return true;
  const std::string advice =
      "no MP4 was made, since there is no ffmpeg in the PATH; with one, repeat the command, or by hand: " +
      command_by_hand(directory, "animation.mp4", scene.render.fps);
  if (scene.locations.contains("render.mp4")) throw FileError(directory / "animation.mp4", advice);
  if (!arguments.quiet) std::cerr << "unfurl: " << advice << "\n";
  return false;
}

// A frame of the film's size.
std::shared_ptr<const Image> finished_frame(const FilmFolder& folder, std::size_t index,
                                            const RenderOptions& options, const FrameMemory& memory) {
  if (auto image = memory.find(index)) return image;
  auto image = std::make_shared<const Image>(read_png(folder.frame(index)));
  if (image->width != options.width || image->height != options.height)
    throw FileError(folder.frame(index), "is not a frame of this film");
  return image;
}

// False: interrupted. Throws FileError where a film could not be made, when all others are.
bool encode(FilmEncoders& encoders, const FilmFolder& folder, const RenderOptions& options,
            std::size_t frames, const Arguments& arguments, const FrameMemory& memory) {
  Progress progress("encoding", arguments.quiet);
  const std::size_t stride = std::max<std::size_t>(1, frames / palette_samples);
  for (std::size_t k = 0; encoders.wants_samples() && k < frames && !interrupted(); k += stride)
    encoders.sample(*finished_frame(folder, k, options, memory));
  for (std::size_t k = 0; k < frames; ++k) {
    if (interrupted()) return false;
    progress.show(k, frames, "frames");
    encoders.add(finished_frame(folder, k, options, memory));
  }
  std::optional<FileError> failure;
  for (const auto& film : encoders.finish()) {
    if (film->problem().empty()) {
      folder.set_encoded(film->film());
      continue;
    }
    if (failure) std::cerr << "unfurl: " << failure->what() << "\n";
    failure.emplace(film->target(),
                    film->problem() + "; by hand: " +
                        command_by_hand(film->target().parent_path(), film->film(), options.fps));
  }
  if (failure) throw FileError(*failure);
  return true;
}

}  // namespace

bool encode_films(const std::filesystem::path& directory, const FilmFolder& folder, const Scene& scene,
                  const Simulation& run, const Arguments& arguments, const FrameMemory& memory) {
  const RenderOptions& options = scene.render;
  const bool webp = options.webp && !folder.encoded("animation.webp"),
             gif = options.gif && !folder.encoded("animation.gif"),
             mp4 = options.mp4 && !folder.encoded("animation.mp4");
  if (!webp && !gif && !mp4) return true;
  const std::size_t frames = film_shots(run.trajectory, options).size();
  std::size_t finished = 0;
  for (std::size_t k = 0; k < frames; ++k) finished += folder.finished(k);
  if (finished < frames) {
    if (!arguments.quiet)
      std::cerr << finished << " of " << frames << " frames are there; the animations follow when all are\n";
    return true;
  }
  FilmEncoders encoders(arguments.threads != 1);
  if (webp) encoders.begin(std::make_unique<WebpFilm>(directory, options, webp_threads(arguments)));
  if (gif) encoders.begin(std::make_unique<GifFilm>(directory, options));
  std::exception_ptr without;
  try {
    if (mp4 && can_make_mp4(directory, scene, arguments))
      encoders.begin(std::make_unique<Mp4Film>(directory, options));
  } catch (const FileError&) {
    without = std::current_exception();  // the others first
  }
  if (!encode(encoders, folder, options, frames, arguments, memory)) return false;
  if (without) std::rethrow_exception(without);
  return true;
}

}  // namespace unfurl
