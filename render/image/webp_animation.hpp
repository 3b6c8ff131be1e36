// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "render/image/image.hpp"

namespace unfurl {

// An animated WebP (lossy, repeats forever) that takes its frames one by one and keeps them compressed in
// memory. Segments of an opaque film are compressed side by side; where they begin does not depend on the
// number of threads. (What is transparent is stored as what changed since the frame before, all in a row.)
class WebpAnimation {
 public:
  // fps: frames per second; a file holds whole milliseconds, so the times of the frames are rounded, not
  // their gaps. Throws FileError where the format does not allow the size (16383 pixels on a side).
  // threads: beside the caller's; 0: all is done in add().
  WebpAnimation(std::filesystem::path target, int width, int height, double fps, bool alpha = false,
                int threads = 0);
  ~WebpAnimation();
  WebpAnimation(WebpAnimation&&) noexcept;
  WebpAnimation& operator=(WebpAnimation&&) noexcept;

  void add(std::shared_ptr<const Image> frame);  // of the animation's size
  // Write the file, whole or not at all. Throws FileError. Without a frame nothing is written.
  void finish();

 private:
  class Film;
  std::unique_ptr<Film> film_;
};

}  // namespace unfurl
