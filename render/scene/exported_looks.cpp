// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/exported_looks.hpp"

#include <cmath>
#include <utility>

#include "render/scene/film_style.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/hardware.hpp"
#include "render/scene/skins.hpp"
#include "render/scene/solid_mesh.hpp"

namespace unfurl {
namespace {

double linear(float encoded) {
  return std::pow(encoded, 2.2);
}

ExportedMaterial exported_material(const RenderOptions& options, const std::string& group) {
  const auto [color, finish] = coat_of_material(material_for(options, group));
  const Surface surface = surface_of(finish);
  ExportedMaterial out{
      group, -1, 0, 0, static_cast<double>(surface.metal), static_cast<double>(surface.roughness)};
  if (color.a > 0) out.red = linear(color.r), out.green = linear(color.g), out.blue = linear(color.b);
  return out;
}

ExportedSurface exported_surface(const Skin& skin, const std::string& name) {
  ExportedSurface out;
  out.name = name;
  for (const SkinVertex& v : skin.vertices) {
    out.positions.insert(out.positions.end(), v.at.data(), v.at.data() + 3);
    out.normals.insert(out.normals.end(), v.normal.data(), v.normal.data() + 3);
  }
  out.triangles = skin.triangles;
  out.red = linear(skin.front.r), out.green = linear(skin.front.g), out.blue = linear(skin.front.b);
  const bool cells = skin.weave == Weave::cells;
  out.opacity = skin.weave == Weave::net ? 0.2 : static_cast<double>(skin.opacity);
  out.metal = cells ? 0.35 : 0.7;
  out.roughness = 0.45;
  return out;
}

}  // namespace

ExportedLooks exported_looks(const Scene& scene, const Trajectory& run) {
  ExportedLooks looks;
  looks.loads = scene.render.loads;
  const Structure& structure = run.structure();
  for (const Rod& rod : structure.rods) looks.materials.push_back(exported_material(scene.render, rod.group));
  FrameStyle style;
  style.surfaces = shown_surfaces(scene, structure);
  if (style.surfaces.empty()) return looks;
  style.options.inset.clear();
  const FrameBuilder frames(run, style);  // which way is up in pictures, and what is a surface's front
  looks.surfaces = [shown = frames.surfaces(), up = frames.upright()](const VectorXd& pose) {
    std::vector<ExportedSurface> surfaces;
    for (const ShownSurface& s : shown) {
      std::vector<Vec3> edge;
      for (const int n : s.nodes) edge.push_back(up * pose.segment<3>(3 * n));
      Skin skin = skin_of(s.surface, edge, s.plan);
      const Eigen::Matrix3f back = up.transpose().cast<float>();
      for (SkinVertex& v : skin.vertices) v.at = back * v.at, v.normal = back * v.normal;
      surfaces.push_back(exported_surface(skin, s.surface.kind));
    }
    return surfaces;
  };
  return looks;
}

}  // namespace unfurl
