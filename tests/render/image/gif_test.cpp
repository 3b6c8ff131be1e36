// SPDX-License-Identifier: BSD-3-Clause
// GIFs, read back by giflib itself.
#include <gif_lib.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "core/export/atomic_file.hpp"
#include "render/image/gif_animation.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace gif_test {

namespace {

struct ScratchFolder {
  fs::path path = fs::temp_directory_path() / ("unfurl_gif_" + std::to_string(::getpid()));
  ScratchFolder() { fs::create_directories(path); }
  ~ScratchFolder() { fs::remove_all(path); }
};

using Pixel = std::array<int, 4>;
constexpr Pixel white{255, 255, 255, 255}, blue{20, 40, 160, 255}, clear{0, 0, 0, 0};

// A square of 10 pixels at x = 4 k on a ground.
Image square(int k, const Pixel& ground = blue) {
  Image image{64, 48, {}};
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (const int value : x >= 4 * k && x < 4 * k + 10 && y >= 20 && y < 30 ? white : ground)
        image.rgba.push_back(static_cast<std::uint8_t>(value));
  return image;
}

struct Reader {
  GifFileType* gif;
  explicit Reader(const fs::path& file) {
    int error = 0;
    gif = DGifOpenFileName(file.c_str(), &error);
    if (gif == nullptr || DGifSlurp(gif) != GIF_OK) throw std::runtime_error("not a GIF");
  }
  ~Reader() {
    int error = 0;
    DGifCloseFile(gif, &error);
  }
  GraphicsControlBlock control(int frame) const {
    GraphicsControlBlock block{};
    DGifSavedExtensionToGCB(gif, frame, &block);
    return block;
  }
  // What a viewer shows after frames 0..frame.
  Pixel shown(int frame, int x, int y) const {
    Pixel pixel = clear;
    for (int k = 0; k <= frame; ++k) {
      const SavedImage& image = gif->SavedImages[k];
      if (k > 0 && control(k - 1).DisposalMode == DISPOSE_BACKGROUND) pixel = clear;
      const int column = x - image.ImageDesc.Left, row = y - image.ImageDesc.Top;
      if (column < 0 || row < 0 || column >= image.ImageDesc.Width || row >= image.ImageDesc.Height) continue;
      const int index = image.RasterBits[row * image.ImageDesc.Width + column];
      if (index == control(k).TransparentColor) continue;
      const GifColorType& c = gif->SColorMap->Colors[index];
      pixel = {c.Red, c.Green, c.Blue, 255};
    }
    return pixel;
  }
};

fs::path write(const fs::path& folder, double fps, const std::vector<Image>& frames) {
  const fs::path file = folder / "a.gif";
  GifAnimation gif(file, frames[0].width, frames[0].height, fps);
  for (const Image& frame : frames) gif.sample(frame);
  for (const Image& frame : frames) gif.add(frame);
  gif.finish();
  return file;
}

}  // namespace

TEST_CASE("a GIF shows every frame in its colours, for its time, forever") {
  const ScratchFolder scratch;
  std::vector<Image> frames;
  for (int k = 0; k < 7; ++k) frames.push_back(square(k));
  const Reader film(write(scratch.path, 30, frames));
  REQUIRE(film.gif->ImageCount == 7);
  CHECK(film.gif->SWidth == 64);
  CHECK(film.gif->SHeight == 48);
  int centiseconds = 0;
  for (int k = 0; k < 7; ++k) {
    centiseconds += film.control(k).DelayTime;
    // Two colours fit into the palette: they come back exactly.
    CHECK(film.shown(k, 4 * k + 5, 25) == white);
    CHECK(film.shown(k, 4 * k - 2 < 0 ? 60 : 4 * k - 2, 25) == blue);
    CHECK(film.shown(k, 32, 5) == blue);
  }
  CHECK(centiseconds == 23);  // 7 / 30 s: rounding does not add up
  const ExtensionBlock& loop = film.gif->SavedImages[0].ExtensionBlocks[0];
  CHECK(std::string(reinterpret_cast<const char*>(loop.Bytes), 11) == "NETSCAPE2.0");
}

