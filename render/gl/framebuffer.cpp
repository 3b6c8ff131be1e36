// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl/framebuffer.hpp"

#include <algorithm>
#include <string>

#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {
namespace {

// Cut the wish down to what the driver has; one sample is the same as none.
int possible_samples(int wanted) {
  int most = 0;
  gl::GetIntegerv(GL_MAX_SAMPLES, &most);
  const int samples = std::min(wanted, most);
  return samples > 1 ? samples : 0;
}

unsigned make_buffer(GLenum format, GLenum attachment, int width, int height, int samples) {
  unsigned buffer = 0;
  gl::GenRenderbuffers(1, &buffer);
  gl::BindRenderbuffer(GL_RENDERBUFFER, buffer);
  gl::RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  gl::FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  return buffer;
}

}  // namespace

bool Framebuffer::make_surface(Surface& surface, int width, int height, int samples) {
  gl::GenFramebuffers(1, &surface.framebuffer);
  gl::BindFramebuffer(GL_FRAMEBUFFER, surface.framebuffer);
  surface.color = make_buffer(GL_RGBA8, GL_COLOR_ATTACHMENT0, width, height, samples);
  surface.depth = make_buffer(GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, width, height, samples);
  if (gl::CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
  destroy_surface(surface);
  return false;
}

void Framebuffer::destroy_surface(Surface& surface) {
  gl::DeleteFramebuffers(1, &surface.framebuffer);
  gl::DeleteRenderbuffers(1, &surface.color);
  gl::DeleteRenderbuffers(1, &surface.depth);
  surface = {};
}

Framebuffer::Framebuffer(int width, int height, int samples) : width_(width), height_(height), samples_(0) {
  int largest = 0;
  gl::GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest ||
      !make_surface(resolved_, width, height, 0)) {
    throw GraphicsError("cannot draw a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                        " pixels: this OpenGL allows up to " + std::to_string(largest) + " on a side");
  }
  samples_ = possible_samples(samples);
  if (samples_ > 0 && !make_surface(drawn_, width, height, samples_)) samples_ = 0;
  bind();
}

Framebuffer::~Framebuffer() {
  if (samples_ > 0) destroy_surface(drawn_);
  destroy_surface(resolved_);
}

void Framebuffer::bind() const {
  gl::BindFramebuffer(GL_FRAMEBUFFER, samples_ > 0 ? drawn_.framebuffer : resolved_.framebuffer);
  gl::Viewport(0, 0, width_, height_);
}

void Framebuffer::bind_resolved() const {
  gl::BindFramebuffer(GL_FRAMEBUFFER, resolved_.framebuffer);
  gl::Viewport(0, 0, width_, height_);
}

void Framebuffer::blit(const Surface& from, const Surface& to, const PixelRect& p) const {
  if (samples_ == 0 || p.empty()) return;
  gl::BindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer);
  gl::BindFramebuffer(GL_DRAW_FRAMEBUFFER, to.framebuffer);
  gl::BlitFramebuffer(p.x0, p.y0, p.x1, p.y1, p.x0, p.y0, p.x1, p.y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Framebuffer::spread(const PixelRect& part) const {
  blit(resolved_, drawn_, part);
  bind();
}

void Framebuffer::resolve(const PixelRect& part) const {
  blit(drawn_, resolved_, part);
  bind_resolved();
}

void Framebuffer::clear_depth(const PixelRect& part) const {
  if (part.empty()) return;
  gl::Enable(GL_SCISSOR_TEST);
  gl::Scissor(part.x0, part.y0, part.x1 - part.x0, part.y1 - part.y0);
  gl::Clear(GL_DEPTH_BUFFER_BIT);
  gl::Disable(GL_SCISSOR_TEST);
}

void Framebuffer::fill(float r, float g, float b, int x, int y, int width, int height) const {
  bind_resolved();
  gl::Enable(GL_SCISSOR_TEST);
  gl::Scissor(x, height_ - y - height, width, height);
  gl::ClearColor(r, g, b, 1);
  gl::Clear(GL_COLOR_BUFFER_BIT);
  gl::Disable(GL_SCISSOR_TEST);
}

void Framebuffer::copy(unsigned target, int target_height, int x, int y) const {
  gl::Disable(GL_SCISSOR_TEST);
  gl::BindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.framebuffer);
  gl::BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  const int low = target_height - y - height_;
  gl::BlitFramebuffer(0, 0, width_, height_, x, low, x + width_, low + height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  gl::BindFramebuffer(GL_FRAMEBUFFER, target);
}

void Framebuffer::copy_to(const Framebuffer& target, int x, int y) const {
  copy(target.resolved_.framebuffer, target.height_, x, y);
}

void Framebuffer::copy_to_window(int window_height) const {
  copy(0, window_height, 0, 0);
}

void Framebuffer::finish() const {
  gl::Finish();
}

Image Framebuffer::read() const {
  Image image{width_, height_, {}};
  const auto row = 4 * static_cast<std::size_t>(width_);
  image.rgba.resize(row * static_cast<std::size_t>(height_));
  gl::BindFramebuffer(GL_FRAMEBUFFER, resolved_.framebuffer);
  gl::PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl::ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  for (int top = 0, bottom = height_ - 1; top < bottom; ++top, --bottom) {  // OpenGL's row 0 is the lowest
    const auto upper = image.rgba.begin() + static_cast<std::ptrdiff_t>(row) * top;
    const auto lower = image.rgba.begin() + static_cast<std::ptrdiff_t>(row) * bottom;
    std::swap_ranges(upper, upper + static_cast<std::ptrdiff_t>(row), lower);
  }
  return image;
}

}  // namespace unfurl
