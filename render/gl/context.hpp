// SPDX-License-Identifier: BSD-3-Clause
// Somewhere to draw: an OpenGL 3.3 core context. One door; a backend is another .cpp that implements the
// interface.
#pragma once

#include <memory>
#include <string>

namespace unfurl {

// One thread may use a context at a time, and one family of contexts (OSMesa or a window) per process at a
// time: the pointers of gl:: are shared. With a window open, draw films into framebuffers of the window's own
// context.
class GlContext {
 public:
  virtual ~GlContext() = default;
  // Make this the calling thread's context and load gl:: from it. Throws GraphicsError.
  virtual void make_current() = 0;
  virtual std::string description()
      const = 0;  // "OSMesa, OpenGL 4.5, llvmpipe": for --version and error reports
};

struct Offscreen {
  int threads = 0;   // how many may draw, 0: as many as the machine has; a process's first context decides
  bool gpu = false;  // the graphics processor: faster, and pictures differ a little from machine to machine
};

// A context without a display; current on return. Draw into a Framebuffer of any size. OSMesa where it opens,
// else EGL with Mesa's software renderer: the same pixels. UNFURL_GL = osmesa, egl or gpu in the environment
// decides instead. Throws GraphicsError, naming the packages to install, where there is none.
std::unique_ptr<GlContext> make_offscreen_context(const Offscreen& wanted = {});

}  // namespace unfurl
