// SPDX-License-Identifier: BSD-3-Clause
// A picture to draw into, anti-aliased where the driver can.
#pragma once

#include "render/image/image.hpp"

namespace unfurl {

// Of a picture [pixels] from its lower left corner, as OpenGL counts: x0 <= x < x1.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

// RGBA8 colour and 24-bit depth of one size. Needs a current context from construction to destruction.
class Framebuffer {
 public:
  // samples: wanted per pixel; 0 or 1 draws without multi-sampling. Takes what the driver has, down to none.
  // Throws GraphicsError where the size is beyond the driver's limit.
  Framebuffer(int width, int height, int samples = 4);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }

  void bind() const;           // draw into the (multi-sampled) picture; sets the viewport
  void bind_resolved() const;  // draw without multi-sampling: text, panels, what has no edges
  // Inside a part of the picture, give every sample the colour of the resolved pixel, then draw with
  // multi-sampling; and average the samples, then draw without.
  void spread(const PixelRect& part) const;
  void resolve(const PixelRect& part) const;
  void resolve() const { resolve(whole()); }
  void clear_depth(const PixelRect& part) const;  // of what is bound
  PixelRect whole() const { return {0, 0, width_, height_}; }
  // Fill a rectangle [pixels from the top left] with one colour (0..1, no depth) and leave the picture bound
  // for drawing without multi-sampling.
  void fill(float r, float g, float b, int x, int y, int width, int height) const;
  // The resolved picture into another one, or into the window's own surface of that height: its upper left
  // corner at (x, y) from the top left there. Leaves the target bound.
  void copy_to(const Framebuffer& target, int x, int y) const;
  void copy_to_window(int window_height) const;
  void finish() const;  // wait until everything so far is drawn: for clocks
  Image read() const;   // what was drawn since, of the resolved picture; top row first, alpha as drawn

 private:
  struct Surface {
    unsigned framebuffer = 0, color = 0, depth = 0;
  };
  void blit(const Surface& from, const Surface& to, const PixelRect& part) const;
  void copy(unsigned target, int target_height, int x, int y) const;
  static bool make_surface(Surface& surface, int width, int height, int samples);
  static void destroy_surface(Surface& surface);

  int width_, height_, samples_;
  Surface drawn_, resolved_;  // the same where there is no multi-sampling
};

}  // namespace unfurl
