// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/skins.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace skins_test {

namespace {

std::vector<Vec3> ring(int n, double radius, const Vec3& center) {
  std::vector<Vec3> out;
  for (int k = 0; k < n; ++k)
    out.push_back(center + radius * Vec3(std::cos(2 * pi * k / n), std::sin(2 * pi * k / n), 0));
  return out;
}

}  // namespace

TEST_CASE("a paraboloid has its focus where its ratio says") {
  const double radius = 2.3, ratio = 0.41, focal_length = ratio * 2 * radius;
  const Vec3 center(0.3, -0.7, 1.9);
  SceneSurface surface;
  surface.kind = "paraboloid", surface.shape = "paraboloid", surface.focal_ratio = ratio;
  // 48 nodes: every point of the fan lies on a ray from the middle to a node.
  const std::vector<Vec3> edge = ring(48, radius, center);
  const Skin skin = skin_of(surface, edge, plan_of(surface, edge, edge));
  REQUIRE(skin.vertices.size() > 400);
  double lowest = 1e9;
  for (const SkinVertex& v : skin.vertices) lowest = std::min(lowest, static_cast<double>(v.at.z()));
  for (const SkinVertex& v : skin.vertices) {
    // Every point of a paraboloid is as far from its focus as from its directrix. Single precision at 2 m.
    const Vec3 at = v.at.cast<double>(), focus(center.x(), center.y(), lowest + focal_length);
    CHECK((at - focus).norm() == Approx(at.z() - (lowest - focal_length)).margin(2e-6));
  }
}

TEST_CASE("a surface with notches covers what is within its edge once and nothing else") {
  // A U, a comb, a dart and a spiral, in a plane somewhere and around either way; their areas by hand.
  struct Shape {
    std::vector<Vec3> edge;
    double area;
  };
  const Shape shapes[] = {
      {{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 7},
      {{{0, 0, 0},
        {5, 0, 0},
        {5, 2, 0},
        {4, 2, 0},
        {4, 1, 0},
        {3, 1, 0},
        {3, 2, 0},
        {2, 2, 0},
        {2, 1, 0},
        {1, 1, 0},
        {1, 2, 0},
        {0, 2, 0}},
       8},
      {{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1.5, 1, 0}}, 0.5},
      {{{0, 0, 0},
        {4, 0, 0},
        {4, 4, 0},
        {1, 4, 0},
        {1, 2, 0},
        {2, 2, 0},
        {2, 3, 0},
        {3, 3, 0},
        {3, 1, 0},
        {0, 1, 0}},
       10}};
  const Mat3 turns[] = {Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized().toRotationMatrix(),
                        Mat3::Identity()};
  for (const Shape& shape : shapes)
    for (const bool back : {false, true})
      for (const Mat3& turn : turns) {
        std::vector<Vec3> edge;
        for (const Vec3& p : shape.edge) edge.push_back(turn * p + Vec3(0.3, -2, 1));
        if (back) std::ranges::reverse(edge);
        SceneSurface surface;
        surface.kind = "membrane";
        const Skin skin = skin_of(surface, edge, plan_of(surface, edge, edge));
        CAPTURE(edge.size(), back);
        // Triangles of n nodes that turn one way and have the area of the shape together lie side by side in
        // it.
        REQUIRE(skin.triangles.size() == 3 * (edge.size() - 2));
        double sum = 0;
        const Vec3 up = skin.vertices.front().normal.cast<double>();
        for (std::size_t i = 0; i < skin.triangles.size(); i += 3) {
          const auto at = [&](std::size_t k) -> Vec3 {
            return skin.vertices[skin.triangles[i + k]].at.cast<double>();
          };
          const double twice = up.dot((at(1) - at(0)).cross(at(2) - at(0)));
          CHECK(twice > -1e-5);  // none where nodes are in one line
          sum += 0.5 * twice;
        }
        CHECK(sum == Approx(shape.area).epsilon(1e-5));  // single precision at 5 m
      }
  // What lines from its middle stay within is drawn as ever, dents and all.
  const std::vector<Vec3> star = {{1, 0, 0},  {0.4, 0.4, 0},   {0, 1, 0},  {-0.4, 0.4, 0},
                                  {-1, 0, 0}, {-0.4, -0.4, 0}, {0, -1, 0}, {0.4, -0.4, 0}};
  CHECK(skin_of(SceneSurface(), star, plan_of(SceneSurface(), star, star)).vertices.size() > 400);
}

