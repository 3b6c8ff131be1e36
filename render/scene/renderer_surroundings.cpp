// SPDX-License-Identifier: BSD-3-Clause
// What is behind the bodies: background, grid, and shadows, on the floor and in the map that bodies read.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "render/gl/functions.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/shaders.hpp"

namespace unfurl {
namespace {

using Eigen::Matrix4f;

constexpr int blur_reach = 26;  // [pixels of the shade on the floor]

Eigen::Vector4f as_vector(const Color& c) {
  return {c.r, c.g, c.b, c.a};
}

// The part of a square map of the light's view that bodies may darken, blurred by `reach` pixels.
PixelRect shaded_part(std::initializer_list<const RendererBodies*> all, const std::vector<Skin>& skins,
                      const Matrix4f& light, int side, int reach) {
  Eigen::Array2f low(1, 1), high(-1, -1);
  const float scale = light.row(0).head<3>().norm();
  const auto add = [&](const Vec3f& end, float radius) {
    const Eigen::Array2f at = (light * end.homogeneous()).head<2>().array();
    low = low.min(at - scale * radius), high = high.max(at + scale * radius);
  };
  for (const RendererBodies* bodies : all)
    for (const SolidInstance& body : bodies->bodies())
      for (const Vec3f& end : {body.a, body.b}) add(end, std::max(body.radius_a, body.radius_b));
  for (const Skin& skin : skins)
    for (const SkinVertex& v : skin.vertices) add(v.at, 0);
  const auto pixel = [&](float ndc, int pad) {
    return std::clamp(
        static_cast<int>(0.5f * (1 + std::clamp(ndc, -1.0f, 1.0f)) * static_cast<float>(side)) + pad, 0,
        side);
  };
  return {pixel(low.x(), -reach), pixel(low.y(), -reach), pixel(high.x(), reach + 1),
          pixel(high.y(), reach + 1)};
}

// The floor's depth in the light's map is linear there: z' = c . (x', y', 1) on the plane of that height.
Vec3f floor_depth(const Matrix4f& light, float height) {
  const Eigen::Matrix2f across = light.topLeftCorner<2, 2>();
  const Eigen::Vector2f start = light.block<2, 1>(0, 2) * height + light.block<2, 1>(0, 3);
  const Eigen::RowVector2f slope = light.block<1, 2>(2, 0) * across.inverse();
  const float at_zero = light(2, 2) * height + light(2, 3) - slope.dot(start);
  // From -1..1 to 0..1 in all three.
  return {slope.x(), slope.y(), 0.5f * (at_zero - slope.x() - slope.y()) + 0.5f};
}

// The directions that pixels look in; in a parallel picture, as if it had the usual opening.
void set_view_rays(const Program& program, const Camera& camera, int width, int height) {
  const Vec3f forward = (camera.target - camera.eye).normalized(),
              right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const float slope = std::tan(0.5f * camera.vertical_field_of_view);
  program.set("view_forward", forward);
  program.set("view_right", Vec3f(slope * right));
  program.set("view_up", Vec3f(slope * up));
  program.set("picture_middle",
              Eigen::Vector2f(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)));
}

}  // namespace

void Renderer::set_planet(const Program& program, const DrawList& list) const {
  const float half = list.planet_half_angle;
  const Vec3f to = list.planet.normalized();
  program.set("planet", Eigen::Vector4f(to.x(), to.y(), to.z(), half > 0 ? std::cos(half) : 2.0f));
}

void Renderer::set_background(const Program& program, const DrawList& list) const {
  program.set("background_top", as_vector(list.background_top));
  program.set("background_bottom", as_vector(list.background_bottom));
  program.set("picture_height", static_cast<float>(frame_.height()));
}

