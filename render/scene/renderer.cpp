#include "render/scene/renderer.hpp"

#include <cstddef>

#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"
#include "render/scene/shaders.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
namespace {

using Eigen::Matrix4f;

constexpr int shadow_side = 2048;  // [pixels]; solid_fragment knows it too

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
      solid_("solid", shaders::solid_vertex, shaders::solid_fragment),
      background_("background", shaders::background_vertex, shaders::background_fragment),
      ground_("ground", shaders::ground_vertex, shaders::ground_fragment) {
  bodies_ = {make_body(capsule_mesh(12, 3)), make_body(capsule_mesh(20, 5)), make_body(cylinder_mesh(14))};
  gl::GenVertexArrays(1, &empty_array_);
  make_shadow_map();
}

Renderer::~Renderer() {
  gl::DeleteFramebuffers(1, &shadow_frame_);
  gl::DeleteTextures(1, &shadow_texture_);
  gl::DeleteVertexArrays(1, &empty_array_);
  for (const Body& body : bodies_) destroy_body(body);
}

Renderer::Body Renderer::make_body(const Mesh& mesh) {
  Body body;
  gl::GenVertexArrays(1, &body.vertex_array);
  gl::GenBuffers(1, &body.vertices);
  gl::GenBuffers(1, &body.indices);
  gl::GenBuffers(1, &body.instances);
  body.index_count = static_cast<int>(mesh.indices.size());
  gl::BindVertexArray(body.vertex_array);
  fill(GL_ELEMENT_ARRAY_BUFFER, body.indices, mesh.indices, GL_STATIC_DRAW);
  fill(GL_ARRAY_BUFFER, body.vertices, mesh.vertices, GL_STATIC_DRAW);
  describe(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, offset), 0);
  describe(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal), 0);
  describe(2, 1, sizeof(MeshVertex), offsetof(MeshVertex, end), 0);
  gl::BindBuffer(GL_ARRAY_BUFFER, body.instances);
  describe(3, 3, sizeof(SolidInstance), offsetof(SolidInstance, a), 1);
  describe(4, 3, sizeof(SolidInstance), offsetof(SolidInstance, b), 1);
  describe(5, 2, sizeof(SolidInstance), offsetof(SolidInstance, radius_a), 1);
  describe(6, 3, sizeof(SolidInstance), offsetof(SolidInstance, red), 1);
  describe(7, 2, sizeof(SolidInstance), offsetof(SolidInstance, metal), 1);
  gl::BindVertexArray(0);
  return body;
}

void Renderer::destroy_body(const Body& body) {
  gl::DeleteBuffers(1, &body.instances);
  gl::DeleteBuffers(1, &body.indices);
  gl::DeleteBuffers(1, &body.vertices);
  gl::DeleteVertexArrays(1, &body.vertex_array);
}

void Renderer::upload(Body& body, const std::vector<SolidInstance>& instances) {
  fill(GL_ARRAY_BUFFER, body.instances, instances, GL_STREAM_DRAW);
  body.instance_count = static_cast<int>(instances.size());
}

void Renderer::draw_bodies() const {
  for (const Body& body : bodies_) {
    if (body.instance_count == 0) continue;
    gl::BindVertexArray(body.vertex_array);
    gl::DrawElementsInstanced(GL_TRIANGLES, body.index_count, GL_UNSIGNED_SHORT, nullptr,
                              body.instance_count);
  }
}

void Renderer::make_shadow_map() {
  gl::GenTextures(1, &shadow_texture_);
  gl::BindTexture(GL_TEXTURE_2D, shadow_texture_);
  gl::TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, shadow_side, shadow_side, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, nullptr);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl::TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl::GenFramebuffers(1, &shadow_frame_);
  gl::BindFramebuffer(GL_FRAMEBUFFER, shadow_frame_);
  gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_texture_, 0);
  gl::DrawBuffer(GL_NONE);
  gl::ReadBuffer(GL_NONE);
  if (gl::CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw GraphicsError("cannot draw: this OpenGL refuses a shadow map");
  }
}

void Renderer::draw_shadow_map(const Matrix4f& light) const {
  gl::BindFramebuffer(GL_FRAMEBUFFER, shadow_frame_);
  gl::Viewport(0, 0, shadow_side, shadow_side);
  gl::Clear(GL_DEPTH_BUFFER_BIT);
  gl::Enable(GL_POLYGON_OFFSET_FILL);
  gl::PolygonOffset(1.5f, 2.0f);
  depth_.use();
  depth_.set("view_projection", light);
  draw_bodies();
  gl::Disable(GL_POLYGON_OFFSET_FILL);
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
  draw_bodies();
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
    ground_.set("shadow_map", 0);
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
  draw_shadow_map(light);
  frame_.bind();
  gl::Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl::ActiveTexture(GL_TEXTURE0);
  gl::BindTexture(GL_TEXTURE_2D, shadow_texture_);
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
