// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "core/export/atomic_file.hpp"
#include "render/image/image.hpp"

namespace unfurl {

// The picture as the bytes of a PNG file, RGB or with its alpha RGBA. May run on several threads at once.
std::vector<std::byte> encode_png(const Image& image, bool alpha = false);

// The file, saying that so many of its pixels are an inch long (chunk pHYs).
std::vector<std::byte> with_resolution(std::vector<std::byte> png, double dpi);

// The file appears whole or not at all. Throws FileError.
void write_png(const std::filesystem::path& path, const Image& image, bool alpha = false,
               Flush flush = Flush::at_once);

// Width and height of a PNG file none of whose bytes is lost or changed, by the checksums in it; nothing
// where it is not there or not whole. Its pixels are not looked at.
std::optional<std::pair<int, int>> whole_png(const std::filesystem::path& path);

// Any PNG. Throws FileError where there is none or it cannot be read.
Image read_png(const std::filesystem::path& path);

}  // namespace unfurl
