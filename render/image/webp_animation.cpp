// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/webp_animation.hpp"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/export/atomic_file.hpp"

namespace unfurl {

struct WebpAnimation::Encoder {
  std::filesystem::path target;
  int width, height;
  double fps;
  bool alpha;
  long frames = 0;
  WebPConfig config{};
  WebPAnimEncoder* handle = nullptr;

  Encoder(std::filesystem::path target_, int width_, int height_, double fps_, bool alpha_)
      : target(std::move(target_)), width(width_), height(height_), fps(fps_), alpha(alpha_) {
    // The encoder itself would complain only at the first frame.
    const bool fits = width <= WEBP_MAX_DIMENSION && height <= WEBP_MAX_DIMENSION;
    WebPAnimEncoderOptions options;
    if (!WebPAnimEncoderOptionsInit(&options) || !WebPConfigInit(&config)) {
      throw std::runtime_error("the installed libwebp is not the one that this program was built for");
    }
    config.quality = 80.0f;
    config.method = 2;  // 0 fastest .. 6 smallest
    // Only what changed since the last frame is stored; a whole frame now and then makes seeking possible.
    // (From kmin on every frame is tried both ways, at twice the price.)
    options.kmin = 119;
    options.kmax = 120;
    handle = fits ? WebPAnimEncoderNew(width, height, &options) : nullptr;
    if (handle == nullptr) {
      throw FileError(target, "WebP cannot hold an animation of " + std::to_string(width) + " x " +
                                  std::to_string(height) + " pixels");
    }
  }
  ~Encoder() { WebPAnimEncoderDelete(handle); }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  int time_ms(long frame) const {
    return static_cast<int>(std::lround(1000.0 * static_cast<double>(frame) / fps));
  }

  [[noreturn]] void fail() const {
    throw FileError(target, std::string("WebP: ") + WebPAnimEncoderGetError(handle));
  }
};

WebpAnimation::WebpAnimation(std::filesystem::path target, int width, int height, double fps, bool alpha)
    : encoder_(std::make_unique<Encoder>(std::move(target), width, height, fps, alpha)) {}
WebpAnimation::~WebpAnimation() = default;
WebpAnimation::WebpAnimation(WebpAnimation&&) noexcept = default;
WebpAnimation& WebpAnimation::operator=(WebpAnimation&&) noexcept = default;

void WebpAnimation::add(const Image& frame) {
  Encoder& e = *encoder_;
  if (frame.width != e.width || frame.height != e.height) {
    throw std::invalid_argument("WebpAnimation::add: the frame is not of the animation's size");
  }
  WebPPicture picture;
  if (!WebPPictureInit(&picture)) throw std::runtime_error("WebPPictureInit failed");
  picture.use_argb = 1;  // the encoder compares frames in this form
  picture.width = e.width;
  picture.height = e.height;
  const auto import = e.alpha ? WebPPictureImportRGBA : WebPPictureImportRGBX;
  const bool good = import(&picture, frame.rgba.data(), 4 * e.width) &&
                    WebPAnimEncoderAdd(e.handle, &picture, e.time_ms(e.frames), &e.config);
  WebPPictureFree(&picture);
  if (!good) e.fail();
  ++e.frames;
}

void WebpAnimation::finish() {
  Encoder& e = *encoder_;
  if (e.frames == 0) return;
  WebPData data;
  WebPDataInit(&data);
  // The last frame stays for as long as the others; the null frame says when it ends.
  const bool good = WebPAnimEncoderAdd(e.handle, nullptr, e.time_ms(e.frames), nullptr) &&
                    WebPAnimEncoderAssemble(e.handle, &data);
  if (!good) e.fail();
  const std::unique_ptr<WebPData, decltype(&WebPDataClear)> owner(&data, &WebPDataClear);
  write_file_atomically(e.target, std::as_bytes(std::span(data.bytes, data.size)));
}

}  // namespace unfurl
