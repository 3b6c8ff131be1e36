// A DrawList becomes an Image: lit solids with shadows on a floor, in OpenGL 3.3 core.
#pragma once

#include <array>

#include "render/gl/context.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/gl/program.hpp"
#include "render/image/image.hpp"
#include "render/scene/draw_list.hpp"
#include "render/scene/solid_mesh.hpp"
#include "render/ui/text_overlay.hpp"

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
  // The same without reading back: leaves the finished picture in the bound framebuffer.
  void paint(const DrawList& list);

 private:
  struct Body {  // a mesh and its instances of this picture
    unsigned vertex_array = 0, vertices = 0, indices = 0, instances = 0;
    int index_count = 0, instance_count = 0;
  };
  static Body make_body(const Mesh& mesh);
  static void destroy_body(const Body& body);
  static void upload(Body& body, const std::vector<SolidInstance>& instances);
  void draw_bodies() const;
  void make_shadow_map();
  void draw_shadow_map(const Eigen::Matrix4f& light) const;
  void draw_solids(const DrawList& list, const Eigen::Matrix4f& view, const Eigen::Matrix4f& light) const;
  void draw_surroundings(const DrawList& list, const Eigen::Matrix4f& view,
                         const Eigen::Matrix4f& light) const;
  void set_background(const Program& program, const DrawList& list) const;

  Framebuffer frame_;
  Program depth_, solid_, background_, ground_;
  std::array<Body, 3> bodies_;  // capsules, balls, cylinders
  unsigned empty_array_ = 0, shadow_texture_ = 0, shadow_frame_ = 0;
  TextOverlay text_;
};

}  // namespace unfurl
