// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>
#include <webp/demux.h>
#include <webp/mux.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>

#include "core/export/atomic_file.hpp"
#include "render/image/mp4_pipe.hpp"
#include "render/image/webp_animation.hpp"
#include "tests/support/not_tested.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace animation_test {

namespace {

struct ScratchFolder {
  fs::path path = fs::temp_directory_path() / ("unfurl_film_" + std::to_string(::getpid()));
  ScratchFolder() { fs::create_directories(path); }
  ~ScratchFolder() { fs::remove_all(path); }
};

// A white square of a fifth of the width that moves from left to right on blue.
Image moving_square(int width, int height, int frame) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool inside = x >= 4 * frame && x < 4 * frame + width / 5 && y > height / 3 && y < height / 2;
      for (const int value : inside ? std::array{255, 255, 255, 255} : std::array{20, 40, 160, 255}) {
        image.rgba.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return image;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) text += static_cast<char>(c);
  return text;
}

struct PathVariable {  // put back at the end
  std::string old = std::getenv("PATH");
  explicit PathVariable(const std::string& value) { setenv("PATH", value.c_str(), 1); }
  ~PathVariable() { setenv("PATH", old.c_str(), 1); }
};

std::shared_ptr<const Image> shared(Image image) {
  return std::make_shared<const Image>(std::move(image));
}

// What a player shows at every change: the time at which it ends [ms] and the picture.
struct Shown {
  int until;
  std::vector<std::uint8_t> rgba;
};
std::vector<Shown> shown_by(const std::string& bytes, int width, int height) {
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
      WebPAnimDecoderNew(&data, nullptr), WebPAnimDecoderDelete);
  std::vector<Shown> shown;
  std::uint8_t* canvas = nullptr;
  int until = 0;
  while (decoder && WebPAnimDecoderGetNext(decoder.get(), &canvas, &until))
    shown.push_back({until, {canvas, canvas + 4 * width * height}});
  return shown;
}

}  // namespace

TEST_CASE(
    "a WebP of several segments is the same by any number of threads, and shows every frame in its place") {
  const ScratchFolder scratch;
  constexpr int width = 64, height = 48, count = 95;  // three segments of 30 and one of 5
  const auto frame = [&](int k) {                     // the third segment rests: one frame of it is stored
    return moving_square(width, height, k >= 60 && k < 90 ? 5 : k % 13);
  };
  std::vector<std::string> files;
  for (const int threads : {0, 1, 3}) {
    const fs::path file = scratch.path / (std::to_string(threads) + ".webp");
    WebpAnimation film(file, width, height, 24.0, false, threads);
    for (int k = 0; k < count; ++k) film.add(shared(frame(k)));
    film.finish();
    files.push_back(bytes_of(file));
  }
  CHECK(files[1] == files[0]);
  CHECK(files[2] == files[0]);
  const std::vector<Shown> shown = shown_by(files[0], width, height);
  REQUIRE(shown.size() > 60);
  CHECK(shown.back().until == 3958);  // 95 / 24 s in whole milliseconds
  int worst = 0, rest = 0;
  for (int k = 0; k < count; ++k) {
    const double middle = 1000.0 * (k + 0.5) / 24;
    const auto at = std::ranges::find_if(shown, [&](const Shown& s) { return s.until > middle; });
    REQUIRE(at != shown.end());
    const Image truth = frame(k);
    int wrong = 0;
    for (std::size_t i = 0; i < truth.rgba.size(); i += 4)
      wrong += std::abs(truth.rgba[i] - at->rgba[i]) > 100;
    worst = std::max(worst, wrong);
    rest += k >= 60 && k < 90 && at->until == 3750;
  }
  CHECK(worst < 28);  // pixels: one step of the square beside its place has twice as many
  CHECK(rest == 30);
}

