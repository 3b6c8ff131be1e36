// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/renderer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "render/gl/functions.hpp"
#include "render/scene/shaders.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
namespace {

using Eigen::Matrix4f;

// Sides of the shadow maps, for a picture of 720 pixels on its shorter side; of larger ones more, or their
// texels would be seen [pixels].
constexpr int shadow_side = 1536, shade_side = 384, shadow_per_shade = shadow_side / shade_side;

int shade_side_for(int width, int height) {
  const int wanted = shade_side * std::min(width, height) / 720;
  return std::clamp(wanted / 2 * 2, shade_side, 4096 / shadow_per_shade);
}

// The camera's place, or the direction to it where the projection is parallel.
Eigen::Vector4f eye_of(const Camera& camera) {
  if (camera.parallel_height <= 0) return {camera.eye.x(), camera.eye.y(), camera.eye.z(), 1};
  const Vec3f back = (camera.eye - camera.target).normalized();
  return {back.x(), back.y(), back.z(), 0};
}

// What was blended over nothing holds its colours multiplied by its alpha.
void divide_by_alpha(Image& image) {
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const int alpha = image.rgba[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = i; c < i + 3; ++c)
      image.rgba[c] = static_cast<std::uint8_t>(std::min(255, (255 * image.rgba[c] + alpha / 2) / alpha));
  }
}

std::string shade_program(const char* pass) {
  return std::string(shaders::version) + "#define " + pass + "\n" + shaders::shade_fragment;
}

std::string solid_vertex(bool hidden) {
  return std::string(hidden ? shaders::version_hidden : shaders::version) + shaders::solid_vertex;
}

}  // namespace

Renderer::Renderer(GlContext& context, int width, int height, int samples)
    : frame_((context.make_current(), width), height, samples),
      backdrop_(width, height, 0),
      depth_("shadow", solid_vertex(false), shaders::depth_fragment),
      skin_depth_("shadow of a surface", shaders::skin_vertex, shaders::skin_depth_fragment),
      shade_from_depth_("shade of depths", shaders::background_vertex, shade_program("FROM_DEPTH")),
      shade_narrow_("shade", shaders::background_vertex, shade_program("NARROW")),
      shade_wide_("soft shade", shaders::background_vertex, shade_program("WIDE")),
      grid_("grid", shaders::ground_vertex, shaders::grid_fragment),
      floor_shadow_("floor shadow", shaders::ground_vertex, shaders::floor_shadow_fragment),
      shadow_map_(TextureKind::depth, shadow_per_shade * shade_side_for(width, height)),
      shade_across_(TextureKind::shade, shade_side_for(width, height)),
      shade_on_floor_(TextureKind::shade, shade_side_for(width, height)),
      soft_across_(TextureKind::shade, shade_side_for(width, height) / 2),
      soft_on_floor_(TextureKind::shade, shade_side_for(width, height) / 2) {
  gl::GenVertexArrays(1, &empty_array_);
}

Renderer::~Renderer() {
  gl::DeleteVertexArrays(1, &empty_array_);
}

const Program& Renderer::solid_program(const char* name, const char* fragment, bool hidden) {
  std::unique_ptr<Program>& program = programs_[std::string(name) + (hidden ? ", hidden" : "")];
  if (!program)
    program =
        std::make_unique<Program>(name, solid_vertex(hidden), std::string(shaders::solid_head) + fragment);
  return *program;
}

const Program& Renderer::begin_solids(const char* name, const char* fragment, const DrawList& list,
                                      const View& view, bool hidden) {
  const Program& program = solid_program(name, fragment, hidden);
  begin_solids(program, list, view);
  return program;
}

