// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/key_tables.hpp"

#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "core/integrators/solver_options.hpp"
#include "core/scene/custom_reader.hpp"
#include "core/scene/elements.hpp"
#include "core/scene/render_options.hpp"
#include "core/scene/surfaces.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

using Keys = std::vector<ParamSpec>;

Keys together(Keys a, const Keys& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The key that chooses the kind of a table; the value stands for all of its entries.
ParamSpec kind_key(std::string_view kind) {
  return required(choice_param("kind", kind, {kind}, "what the table describes"));
}

ParamSpec names_key(std::string_view name, std::size_t length, std::string_view help, bool required = true) {
  ParamSpec spec = names_param(name, help);
  spec.length = length;
  spec.required = required;
  return spec;
}

// How an entry names what it acts on.
Keys member_keys(Members members) {
  switch (members) {
    case Members::none:
      return {};
    case Members::each_node:
      return {names_key("nodes", 0, "names or globs, one for each")};
    case Members::node_list:
      return {names_key("nodes", 0, "A, B, ...: all of them in one")};
    case Members::path:
      return {names_key("nodes", 0, "A, B, ...: in order")};
    case Members::terms:
      return {names_key(
          "terms", 0,
          "sum of: \"C length A B\", \"C coordinate A along X Y Z\", \"C angle A HINGE B\" (also: "
          "about X Y Z), \"C dihedral A B C D\"; C: a number; a dihedral goes from A to D, right-handed "
          "about the edge from B to C: 0 folded together, 180 or -180 flat")};
    case Members::two_nodes:
      return {names_key("nodes", 2, "A, B")};
    case Members::three_nodes:
      return {names_key("nodes", 3, "A, B, C: a bend at the middle one")};
    case Members::rods:
      return {names_key("rods", 0, "names or globs of rods or of their groups")};
    case Members::rod:
      return {text_param("rod", "", "its name; the direction follows it")};
    case Members::measure:
      return {
          names_key("rods", 2,
                    "R, S: the angle between two rods at the node they share; they share none: between their "
                    "directions, from first node to second",
                    false),
          names_key("nodes", 0,
                    "A, HINGE, B: the angle at the middle one; A, B: their distance, or with direction the "
                    "difference of their coordinates; A: its coordinate",
                    false),
          boolean_param("fold_angle", false, "the structure's fold angle, in place of rods and nodes")};
    case Members::angle:
      break;
  }
  return {names_key("rods", 2,
                    "R, S: the angle between two rods at the node they share; they share none: between their "
                    "directions, from first node to second",
                    false),
          names_key("nodes", 3, "A, HINGE, B: the angle at the middle one, in place of rods", false),
          boolean_param("fold_angle", false, "the structure's fold angle, in place of rods and nodes")};
}

KeyTable element_table(std::string_view table, const ElementKind& kind) {
  Keys keys = {kind_key(kind.kind), text_param("name", "", "for messages and columns; made up by default"),
               enabled_param()};
  return {std::string(table) + "." + std::string(kind.kind), "[[" + std::string(table) + "]]",
          std::string(kind.help), together(together(keys, member_keys(kind.members)), kind.params())};
}

void add_structures(std::vector<KeyTable>& tables) {
  for (const Family& family : families())
    tables.push_back({"structure." + std::string(family.kind), "[structure]", std::string(family.help),
                      together({kind_key(family.kind)}, family.params())});
  tables.push_back({"structure.custom", "[structure]",
                    "nodes, rods and constraints listed in the scene or in CSV files beside it",
                    together({kind_key("custom")}, custom_params())});
  tables.push_back(
      {"structure.nodes", "[[structure.nodes]]", "a node of a custom structure", custom_node_params()});
  tables.push_back({"structure.rods", "[[structure.rods]]", "a rod of a custom structure",
                    together({names_key("nodes", 2, "its ends")}, custom_rod_params())});
}

}  // namespace

const std::vector<ParamSpec>& scene_params() {
  static const Keys params = {
      text_param("title", "", "of pictures and figures; by default the scene's name")};
  return params;
}

