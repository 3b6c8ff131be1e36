// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl/context.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "render/gl/framebuffer.hpp"
#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"
#include "render/gl/program.hpp"

using namespace unfurl;

namespace context_test {

namespace {

struct OtherLibraries {  // put back at the end
  explicit OtherLibraries(const char* osmesa, const char* egl = "libnoegl.so") {
    setenv("UNFURL_OSMESA", osmesa, 1);
    setenv("UNFURL_EGL", egl, 1);
  }
  ~OtherLibraries() {
    unsetenv("UNFURL_OSMESA");
    unsetenv("UNFURL_EGL");
  }
};

std::string refusal() {
  try {
    make_offscreen_context();
  } catch (const GraphicsError& error) {
    return error.what();
  }
  return "no error";
}

std::array<int, 4> pixel(const Image& image, int x, int y) {
  const std::size_t at =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgba.at(at), image.rgba.at(at + 1), image.rgba.at(at + 2), image.rgba.at(at + 3)};
}

// Red, with a blue stripe over the lowest rows.
void draw_flag(int width, int stripe) {
  gl::ClearColor(1, 0, 0, 1);
  gl::Clear(GL_COLOR_BUFFER_BIT);
  gl::Enable(GL_SCISSOR_TEST);
  gl::Scissor(0, 0, width, stripe);
  gl::ClearColor(0, 0, 1, 1);
  gl::Clear(GL_COLOR_BUFFER_BIT);
  gl::Disable(GL_SCISSOR_TEST);
}

}  // namespace

TEST_CASE("neither OSMesa nor EGL is an error that names both and the packages to install") {
  const OtherLibraries none("libnone.so");
  CHECK_THAT(refusal(), Catch::Contains("libnone.so") && Catch::Contains("libnoegl.so") &&
                            Catch::Contains("package libosmesa6, or libegl1 and libegl-mesa0"));
}

TEST_CASE("a library that is not EGL is refused") {
  const OtherLibraries other("libnone.so", "libz.so.1");
  CHECK_THAT(refusal(), Catch::Contains("libz.so.1 lacks eglGetProcAddress"));
}

TEST_CASE("a library that is not OSMesa is refused") {
  const OtherLibraries other("libz.so.1");
  CHECK_THAT(refusal(),
             Catch::Contains("libz.so.1 is not an OSMesa library") && Catch::Contains("libosmesa6"));
}

TEST_CASE("the offscreen context is OpenGL 3.3 or later and says what it is") {
  const auto context = make_offscreen_context();
  CHECK_THAT(context->description(), Catch::StartsWith("OSMesa, OpenGL "));
  int major = 0, minor = 0;
  gl::GetIntegerv(GL_MAJOR_VERSION, &major);
  gl::GetIntegerv(GL_MINOR_VERSION, &minor);
  CHECK(10 * major + minor >= 33);
}

TEST_CASE("a framebuffer reads back top row first, with and without multi-sampling") {
  const auto context = make_offscreen_context();
  const int samples = GENERATE(0, 1, 4, 64);  // 64: more than any driver has
  const Framebuffer frame(37, 21, samples);
  CHECK(frame.samples() <= samples);
  CHECK(frame.samples() != 1);
  draw_flag(37, 5);
  frame.resolve();
  const Image image = frame.read();
  CHECK(image.width == 37);
  CHECK(image.height == 21);
  CHECK(pixel(image, 0, 0) == std::array{255, 0, 0, 255});
  CHECK(pixel(image, 36, 15) == std::array{255, 0, 0, 255});
  CHECK(pixel(image, 0, 16) == std::array{0, 0, 255, 255});
  CHECK(pixel(image, 36, 20) == std::array{0, 0, 255, 255});
  CHECK(gl::GetError() == GL_NO_ERROR);
}

TEST_CASE("a picture that the driver cannot hold is refused with its limit") {
  const auto context = make_offscreen_context();
  CHECK_THROWS_WITH(Framebuffer(1 << 20, 100),
                    Catch::Contains("1048576 x 100") && Catch::Contains("allows up to"));
  CHECK_THROWS_AS(Framebuffer(0, 100), GraphicsError);
}

TEST_CASE("two contexts take turns") {
  const auto first = make_offscreen_context();
  const Framebuffer a(8, 8, 0);
  draw_flag(8, 4);
  {
    const auto second = make_offscreen_context();
    const Framebuffer b(8, 8, 0);
    gl::ClearColor(0, 1, 0, 1);
    gl::Clear(GL_COLOR_BUFFER_BIT);
    CHECK(pixel(b.read(), 4, 7) == std::array{0, 255, 0, 255});
  }
  first->make_current();
  CHECK(pixel(a.read(), 4, 7) == std::array{0, 0, 255, 255});
}

TEST_CASE("a shader that does not compile is told with its name and stage") {
  const auto context = make_offscreen_context();
  const char* good = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }";
  CHECK_THROWS_WITH(Program("lamp", good, "#version 330 core\nvoid main() { nonsense; }"),
                    Catch::Contains("'lamp, fragment stage'") && Catch::Contains("nonsense"));
}

}  // namespace context_test
