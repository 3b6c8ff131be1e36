// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/write.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "core/scene/custom_reader.hpp"
#include "core/scene/key_tables.hpp"
#include "core/scene/title.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

// Shortest text that reads back as the same number; TOML needs a point or an exponent to call it a float.
std::string real_text(double x) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  std::string text(buffer.data(), end);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string vec_text(const Vec3& v) {
  return toml_value(std::vector<double>{v[0], v[1], v[2]});
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + toml_string(name);
  return "[" + text + "]";
}

std::string line(std::string_view key, const std::string& value, std::string_view unit = {}) {
  return std::string(key) + " = " + value + (unit.empty() ? "" : "  # " + std::string(unit)) + "\n";
}

// With the unit that the key is declared with.
std::string line_of(const std::vector<ParamSpec>& specs, std::string_view key, const std::string& value) {
  const auto spec = std::ranges::find(specs, key, &ParamSpec::name);
  return line(key, value, spec == specs.end() ? "" : spec->unit);
}

std::string params_text(const std::vector<ParamSpec>& specs, const ParamSet& values) {
  std::string text;
  for (const auto& spec : specs) text += line(spec.name, toml_value(values.value(spec.name)), spec.unit);
  return text;
}

bool worth_writing(const ParamValue& value) {
  if (const auto* x = std::get_if<double>(&value)) return !std::isnan(*x);
  if (const auto* text = std::get_if<std::string>(&value)) return !text->empty();
  const auto* list = std::get_if<std::vector<double>>(&value);
  return !list || !list->empty();
}

bool is_idle(const ParamSpec& spec, const SceneElement& element, const ElementKind& kind) {
  return !means_something(spec, kind.params(), element.values);
}

std::string element_text(std::string_view table, const SceneElement& element, const ElementKind& kind,
                         IdleValues idle) {
  std::string text = "\n[[" + std::string(table) + "]]\n" + line("kind", toml_string(element.kind));
  text += line("name", toml_string(element.name));
  if (!element.nodes.empty()) text += line("nodes", names_text(element.nodes));
  if (!element.rods.empty())
    text += kind.members == Members::rod ? line("rod", toml_string(element.rods.front()))
                                         : line("rods", names_text(element.rods));
  if (!element.terms.empty()) text += line("terms", names_text(element.terms));
  if (!element.enabled) text += line("enabled", "false");
  if (element.fold_angle) text += line("fold_angle", "true");
  for (const auto& spec : kind.params()) {
    const ParamValue& value = element.values.value(spec.name);
    if (!worth_writing(value)) continue;
    if (is_idle(spec, element, kind) && (idle == IdleValues::left_out || value == spec.fallback)) continue;
    text += line(spec.name, toml_value(value), spec.unit);
  }
  return text;
}

std::string structure_text(const Scene& scene) {
  std::string text = "\n[structure]\n" + line("kind", toml_string(scene.kind));
  if (const Family* family = find_family(scene.kind))
    return text + params_text(family->params(), scene.structure);
  text += line("mass", toml_string(scene.custom.lumped_mass ? "lumped" : "consistent"));
  text += params_text(rod_material_params(), rod_material_values(scene.custom.material));
  for (const auto& node : scene.custom.nodes) text += custom_node_text(node);
  for (const auto& rod : scene.custom.rods) text += custom_rod_text(rod);
  return text;
}

std::string solver_text(const Scene& scene) {
  return "\n[solver]\n" + params_text(solver_params(), solver_values(scene.solver));
}

std::string render_text(const Scene& scene) {
  const RenderOptions& render = scene.render;
  std::string text = "\n[render]\n" + params_text(render_params(), render_values(render));
  // Said, it is asked for; left out, it is made where ffmpeg is.
  const std::string film = "\nmp4 = true\n";
  if (const std::size_t at = text.find(film);
      at != std::string::npos && !scene.locations.contains("render.mp4"))
    text.insert(at + 1, "# ");
  for (const CameraKey& key : render.camera_keys)
    text += "\n[[render.camera_keys]]\n" + params_text(camera_key_params(), camera_key_values(key));
  for (const GroupMaterial& entry : render.materials)
    text += "\n[[render.materials]]\n" + line("group", toml_string(entry.group)) +
            line("material", toml_string(entry.material));
  return text;
}

using TextMembers = std::vector<std::pair<std::string_view, std::string>>;  // key, value as TOML

TextMembers members_of(const CustomNode& node) {
  TextMembers members{{"name", toml_string(node.name)}, {"position", vec_text(node.position)}};
  if (!node.velocity.isZero(0.0)) members.emplace_back("velocity", vec_text(node.velocity));
  if (node.mass != 0.0) members.emplace_back("mass", real_text(node.mass));
  if (node.fixed) members.emplace_back("fixed", "true");
  return members;
}

