// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/png.hpp"

#include <zlib.h>
#ifdef UNFURL_LIBDEFLATE
#include <libdeflate.h>
#endif

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/export/atomic_file.hpp"

namespace {

#ifdef UNFURL_LIBDEFLATE
// In half of zlib's time, and the files are no larger.
unsigned char* deflate_for_stb(unsigned char* data, int size, int* out_size, int /*quality*/) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(4), &libdeflate_free_compressor);
  if (!compressor) return nullptr;
  const auto length = static_cast<std::size_t>(size);
  const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), length);
  auto* out = static_cast<unsigned char*>(std::malloc(most));  // stb frees it
  if (out == nullptr) return nullptr;
  const std::size_t got = libdeflate_zlib_compress(compressor.get(), data, length, out, most);
  if (got == 0) {
    std::free(out);
    return nullptr;
  }
  *out_size = static_cast<int>(got);
  return out;
}
#else
// zlib's level 4 is twice as fast as stb's own compressor on rendered pictures, and the files are smaller.
unsigned char* deflate_for_stb(unsigned char* data, int size, int* out_size, int /*quality*/) {
  uLongf length = compressBound(static_cast<uLong>(size));
  auto* out = static_cast<unsigned char*>(std::malloc(length));  // stb frees it
  if (out == nullptr) return nullptr;
  if (compress2(out, &length, data, static_cast<uLong>(size), 4) != Z_OK) {
    std::free(out);
    return nullptr;
  }
  *out_size = static_cast<int>(length);
  return out;
}
#endif

}  // namespace

#define STBIW_ZLIB_COMPRESS deflate_for_stb
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>

namespace unfurl {
namespace {

std::vector<std::uint8_t> without_alpha(const Image& image) {
  const std::size_t pixels = image.rgba.size() / 4;
  std::vector<std::uint8_t> rgb(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    rgb[3 * i] = image.rgba[4 * i];
    rgb[3 * i + 1] = image.rgba[4 * i + 1];
    rgb[3 * i + 2] = image.rgba[4 * i + 2];
  }
  return rgb;
}

// Row filter 0 for every row: trying all five costs twice the time and gains nothing on flat-shaded pictures.
// stb keeps the choice in a variable of its own; set once, so that threads may encode side by side.
void choose_row_filter() {
  static const int chosen = stbi_write_force_png_filter = 0;
  static_cast<void>(chosen);
}

}  // namespace

std::vector<std::byte> encode_png(const Image& image, bool alpha) {
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  choose_row_filter();
  if (pixels == 0 || image.rgba.size() != 4 * pixels) {
    throw std::invalid_argument("encode_png: the picture is empty or its size does not fit its pixels");
  }
  const std::vector<std::uint8_t> rgb = alpha ? std::vector<std::uint8_t>() : without_alpha(image);
  const int channels = alpha ? 4 : 3;
  int size = 0;
  const std::unique_ptr<unsigned char, decltype(&std::free)> bytes(
      stbi_write_png_to_mem(alpha ? image.rgba.data() : rgb.data(), channels * image.width, image.width,
                            image.height, channels, &size),
      &std::free);
  if (!bytes) throw std::bad_alloc();
  const auto* first = reinterpret_cast<const std::byte*>(bytes.get());
  return {first, first + size};
}

std::vector<std::byte> with_resolution(std::vector<std::byte> png, double dpi) {
  constexpr std::size_t behind_header = 8 + 25;  // signature and IHDR
  std::vector<std::uint8_t> chunk{0, 0, 0, 9, 'p', 'H', 'Y', 's'};
  const auto put = [&](std::uint32_t v) {
    for (const int shift : {24, 16, 8, 0}) chunk.push_back(static_cast<std::uint8_t>(v >> shift & 255));
  };
  const auto per_metre = static_cast<std::uint32_t>(std::lround(dpi / 0.0254));
  put(per_metre), put(per_metre);
  chunk.push_back(1);  // the unit is the metre
  put(static_cast<std::uint32_t>(crc32(0, chunk.data() + 4, static_cast<uInt>(chunk.size() - 4))));
  const auto* first = reinterpret_cast<const std::byte*>(chunk.data());
  png.insert(png.begin() + behind_header, first, first + chunk.size());
  return png;
}

void write_png(const std::filesystem::path& path, const Image& image, bool alpha, Flush flush) {
  write_file_atomically(path, encode_png(image, alpha), flush);
}

std::optional<std::pair<int, int>> whole_png(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  const auto number = [&](std::size_t at) {
    std::uint32_t v = 0;
    for (std::size_t k = at; k < at + 4; ++k) v = v << 8 | data[k];
    return v;
  };
  constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
  if (!bytes.starts_with(signature)) return {};
  // A chunk: length of its data, name, data, checksum of name and data.
  for (std::size_t at = signature.size(); bytes.size() - at >= 12;) {
    const std::size_t length = number(at);
    if (bytes.size() - at - 12 < length) return {};
    const std::string_view name(bytes.data() + at + 4, 4);
    if (crc32(0, data + at + 4, static_cast<uInt>(length + 4)) != number(at + 8 + length)) return {};
    if (at == signature.size() && (name != "IHDR" || length != 13)) return {};
    at += 12 + length;
    if (name == "IEND" && at == bytes.size())
      return std::pair(static_cast<int>(number(16)), static_cast<int>(number(20)));
  }
  return {};
}

Image read_png(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(path, "cannot be read");
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  Image image;
  int channels = 0;
  const std::unique_ptr<unsigned char, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                            static_cast<int>(bytes.size()), &image.width, &image.height, &channels, 4),
      &stbi_image_free);
  if (!pixels) throw FileError(path, "is not a whole PNG file");
  const std::size_t size = 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.rgba.assign(pixels.get(), pixels.get() + size);
  return image;
}

}  // namespace unfurl