void Renderer::begin_solids(const Program& program, const DrawList& list, const View& view) const {
  const Eigen::Vector4f eye = eye_of(list.camera);
  program.use();
  set_background(program, list);
  program.set("view_projection", view.camera);
  program.set("light_projection", view.light);
  program.set("shadow_map", 0);
  program.set("eye", eye);
  const Vec3f light = list.light_direction.normalized();
  program.set("to_light", light);
  program.set("lamp", Vec3f((light + Vec3f(0, 0, 0.6f)).normalized()));
  program.set("strip", Vec3f(Vec3f(-light.x(), -light.y(), 0.25f).normalized()));
  const Vec3f& middle = list.framed_center;
  program.set("fade_center", middle);
  program.set("mist_way", Vec3f((middle * eye.w() - eye.head<3>()).normalized() / list.framed_radius));
  program.set("mist", list.depth_fade);
  const Camera& camera = list.camera;
  const float rise = camera.parallel_height > 0 ? camera.parallel_height
                                                : 2 * std::tan(0.5f * camera.vertical_field_of_view);
  program.set("pixel", rise / static_cast<float>(frame_.height()));
  program.set("texel", 2 / (view.light.row(0).head<3>().norm() * static_cast<float>(shadow_map_.side())));
  const float floor = list.ground.shown ? list.ground.z : -1e6f;
  program.set("floor_height_reach", Eigen::Vector2f(floor, 0.25f * list.radius));
  program.set("to_eye", Vec3f((list.camera.eye - list.camera.target).normalized()));
  set_planet(program, list);
}

void Renderer::draw_bodies(const Program& program) const {
  program.set("meets", 2);  // rods, at their joints
  capsules_.draw();
  program.set("meets", 0);
  balls_.draw();
  program.set("meets", 1);  // fittings and arrows, at the joint that they begin in
  cylinders_.draw();
  program.set("meets", 0);
  plates_.draw();
}

void Renderer::draw_solids(const DrawList& list, const View& view) {
  if (list.shading == Shading::outline) return draw_outlines(list, view);
  if (list.shading == Shading::space)
    draw_bodies(begin_solids("space", shaders::space_fragment, list, view));
  else if (list.shading == Shading::flat)
    draw_bodies(begin_solids("flat", shaders::flat_fragment, list, view));
  else
    draw_bodies(begin_solids("studio", shaders::studio_fragment, list, view));
}

// What is seen first; then, blended over it, the lines of what lies well behind.
void Renderer::draw_outlines(const DrawList& list, const View& view) {
  for (const bool hidden : {false, true}) {
    const Program& program = begin_solids("outline", shaders::outline_fragment, list, view, hidden);
    program.set("line_width",
                std::max(1.0f, static_cast<float>(std::min(frame_.width(), frame_.height())) / 600.0f));
    program.set("hidden", hidden ? 1 : 0);
    program.set("nearer", list.hidden_gap);
    if (hidden) gl::DepthFunc(GL_GREATER), begin_blending();
    draw_bodies(program);
  }
  end_blending();
  gl::DepthFunc(GL_LEQUAL);
}

// Ghosts do not cover each other nor what is solid: drawn last, blended, and each pixel once.
void Renderer::draw_ghosts(const DrawList& list, const View& view) {
  if (list.ghosts.empty()) return;
  begin_solids("ghost", shaders::ghost_fragment, list, view);
  begin_blending();
  gl::DepthMask(GL_TRUE);
  ghosts_.draw();
  end_blending();
}

// What is solid first, then from far to near, blended over it.
void Renderer::draw_skins(const DrawList& list, const View& view) {
  if (list.skins.empty()) return;
  std::unique_ptr<Program>& program = programs_["skin"];
  if (!program)
    program = std::make_unique<Program>("skin", shaders::skin_vertex,
                                        std::string(shaders::solid_head) + shaders::skin_fragment);
  begin_solids(*program, list, view);
  program->set("night", list.shading == Shading::space ? 1 : 0);
  program->set("plain", list.shading == Shading::outline || list.shading == Shading::flat ? 1 : 0);
  gl::Disable(GL_CULL_FACE);
  begin_blending();
  gl::DepthMask(GL_TRUE);
  skins_.draw(*program);
  end_blending();
  gl::Enable(GL_CULL_FACE);
}

void Renderer::begin_blending() {
  gl::Enable(GL_BLEND);
  gl::BlendEquation(GL_FUNC_ADD);
  gl::BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl::DepthMask(GL_FALSE);
}

void Renderer::end_blending() {
  gl::Disable(GL_BLEND);
  gl::DepthMask(GL_TRUE);
}