TextMembers members_of(const CustomRod& rod) {
  TextMembers members;
  if (!rod.name.empty()) members.emplace_back("name", toml_string(rod.name));
  members.emplace_back("nodes", names_text(rod.nodes));
  if (rod.mass) members.emplace_back("mass", real_text(*rod.mass));
  if (rod.density != 0.0) members.emplace_back("density", real_text(rod.density));
  if (rod.area != 0.0) members.emplace_back("area", real_text(rod.area));
  if (rod.length != 0.0) members.emplace_back("length", real_text(rod.length));
  if (!std::isnan(rod.youngs_modulus)) members.emplace_back("youngs_modulus", real_text(rod.youngs_modulus));
  if (!std::isnan(rod.strength)) members.emplace_back("strength", real_text(rod.strength));
  if (rod.second_moment != 0.0) members.emplace_back("second_moment", real_text(rod.second_moment));
  if (rod.elastic) members.emplace_back("elastic", *rod.elastic ? "true" : "false");
  if (rod.segments > 0) members.emplace_back("segments", std::to_string(rod.segments));
  if (rod.free_length != 0.0) members.emplace_back("free_length", real_text(rod.free_length));
  if (rod.group != "rod") members.emplace_back("group", toml_string(rod.group));
  return members;
}

std::string entry_text(std::string_view list, const std::vector<ParamSpec>& specs,
                       const TextMembers& members) {
  std::string text = "\n[[" + std::string(list) + "]]\n";
  for (const auto& [key, value] : members) text += line_of(specs, key, value);
  return text;
}

std::string inline_table(const TextMembers& members) {
  std::string text;
  for (const auto& [key, value] : members)
    text += (text.empty() ? "" : ", ") + std::string(key) + " = " + value;
  return "{" + text + "}";
}

std::string idle_lines(const SceneElement& element, const ElementKind& kind) {
  std::string text;
  for (const auto& spec : kind.params()) {
    const ParamValue& value = element.values.value(spec.name);
    if (worth_writing(value) && value != spec.fallback && is_idle(spec, element, kind))
      text += "# of " + toml_string(element.name) + ": " + line(spec.name, toml_value(value));
  }
  return text;
}

}  // namespace

std::string custom_node_text(const CustomNode& node) {
  return entry_text("structure.nodes", custom_node_params(), members_of(node));
}

std::string custom_rod_text(const CustomRod& rod) {
  return entry_text("structure.rods", custom_rod_params(), members_of(rod));
}

std::string inline_text(const CustomNode& node) {
  return inline_table(members_of(node));
}

std::string inline_text(const CustomRod& rod) {
  return inline_table(members_of(rod));
}

std::string idle_text(const Scene& scene) {
  std::string text;
  for (const auto& force : scene.forces) text += idle_lines(force, *find_kind(scene_forces(), force.kind));
  for (const auto& constraint : scene.constraints)
    text += idle_lines(constraint, *find_kind(scene_constraints(), constraint.kind));
  return text;
}

std::string toml_string(std::string_view text) {
  constexpr std::string_view hex = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result.append(1, '\\').append(1, c);
    else if (byte < 0x20 || byte == 0x7f)
      result.append("\\u00").append(1, hex[byte >> 4U]).append(1, hex[byte & 15U]);
    else
      result += c;
  }
  return result + '"';
}

std::string toml_value(const ParamValue& value) {
  struct Writer {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(long i) const { return std::to_string(i); }
    std::string operator()(double x) const { return real_text(x); }
    std::string operator()(const std::string& s) const { return toml_string(s); }
    std::string operator()(const std::vector<double>& v) const {
      std::string text;
      for (const double x : v) text += (text.empty() ? "" : ", ") + real_text(x);
      return "[" + text + "]";
    }
    std::string operator()(const std::vector<std::string>& v) const { return names_text(v); }
  };
  return std::visit(Writer{}, value);
}

std::string scene_text(const Scene& scene, IdleValues idle) {
  std::string text = line("title", toml_string(scene.title_pattern.empty() ? title_that_says(scene.title)
                                                                           : scene.title_pattern)) +
                     structure_text(scene);
  text += "\n[gravity]\n" + line_of(gravity_params(), "acceleration", vec_text(scene.gravity));
  for (const auto& load : scene.loads)
    text += "\n[[loads]]\n" + (load.enabled ? "" : line("enabled", "false")) +
            line("nodes", names_text(load.nodes)) + line_of(load_params(), "force", vec_text(load.force));
  for (const auto& force : scene.forces)
    text += element_text("forces", force, *find_kind(scene_forces(), force.kind), idle);
  for (const auto& constraint : scene.constraints)
    text += element_text("constraints", constraint, *find_kind(scene_constraints(), constraint.kind), idle);
  if (const SceneElement& d = scene.deployment; !d.terms.empty()) {
    text += "\n[deployment]\n" + line("measure", names_text(d.terms));
    for (const auto& spec : deployment_params())
      if (worth_writing(d.values.value(spec.name)))
        text += line(spec.name, toml_value(d.values.value(spec.name)));
  }
  for (const SceneSurface& surface : scene.surfaces)
    text += "\n[[surfaces]]\n" + line("nodes", names_text(surface.nodes)) +
            params_text(surface_params(), surface_values(surface));
  return text + solver_text(scene) + render_text(scene);
}

}  // namespace unfurl
