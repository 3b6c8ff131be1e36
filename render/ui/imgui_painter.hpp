// SPDX-License-Identifier: BSD-3-Clause
// Draws what Dear ImGui describes. Debian's own OpenGL backend loads libGL itself and cannot draw under
// OSMesa.
#pragma once

#include <imgui.h>

#include <Eigen/Core>

#include "render/gl/program.hpp"
#include "render/plot/canvas.hpp"

namespace unfurl {

// ImDrawData -> the bound framebuffer (alpha-blended, no depth test). A texture id is an OpenGL texture name.
// Needs a current GlContext from construction to destruction.
class ImguiPainter {
 public:
  ImguiPainter();
  ~ImguiPainter();
  ImguiPainter(const ImguiPainter&) = delete;
  ImguiPainter& operator=(const ImguiPainter&) = delete;

  // Tell an ImGui context what this painter can do. Once per context.
  static void announce(ImGuiIO& io);
  // Build the atlas where needed, copy it to a texture and set its id. Again after fonts were added.
  void upload_fonts(ImFontAtlas& atlas);
  // The viewport is set to the draw data's size; blending and scissor are left off.
  void draw(const ImDrawData& data) const;
  // Only what of it lies in a rectangle [whole pixels from the top left].
  void draw(const ImDrawData& data, const plot::Rect& part) const;

 private:
  void draw_list(const ImDrawList& list, const ImDrawData& data, int height, const plot::Rect& part) const;

  Program program_;
  unsigned vertex_array_ = 0, vertices_ = 0, indices_ = 0, font_texture_ = 0;
};

}  // namespace unfurl
