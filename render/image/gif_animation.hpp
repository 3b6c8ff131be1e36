// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "render/image/image.hpp"

namespace unfurl {

// An animated GIF that repeats forever: one palette of 255 colours for the whole film, and of each frame only
// the pixels that changed. Frames beyond 50 a second, which viewers would slow down, are left out, the last
// one not.
//
//     for some frames spread over the film: gif.sample(frame);
//     for all frames in order:              gif.add(frame);
//     gif.finish();
class GifAnimation {
 public:
  GifAnimation(std::filesystem::path target, int width, int height, double fps);
  ~GifAnimation();
  GifAnimation(const GifAnimation&) = delete;
  GifAnimation& operator=(const GifAnimation&) = delete;

  // Frames of the animation's size; pixels that are more transparent than not become fully so.
  void sample(const Image& frame);
  void add(const Image& frame);
  // Write the file, whole or not at all. Throws FileError. Without a frame nothing is written.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace unfurl
