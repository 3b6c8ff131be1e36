// A DrawList becomes an Image: lit solids with shadows on a floor, in OpenGL 3.3 core.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>

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
  // The same without reading back: leaves the finished picture in the bound framebuffer. `coarse`: with one
  // sample per pixel, in about half the time.
  void paint(const DrawList& list, bool coarse = false);
  // The picture that was painted last.
  Image read() const;
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
    bool small = false;  // no body is more than a few pixels thick: the coarse shape is as good
  };
  static Shape make_shape(const Mesh& mesh, unsigned instances);
  static Body make_body(const Mesh& fine, const Mesh& coarse);
  static void destroy_shape(const Shape& shape);
  static void upload(Body& body, const std::vector<SolidInstance>& instances);
  bool upload_solids(const DrawList& list);
  static void draw_body(const Body& body, Shape Body::*shape);
  void draw_bodies(Shape Body::*shape) const;
  void draw_shadows(const DrawList& list, const Eigen::Matrix4f& light) const;
  // A look's program is made at its first picture.
  const Program& solid_program(const char* name, const char* fragment);
  const Program& begin_solids(const char* name, const char* fragment, const DrawList& list,
                              const Eigen::Matrix4f& view, const Eigen::Matrix4f& light);
  void draw_solids(const DrawList& list, const Eigen::Matrix4f& view, const Eigen::Matrix4f& light);
  void draw_outlines(const DrawList& list, const Eigen::Matrix4f& view, const Eigen::Matrix4f& light);
  void draw_ghosts(const DrawList& list, const Eigen::Matrix4f& view, const Eigen::Matrix4f& light);
  static void begin_blending();
  static void end_blending();
  void draw_surroundings(const DrawList& list, const Eigen::Matrix4f& view,
                         const Eigen::Matrix4f& light) const;
  void set_background(const Program& program, const DrawList& list) const;

  Framebuffer frame_;
  Program depth_, shade_, background_, ground_;
  std::map<std::string, std::unique_ptr<Program>> solid_;  // by name
  std::array<Body, 4> bodies_;                             // capsules, balls, cylinders, ghosts
  unsigned empty_array_ = 0;
  TextureTarget shadow_map_;                     // depth from the light
  TextureTarget shade_across_, shade_on_floor_;  // the shadow on the floor, blurred one way, then both
  TextOverlay text_;
  bool transparent_ = false;  // of the picture that was painted last
  Solids solids_;             // that the buffers hold
  bool floor_shown_ = false;
  Eigen::Matrix4f shadows_from_ = Eigen::Matrix4f::Zero();  // the light that the shadow maps were drawn for
};

}  // namespace unfurl
