// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/imgui_painter.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "render/gl/functions.hpp"

namespace unfurl {
namespace {

constexpr const char* vertex_source = R"(#version 330 core
layout(location = 0) in vec2 position;  // pixels from the top left
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
uniform vec2 origin, size;
out vec2 at;
out vec4 tint;
void main() {
  at = uv;
  tint = color;
  vec2 p = (position - origin) / size;
  gl_Position = vec4(2.0 * p.x - 1.0, 1.0 - 2.0 * p.y, 0.0, 1.0);
})";

constexpr const char* fragment_source = R"(#version 330 core
in vec2 at;
in vec4 tint;
uniform sampler2D atlas;
layout(location = 0) out vec4 color;
void main() { color = tint * texture(atlas, at); })";

const void* offset_of(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

GLuint texture_of(ImTextureID id) {
  return static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(id));
}

void enable_blending() {
  gl::Disable(GL_DEPTH_TEST);
  gl::Disable(GL_CULL_FACE);
  gl::Enable(GL_BLEND);
  gl::BlendEquation(GL_FUNC_ADD);
  gl::BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl::Enable(GL_SCISSOR_TEST);
}

}  // namespace

ImguiPainter::ImguiPainter() : program_("imgui", vertex_source, fragment_source) {
  gl::GenVertexArrays(1, &vertex_array_);
  gl::GenBuffers(1, &vertices_);
  gl::GenBuffers(1, &indices_);
  gl::BindVertexArray(vertex_array_);
  gl::BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl::BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  constexpr GLsizei stride = sizeof(ImDrawVert);
  gl::VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, offset_of(offsetof(ImDrawVert, pos)));
  gl::VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, offset_of(offsetof(ImDrawVert, uv)));
  gl::VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, offset_of(offsetof(ImDrawVert, col)));
  for (GLuint attribute = 0; attribute < 3; ++attribute) gl::EnableVertexAttribArray(attribute);
  gl::BindVertexArray(0);
}

ImguiPainter::~ImguiPainter() {
  gl::DeleteTextures(1, &font_texture_);
  gl::DeleteBuffers(1, &indices_);
  gl::DeleteBuffers(1, &vertices_);
  gl::DeleteVertexArrays(1, &vertex_array_);
}

void ImguiPainter::announce(ImGuiIO& io) {
  io.BackendRendererName = "unfurl";
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

void ImguiPainter::upload_fonts(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  if (font_texture_ == 0) gl::GenTextures(1, &font_texture_);
  gl::BindTexture(GL_TEXTURE_2D, font_texture_);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl::PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl::TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  atlas.SetTexID(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(font_texture_)));
}

void ImguiPainter::draw_list(const ImDrawList& list, const ImDrawData& data, int height,
                             const plot::Rect& part) const {
  const auto shown = [&](const ImDrawCmd& c) {
    return part.overlaps({c.ClipRect.x - data.DisplayPos.x, c.ClipRect.y - data.DisplayPos.y,
                          c.ClipRect.z - data.DisplayPos.x, c.ClipRect.w - data.DisplayPos.y});
  };
  if (std::none_of(list.CmdBuffer.begin(), list.CmdBuffer.end(), shown)) return;
  gl::BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
  gl::BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                 GL_STREAM_DRAW);
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.UserCallback == ImDrawCallback_ResetRenderState) continue;
    if (command.UserCallback != nullptr) {
      command.UserCallback(&list, &command);
      continue;
    }
    const int left = static_cast<int>(std::max<double>(part.x0, command.ClipRect.x - data.DisplayPos.x));
    const int top = static_cast<int>(std::max<double>(part.y0, command.ClipRect.y - data.DisplayPos.y));
    const int right = static_cast<int>(std::min<double>(part.x1, command.ClipRect.z - data.DisplayPos.x));
    const int bottom = static_cast<int>(std::min<double>(part.y1, command.ClipRect.w - data.DisplayPos.y));
    if (right <= left || bottom <= top) continue;
    gl::Scissor(left, height - bottom, right - left, bottom - top);
    gl::BindTexture(GL_TEXTURE_2D, texture_of(command.GetTexID()));
    constexpr GLenum type = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    gl::DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), type,
                               offset_of(command.IdxOffset * sizeof(ImDrawIdx)),
                               static_cast<GLint>(command.VtxOffset));
  }
}

void ImguiPainter::draw(const ImDrawData& data) const {
  draw(data, {0, 0, data.DisplaySize.x, data.DisplaySize.y});
}

void ImguiPainter::draw(const ImDrawData& data, const plot::Rect& part) const {
  const int width = static_cast<int>(data.DisplaySize.x), height = static_cast<int>(data.DisplaySize.y);
  if (width <= 0 || height <= 0) return;
  gl::Viewport(0, 0, width, height);
  enable_blending();
  program_.use();
  program_.set("atlas", 0);
  program_.set("origin", Eigen::Vector2f(data.DisplayPos.x, data.DisplayPos.y));
  program_.set("size", Eigen::Vector2f(data.DisplaySize.x, data.DisplaySize.y));
  gl::ActiveTexture(GL_TEXTURE0);
  gl::BindVertexArray(vertex_array_);
  gl::BindBuffer(GL_ARRAY_BUFFER, vertices_);
  for (int i = 0; i < data.CmdListsCount; ++i) draw_list(*data.CmdLists[i], data, height, part);
  gl::BindVertexArray(0);
  gl::Disable(GL_SCISSOR_TEST);
  gl::Disable(GL_BLEND);
}

}  // namespace unfurl
