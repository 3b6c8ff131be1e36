// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "render/image/image.hpp"

namespace unfurl {

// Is there an `ffmpeg` in the PATH?
bool ffmpeg_available();

// An H.264 film by the program ffmpeg, fed through its standard input. A film is an extra: nothing here
// throws, and what goes wrong is told at the end. An odd size gets one row or column of black to make it
// even, as H.264 wants.
class Mp4Pipe {
 public:
  Mp4Pipe(std::filesystem::path target, int width, int height, double fps);
  ~Mp4Pipe();  // without finish(): stops ffmpeg and leaves nothing behind
  Mp4Pipe(Mp4Pipe&&) noexcept;
  Mp4Pipe& operator=(Mp4Pipe&&) noexcept;

  void add(const Image& frame);
  // Close the film and give it its name. Empty where all went well, else what went wrong. Whatever ffmpeg
  // does, a minute of silence is the end.
  std::string finish();

 private:
  struct Process;
  std::unique_ptr<Process> process_;
};

}  // namespace unfurl
