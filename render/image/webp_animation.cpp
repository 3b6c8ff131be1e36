// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/webp_animation.hpp"

#include <webp/encode.h>
#include <webp/mux.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/export/atomic_file.hpp"
#include "render/image/task_queue.hpp"

namespace unfurl {

namespace webp {  // not anonymous: members of the header's class are of these

struct Format {
  std::filesystem::path target;
  int width, height;
  double fps;
  bool alpha;

  int time_ms(long frame) const {
    return static_cast<int>(std::lround(1000.0 * static_cast<double>(frame) / fps));
  }
};

// Data that libwebp allocated.
class Owned {
 public:
  Owned() { WebPDataInit(&data); }
  ~Owned() { WebPDataClear(&data); }
  Owned(Owned&& other) noexcept : data(std::exchange(other.data, {nullptr, 0})) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(data, other.data);
    return *this;
  }
  WebPData data;
};

// Consecutive frames as an animation of its own.
class Segment {
 public:
  Segment(const Format& format, long first) : format_(format), first_(first), next_(first) {
    WebPAnimEncoderOptions options;
    if (!WebPAnimEncoderOptionsInit(&options) || !WebPConfigInit(&config_))
      throw std::runtime_error("the installed libwebp is not the one that this program was built for");
    config_.quality = 80.0f;
    config_.method = 2;  // 0 fastest .. 6 smallest
    // Only what changed since the last frame is stored; a whole frame now and then makes seeking possible.
    // (From kmin on every frame is tried both ways, at twice the price.)
    options.kmin = 119;
    options.kmax = 120;
    handle_ = WebPAnimEncoderNew(format.width, format.height, &options);
    if (handle_ == nullptr) throw std::bad_alloc();
  }
  ~Segment() { WebPAnimEncoderDelete(handle_); }
  Segment(const Segment&) = delete;
  Segment& operator=(const Segment&) = delete;

  void add(const Image& frame) {
    WebPPicture picture;
    if (!WebPPictureInit(&picture)) throw std::runtime_error("WebPPictureInit failed");
    picture.use_argb = 1;  // the encoder compares frames in this form
    picture.width = format_.width;
    picture.height = format_.height;
    const auto import = format_.alpha ? WebPPictureImportRGBA : WebPPictureImportRGBX;
    const bool good = import(&picture, frame.rgba.data(), 4 * format_.width) &&
                      WebPAnimEncoderAdd(handle_, &picture, time(), &config_);
    WebPPictureFree(&picture);
    if (!good) fail();
    ++next_;
  }
  // The last frame stays for as long as the others; the null frame says when it ends.
  Owned finish() {
    Owned whole;
    if (!WebPAnimEncoderAdd(handle_, nullptr, time(), nullptr) ||
        !WebPAnimEncoderAssemble(handle_, &whole.data))
      fail();
    return whole;
  }

 private:
  int time() const { return format_.time_ms(next_) - format_.time_ms(first_); }
  [[noreturn]] void fail() const {
    throw FileError(format_.target, std::string("WebP: ") + WebPAnimEncoderGetError(handle_));
  }

  const Format& format_;
  long first_, next_;  // frames of the film
  WebPConfig config_{};
  WebPAnimEncoder* handle_ = nullptr;
};

using Mux = std::unique_ptr<WebPMux, void (*)(WebPMux*)>;

[[noreturn]] inline void fail_to_join(const Format& format) {
  throw FileError(format.target, "WebP: the segments of the film cannot be joined");
}

// The frames of a segment behind those that there are. Its first one is opaque and covers the whole picture:
// what was there before does not matter. Frames that are all alike are one, as a picture without a duration.
inline void append(WebPMux* film, const Owned& segment, int duration_ms, const Format& format) {
  const Mux part(WebPMuxCreate(&segment.data, 0), WebPMuxDelete);
  for (std::uint32_t k = 1; part; ++k) {
    WebPMuxFrameInfo frame;
    const WebPMuxError found = WebPMuxGetFrame(part.get(), k, &frame);
    if (found == WEBP_MUX_NOT_FOUND && k > 1) return;
    if (found != WEBP_MUX_OK) break;
    if (frame.id != WEBP_CHUNK_ANMF) frame.duration = duration_ms;
    frame.id = WEBP_CHUNK_ANMF;
    if (k == 1) frame.blend_method = WEBP_MUX_NO_BLEND;
    const WebPMuxError pushed = WebPMuxPushFrame(film, &frame, 1);
    WebPDataClear(&frame.bitstream);
    if (pushed != WEBP_MUX_OK) break;
  }
  fail_to_join(format);
}

}  // namespace webp

