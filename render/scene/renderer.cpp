#include "render/scene/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "render/gl/functions.hpp"
#include "render/scene/shaders.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
namespace {

using Eigen::Matrix4f;

constexpr int shadow_side = 1536, shade_side = 384;  // [pixels]

constexpr std::size_t ghost_body = 3;

Eigen::Vector4f as_vector(const Color& c) {
  return {c.r, c.g, c.b, c.a};
}

// The camera's place, or the direction to it where the projection is parallel.
Eigen::Vector4f eye_of(const Camera& camera) {
  if (camera.parallel_height <= 0) return {camera.eye.x(), camera.eye.y(), camera.eye.z(), 1};
  const Vec3f back = (camera.eye - camera.target).normalized();
  return {back.x(), back.y(), back.z(), 0};
}

constexpr float few_pixels = 2.5f;  // of radius: with so few, six sides look as round as twelve

bool same(const std::vector<SolidInstance>& a, const std::vector<SolidInstance>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

// The largest radius in pixels that a body has in the picture, roughly.
float thickest_pixels(const std::vector<SolidInstance>& bodies, const Camera& camera, int height) {
  const Vec3f forward = (camera.target - camera.eye).normalized();
  const float slope = 2 * std::tan(0.5f * camera.vertical_field_of_view);
  float most = 0;
  for (const SolidInstance& body : bodies) {
    const float depth = std::max(
        camera.near_plane, std::min(forward.dot(body.a - camera.eye), forward.dot(body.b - camera.eye)));
    const float visible = camera.parallel_height > 0 ? camera.parallel_height : slope * depth;
    most = std::max(most, std::max(body.radius_a, body.radius_b) / visible);
  }
  return most * static_cast<float>(height);
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

}  // namespace

Renderer::Renderer(GlContext& context, int width, int height, int samples)
    : frame_((context.make_current(), width), height, samples),
      depth_("shadow", shaders::solid_vertex, shaders::depth_fragment),
      shade_("shade", shaders::background_vertex, shaders::shade_fragment),
      background_("background", shaders::background_vertex, shaders::background_fragment),
      ground_("ground", shaders::ground_vertex, shaders::ground_fragment),
      bodies_{make_body(capsule_mesh(12, 2), capsule_mesh(6, 1)),
              make_body(capsule_mesh(16, 4), capsule_mesh(8, 2)),
              make_body(cylinder_mesh(12), cylinder_mesh(6)),
              make_body(capsule_mesh(8, 1), capsule_mesh(6, 1))},
      shadow_map_(TextureKind::depth, shadow_side),
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
  depth_.set("eye", Eigen::Vector4f(0, 0, 1, 0));
  depth_.set("nearer", 0.0f);
  draw_bodies(&Body::coarse);
  gl::Disable(GL_POLYGON_OFFSET_FILL);
  shadow_map_.use_as_texture(0);
  if (!list.ground.shown) return;
  gl::Disable(GL_DEPTH_TEST);
  gl::BindVertexArray(empty_array_);
  shade_.use();
  shade_.set("depth", 0);
  shade_.set("shade", 1);
  shade_.set("texels", shadow_map_.side() / shade_on_floor_.side());
  shadow_map_.compare_depths(false);
  for (const bool across : {true, false}) {
    (across ? shade_across_ : shade_on_floor_).bind();
    if (!across) shade_across_.use_as_texture(1);
    shade_.set("across", across ? 1 : 0);
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
  }
  shade_on_floor_.use_as_texture(1);
  shadow_map_.use_as_texture(0);
  shadow_map_.compare_depths(true);
  gl::Enable(GL_DEPTH_TEST);
}

const Program& Renderer::solid_program(const char* name, const char* fragment) {
  std::unique_ptr<Program>& program = solid_[name];
  if (!program)
    program =
        std::make_unique<Program>(name, shaders::solid_vertex, std::string(shaders::solid_head) + fragment);
  return *program;
}

const Program& Renderer::begin_solids(const char* name, const char* fragment, const DrawList& list,
                                      const Matrix4f& view, const Matrix4f& light) {
  const Program& program = solid_program(name, fragment);
  program.use();
  set_background(program, list);
  program.set("view_projection", view);
  program.set("light_projection", light);
  program.set("shadow_map", 0);
  program.set("eye", eye_of(list.camera));
  program.set("nearer", 0.0f);
  program.set("to_light", Vec3f(list.light_direction.normalized()));
  program.set("fade_center", list.center);
  program.set("fade", Eigen::Vector2f(list.radius, list.depth_fade));
  const float floor = list.ground.shown ? list.ground.z : -1e6f;
  program.set("floor_height_reach", Eigen::Vector2f(floor, 0.25f * list.radius));
  return program;
}

void Renderer::draw_solids(const DrawList& list, const Matrix4f& view, const Matrix4f& light) {
  if (list.shading == Shading::outline) return draw_outlines(list, view, light);
  if (list.shading == Shading::studio) begin_solids("studio", shaders::studio_fragment, list, view, light);
  if (list.shading == Shading::space) begin_solids("space", shaders::space_fragment, list, view, light);
  if (list.shading == Shading::flat) begin_solids("flat", shaders::flat_fragment, list, view, light);
  draw_bodies(&Body::fine);
}

// What is seen first; then, blended over it, the lines of what lies well behind.
void Renderer::draw_outlines(const DrawList& list, const Matrix4f& view, const Matrix4f& light) {
  const Program& program = begin_solids("outline", shaders::outline_fragment, list, view, light);
  program.set("line_width", std::max(1.0f, static_cast<float>(frame_.height()) / 600.0f));
  program.set("hidden", 0);
  draw_bodies(&Body::fine);
  program.set("hidden", 1);
  program.set("nearer", list.hidden_gap);
  gl::DepthFunc(GL_GREATER);
  begin_blending();
  draw_bodies(&Body::fine);
  end_blending();
  gl::DepthFunc(GL_LEQUAL);
}

// Ghosts do not cover each other nor what is solid: drawn last, blended, and each pixel once.
void Renderer::draw_ghosts(const DrawList& list, const Matrix4f& view, const Matrix4f& light) {
  if (list.ghosts.empty()) return;
  std::vector<SolidInstance> tubes = tubes_of(list.ghosts);
  for (std::size_t i = 0; i < tubes.size(); ++i) tubes[i].metal = list.ghosts[i].color.a;
  upload(bodies_[ghost_body], tubes);
  begin_solids("ghost", shaders::ghost_fragment, list, view, light);
  begin_blending();
  gl::DepthMask(GL_TRUE);
  draw_body(bodies_[ghost_body], &Body::fine);
  end_blending();
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
    ground_.set("grid_strength", list.ground.grid ? 1.0f : 0.0f);
    ground_.set("transparent", list.transparent ? 1 : 0);
    gl::DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  if (list.transparent) return;
  background_.use();
  background_.set("stars", list.stars);
  set_background(background_, list);
  gl::DrawArrays(GL_TRIANGLES, 0, 3);
}

// Returns whether anything is not as it was in the picture before.
bool Renderer::upload_solids(const DrawList& list) {
  Solids solids = solids_of(list);
  const bool moved = !same(solids.capsules, solids_.capsules) || !same(solids.balls, solids_.balls) ||
                     !same(solids.cylinders, solids_.cylinders) || list.ground.shown != floor_shown_;
  if (moved) {
    upload(bodies_[0], solids.capsules);
    upload(bodies_[1], solids.balls);
    upload(bodies_[2], solids.cylinders);
    solids_ = std::move(solids);
    floor_shown_ = list.ground.shown;
  }
  bodies_[0].small = thickest_pixels(solids_.capsules, list.camera, frame_.height()) < few_pixels;
  bodies_[1].small = thickest_pixels(solids_.balls, list.camera, frame_.height()) < few_pixels;
  bodies_[2].small = thickest_pixels(solids_.cylinders, list.camera, frame_.height()) < few_pixels;
  bodies_[ghost_body].instance_count = 0;
  return moved;
}

void Renderer::paint(const DrawList& list, bool coarse) {
  const bool moved = upload_solids(list);
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
  if (moved || light != shadows_from_) draw_shadows(list, light);
  shadows_from_ = light;
  shadow_map_.use_as_texture(0);
  shade_on_floor_.use_as_texture(1);
  frame_.bind(coarse);
  gl::ClearColor(0, 0, 0, 0);  // where there is a background it covers what is left
  gl::Clear(GL_DEPTH_BUFFER_BIT | (list.transparent ? GL_COLOR_BUFFER_BIT : 0U));
  draw_solids(list, view, light);
  gl::Disable(GL_CULL_FACE);  // the floor may be seen from below
  draw_surroundings(list, view, light);
  gl::Enable(GL_CULL_FACE);
  draw_ghosts(list, view, light);
  gl::Disable(GL_CULL_FACE);
  if (!coarse) frame_.resolve();
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
