// A DrawList becomes an Image: lit solids with shadows on a floor, in OpenGL 3.3 core.
#pragma once

#include <array>

#include "render/gl/context.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/gl/program.hpp"
#include "render/gl/texture_target.hpp"
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
  const Framebuffer& picture() const { return frame_; }  // what was painted last

 private:
  struct Shape {  // a mesh, with a body's instances
    unsigned vertex_array = 0, vertices = 0, indices = 0;
    int index_count = 0;
  };
  struct Body {
    Shape fine, coarse;      // for the picture; for the shadow, where nobody counts the corners
    unsigned instances = 0;  // of this picture
    int instance_count = 0;
  };
  static Shape make_shape(const Mesh& mesh, unsigned instances);
  static Body make_body(const Mesh& fine, const Mesh& coarse);
  static void destroy_shape(const Shape& shape);
  static void upload(Body& body, const std::vector<SolidInstance>& instances);
  void draw_bodies(Shape Body::*shape) const;
  void draw_shadows(const DrawList& list, const Eigen::Matrix4f& light) const;
  void draw_solids(const DrawList& list, const Eigen::Matrix4f& view, const Eigen::Matrix4f& light) const;
  void draw_surroundings(const DrawList& list, const Eigen::Matrix4f& view,
                         const Eigen::Matrix4f& light) const;
  void set_background(const Program& program, const DrawList& list) const;

  Framebuffer frame_;
  Program depth_, shade_, solid_, background_, ground_;
  std::array<Body, 3> bodies_;  // capsules, balls, cylinders
  unsigned empty_array_ = 0;
  TextureTarget shadow_map_;                     // depth from the light
  TextureTarget shade_across_, shade_on_floor_;  // the shadow on the floor, blurred one way, then both
  TextOverlay text_;
};

}  // namespace unfurl
