// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/png.hpp"

#include <zlib.h>
#ifdef UNFURL_LIBDEFLATE
#include <libdeflate.h>
#endif

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/export/atomic_file.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>

namespace unfurl {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The rows of a PNG file: before each the byte 0, which says that it is as it is. Trying all five filters
// costs twice the time and gains nothing on flat-shaded pictures.
Bytes rows_of(const Image& image, bool alpha) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const std::size_t channels = alpha ? 4 : 3;
  Bytes rows((1 + channels * width) * height);
  const std::uint8_t* from = image.rgba.data();
  std::uint8_t* to = rows.data();
  for (std::size_t y = 0; y < height; ++y) {
    *to++ = 0;
    for (std::size_t x = 0; x < width; ++x, from += 4, to += channels) {
      to[0] = from[0], to[1] = from[1], to[2] = from[2];
      if (alpha) to[3] = from[3];
    }
  }
  return rows;
}

#ifdef UNFURL_LIBDEFLATE
// In a third of zlib's time. Finer levels make files that are a twentieth smaller and cost half as much
// again.
Bytes deflated(const Bytes& data) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(1), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  Bytes out(libdeflate_zlib_compress_bound(compressor.get(), data.size()));
  out.resize(libdeflate_zlib_compress(compressor.get(), data.data(), data.size(), out.data(), out.size()));
  if (out.empty()) throw std::bad_alloc();
  return out;
}
#else
Bytes deflated(const Bytes& data) {
  uLongf length = compressBound(static_cast<uLong>(data.size()));
  Bytes out(length);
  if (compress2(out.data(), &length, data.data(), static_cast<uLong>(data.size()), 4) != Z_OK)
    throw std::bad_alloc();
  out.resize(length);
  return out;
}
#endif

void put(Bytes& out, std::size_t number) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(number >> shift & 255));
}

// Length of the data, name, data, checksum of name and data.
void add_chunk(Bytes& out, std::string_view name, const Bytes& data) {
  put(out, data.size());
  const std::size_t start = out.size();
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  put(out, crc32(0, out.data() + start, static_cast<uInt>(out.size() - start)));
}

std::vector<std::byte> as_bytes(const Bytes& bytes) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  return {first, first + bytes.size()};
}

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);

}  // namespace

std::vector<std::byte> encode_png(const Image& image, bool alpha) {
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (pixels == 0 || image.rgba.size() != 4 * pixels) {
    throw std::invalid_argument("encode_png: the picture is empty or its size does not fit its pixels");
  }
  Bytes header;
  put(header, static_cast<std::size_t>(image.width));
  put(header, static_cast<std::size_t>(image.height));
  const std::uint8_t kind = alpha ? 6 : 2;  // with and without alpha, of eight bits; nothing unusual
  header.insert(header.end(), {8, kind, 0, 0, 0});
  Bytes out(signature.begin(), signature.end());
  add_chunk(out, "IHDR", header);
  add_chunk(out, "IDAT", deflated(rows_of(image, alpha)));
  add_chunk(out, "IEND", {});
  return as_bytes(out);
}

std::vector<std::byte> with_resolution(std::vector<std::byte> png, double dpi) {
  constexpr std::size_t behind_header = 8 + 25;  // signature and IHDR
  const auto per_metre = static_cast<std::size_t>(std::lround(dpi / 0.0254));
  Bytes data, chunk;
  put(data, per_metre), put(data, per_metre);
  data.push_back(1);  // the unit is the metre
  add_chunk(chunk, "pHYs", data);
  const std::vector<std::byte> added = as_bytes(chunk);
  png.insert(png.begin() + behind_header, added.begin(), added.end());
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
  if (!bytes.starts_with(signature)) return {};
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