class WebpAnimation::Film {
 public:
  Film(webp::Format format, int threads) : format_(std::move(format)), workers_(threads) {
    // The encoder itself would complain only at the first frame.
    if (format_.width > WEBP_MAX_DIMENSION || format_.height > WEBP_MAX_DIMENSION)
      throw FileError(format_.target, "WebP cannot hold an animation of " + std::to_string(format_.width) +
                                          " x " + std::to_string(format_.height) + " pixels");
  }

  void add(std::shared_ptr<const Image> frame) {
    if (frame->width != format_.width || frame->height != format_.height)
      throw std::invalid_argument("WebpAnimation::add: the frame is not of the animation's size");
    ++frames_;
    if (format_.alpha) {
      if (!row_) row_ = std::make_unique<webp::Segment>(format_, 0);
      return row_->add(*frame);
    }
    waiting_.push_back(std::move(frame));
    if (waiting_.size() == segment_frames()) begin_segment();
  }

  void finish() {
    if (frames_ == 0) return;
    if (format_.alpha) return write(row_->finish());
    if (!waiting_.empty()) begin_segment();
    workers_.finish();
    const webp::Mux film(WebPMuxNew(), WebPMuxDelete);
    const WebPMuxAnimParams forever{0xFFFFFFFF, 0};
    for (const Part& part : parts_)
      webp::append(film.get(), part.bytes, format_.time_ms(part.end) - format_.time_ms(part.first), format_);
    webp::Owned whole;
    if (WebPMuxSetAnimationParams(film.get(), &forever) != WEBP_MUX_OK ||
        WebPMuxSetCanvasSize(film.get(), format_.width, format_.height) != WEBP_MUX_OK ||
        WebPMuxAssemble(film.get(), &whole.data) != WEBP_MUX_OK)
      webp::fail_to_join(format_);
    write(whole);
  }

 private:
  struct Part {
    long first, end;  // frames of the film
    webp::Owned bytes = {};
  };

  // Whole frames cost space, and frames that wait cost memory.
  std::size_t segment_frames() const {
    constexpr double bytes = 60e6, least = 8, most = 30;
    return static_cast<std::size_t>(std::clamp(bytes / (4.0 * format_.width * format_.height), least, most));
  }

  void begin_segment() {
    Part& part = parts_.emplace_back(Part{frames_ - static_cast<long>(waiting_.size()), frames_});
    workers_.add([this, &part, images = std::exchange(waiting_, {})] {
      webp::Segment segment(format_, part.first);
      for (const auto& image : images) segment.add(*image);
      part.bytes = segment.finish();
    });
  }

  void write(const webp::Owned& whole) const {
    write_file_atomically(format_.target, std::as_bytes(std::span(whole.data.bytes, whole.data.size)));
  }

  webp::Format format_;
  long frames_ = 0;
  std::unique_ptr<webp::Segment> row_;  // of a film with transparent pixels: the only one
  std::vector<std::shared_ptr<const Image>> waiting_;
  std::deque<Part> parts_;  // of the others; they stay where they are
  TaskQueue workers_;       // last: ends before what it works on
};

WebpAnimation::WebpAnimation(std::filesystem::path target, int width, int height, double fps, bool alpha,
                             int threads)
    : film_(std::make_unique<Film>(webp::Format{std::move(target), width, height, fps, alpha}, threads)) {}
WebpAnimation::~WebpAnimation() = default;
WebpAnimation::WebpAnimation(WebpAnimation&&) noexcept = default;
WebpAnimation& WebpAnimation::operator=(WebpAnimation&&) noexcept = default;

void WebpAnimation::add(std::shared_ptr<const Image> frame) {
  film_->add(std::move(frame));
}

void WebpAnimation::finish() {
  film_->finish();
}

}  // namespace unfurl