TEST_CASE("a surface keeps its triangles while a notch comes and goes") {
  // A corner that swings in the plane from outside to within the others.
  const std::vector<Vec3> kite = {{0, 0, 0}, {2, 0, 0}, {1.6, 1.6, 0}, {0, 2, 0}},
                          dart = {{0, 0, 0}, {2, 0, 0}, {0.9, 0.9, 0}, {0, 2, 0}};
  SceneSurface surface;
  surface.kind = "membrane";
  for (const bool opens : {false, true}) {
    const SkinPlan plan = plan_of(surface, opens ? dart : kite, opens ? kite : dart);
    CHECK(plan.cut.empty() == opens);  // as it is in the last pose
    const Skin one = skin_of(surface, kite, plan), other = skin_of(surface, dart, plan);
    CHECK(one.triangles == other.triangles);
    CHECK(one.vertices.size() == other.vertices.size());
    CHECK(one.vertices.size() == (opens ? 81 : 4));  // 8 x 8 parts; the nodes
  }
}

TEST_CASE("a panel is spanned between its edges, whichever way its nodes go around") {
  const std::vector<Vec3> edge = {{0, 0, 1}, {2, 0, 1.3}, {2, 1, 1}, {0, 1, 0.8}};
  SceneSurface surface;
  surface.kind = "solar_panel";
  const std::vector<Vec3> back(edge.rbegin(), edge.rend());
  for (const Skin& skin : {skin_of(surface, edge, plan_of(surface, edge, edge)),
                           skin_of(surface, back, plan_of(surface, back, back))}) {
    for (const SkinVertex& v : skin.vertices) {
      const double x = static_cast<double>(v.at.x()) / 2, y = static_cast<double>(v.at.y());
      const double z = (1 - y) * ((1 - x) * 1 + x * 1.3) + y * ((1 - x) * 0.8 + x * 1);
      CHECK(static_cast<double>(v.at.z()) == Approx(z).margin(1e-6));
      CHECK(v.normal.z() > 0.5f);  // the front is above
    }
    CHECK(skin.opacity == 1.0f);
  }
}

namespace {

const std::string linkage = R"(
[structure]
kind = "hoop"
units = 4
fold_angle = 80.0
[solver]
end_time = 10.0
[[surfaces]]
kind = "net"
nodes = ["T*"]
cells = 7
[[surfaces]]
kind = "membrane"
nodes = ["B0", "Mb0", "B1"]
enabled = false
)";

}  // namespace

TEST_CASE("surfaces are carried by their nodes, read back as written, and wrong names are told") {
  const Scene scene = read_scene_text(linkage, "net.toml");
  REQUIRE(scene.surfaces.size() == 2);
  const Scene again = read_scene_text(scene_text(scene), "again.toml");
  CHECK(again.surfaces == scene.surfaces);
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  const FrameBuilder frames(run.trajectory, film_style(scene, run, diagnostics));
  const DrawList list = frames.build(1.7);
  REQUIRE(list.skins.size() == 1);  // the other is not enabled
  const VectorXd q = run.trajectory.positions_at(1.7);
  const Structure& s = run.trajectory.structure();
  for (std::size_t i = 0; i < s.node_copies.size(); ++i) {
    if (s.node_copies[i].name.front() != 'T') continue;
    float least = 1e9f;
    for (const SkinVertex& v : list.skins[0].vertices)
      least = std::min(least, (v.at - q.segment<3>(3 * static_cast<Index>(i)).cast<float>()).norm());
    CHECK(least < 1e-5f);
  }
  std::string wrong = linkage;
  wrong.replace(wrong.find("\"T*\""), 4, "\"T0\", \"T9\", \"T1\"");
  CHECK_THROWS_WITH(build_model(read_scene_text(wrong, "x.toml")),
                    Catch::Contains("surfaces[0].nodes") && Catch::Contains("no node matches 'T9'"));
  wrong.replace(wrong.find("\"T9\", "), 6, "");
  CHECK_THROWS_WITH(build_model(read_scene_text(wrong, "x.toml")), Catch::Contains("three nodes"));
}

TEST_CASE("a surface and trails named by a pattern are of the scene's nodes, however rods are cut") {
  const auto nodes = [](const std::string& segments, const std::string& pattern) {
    const Scene scene = read_scene_text("structure.segments = " + segments + R"(
structure.kind = "custom"
structure.youngs_modulus = 7e10
structure.rod_model = "elastic"
structure.nodes = [{name = "N1", position = [0, 0, 0], fixed = true}, {name = "N2", position = [1, 0, 0], fixed = true},
  {name = "N3", position = [1, 0, 1]}, {name = "N4", position = [0, 0, 1]}]
structure.rods = [{nodes = ["N1", "N4"], mass = 1, area = 1e-4}, {nodes = ["N2", "N3"], mass = 1, area = 1e-4},
  {nodes = ["N3", "N4"], mass = 1, area = 1e-4}]
[render]
trails = "N*"
[[surfaces]]
kind = "membrane"
nodes = [)" + pattern + "]\n",
                                        "sail.toml");
    const auto model = build_model(scene);
    check_film_names(scene, model->structure);
    return shown_surfaces(scene, model->structure).front().nodes;
  };
  for (const char* segments : {"1", "4"}) CHECK(nodes(segments, "'N*'") == std::vector<int>{0, 1, 2, 3});
  CHECK(nodes("4", "'N1', 'N2', 'N*.2'").size() == 5);
  CHECK_THROWS_WITH(nodes("4", "'N1', 'N2', 'N*4?1'"), Catch::Contains("matches nodes within cut rods only"));
}

