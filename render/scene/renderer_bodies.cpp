// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/renderer_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "render/gl/functions.hpp"

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

bool same(const std::vector<SolidInstance>& a, const std::vector<SolidInstance>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

// The level of each body, by the size of its nearer end.
std::vector<std::uint8_t> detail_of(BodyKind kind, const std::vector<SolidInstance>& bodies,
                                    const Camera& camera, int height) {
  const Vec3f forward = (camera.target - camera.eye).normalized();
  const float slope = 2 * std::tan(0.5f * camera.vertical_field_of_view);
  const bool parallel = camera.parallel_height > 0;
  std::vector<std::uint8_t> levels;
  for (const SolidInstance& body : bodies) {
    const float depth = std::max(
        camera.near_plane, std::min(forward.dot(body.a - camera.eye), forward.dot(body.b - camera.eye)));
    const float visible = parallel ? camera.parallel_height : slope * depth;
    const float radius = std::max(body.radius_a, body.radius_b) / visible * static_cast<float>(height);
    const Vec3f sight = parallel ? forward : Vec3f((body.a - camera.eye).normalized());
    const float cosine = std::abs((body.b - body.a).normalized().dot(sight));
    const int level = is_ribbon(kind, radius, cosine) ? detail_levels : detail_level(radius);
    levels.push_back(static_cast<std::uint8_t>(level));
  }
  return levels;
}

constexpr int level_sides[detail_levels] = {6, 8, 12, 24}, ball_sides[detail_levels] = {8, 10, 16, 32};

}  // namespace

// The middle of a side of n is r (1 - cos(pi / n)) inside the circle: a third of a pixel at these radii.
int detail_level(float radius) {
  int level = 0;
  while (level + 1 < detail_levels &&
         radius * (1 - std::cos(3.14159f / static_cast<float>(level_sides[level]))) > 0.34f)
    ++level;
  return level;
}

bool is_ribbon(BodyKind kind, float radius, float cosine) {
  constexpr float widest_rod = 4.5f, widest_plate = 2.5f;
  switch (kind) {
    case BodyKind::capsule:
      return radius <= widest_rod && cosine < 0.9f;
    case BodyKind::cylinder:  // its end is seen as an ellipse of half that width
      return radius <= widest_rod && cosine < std::min(0.9f, 1.1f / radius);
    case BodyKind::plate:
      return radius <= widest_plate && cosine < std::min(0.9f, 1.1f / radius);
    case BodyKind::ball:
      return false;
  }
  return false;
}

Mesh detailed_mesh(BodyKind kind, int level) {
  const int sides = level_sides[level], round = ball_sides[level];
  switch (kind) {
    case BodyKind::capsule:
      return capsule_mesh(sides, std::max(1, sides / 6));
    case BodyKind::ball:
      return capsule_mesh(round, round / 4);
    case BodyKind::cylinder:
      return level < 3 ? plain_cylinder_mesh(sides) : cylinder_mesh(sides);
    case BodyKind::plate:
      return plate_mesh(sides / 2);
  }
  return {};
}

RendererBodies::Shape RendererBodies::make_shape(const Mesh& mesh, unsigned instances) {
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
  describe(8, 3, sizeof(SolidInstance), offsetof(SolidInstance, side), 1);
  gl::BindVertexArray(0);
  return shape;
}

RendererBodies::RendererBodies(BodyKind kind) : kind_(kind) {
  for (int i = 0; i < detail_levels; ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    gl::GenBuffers(1, &level.instances);
    level.picture = make_shape(detailed_mesh(kind, i), level.instances);
    level.shadow = make_shape(detailed_mesh(kind, std::max(0, i - 2)), level.instances);
  }
  Level& ribbons = levels_.back();
  const float before = kind == BodyKind::capsule ? 0.55f : kind == BodyKind::plate ? 0.8f : 0.0f;
  gl::GenBuffers(1, &ribbons.instances);
  ribbons.picture =
      make_shape(ribbon_mesh(before, kind == BodyKind::plate ? 0.0f : before), ribbons.instances);
  ribbons.shadow = make_shape(detailed_mesh(kind, 0), ribbons.instances);
}

RendererBodies::~RendererBodies() {
  for (const Level& level : levels_) {
    destroy_shape(level.picture);
    destroy_shape(level.shadow);
    gl::DeleteBuffers(1, &level.instances);
  }
}

void RendererBodies::destroy_shape(const Shape& shape) {
  gl::DeleteBuffers(1, &shape.indices);
  gl::DeleteBuffers(1, &shape.vertices);
  gl::DeleteVertexArrays(1, &shape.vertex_array);
}

bool RendererBodies::set(std::vector<SolidInstance> bodies, const Camera& camera, int height) {
  std::vector<std::uint8_t> detail = detail_of(kind_, bodies, camera, height);
  if (detail == detail_ && same(bodies, bodies_)) return false;
  bodies_ = std::move(bodies);
  detail_ = std::move(detail);
  upload();
  return true;
}

void RendererBodies::upload() {
  std::array<std::vector<SolidInstance>, detail_levels + 1> sorted;
  for (std::size_t i = 0; i < bodies_.size(); ++i) sorted[detail_[i]].push_back(bodies_[i]);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    levels_[i].count = static_cast<int>(sorted[i].size());
    fill(GL_ARRAY_BUFFER, levels_[i].instances, sorted[i], GL_STREAM_DRAW);
  }
}

void RendererBodies::draw_shape(const Shape& shape, int count) {
  if (count == 0) return;
  gl::BindVertexArray(shape.vertex_array);
  gl::DrawElementsInstanced(GL_TRIANGLES, shape.index_count, GL_UNSIGNED_SHORT, nullptr, count);
}

void RendererBodies::draw() const {
  for (const Level& level : levels_) draw_shape(level.picture, level.count);
}

void RendererBodies::draw_shadow() const {
  for (const Level& level : levels_) draw_shape(level.shadow, level.count);
}

}  // namespace unfurl