// The depth map, for shadows of bodies on bodies; from it, for the floor, what of the light is missing,
// blurred. One read of that costs a floor pixel a sixth of as many reads of the depth map as would be as
// soft.
void Renderer::draw_shadows(const DrawList& list, const Matrix4f& light) {
  gl::Enable(GL_DEPTH_TEST);
  gl::Enable(GL_CULL_FACE);
  shadow_map_.bind();
  gl::Clear(GL_DEPTH_BUFFER_BIT);
  gl::Enable(GL_POLYGON_OFFSET_FILL);
  gl::PolygonOffset(1.5f, 2.0f);
  depth_.use();
  depth_.set("view_projection", light);
  for (const RendererBodies* bodies : {&capsules_, &balls_, &cylinders_})
    bodies->draw_shadow();  // lugs: too small
  if (!list.skins.empty()) {
    gl::Disable(GL_CULL_FACE);
    skin_depth_.use();
    skin_depth_.set("view_projection", light);
    skin_depth_.set("pushed", 0.025f);
    skins_.draw_shadow(skin_depth_);
  }
  gl::Disable(GL_POLYGON_OFFSET_FILL);
  if (list.ground.shown) {
    shaded_ = shaded_part({&capsules_, &balls_, &cylinders_, &plates_}, list.skins, light,
                          shade_on_floor_.side(), blur_reach);
    blur_shadows(list, light);
  }
  shadows_from_ = light;
  floor_shown_ = list.ground.shown;
  floor_z_ = list.ground.z;
}

void Renderer::blur_shadows(const DrawList& list, const Matrix4f& light) const {
  gl::Disable(GL_DEPTH_TEST);
  gl::Disable(GL_CULL_FACE);
  gl::BindVertexArray(empty_array_);
  shadow_map_.use_as_texture(0);
  shadow_map_.compare_depths(false);
  gl::ClearColor(0, 0, 0, 0);
  const TextureTarget* targets[] = {&shade_across_, &shade_on_floor_, &soft_across_, &soft_on_floor_};
  const Program* programs[] = {&shade_from_depth_, &shade_narrow_, &shade_wide_, &shade_wide_};
  for (int pass = 0; pass < 4; ++pass) {
    const TextureTarget& target = *targets[pass];
    const int part = shade_on_floor_.side() / target.side();
    const Program& program = *programs[pass];
    program.use();
    if (pass == 0) {
      program.set("depth", 0);
      program.set("texels", shadow_map_.side() / shade_on_floor_.side());
      program.set("floor_depth", floor_depth(light, list.ground.z));
    } else {
      const TextureTarget& source = *targets[pass - 1];
      const auto texel = 1 / static_cast<float>(target.side());
      program.set("shade", 1);
      program.set("way", pass == 2 ? Eigen::Vector2f(texel, 0) : Eigen::Vector2f(0, texel));
      program.set("coarser", static_cast<float>(source.side()) / static_cast<float>(target.side()));
      source.use_as_texture(1);
    }
    target.bind();
    gl::Clear(GL_COLOR_BUFFER_BIT);
    gl::Enable(GL_SCISSOR_TEST);
    gl::Scissor(shaded_.x0 / part, shaded_.y0 / part, (shaded_.x1 - shaded_.x0) / part,
                (shaded_.y1 - shaded_.y0) / part);
    if (!shaded_.empty()) gl::DrawArrays(GL_TRIANGLES, 0, 3);
    gl::Disable(GL_SCISSOR_TEST);
  }
  shadow_map_.use_as_texture(0);
  shadow_map_.compare_depths(true);
}

const Program& Renderer::begin_floor(const Program& program, const DrawList& list,
                                     const Matrix4f& camera) const {
  const Ground& g = list.ground;
  program.use();
  program.set("view_projection", camera);
  program.set("center", Eigen::Vector2f(g.center.head<2>()));
  program.set("reach", g.fade);
  gl::BindVertexArray(empty_array_);
  begin_blending();
  return program;
}

