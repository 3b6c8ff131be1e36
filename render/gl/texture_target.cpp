// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl/texture_target.hpp"

#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {
namespace {

void attach_depth(unsigned texture, int side) {
  gl::TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, side, side, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
  gl::DrawBuffer(GL_NONE);
  gl::ReadBuffer(GL_NONE);
}

void attach_shade(unsigned texture, int side) {
  gl::TexImage2D(GL_TEXTURE_2D, 0, GL_RG8, side, side, 0, GL_RG, GL_UNSIGNED_BYTE, nullptr);
  gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

}  // namespace

TextureTarget::TextureTarget(TextureKind kind, int side) : side_(side) {
  gl::GenTextures(1, &texture_);
  gl::BindTexture(GL_TEXTURE_2D, texture_);
  gl::GenFramebuffers(1, &framebuffer_);
  gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  (kind == TextureKind::depth ? attach_depth : attach_shade)(texture_, side);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (gl::CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  gl::DeleteFramebuffers(1, &framebuffer_);
  gl::DeleteTextures(1, &texture_);
  throw GraphicsError("cannot draw: this OpenGL cannot draw into a texture");
}

TextureTarget::~TextureTarget() {
  gl::DeleteFramebuffers(1, &framebuffer_);
  gl::DeleteTextures(1, &texture_);
}

void TextureTarget::bind() const {
  gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl::Viewport(0, 0, side_, side_);
}

void TextureTarget::use_as_texture(int unit) const {
  gl::ActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  gl::BindTexture(GL_TEXTURE_2D, texture_);
}

void TextureTarget::compare_depths(bool compare) const {
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, compare ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
}

}  // namespace unfurl
