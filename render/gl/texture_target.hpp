// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace unfurl {

enum class TextureKind {
  depth,  // 24 bits, read by a sampler2DShadow
  shade   // two 8-bit channels
};

// A square texture that one pass draws and a later one reads, bilinearly. Outside it continues its edge.
// Needs a current context from construction to destruction. Throws GraphicsError.
class TextureTarget {
 public:
  TextureTarget(TextureKind kind, int side);
  ~TextureTarget();
  TextureTarget(const TextureTarget&) = delete;
  TextureTarget& operator=(const TextureTarget&) = delete;

  int side() const { return side_; }    // [pixels]
  void bind() const;                    // draw into it; sets the viewport
  void use_as_texture(int unit) const;  // read it
  // Of a depth texture in use: read by a sampler2DShadow (as it begins) or, unfiltered, by a sampler2D.
  void compare_depths(bool compare) const;

 private:
  int side_;
  unsigned texture_ = 0, framebuffer_ = 0;
};

}  // namespace unfurl
