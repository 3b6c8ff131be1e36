// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/renderer_skins.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <utility>

#include "render/gl/functions.hpp"

namespace unfurl {
namespace {

constexpr float cord_width = 0.045f;  // half of it, in cells

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// The triangles of a surface from far to near.
std::vector<std::uint32_t> sorted_triangles(const Skin& skin, const Camera& camera) {
  const Vec3f forward = (camera.target - camera.eye).normalized();
  const std::size_t count = skin.triangles.size() / 3;
  std::vector<float> depth(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) depth[i] += forward.dot(skin.vertices[skin.triangles[3 * i + k]].at);
  std::vector<std::uint32_t> order(count), out;
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return depth[a] > depth[b]; });
  for (const std::uint32_t i : order)
    for (std::size_t k = 0; k < 3; ++k) out.push_back(skin.triangles[3 * i + k]);
  return out;
}

// What it keeps of the light, its cords included.
float coverage_of(const Skin& skin) {
  const float cords = skin.weave == Weave::mesh || skin.weave == Weave::net ? 6 * cord_width : 0.0f;
  return std::min(1.0f, skin.opacity + (1 - skin.opacity) * cords);
}

}  // namespace

RendererSkins::RendererSkins() {
  gl::GenVertexArrays(1, &array_);
  gl::GenBuffers(1, &vertex_buffer_);
  gl::GenBuffers(1, &index_buffer_);
  gl::BindVertexArray(array_);
  gl::BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  gl::BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  const auto describe = [](GLuint attribute, int floats, std::size_t offset) {
    gl::VertexAttribPointer(attribute, floats, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(sizeof(SkinVertex)),
                            reinterpret_cast<const void*>(offset));
    gl::EnableVertexAttribArray(attribute);
  };
  describe(0, 3, offsetof(SkinVertex, at));
  describe(1, 3, offsetof(SkinVertex, normal));
  describe(2, 2, offsetof(SkinVertex, cell));
  gl::BindVertexArray(0);
}

RendererSkins::~RendererSkins() {
  gl::DeleteBuffers(1, &index_buffer_);
  gl::DeleteBuffers(1, &vertex_buffer_);
  gl::DeleteVertexArrays(1, &array_);
}

bool RendererSkins::set(const std::vector<Skin>& skins, const Camera& camera) {
  std::vector<SkinVertex> vertices;
  std::vector<std::uint32_t> triangles;
  parts_.clear();
  for (const Skin& skin : skins) {
    Part part;
    part.skin = {{}, {}, skin.weave, skin.front, skin.back, skin.opacity, skin.square};
    part.first = static_cast<int>(triangles.size());
    const auto base = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), skin.vertices.begin(), skin.vertices.end());
    for (const std::uint32_t i : sorted_triangles(skin, camera)) triangles.push_back(base + i);
    part.count = static_cast<int>(triangles.size()) - part.first;
    parts_.push_back(std::move(part));
  }
  std::vector<float> coverage;
  for (const Part& part : parts_) coverage.push_back(coverage_of(part.skin));
  const bool same_light = std::exchange(coverage_, coverage) == coverage;
  if (same_bytes(vertices, vertices_) && triangles == triangles_) return !same_light;
  vertices_ = std::move(vertices);
  triangles_ = std::move(triangles);
  gl::BindVertexArray(array_);
  gl::BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  gl::BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(SkinVertex)),
                 vertices_.data(), GL_STREAM_DRAW);
  gl::BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles_.size() * sizeof(std::uint32_t)),
                 triangles_.data(), GL_STREAM_DRAW);
  gl::BindVertexArray(0);
  return true;
}

namespace {

void draw_range(int first, int count) {
  gl::DrawElementsInstanced(
      GL_TRIANGLES, count, GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(static_cast<std::size_t>(first) * sizeof(std::uint32_t)), 1);
}

}  // namespace

void RendererSkins::draw(const Program& program) const {
  gl::BindVertexArray(array_);
  for (const Part& part : parts_) {
    const Skin& s = part.skin;
    program.set("front", Vec3f(s.front.r, s.front.g, s.front.b));
    program.set("back", Vec3f(s.back.r, s.back.g, s.back.b));
    program.set("opacity", s.opacity);
    program.set("cord", cord_width * (s.weave == Weave::mesh ? 0.7f : 1.0f));
    program.set("weave", static_cast<int>(s.weave));
    program.set("square", s.square ? 1 : 0);
    draw_range(part.first, part.count);
  }
  gl::BindVertexArray(0);
}

void RendererSkins::draw_shadow(const Program& program) const {
  gl::BindVertexArray(array_);
  for (const Part& part : parts_) {
    program.set("coverage", coverage_of(part.skin));
    draw_range(part.first, part.count);
  }
  gl::BindVertexArray(0);
}

}  // namespace unfurl
