// SPDX-License-Identifier: BSD-3-Clause
// A few whole pictures against ones that were looked at and kept (tests/baselines). Two numbers compare them,
// of channels from 0 to 255:
//
//   mean   the mean difference. 1 is what the noise of another rasteriser's rounding along all edges makes.
//   share  of pixels with a channel off by more than 48: what the eye sees as another colour. An edge that
//   moves by
//          a tenth of a pixel stays below; a rod that is missing or elsewhere is some percent of a picture.
//
// After a change that is meant: run the command of each, look at the picture, and put it in the place of the
// old one.
#include <catch2/catch.hpp>
#include <filesystem>

#include "render/image/png.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace baseline_test {

namespace {

struct Difference {
  double mean = 0, share = 0;
};

Difference difference(const Image& a, const Image& b) {
  Difference d;
  REQUIRE(a.width == b.width);
  REQUIRE(a.height == b.height);
  REQUIRE(a.rgba.size() == b.rgba.size());
  const std::size_t channels = a.rgba.size() / static_cast<std::size_t>(a.width * a.height);
  for (std::size_t i = 0; i < a.rgba.size(); i += channels) {
    int largest = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const int off = std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]});
      largest = std::max(largest, off);
      d.mean += off;
    }
    d.share += largest > 48;
  }
  d.mean /= static_cast<double>(a.rgba.size());
  d.share *= static_cast<double>(channels) / static_cast<double>(a.rgba.size());
  return d;
}

constexpr double most_mean = 1.0, most_share = 0.003;

// Frame `frame` of `unfurl render hoop6 -o out --size 320x180 --supersample 2 --frames FRAME --look LOOK`.
Image frame(const std::string& look, const std::string& frame) {
  const ScratchDirectory dir;
  REQUIRE(run_program({"render", "hoop6", "-o", dir / "out", "--size", "320x180", "--supersample", "2",
                       "--frames", frame, "--look", look, "--quiet"})
              .code == 0);
  return read_png(dir / ("out/frames/frame_00" + frame + ".png"));
}

// `unfurl figure hoop6 NAME -o NAME.png --dpi 60`
Image figure(const std::string& name) {
  const ScratchDirectory dir;
  REQUIRE(
      run_program({"figure", "hoop6", name, "-o", dir / (name + ".png"), "--dpi", "60", "--quiet"}).code ==
      0);
  return read_png(dir / (name + ".png"));
}

Image kept(const std::string& name) {
  return read_png(std::filesystem::path(UNFURL_ROOT) / "tests/baselines" / (name + ".png"));
}

void check_same(const Image& now, const std::string& name) {
  const Difference d = difference(now, kept(name));
  INFO(name << ": mean " << d.mean << ", share " << d.share);
  CHECK(d.mean <= most_mean);
  CHECK(d.share <= most_share);
}

}  // namespace

TEST_CASE("frames and figures look as they did when they were looked at") {
  check_same(frame("studio", "142"), "studio");
  check_same(frame("blueprint", "142"), "blueprint");
  check_same(figure("energy"), "energy");
  check_same(figure("poses"), "poses");
}

TEST_CASE("the levels of the baselines tell a ring apart that stands a twentieth of a second elsewhere") {
  const Difference other = difference(frame("studio", "140"), kept("studio"));
  INFO("mean " << other.mean << ", share " << other.share);
  CHECK(other.share > 2 * most_share);
}

}  // namespace baseline_test
