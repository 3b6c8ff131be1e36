// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/gif_animation.hpp"

#include <gif_lib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/export/atomic_file.hpp"
#include "render/image/color_palette.hpp"

namespace unfurl {
namespace {

constexpr std::size_t colors = 255;  // and one index for "as before"
constexpr GifByteType clear_index = 255;
constexpr int most_side = 65535;
constexpr int dither = 3;  // of 255
constexpr std::array<int, 16> bayer{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

struct Rect {
  int left, top, width, height;
};

int append_to(GifFileType* gif, const GifByteType* data, int size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(gif->UserData);
  const auto* first = reinterpret_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + size);
  return size;
}

}  // namespace

struct GifAnimation::Encoder {
  std::filesystem::path target;
  int width, height;
  double fps;
  int stride;  // every so many frames one is kept
  long given = 0;
  Image latest;  // behind the frame that is kept next; empty: there is none
  bool transparent = false;
  ColorPalette palette{colors};
  std::vector<GifByteType> shown, next;  // indices, row by row
  std::vector<std::byte> bytes;
  GifFileType* gif = nullptr;

  Encoder(std::filesystem::path target_, int width_, int height_, double fps_)
      : target(std::move(target_)), width(width_), height(height_), fps(fps_) {
    stride = std::max(1, static_cast<int>(std::ceil(fps / 50.0 - 1e-9)));
    if (width > most_side || height > most_side)
      throw FileError(target, "a GIF is at most 65535 pixels wide");
  }
  ~Encoder() { close(); }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  bool close() {
    int error = 0;
    return gif == nullptr || EGifCloseFile(std::exchange(gif, nullptr), &error) == GIF_OK;
  }
  void require(int result) const {
    if (result == GIF_OK) return;
    const char* cause = gif ? GifErrorString(gif->Error) : nullptr;
    throw FileError(target, std::string("GIF: ") + (cause ? cause : "cannot be encoded"));
  }

  int centiseconds(long frame) const {
    return static_cast<int>(std::lround(100.0 * static_cast<double>(frame) / fps));
  }
  void open();
  void write_loop();
  void index(const Image& frame);
  Rect changed() const;
  void write_frame();
};

void GifAnimation::Encoder::open() {
  palette.choose();
  std::array<GifColorType, 256> table{};
  for (std::size_t k = 0; k < palette.colors().size(); ++k) {
    const auto& c = palette.colors()[k];
    table[k] = {c[0], c[1], c[2]};
  }
  int error = 0;
  gif = EGifOpen(&bytes, append_to, &error);
  if (gif == nullptr) throw FileError(target, "GIF: cannot be encoded");
  EGifSetGifVersion(gif, true);
  ColorMapObject map{256, 8, false, table.data()};
  require(EGifPutScreenDesc(gif, width, height, 8, 0, &map));
  write_loop();
}

void GifAnimation::Encoder::write_loop() {
  require(EGifPutExtensionLeader(gif, APPLICATION_EXT_FUNC_CODE));
  require(EGifPutExtensionBlock(gif, 11, "NETSCAPE2.0"));
  const std::array<GifByteType, 3> forever{1, 0, 0};
  require(EGifPutExtensionBlock(gif, 3, forever.data()));
  require(EGifPutExtensionTrailer(gif));
}

void GifAnimation::Encoder::index(const Image& frame) {
  next.resize(frame.rgba.size() / 4);
  const auto wide = static_cast<std::size_t>(width);
  for (std::size_t i = 0; i < next.size(); ++i) {
    const std::uint8_t* pixel = &frame.rgba[4 * i];
    if (pixel[3] < 128) {
      next[i] = clear_index;
      continue;
    }
    // Where a pixel is decides to which side it is rounded: a gradient has no steps, and what rests stays.
    const std::size_t x = i % wide, y = i / wide;
    const int shift = (bayer[4 * (y % 4) + x % 4] * 2 - 15) * dither / 15;
    std::array<std::uint8_t, 3> moved{};
    for (std::size_t c = 0; c < 3; ++c)
      moved[c] = static_cast<std::uint8_t>(std::clamp(pixel[c] + shift, 0, 255));
    next[i] = palette.nearest(moved.data());
  }
}

// The part of the picture in which something is new; a single pixel where nothing is.
Rect GifAnimation::Encoder::changed() const {
  if (shown.empty() || transparent) return {0, 0, width, height};
  int left = width, right = -1, top = height, bottom = -1;
  for (int y = 0; y < height; ++y) {
    const auto row = static_cast<std::ptrdiff_t>(y) * width;
    const auto a = shown.begin() + row, b = next.begin() + row;
    const auto first = static_cast<int>(std::mismatch(a, a + width, b).first - a);
    if (first == width) continue;
    int last = width - 1;
    while (a[last] == b[last]) --last;
    left = std::min(left, first), right = std::max(right, last);
    top = std::min(top, y), bottom = y;
  }
  if (right < 0) return {0, 0, 1, 1};
  return {left, top, right - left + 1, bottom - top + 1};
}

// What is in `next`, for as long as the frames that it stands for.
void GifAnimation::Encoder::write_frame() {
  const long first_of = (given - 1) / stride * stride;
  const int delay = centiseconds(first_of + stride) - centiseconds(first_of);
  const Rect part = changed();
  GraphicsControlBlock control{transparent ? DISPOSE_BACKGROUND : DISPOSE_DO_NOT, false, delay, clear_index};
  std::array<GifByteType, 4> block{};
  EGifGCBToExtension(&control, block.data());
  require(EGifPutExtension(gif, GRAPHICS_EXT_FUNC_CODE, 4, block.data()));
  require(EGifPutImageDesc(gif, part.left, part.top, part.width, part.height, false, nullptr));
  std::vector<GifByteType> line(static_cast<std::size_t>(part.width));
  for (int y = part.top; y < part.top + part.height; ++y) {
    const std::size_t first =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(part.left);
    for (std::size_t x = 0; x < line.size(); ++x) {
      const bool same = !shown.empty() && !transparent && shown[first + x] == next[first + x];
      line[x] = same ? clear_index : next[first + x];
    }
    require(EGifPutLine(gif, line.data(), part.width));
  }
  shown.swap(next);
}

GifAnimation::GifAnimation(std::filesystem::path target, int width, int height, double fps)
    : encoder_(std::make_unique<Encoder>(std::move(target), width, height, fps)) {}
GifAnimation::~GifAnimation() = default;

void GifAnimation::sample(const Image& frame) {
  for (std::size_t i = 3; i < frame.rgba.size() && !encoder_->transparent; i += 4)
    encoder_->transparent = frame.rgba[i] < 128;
  encoder_->palette.sample(frame);
}

void GifAnimation::add(const Image& frame) {
  Encoder& e = *encoder_;
  if (frame.width != e.width || frame.height != e.height)
    throw std::invalid_argument("GifAnimation::add: the frame is not of the animation's size");
  const bool kept = e.given % e.stride == 0;
  if (e.gif == nullptr) e.open();
  if (kept && e.given > 0) e.write_frame();
  ++e.given;
  e.latest = kept ? Image() : frame;
  if (kept) e.index(frame);
}

void GifAnimation::finish() {
  Encoder& e = *encoder_;
  if (e.gif == nullptr) return;
  if (!e.latest.rgba.empty()) e.index(e.latest);  // the film ends with its last frame
  e.write_frame();
  if (!e.close()) throw FileError(e.target, "GIF: cannot be encoded");
  write_file_atomically(e.target, std::span<const std::byte>(e.bytes));
}

}  // namespace unfurl
