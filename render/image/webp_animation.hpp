// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "render/image/image.hpp"

namespace unfurl {

// An animated WebP (lossy, repeats forever) that takes its frames one by one and keeps them compressed in
// memory.
class WebpAnimation {
 public:
  // fps: frames per second; a file holds whole milliseconds, so the times of the frames are rounded, not
  // their gaps. Throws FileError where the format does not allow the size (16383 pixels on a side).
  WebpAnimation(std::filesystem::path target, int width, int height, double fps, bool alpha = false);
  ~WebpAnimation();
  WebpAnimation(WebpAnimation&&) noexcept;
  WebpAnimation& operator=(WebpAnimation&&) noexcept;

  void add(const Image& frame);  // of the animation's size
  // Write the file, whole or not at all. Throws FileError. Without a frame nothing is written.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace unfurl