// Returns whether anything is not as it was in the picture before.
bool Renderer::upload_solids(const DrawList& list) {
  Solids solids = solids_of(list);
  const int height = frame_.height();
  bool moved = capsules_.set(std::move(solids.capsules), list.camera, height);
  moved |= balls_.set(std::move(solids.balls), list.camera, height);
  moved |= cylinders_.set(std::move(solids.cylinders), list.camera, height);
  moved |= plates_.set(std::move(solids.plates), list.camera, height);
  moved |= skins_.set(list.skins, list.camera);
  std::vector<SolidInstance> ghosts = tubes_of(list.ghosts);
  for (std::size_t i = 0; i < ghosts.size(); ++i) ghosts[i].metal = list.ghosts[i].color.a;
  ghosts_.set(std::move(ghosts), list.camera, height);
  return moved;
}

// Where bodies may be seen, with a margin.
PixelRect Renderer::solid_part(const DrawList& list, const Matrix4f& camera) const {
  const Vec3f forward = (list.camera.target - list.camera.eye).normalized();
  const float right = camera.row(0).head<3>().norm(), up = camera.row(1).head<3>().norm();
  Eigen::Array2f low(1, 1), high(-1, -1);
  bool near = false;
  const auto add = [&](const Vec3f& end, float r) {
    near |= forward.dot(end - list.camera.eye) - r < list.camera.near_plane;
    const Eigen::Vector4f clip = camera * end.homogeneous();
    const float reach = list.camera.parallel_height > 0 ? 0.0f : r;  // towards the camera
    const Eigen::Array2f at = clip.head<2>().array() / clip.w(),
                         around = (Eigen::Array2f(right, up) + at.abs()) * r / (clip.w() - reach);
    low = low.min(at - around), high = high.max(at + around);
  };
  for (const RendererBodies* bodies : {&capsules_, &balls_, &cylinders_, &plates_, &ghosts_})
    for (const SolidInstance& body : bodies->bodies())
      for (const Vec3f& end : {body.a, body.b}) add(end, 1.1f * std::max(body.radius_a, body.radius_b));
  for (const Skin& skin : list.skins)
    for (const SkinVertex& v : skin.vertices) add(v.at, 0);
  if (near) return frame_.whole();
  const auto pixel = [](float ndc, int size, float pad) {
    return static_cast<int>(
        std::clamp(0.5f * (1 + ndc) * static_cast<float>(size) + pad, 0.0f, static_cast<float>(size)));
  };
  const int w = frame_.width(), h = frame_.height();
  return {pixel(low.x(), w, -2), pixel(low.y(), h, -2), pixel(high.x(), w, 3), pixel(high.y(), h, 3)};
}

// Bodies have edges and are drawn with several samples a pixel, in the part of the picture where they are.
// What is behind them has none; while the camera rests it is drawn once.
void Renderer::paint(const DrawList& list, bool coarse) {
  const bool moved = upload_solids(list) || list.ground.shown != floor_shown_ || list.ground.z != floor_z_;
  const float aspect = static_cast<float>(frame_.width()) / static_cast<float>(frame_.height());
  View view;
  view.camera = view_projection(list.camera, aspect);
  view.light = light_projection(list.light_direction, list.center, list.radius);
  view.solid = solid_part(list, view.camera);

  gl::Disable(GL_BLEND);
  gl::Disable(GL_SCISSOR_TEST);
  gl::DepthFunc(GL_LEQUAL);
  gl::DepthMask(GL_TRUE);
  gl::CullFace(GL_BACK);
  if (moved || view.light != shadows_from_) draw_shadows(list, view.light);
  gl::Disable(GL_DEPTH_TEST);
  gl::Disable(GL_CULL_FACE);  // the floor may be seen from below
  draw_backdrop(list, view.camera);
  backdrop_.copy_to(frame_, 0, 0);
  frame_.bind_resolved();
  if (list.ground.shown) draw_floor_shadow(list, view);

  if (!coarse) frame_.spread(view.solid);
  gl::Enable(GL_DEPTH_TEST);
  gl::Enable(GL_CULL_FACE);
  frame_.clear_depth(view.solid);
  shadow_map_.use_as_texture(0);
  draw_solids(list, view);
  draw_skins(list, view);
  draw_ghosts(list, view);
  gl::Disable(GL_CULL_FACE);
  if (!coarse) frame_.resolve(view.solid);
  text_.draw(list, frame_.width(), frame_.height());
  transparent_ = list.transparent;
}

Image Renderer::draw(const DrawList& list) {
  paint(list);
  return read();
}

Image Renderer::read() const {
  Image image = frame_.read();
  if (transparent_) divide_by_alpha(image);
  return image;
}

}  // namespace unfurl
