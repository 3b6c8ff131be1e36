#include "render/scene/renderer.hpp"

#include <cstddef>

#include "render/gl/functions.hpp"
#include "render/scene/shaders.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
namespace {

using Eigen::Matrix4f;

constexpr int shadow_side = 2048, shade_side = 512;  // [pixels]

const void* offset_of(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

void describe(GLuint attribute, int floats, std::size_t stride, std::size_t offset, GLuint divisor) {
  gl::VertexAttribPointer(attribute, floats, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          offset_of(offset));
  gl::EnableVertexAttribArray(attribute);
  gl::VertexAttribDivisor(attribute, divisor);
}

template <class T>
void fill(GLenum target, unsigned buffer, const std::vector<T>& data, GLenum usage) {
  gl::BindBuffer(target, buffer);
  gl::BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}

Eigen::Vector4f as_vector(const Color& c) {
  return {c.r, c.g, c.b, c.a};
}

}  // namespace

Renderer::Renderer(GlContext& context, int width, int height, int samples)
    : frame_((context.make_current(), width), height, samples),
      depth_("shadow", shaders::solid_vertex, shaders::depth_fragment),
      shade_("shade", shaders::background_vertex, shaders::shade_fragment),
      solid_("solid", shaders::solid_vertex, shaders::solid_fragment),
      background_("background", shaders::background_vertex, shaders::background_fragment),
      ground_("ground", shaders::ground_vertex, shaders::ground_fragment),
      bodies_{make_body(capsule_mesh(12, 2), capsule_mesh(6, 1)),
              make_body(capsule_mesh(16, 4), capsule_mesh(8, 2)),
              make_body(cylinder_mesh(12), cylinder_mesh(6))},
      shadow_map_(TextureKind::depth_compare, shadow_side),
      shade_across_(TextureKind::shade, shade_side),
      shade_on_floor_(TextureKind::shade, shade_side) {
  gl::GenVertexArrays(1, &empty_array_);
}

Renderer::~Renderer() {
  gl::DeleteVertexArrays(1, &empty_array_);
  for (const Body& body : bodies_) {
    destroy_shape(body.fine);
    destroy_shape(body.coarse);
    gl::DeleteBuffers(1, &body.instances);
  }
}

Renderer::Shape Renderer::make_shape(const Mesh& mesh, unsigned instances) {
  Shape shape;
  gl::GenVertexArrays(1, &shape.vertex_array);
  gl::GenBuffers(1, &shape.vertices);
  gl::GenBuffers(1, &shape.indices);
  shape.index_count = static_cast<int>(mesh.indices.size());
  gl::BindVertexArray(shape.vertex_array);
  fill(GL_ELEMENT_ARRAY_BUFFER, shape.indices, mesh.indices, GL_STATIC_DRAW);
  fill(GL_ARRAY_BUFFER, shape.vertices, mesh.vertices, GL_STATIC_DRAW);
  describe(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, offset), 0);
  describe(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal), 0);
  describe(2, 1, sizeof(MeshVertex), offsetof(MeshVertex, end), 0);
  gl::BindBuffer(GL_ARRAY_BUFFER, instances);
  describe(3, 3, sizeof(SolidInstance), offsetof(SolidInstance, a), 1);
  describe(4, 3, sizeof(SolidInstance), offsetof(SolidInstance, b), 1);
  describe(5, 2, sizeof(SolidInstance), offsetof(SolidInstance, radius_a), 1);
  describe(6, 3, sizeof(SolidInstance), offsetof(SolidInstance, red), 1);
  describe(7, 2, sizeof(SolidInstance), offsetof(SolidInstance, metal), 1);
  gl::BindVertexArray(0);
  return shape;
}

Renderer::Body Renderer::make_body(const Mesh& fine, const Mesh& coarse) {
  Body body;
  gl::GenBuffers(1, &body.instances);
  body.fine = make_shape(fine, body.instances);
  body.coarse = make_shape(coarse, body.instances);
  return body;
}

void Renderer::destroy_shape(const Shape& shape) {
  gl::DeleteBuffers(1, &shape.indices);
  gl::DeleteBuffers(1, &shape.vertices);
  gl::DeleteVertexArrays(1, &shape.vertex_array);
}

void Renderer::upload(Body& body, const std::vector<SolidInstance>& instances) {
  fill(GL_ARRAY_BUFFER, body.instances, instances, GL_STREAM_DRAW);
  body.instance_count = static_cast<int>(instances.size());
}