TEST_CASE("an animated WebP holds every frame for its time and repeats forever") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path / "a.webp";
  WebpAnimation film(file, 64, 48, 30.0);
  for (int k = 0; k < 7; ++k) film.add(shared(moving_square(64, 48, k)));
  CHECK_FALSE(fs::exists(file));  // nothing appears before it is whole
  film.finish();
  const std::string bytes = bytes_of(file);
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPMux, void (*)(WebPMux*)> mux(WebPMuxCreate(&data, 0), WebPMuxDelete);
  REQUIRE(mux);
  int frames = 0, width = 0, height = 0, duration = 0;
  CHECK(WebPMuxNumChunks(mux.get(), WEBP_CHUNK_ANMF, &frames) == WEBP_MUX_OK);
  CHECK(frames == 7);
  CHECK(WebPMuxGetCanvasSize(mux.get(), &width, &height) == WEBP_MUX_OK);
  CHECK(width == 64);
  CHECK(height == 48);
  for (int k = 1; k <= frames; ++k) {
    WebPMuxFrameInfo frame;
    REQUIRE(WebPMuxGetFrame(mux.get(), static_cast<std::uint32_t>(k), &frame) == WEBP_MUX_OK);
    duration += frame.duration;
    WebPDataClear(&frame.bitstream);
  }
  CHECK(duration == 233);  // 7 / 30 s in whole milliseconds: rounding does not add up
  WebPMuxAnimParams params;
  CHECK(WebPMuxGetAnimationParams(mux.get(), &params) == WEBP_MUX_OK);
  CHECK(params.loop_count == 0);
}

TEST_CASE("an animation that cannot be written is a file error, one without frames is no file") {
  const ScratchFolder scratch;
  WebpAnimation lost(scratch.path / "nowhere" / "a.webp", 16, 16, 30.0);
  lost.add(shared(moving_square(16, 16, 0)));
  CHECK_THROWS_AS(lost.finish(), FileError);
  WebpAnimation(scratch.path / "empty.webp", 16, 16, 30.0).finish();
  CHECK(fs::is_empty(scratch.path));
  CHECK_THROWS_AS(WebpAnimation(scratch.path / "big.webp", 20000, 16, 30.0), FileError);
  CHECK_THROWS_AS(lost.add(shared(moving_square(8, 8, 0))), std::invalid_argument);
}

TEST_CASE("an MP4 of odd size is made even and has every frame") {
  if (testing::lacks(ffmpeg_available() && testing::installed("ffprobe"), "MP4 (apt-get install ffmpeg)"))
    return;
  const ScratchFolder scratch;
  const fs::path file = scratch.path / "it's a film.mp4";  // no shell is asked
  Mp4Pipe film(file, 65, 47, 25.0);
  for (int k = 0; k < 10; ++k) film.add(moving_square(65, 47, k));
  CHECK(film.finish() == "");
  CHECK(std::distance(fs::directory_iterator(scratch.path), fs::directory_iterator()) == 1);
  CHECK(output_of("ffprobe -v error -count_frames -select_streams v -of csv=p=0 -show_entries "
                  "stream=width,height,r_frame_rate,nb_read_frames \"" +
                  file.string() + "\"") == "66,48,25/1,10\n");
  // Players guess the colours of a film that does not say which they are, and small ones as those of old TV.
  CHECK(output_of("ffprobe -v error -select_streams v -of default=nk=1:nw=1 -show_entries "
                  "stream=color_range,color_space,color_transfer,color_primaries \"" +
                  file.string() + "\"") == "tv\nbt709\nbt709\nbt709\n");
}