TEST_CASE("a GIF stores only what changed") {
  const ScratchFolder scratch;
  const Reader film(write(scratch.path, 30, {square(0), square(1), square(1)}));
  const GifImageDesc &moved = film.gif->SavedImages[1].ImageDesc, &still = film.gif->SavedImages[2].ImageDesc;
  CHECK(moved.Left == 0);
  CHECK(moved.Top == 20);
  CHECK(moved.Width == 14);
  CHECK(moved.Height == 10);
  CHECK(still.Width * still.Height == 1);
  CHECK(film.shown(2, 8, 25) == white);
}

TEST_CASE("a GIF of more frames a second than viewers show leaves some out, at the same speed") {
  const ScratchFolder scratch;
  std::vector<Image> frames;
  for (int k = 0; k < 12; ++k) frames.push_back(square(k));
  const Reader film(write(scratch.path, 120, frames));
  CHECK(film.gif->ImageCount == 4);  // every third: 40 a second
  CHECK(film.control(0).DelayTime >= 2);
  CHECK(film.shown(1, 4 * 3 + 9, 25) == white);
}

// Of 34 frames at 60 a second every other one is kept; the last has the place of the one before it, and the
// film its length: 34 / 60 s, to a centisecond.
TEST_CASE("a GIF that leaves frames out ends with the last one") {
  const ScratchFolder scratch;
  for (const int count : {33, 34}) {
    std::vector<Image> frames;
    for (int k = 0; k < count; ++k) frames.push_back(square(k % 12));
    const Reader film(write(scratch.path, 60, frames));
    CHECK(film.gif->ImageCount == 17);
    const int last = (count - 1) % 12;  // each square begins 4 pixels further on, and is 10 wide
    CHECK(film.shown(16, 4 * last + 9, 25) == white);
    CHECK(film.shown(16, 4 * last - 1 < 0 ? 60 : 4 * last - 1, 25) == blue);
    CHECK(film.shown(15, 4 * 6 + 9, 25) == white);  // frame 30
    int centiseconds = 0;
    for (int k = 0; k < 17; ++k) centiseconds += film.control(k).DelayTime;
    CHECK(centiseconds == 57);
  }
}

TEST_CASE("a GIF keeps what is transparent, and nothing of the frame before") {
  const ScratchFolder scratch;
  const Reader film(write(scratch.path, 25, {square(0, clear), square(5, clear)}));
  CHECK(film.shown(0, 5, 25) == white);
  CHECK(film.shown(1, 5, 25) == clear);
  CHECK(film.shown(1, 25, 25) == white);
}

TEST_CASE("ffprobe counts the frames of a GIF") {
  const ScratchFolder scratch;
  const fs::path file = write(scratch.path, 25, {square(0), square(1), square(2), square(3), square(4)});
  if (std::system("ffprobe -version >/dev/null 2>&1") != 0) return;
  const std::string command =
      "test \"$(ffprobe -v error -count_frames -select_streams v -of csv=p=0 -show_entries "
      "stream=width,height,nb_read_frames '" +
      file.string() + "')\" = 64,48,5";
  CHECK(std::system(command.c_str()) == 0);
}

TEST_CASE("a GIF that cannot be written is a file error, one without frames is no file") {
  const ScratchFolder scratch;
  GifAnimation lost(scratch.path / "nowhere" / "a.gif", 64, 48, 25);
  lost.sample(square(0));
  lost.add(square(0));
  CHECK_THROWS_AS(lost.finish(), FileError);
  GifAnimation(scratch.path / "empty.gif", 64, 48, 25).finish();
  CHECK(fs::is_empty(scratch.path));
}

}  // namespace gif_test