void Renderer::draw_bodies(Shape Body::*shape) const {
  for (const Body& body : bodies_) {
    if (body.instance_count == 0) continue;
    gl::BindVertexArray((body.*shape).vertex_array);
    gl::DrawElementsInstanced(GL_TRIANGLES, (body.*shape).index_count, GL_UNSIGNED_SHORT, nullptr,
                              body.instance_count);
  }
}

// The depth map, for shadows of bodies on bodies; from it, for the floor, what of the light is missing,
// blurred. One read of that costs a floor pixel a sixth of as many reads of the depth map as would be as
// soft.
void Renderer::draw_shadows(const DrawList& list, const Matrix4f& light) const {
  shadow_map_.bind();
  gl::Clear(GL_DEPTH_BUFFER_BIT);
  gl::Enable(GL_POLYGON_OFFSET_FILL);
  gl::PolygonOffset(1.5f, 2.0f);
  depth_.use();
  depth_.set("view_projection", light);
  draw_bodies(&Body::coarse);
  gl::Disable(GL_POLYGON_OFFSET_FILL);
  shadow_map_.use_as_texture(0);
  if (!list.ground.shown) return;
  gl::Disable(GL_DEPTH_TEST);
  gl::BindVertexArray(empty_array_);
  shade_.use();
  shade_.set("depth", 0);
  shade_.set("shade", 1);
  for (const bool across : {true, false}) {
    (across ? shade_across_ : shade_on_floor_).bind();
    if (!across) shade_across_.use_as_texture(1);
    shade_.set("across", across ? 1 : 0);
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
  }
  shade_on_floor_.use_as_texture(1);
  gl::Enable(GL_DEPTH_TEST);
}

void Renderer::draw_solids(const DrawList& list, const Matrix4f& view, const Matrix4f& light) const {
  solid_.use();
  solid_.set("view_projection", view);
  solid_.set("light_projection", light);
  solid_.set("shadow_map", 0);
  solid_.set("eye", list.camera.eye);
  solid_.set("to_light", Vec3f(list.light_direction.normalized()));
  const float floor = list.ground.shown ? list.ground.z : -1e6f;
  solid_.set("floor_height_reach", Eigen::Vector2f(floor, 0.25f * list.radius));
  draw_bodies(&Body::fine);
}

void Renderer::set_background(const Program& program, const DrawList& list) const {
  program.set("background_top", as_vector(list.background_top));
  program.set("background_bottom", as_vector(list.background_bottom));
  program.set("picture_height", static_cast<float>(frame_.height()));
}

void Renderer::draw_surroundings(const DrawList& list, const Matrix4f& view, const Matrix4f& light) const {
  gl::BindVertexArray(empty_array_);
  if (list.ground.shown) {
    ground_.use();
    set_background(ground_, list);
    ground_.set("view_projection", view);
    ground_.set("light_projection", light);
    ground_.set("shade", 1);
    ground_.set("center", Vec3f(list.ground.center.x(), list.ground.center.y(), list.ground.z));
    ground_.set("reach", list.ground.fade);
    ground_.set("cell", list.ground.cell);
    gl::DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  background_.use();
  set_background(background_, list);
  gl::DrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::paint(const DrawList& list) {
  const Solids solids = solids_of(list);
  upload(bodies_[0], solids.capsules);
  upload(bodies_[1], solids.balls);
  upload(bodies_[2], solids.cylinders);
  const float aspect = static_cast<float>(frame_.width()) / static_cast<float>(frame_.height());
  const Matrix4f view = view_projection(list.camera, aspect);
  const Matrix4f light = light_projection(list.light_direction, list.center, list.radius);

  gl::Disable(GL_BLEND);
  gl::Disable(GL_SCISSOR_TEST);
  gl::Enable(GL_DEPTH_TEST);
  gl::DepthFunc(GL_LEQUAL);
  gl::DepthMask(GL_TRUE);
  gl::Enable(GL_CULL_FACE);
  gl::CullFace(GL_BACK);
  draw_shadows(list, light);
  frame_.bind();
  gl::Clear(GL_DEPTH_BUFFER_BIT);  // the background covers what else is left
  draw_solids(list, view, light);
  gl::Disable(GL_CULL_FACE);  // the floor may be seen from below
  draw_surroundings(list, view, light);
  frame_.resolve();
  text_.draw(list.labels, frame_.width(), frame_.height());
}

Image Renderer::draw(const DrawList& list) {
  paint(list);
  return frame_.read();
}

}  // namespace unfurl
