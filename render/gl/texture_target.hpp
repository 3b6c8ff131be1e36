#pragma once

namespace unfurl {

enum class TextureKind {
  depth_compare,  // 24-bit depth, read by a sampler2DShadow
  shade           // one 8-bit channel
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

 private:
  int side_;
  unsigned texture_ = 0, framebuffer_ = 0;
};

}  // namespace unfurl