// Linux takes 128 kB in one word of a command.
TEST_CASE("an MP4 takes a note of any length with any characters") {
  if (testing::lacks(ffmpeg_available(), "MP4 (apt-get install ffmpeg)")) return;
  struct Noting final : FileFinisher {
    std::string text;
    std::string note(const fs::path&) override { return text; }
    bool finish(const fs::path&, const fs::path&) override { return false; }
  } noting;
  for (int i = 0; noting.text.size() < 300'000; ++i)
    noting.text += std::to_string(i) + " a=b; #c \\ \"d\" \u00e9\n";
  const ScratchFolder scratch;
  const fs::path file = scratch.path / "a.mp4";
  FileFinisher* before = finish_files(&noting);
  Mp4Pipe film(file, 64, 48, 25.0);
  for (int k = 0; k < 3; ++k) film.add(moving_square(64, 48, k));
  CHECK(film.finish() == "");
  finish_files(before);
  std::ifstream made(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(made), {}};
  CHECK(bytes.find(noting.text) != std::string::npos);
}

// "a:b" would be a protocol, "-dash" an option.
TEST_CASE("an MP4 goes into a folder of any name") {
  if (testing::lacks(ffmpeg_available(), "MP4 (apt-get install ffmpeg)")) return;
  const ScratchFolder scratch;
  const fs::path here = fs::current_path();
  fs::current_path(scratch.path);
  for (const char* folder : {"2026-11-27T08:00", "a:b", "-dash", "p%d q#1"}) {
    INFO(folder);
    fs::create_directory(folder);
    Mp4Pipe film(fs::path(folder) / "a.mp4", 64, 48, 25.0);
    for (int k = 0; k < 3; ++k) film.add(moving_square(64, 48, k));
    CHECK(film.finish() == "");
    CHECK(fs::exists(fs::path(folder) / "a.mp4"));
  }
  fs::current_path(here);
}

TEST_CASE("an MP4 for which the disk has no room says so") {
  if (testing::lacks(ffmpeg_available(), "MP4 (apt-get install ffmpeg)")) return;
  const ScratchFolder scratch;
  const std::string folder = scratch.path.string();
  if (testing::lacks(
          std::system(("mount -t tmpfs -o size=16k tmpfs " + folder + " 2>/dev/null").c_str()) == 0,
          "a small file system (root may mount one)"))
    return;
  std::string error;
  {
    Mp4Pipe film(scratch.path / "a.mp4", 640, 480, 25.0);
    std::mt19937 random(7);  // noise is what does not shrink: some 100 kB a frame
    for (int k = 0; k < 3; ++k) {
      Image noise{640, 480, {}};
      for (int i = 0; i < 4 * 640 * 480; ++i) noise.rgba.push_back(static_cast<std::uint8_t>(random()));
      film.add(noise);
    }
    error = film.finish();
  }
  const bool empty = fs::is_empty(scratch.path);
  REQUIRE(std::system(("umount " + folder).c_str()) == 0);
  CHECK_THAT(error, Catch::StartsWith("no MP4 was written: ffmpeg ") &&
                        Catch::EndsWith(": no space left on device"));
  CHECK(empty);
}

TEST_CASE("an MP4 that fails is a warning and leaves nothing behind") {
  const ScratchFolder scratch;
  const fs::path bin = scratch.path / "bin";
  fs::create_directory(bin);
  std::ofstream(bin / "ffmpeg") << "#!/bin/sh\nexit 1\n";
  fs::permissions(bin / "ffmpeg", fs::perms::owner_all);
  const fs::path file = scratch.path / "a.mp4";
  SECTION("ffmpeg dies while it is fed more than any buffer holds") {
    const PathVariable path(bin.string());
    CHECK(ffmpeg_available());
    Mp4Pipe film(file, 640, 480, 25.0);
    for (int k = 0; k < 5; ++k) film.add(moving_square(640, 480, k));
    CHECK(film.finish() == "no MP4 was written: ffmpeg stopped early");
  }
  SECTION("there is no ffmpeg") {
    const PathVariable path((scratch.path / "none").string());
    CHECK_FALSE(ffmpeg_available());
    Mp4Pipe film(file, 64, 48, 25.0);
    film.add(moving_square(64, 48, 0));
    CHECK(film.finish() == "no MP4 was written: cannot start ffmpeg: No such file or directory");
  }
  CHECK(std::distance(fs::directory_iterator(scratch.path), fs::directory_iterator()) == 1);
}

}  // namespace animation_test