const Program& Renderer::background_program(const DrawList& list) {
  const bool stars = list.stars > 0, planet = list.planet_half_angle > 0;
  const std::string name =
      std::string("background") + (stars ? " with stars" : "") + (planet ? " with a planet" : "");
  std::unique_ptr<Program>& program = programs_[name];
  if (!program)
    program =
        std::make_unique<Program>(name, shaders::background_vertex,
                                  std::string(shaders::version) + (stars ? "#define STARS\n" : "") +
                                      (planet ? "#define PLANET\n" : "") + shaders::background_fragment);
  return *program;
}

void Renderer::draw_backdrop(const DrawList& list, const Matrix4f& camera) {
  const Ground& g = list.ground;
  std::vector<float> shows(camera.data(), camera.data() + 16);
  for (const Color& c : {list.background_top, list.background_bottom})
    shows.insert(shows.end(), {c.r, c.g, c.b, c.a});
  const bool grid = g.shown && g.grid;
  shows.insert(shows.end(), {list.stars, list.transparent ? 1.0f : 0.0f, grid ? 1.0f : 0.0f,
                             list.planet_half_angle, list.planet.x(), list.planet.y(), list.planet.z()});
  if (list.planet_half_angle > 0)
    shows.insert(shows.end(), list.light_direction.data(), list.light_direction.data() + 3);
  if (grid) {
    shows.insert(shows.end(), {g.z, g.cell, g.fade, g.center.x(), g.center.y()});
    shows.insert(shows.end(), {g.lines.r, g.lines.g, g.lines.b, g.lines.a});
  }
  if (shows == backdrop_of_) return;
  backdrop_of_ = std::move(shows);

  backdrop_.bind();
  gl::ClearColor(0, 0, 0, 0);
  gl::Clear(GL_COLOR_BUFFER_BIT);
  gl::BindVertexArray(empty_array_);
  if (!list.transparent) {
    const Program& background = background_program(list);
    background.use();
    background.set("stars", list.stars);
    set_background(background, list);
    set_planet(background, list);
    set_view_rays(background, list.camera, frame_.width(), frame_.height());
    background.set("to_light", Vec3f(list.light_direction.normalized()));
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
  }
  if (!grid) return;
  const Program& program = begin_floor(grid_, list, camera);
  program.set("picture_height", static_cast<float>(frame_.height()));
  program.set("cell", g.cell);
  program.set("lines_color", as_vector(g.lines));
  program.set("corner", Vec3f(g.center.x() - g.fade, g.center.y() - g.fade, g.z));
  program.set("side_u", Vec3f(2 * g.fade, 0, 0));
  program.set("side_v", Vec3f(0, 2 * g.fade, 0));
  gl::DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  end_blending();
}

// Only where there is some: the shaded part of the map, carried along the light to the floor.
void Renderer::draw_floor_shadow(const DrawList& list, const View& view) const {
  if (shaded_.empty()) return;
  const float z = list.ground.z, per_pixel = 2.0f / static_cast<float>(shade_on_floor_.side());
  const Eigen::Matrix2f across = view.light.topLeftCorner<2, 2>().inverse();
  const auto on_floor = [&](int x, int y) {
    const Eigen::Vector2f map(per_pixel * static_cast<float>(x) - 1, per_pixel * static_cast<float>(y) - 1);
    const Eigen::Vector2f at =
        across * (map - z * view.light.block<2, 1>(0, 2) - view.light.block<2, 1>(0, 3));
    return Vec3f(at.x(), at.y(), z);
  };
  const Vec3f corner = on_floor(shaded_.x0, shaded_.y0);
  const Program& program = begin_floor(floor_shadow_, list, view.camera);
  program.set("corner", corner);
  program.set("side_u", Vec3f(on_floor(shaded_.x1, shaded_.y0) - corner));
  program.set("side_v", Vec3f(on_floor(shaded_.x0, shaded_.y1) - corner));
  program.set("floor_height", z);
  program.set("light_projection", view.light);
  program.set("shade", 1);
  program.set("soft_shade", 2);
  program.set("shadow_color", as_vector(list.ground.shadow));
  shade_on_floor_.use_as_texture(1);
  soft_on_floor_.use_as_texture(2);
  gl::DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  end_blending();
}

}  // namespace unfurl
