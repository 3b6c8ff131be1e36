// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/png.hpp"

#include <unistd.h>
#include <zlib.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>

using namespace unfurl;

namespace png_test {

namespace {

std::uint32_t big_endian(const std::vector<std::byte>& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes.at(at + i));
  return value;
}

// The scan lines of a PNG with one IDAT chunk right after IHDR, inflated: per row a filter byte and the
// pixels.
std::vector<std::uint8_t> scan_lines(const std::vector<std::byte>& png, std::size_t size) {
  const std::size_t chunk = 8 + 25;  // signature, IHDR
  std::vector<std::uint8_t> rows(size);
  uLongf length = size;
  REQUIRE(uncompress(rows.data(), &length, reinterpret_cast<const Bytef*>(png.data()) + chunk + 8,
                     big_endian(png, chunk)) == Z_OK);
  REQUIRE(length == size);
  return rows;
}

const Image two_by_one{2, 1, {1, 2, 3, 40, 250, 251, 252, 255}};

}  // namespace

TEST_CASE("a PNG has the signature, the size and the pixels of the picture") {
  const std::vector<std::byte> png = encode_png(two_by_one);
  CHECK(big_endian(png, 0) == 0x89504E47);
  CHECK(big_endian(png, 4) == 0x0D0A1A0A);
  CHECK(big_endian(png, 16) == 2);               // width
  CHECK(big_endian(png, 20) == 1);               // height
  CHECK(std::to_integer<int>(png.at(25)) == 2);  // colour type RGB
  CHECK(scan_lines(png, 7) == std::vector<std::uint8_t>{0, 1, 2, 3, 250, 251, 252});
}

TEST_CASE("a PNG keeps alpha when asked") {
  const std::vector<std::byte> png = encode_png(two_by_one, true);
  CHECK(std::to_integer<int>(png.at(25)) == 6);  // colour type RGBA
  CHECK(scan_lines(png, 9) == std::vector<std::uint8_t>{0, 1, 2, 3, 40, 250, 251, 252, 255});
}

TEST_CASE("a picture whose size does not fit its pixels is refused") {
  CHECK_THROWS_AS(encode_png(Image{}), std::invalid_argument);
  CHECK_THROWS_AS(encode_png(Image{2, 2, {1, 2, 3, 4}}), std::invalid_argument);
}

TEST_CASE("a PNG file with any one byte changed, cut or added is not whole") {
  Image image{7, 5, std::vector<std::uint8_t>(4 * 7 * 5)};
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = static_cast<std::uint8_t>(37 * i);
  const std::vector<std::byte> good = with_resolution(encode_png(image), 300);
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("unfurl_png_" + std::to_string(::getpid()));
  const auto size_of = [&](const std::vector<std::byte>& bytes) {
    write_file_atomically(path, bytes);
    return whole_png(path);
  };
  CHECK(size_of(good) == std::pair(7, 5));
  int unseen = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::byte> bad = good;
    bad[i] ^= std::byte{4};
    write_file_atomically(path, bad, Flush::later);
    unseen += whole_png(path).has_value();
  }
  CHECK(unseen == 0);
  std::vector<std::byte> cut(good.begin(), good.end() - 1), more = good;
  more.push_back(std::byte{0});
  CHECK_FALSE(size_of(cut));
  CHECK_FALSE(size_of(more));
  CHECK_FALSE(size_of({}));
  std::filesystem::remove(path);
  CHECK_FALSE(whole_png(path));
}

}  // namespace png_test
