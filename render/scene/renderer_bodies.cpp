// The renderer's meshes and their instances on the graphics side.
#include <cstddef>

#include "render/gl/functions.hpp"
#include "render/scene/renderer.hpp"

namespace unfurl {
namespace {

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

}  // namespace

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

void Renderer::draw_body(const Body& body, Shape Body::*shape) {
  if (body.instance_count == 0) return;
  const Shape& drawn = body.small ? body.coarse : body.*shape;
  gl::BindVertexArray(drawn.vertex_array);
  gl::DrawElementsInstanced(GL_TRIANGLES, drawn.index_count, GL_UNSIGNED_SHORT, nullptr, body.instance_count);
}

void Renderer::draw_bodies(Shape Body::*shape) const {
  for (const Body& body : bodies_) draw_body(body, shape);
}

}  // namespace unfurl