const std::vector<ParamSpec>& gravity_params() {
  static const Keys params = {vector_param("acceleration", "m/s^2", {0, 0, 0}, "acceleration of free fall")};
  return params;
}

const std::vector<ParamSpec>& load_params() {
  static const Keys params = {required(vector_param("force", "N", {0, 0, 0}, "constant force on each node")),
                              enabled_param()};
  return params;
}

const std::vector<ParamSpec>& deployment_params() {
  static const Keys params = [] {
    constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
    constexpr double endless = std::numeric_limits<double>::infinity();
    return Keys{required(real_param("deployed", "", 0.0, -endless, endless,
                                    "its value when deployed; m, or deg where all terms are angles")),
                real_param("stowed", "", not_given, -endless, endless,
                           "its value when stowed; by default that at t = 0")};
  }();
  return params;
}

const std::vector<KeyTable>& key_tables() {
  static const std::vector<KeyTable> tables = [] {
    std::vector<KeyTable> all = {{"scene", "", "before the first table", scene_params()}};
    add_structures(all);
    all.push_back({"gravity", "[gravity]", "weight", gravity_params()});
    all.push_back({"loads", "[[loads]]", "constant forces on nodes",
                   together({names_key("nodes", 0, "names or globs, the force on each")}, load_params())});
    for (const ElementKind& kind : scene_forces()) all.push_back(element_table("forces", kind));
    for (const ElementKind& kind : scene_constraints()) all.push_back(element_table("constraints", kind));
    all.push_back({"deployment", "[deployment]", "when a structure without a fold angle is deployed",
                   together({names_key("measure", 0,
                                       "what is measured: a term as those of a combination, a list of them "
                                       "that is summed up, or the name of a constraint or force")},
                            deployment_params())});
    all.push_back(
        {"surfaces", "[[surfaces]]", "meshes, membranes and panels shown between nodes that carry them",
         together({names_key("nodes", 0, "names or globs, in order around the edge")}, surface_params())});
    all.push_back({"solver", "[solver]", "how the motion is solved", solver_params()});
    all.push_back({"render", "[render]", "pictures and films", render_params()});
    all.push_back({"render.camera_keys", "[[render.camera_keys]]",
                   "where the camera is at a time; between them it moves smoothly", camera_key_params()});
    all.push_back({"render.materials", "[[render.materials]]",
                   "what rods of a group are made of in the pictures", material_params()});
    return all;
  }();
  return tables;
}

std::vector<const KeyTable*> find_key_tables(std::string_view name) {
  std::vector<const KeyTable*> found;
  const std::string opening = std::string(name) + ".", ending = "." + std::string(name);
  for (const KeyTable& table : key_tables())
    if (table.name == name || table.name.starts_with(opening)) found.push_back(&table);
  if (!found.empty()) return found;
  for (const KeyTable& table : key_tables())
    if (table.name.ends_with(ending)) found.push_back(&table);
  return found;
}

std::string_view type_text(const ParamSpec& spec) {
  switch (spec.kind) {
    case ParamKind::boolean:
      return "switch";
    case ParamKind::integer:
      return "whole number";
    case ParamKind::real:
      return "number";
    case ParamKind::choice:
      return "choice";
    case ParamKind::text:
      return "text";
    case ParamKind::vector:
      return "list of numbers";
    case ParamKind::names:
      break;
  }
  return "list of names";
}

std::string default_text(const ParamSpec& spec) {
  struct Writer {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(long i) const { return std::to_string(i); }
    std::string operator()(double x) const {
      if (std::isnan(x)) return "none";
      std::ostringstream out;
      out << std::setprecision(16) << x;
      return out.str();
    }
    std::string operator()(const std::string& text) const { return text.empty() ? "none" : text; }
    std::string operator()(const std::vector<double>& list) const {
      std::string text;
      for (const double x : list) text += (text.empty() ? "[" : ", ") + (*this)(x);
      return text.empty() ? "none" : text + "]";
    }
    std::string operator()(const std::vector<std::string>&) const { return "none"; }
  };
  return std::visit(Writer{}, spec.fallback);
}

}  // namespace unfurl
