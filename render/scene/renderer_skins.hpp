// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a picture on the graphics side.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/program.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

// Needs a current context from construction to destruction.
class RendererSkins {
 public:
  RendererSkins();
  ~RendererSkins();
  RendererSkins(const RendererSkins&) = delete;
  RendererSkins& operator=(const RendererSkins&) = delete;

  // What is drawn from now on; each surface from far to near, since what is behind shows through. Returns
  // whether anything is not as it was.
  bool set(const std::vector<Skin>& skins, const Camera& camera);
  void draw(const Program& program) const;         // in use, but for what each surface says
  void draw_shadow(const Program& program) const;  // likewise: as dark as they are

 private:
  struct Part {
    Skin skin;  // without its points
    int first = 0, count = 0;
  };
  std::vector<Part> parts_;
  std::vector<SkinVertex> vertices_;
  std::vector<float> coverage_;  // per part: what it keeps of the light
  std::vector<std::uint32_t> triangles_;
  unsigned array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
};

}  // namespace unfurl