TEST_CASE("a mesh lets light through and shades the floor, a panel does not") {
  const auto context = make_offscreen_context();
  constexpr int width = 320, height = 180;
  Renderer renderer(*context, width, height);
  DrawList list;
  list.camera.eye = {0, -8, 6};
  list.camera.target = {0, 0, 0.5f};
  list.camera.vertical_field_of_view = 0.6f;
  list.radius = 4;
  list.light_direction = {0, 0, 1};
  list.ground.cell = 100;
  list.ground.fade = 30;
  const auto brightness = [&](const Image& image, const Vec3f& at) {
    const Vec3f p = project(list.camera, width, height, at);
    const auto i = 4 * (static_cast<std::size_t>(p.y()) * width + static_cast<std::size_t>(p.x()));
    return image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2];
  };
  const Vec3f below(0.4f, 0.15f, 0), seen(0.4f, 0.15f, 0);
  const int bare = brightness(renderer.draw(list), below);
  const auto with = [&](const char* kind) {
    SceneSurface surface;
    surface.kind = kind;
    // High above: its shadow is below it, the camera sees the floor past it.
    list.skins = {
        skin_of(surface, {{-1.5, -1.5, 3.0}, {1.5, -1.5, 3.0}, {1.5, 1.5, 3.0}, {-1.5, 1.5, 3.0}}, {})};
    return brightness(renderer.draw(list), seen);
  };
  const int mesh = with("mesh"), panel = with("solar_panel");
  CHECK(mesh < bare - 30);
  CHECK(panel < mesh - 30);
}

TEST_CASE("a surface keeps its front while it is turned over") {
  // A panel that turns by 180 degrees about A-B, and nothing else: every point of its surface keeps its
  // distance from A, B and C; single precision at 2 m.
  const std::string panel =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
      "{name = 'B', position = [0, 1, 0], fixed = true},\n"
      "{name = 'C', position = [1.3, 1, 0], velocity = [0, 0, 4.084], mass = 1},\n"
      "{name = 'D', position = [1.3, 0, 0], velocity = [0, 0, 4.084], mass = 1}]\n"
      "rods = [{nodes = ['A', 'D'], mass = 0.1}, {nodes = ['B', 'C'], mass = 0.1}, {nodes = ['C', 'D'], mass "
      "= 0.1},\n"
      "{nodes = ['A', 'C'], mass = 0.1}]\n[solver]\nend_time = 1\nstep = 0.01\n[[surfaces]]\n"
      "nodes = ['A', 'D', 'C', 'B']\nkind = ";
  for (const std::string kind : {"'solar_panel'", "'paraboloid'\nshape = 'paraboloid'"}) {
    const Scene scene = read_scene_text(panel + kind + "\n", "panel.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Diagnostics diagnostics = diagnose(run);
    const FrameBuilder frames(run.trajectory, film_style(scene, run, diagnostics));
    const auto distances = [&](double t) {
      const DrawList list = frames.build(t);
      const VectorXd q = run.trajectory.positions_at(t);
      std::vector<float> out;
      for (const SkinVertex& v : list.skins.at(0).vertices)
        for (const Index n : {0, 1, 2}) out.push_back((v.at - q.segment<3>(3 * n).cast<float>()).norm());
      return out;
    };
    const std::vector<float> first = distances(0);
    for (const double t : {0.3, 0.49, 0.52, 0.8, 1.0}) {
      const std::vector<float> now = distances(t);
      REQUIRE(now.size() == first.size());
      float off = 0;
      for (std::size_t i = 0; i < now.size(); ++i) off = std::max(off, std::abs(now[i] - first[i]));
      CAPTURE(kind, t);
      CHECK(off < 1e-5f);
    }
    // At the end the front is above, as in a run that ends where the structure is deployed.
    CHECK(frames.build(1.0).skins.at(0).vertices[0].normal.z() > 0.9f);
  }
}

}  // namespace skins_test
