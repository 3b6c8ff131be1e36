// SPDX-License-Identifier: BSD-3-Clause
// A DrawList becomes an Image: lit solids with shadows on a floor, in OpenGL 3.3 core.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/gl/context.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/gl/program.hpp"
#include "render/gl/texture_target.hpp"
#include "render/image/image.hpp"
#include "render/scene/draw_list.hpp"
#include "render/scene/renderer_bodies.hpp"
#include "render/scene/renderer_skins.hpp"
#include "render/scene/text_overlay.hpp"

namespace unfurl {

class Renderer {
 public:
  // Pictures of width x height pixels. The context must outlive the renderer and be current on its thread.
  // samples: per pixel, as many as the driver has. Throws GraphicsError.
  Renderer(GlContext& context, int width, int height, int samples = 4);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  Image draw(const DrawList& list);
  // The same without reading back: leaves the finished picture in the bound framebuffer. `coarse`: with one
  // sample per pixel, in about half the time.
  void paint(const DrawList& list, bool coarse = false);
  // The picture that was painted last.
  Image read() const;
  const Framebuffer& picture() const { return frame_; }  // what was painted last

 private:
  using Matrix4f = Eigen::Matrix4f;
  struct View {  // of a picture
    Matrix4f camera, light;
    PixelRect solid;  // outside it is nothing but surroundings
  };
  bool upload_solids(const DrawList& list);
  PixelRect solid_part(const DrawList& list, const Matrix4f& camera) const;
  void draw_shadows(const DrawList& list, const Matrix4f& light);
  void blur_shadows(const DrawList& list, const Matrix4f& light) const;
  void draw_backdrop(const DrawList& list, const Matrix4f& camera);
  void draw_floor_shadow(const DrawList& list, const View& view) const;
  const Program& begin_floor(const Program& program, const DrawList& list, const Matrix4f& camera) const;
  // A look's program is made at its first picture.
  const Program& background_program(const DrawList& list);
  const Program& solid_program(const char* name, const char* fragment, bool hidden);
  const Program& begin_solids(const char* name, const char* fragment, const DrawList& list, const View& view,
                              bool hidden = false);
  void begin_solids(const Program& program, const DrawList& list, const View& view) const;
  void draw_solids(const DrawList& list, const View& view);
  void draw_outlines(const DrawList& list, const View& view);
  void draw_ghosts(const DrawList& list, const View& view);
  void draw_skins(const DrawList& list, const View& view);
  void set_planet(const Program& program, const DrawList& list) const;
  void draw_bodies(const Program& program) const;
  static void begin_blending();
  static void end_blending();
  void set_background(const Program& program, const DrawList& list) const;

  Framebuffer frame_, backdrop_;  // backdrop: what is behind the bodies, but for shadows
  Program depth_, skin_depth_, shade_from_depth_, shade_narrow_, shade_wide_, grid_, floor_shadow_;
  std::map<std::string, std::unique_ptr<Program>> programs_;  // by name
  RendererBodies capsules_{BodyKind::capsule}, balls_{BodyKind::ball}, cylinders_{BodyKind::cylinder},
      plates_{BodyKind::plate}, ghosts_{BodyKind::capsule};
  RendererSkins skins_;
  unsigned empty_array_ = 0;
  TextureTarget shadow_map_;                     // depth from the light
  TextureTarget shade_across_, shade_on_floor_;  // the shadow on the floor, blurred one way, then both
  TextureTarget soft_across_, soft_on_floor_;    // the same, blurred more
  TextOverlay text_;
  bool transparent_ = false;        // of the picture that was painted last
  std::vector<float> backdrop_of_;  // what the backdrop shows
  float floor_z_ = 0;
  bool floor_shown_ = false;                  // when the shadow maps were drawn,
  Matrix4f shadows_from_ = Matrix4f::Zero();  // by this light,
  PixelRect shaded_;                          // and this part of the map on the floor is not empty
};

}  // namespace unfurl
