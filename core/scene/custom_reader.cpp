// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/custom_reader.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "core/scene/csv_table.hpp"
#include "core/scene/element_members.hpp"
#include "core/scene/overrides.hpp"
#include "core/scene/text_file.hpp"
#include "core/structure/structure_error.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();
constexpr const char* mass_twice = "give mass, or density and area, not both";

std::string entry_key(std::string_view table, std::size_t index) {
  return "structure." + std::string(table) + "[" + std::to_string(index) + "]";
}

// An override of an entry that only the CSV file has: --set structure.nodes.B.mass=2 makes a table,
// structure.rods[0].mass=2 an entry that lacks what each must have, `needed`.
bool is_in_file(TableReader& table, const std::string& name, const std::string& needed) {
  const TomlTree* tree = table.member(name);
  const std::string said = entries_in_file(name, table.member(name + "_file"));
  if (!tree || said.empty()) return false;
  const auto made = [&](const TomlTree& part) {
    return part.kind == TomlTree::Kind::table && part.where.file == override_source && !part.find(needed);
  };
  const bool only_there = made(*tree) || std::ranges::any_of(tree->items, made);
  if (only_there) table.problem(name, "has no such entry; " + said);
  return only_there;
}

// `nodes = "nodes.csv"`: the key that names a file is another one.
bool names_a_file(TableReader& table, const std::string& name) {
  const TomlTree* tree = table.member(name);
  if (!tree || tree->kind != TomlTree::Kind::text) return false;
  table.problem(name, "must be an array of tables, [[structure." + name + "]]; a CSV file is named by " +
                          name + "_file = " + in_quotes(tree->text));
  return true;
}

void read_nodes(TableReader& table, CustomSpec& spec, SceneNotes& notes) {
  if (names_a_file(table, "nodes") || is_in_file(table, "nodes", "name")) return;
  for (const TomlTree* tree : table.tables("nodes")) {
    const std::string key = entry_key("nodes", spec.nodes.size());
    notes.locations[key] = tree->where;
    TableReader entry(tree, key, tree->where, notes);
    const ParamSet values = entry.read(custom_node_params());
    entry.finish();
    spec.nodes.push_back({values.text("name"), vec3(values, "position"), vec3(values, "velocity"),
                          values.real("mass"), values.boolean("fixed")});
  }
}

void read_rods(TableReader& table, CustomSpec& spec, SceneNotes& notes) {
  if (names_a_file(table, "rods") || is_in_file(table, "rods", "nodes")) return;
  for (const TomlTree* tree : table.tables("rods")) {
    const std::string key = entry_key("rods", spec.rods.size());
    notes.locations[key] = tree->where;
    TableReader entry(tree, key, tree->where, notes);
    const ParamSet values = entry.read(custom_rod_params());
    CustomRod rod{values.text("name"),    entry.names("nodes"), {},
                  values.real("density"), values.real("area"),  values.text("group")};
    entry.finish();
    if (entry.has("mass")) rod.mass = values.real("mass");
    if (entry.has("mass") && entry.has("density")) entry.problem("density", mass_twice);
    if (entry.has("length")) rod.length = values.real("length");
    if (entry.has("youngs_modulus")) rod.youngs_modulus = values.real("youngs_modulus");
    if (entry.has("strength")) rod.strength = values.real("strength");
    if (entry.has("second_moment")) rod.second_moment = values.real("second_moment");
    if (entry.has("elastic")) rod.elastic = values.boolean("elastic");
    if (entry.has("segments")) rod.segments = values.integer("segments");
    if (entry.has("free_length")) rod.free_length = values.real("free_length");
    spec.rods.push_back(std::move(rod));
  }
}

// Numbers of a row outside the range of the keys that they stand for are noted, and left out.
void keep_to_ranges(CsvRow& row, const std::string& key, const std::vector<ParamSpec>& specs,
                    SceneNotes& notes) {
  for (const ParamSpec& spec : specs) {
    const auto it = row.numbers.find(spec.name);
    if (it == row.numbers.end() || (spec.kind != ParamKind::real && spec.kind != ParamKind::integer))
      continue;
    ParamValue value = it->second;
    if (spec.kind == ParamKind::integer)
      if (const auto whole = as_whole_number(it->second)) value = *whole;
    const std::string error = range_error(spec, value);
    if (error.empty()) continue;
    notes.add(row.where, key + "." + std::string(spec.name), error);
    row.numbers.erase(it);
  }
}

void read_constraints(TableReader& table, const std::string& folder, SceneNotes& notes,
                      std::vector<SceneElement>& constraints) {
  for (const TomlTree* tree : table.tables("constraints")) {
    const std::string key = entry_key("constraints", constraints.size());
    TableReader entry(tree, key, tree->where, notes);
    constraints.push_back(read_element(entry, key, scene_constraints(), folder, notes));
  }
}

std::optional<double> cell(const CsvRow& row, std::string_view name) {
  const auto it = row.numbers.find(name);
  return it == row.numbers.end() ? std::nullopt : std::optional(it->second);
}

double cell(const CsvRow& row, std::string_view name, double fallback) {
  return cell(row, name).value_or(fallback);
}

std::string text_cell(const CsvRow& row, std::string_view name, std::string_view fallback) {
  const auto it = row.texts.find(name);
  return it == row.texts.end() || it->second.empty() ? std::string(fallback) : it->second;
}

// The file that the key names; none when there is no such key.
std::optional<TextFile> file_of(TableReader& table, std::string_view key, const std::string& name,
                                const std::string& folder, SceneNotes& notes) {
  if (!table.has(key) || name.empty()) return {};
  TextFile file = read_file_beside(folder, name);
  notes.files.insert(file.path);
  if (file.error.empty()) return file;
  table.problem(key, file.error);
  return {};
}

// The place of a key of an entry, of the entry, or of the whole table: the closest that is known.
SourceLocation nearest_location(const std::string& entry, const std::string& key, const TableReader& table,
                                const SceneNotes& notes) {
  for (const auto& name : {entry + "." + key, entry})
    if (const auto it = notes.locations.find(name); it != notes.locations.end()) return it->second;
  return table.where();
}

// What is wrong with the list as a whole. A key in which something is wrong already (problems from `before`
// on) is not reported twice; where a whole list could not be read, everything that refers to it would be, so
// nothing is.
void note_problems(const CustomSpec& spec, std::size_t before, const TableReader& table, SceneNotes& notes) {
  std::set<std::string> known;
  for (std::size_t i = before; i < notes.problems.size(); ++i) {
    if (notes.problems[i].key.find('[') == std::string::npos) return;
    known.insert(notes.problems[i].key);
  }
  for (const auto& problem : check_custom(spec)) {
    const std::string entry = problem.index < 0
                                  ? "structure." + problem.table
                                  : entry_key(problem.table, static_cast<std::size_t>(problem.index));
    const std::string key = problem.key.empty() ? entry : entry + "." + problem.key;
    if (!known.contains(key))
      notes.add(nearest_location(entry, problem.key, table, notes), key, problem.message);
  }
}

}  // namespace

const std::vector<ParamSpec>& custom_params() {
  static const std::vector<ParamSpec> params = [] {
    ParamSpec nodes =
        text_param("nodes_file", "", "CSV file beside the scene: name,x,y,z[,vx,vy,vz,mass,fixed]");
    ParamSpec rods =
        text_param("rods_file", "",
                   "CSV file beside the scene: a, b [, name, mass, density, area, group, length, "
                   "youngs_modulus, strength, second_moment, elastic, segments, free_length]");
    std::vector<ParamSpec> all{
        choice_param("mass", "consistent", {"consistent", "lumped"}, "mass matrix of a rod"), nodes, rods};
    all.insert(all.end(), rod_material_params().begin(), rod_material_params().end());
    return all;
  }();
  return params;
}

const std::vector<ParamSpec>& custom_node_params() {
  static const std::vector<ParamSpec> params = [] {
    ParamSpec name = text_param("name", "", "what rods, constraints and loads call the node");
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    ParamSpec position = vector_param("position", "m", {unknown, unknown, unknown}, "at t = 0");
    name.required = position.required = true;
    return std::vector<ParamSpec>{
        name, position, vector_param("velocity", "m/s", {0, 0, 0}, "at t = 0; projected on the constraints"),
        real_param("mass", "kg", 0.0, 0.0, std::numeric_limits<double>::infinity(),
                   "added to the rods' share"),
        boolean_param("fixed", false, "stays where it is")};
  }();
  return params;
}

const std::vector<ParamSpec>& custom_rod_params() {
  static const std::vector<ParamSpec> params = [] {
    ParamSpec name = text_param("name", "", "\"A-B\" from its nodes by default");
    ParamSpec group = text_param("group", "rod", "what colours and groups of rod forces go by");
    ParamSpec length = positive_param(
        "length", "m", 0.0,
        "the distance of its nodes by default; where it differs by up to 1 %, nodes are moved");
    return std::vector<ParamSpec>{
        name,
        real_param("mass", "kg", 0.0, 0.0, endless,
                   "to be given where density and area are not; 0: a pure distance constraint"),
        real_param("density", "kg/m^3", 0.0, 0.0, endless, "in place of mass, with area"),
        real_param("area", "m^2", 0.0, 0.0, endless, "cross section"),
        group,
        length,
        positive_param("youngs_modulus", "Pa", endless,
                       "of this rod, with area; by default that of all rods"),
        positive_param("strength", "Pa", endless, "of this rod; by default that of all rods"),
        real_param("second_moment", "m^4", 0.0, 0.0, endless,
                   "of the cross section, the smallest; 0: that of the section"),
        boolean_param("elastic", false, "gives in the motion; by default as rod_model says of all rods"),
        integer_param("segments", 1, 1, 1000,
                      "that it is cut into, to bend; by default as structure.segments says of all rods"),
        positive_param("free_length", "m", std::numeric_limits<double>::quiet_NaN(),
                       "of an elastic rod without force; its nodes stay where they are given, and the rod "
                       "is stretched at t = 0")};
  }();
  return params;
}

void add_csv_nodes(std::string_view text, const std::string& file, std::string_view header, bool named,
                   CustomSpec& spec, SceneNotes& notes) {
  const std::vector<CsvColumn> columns = {
      {"name", "", false, named}, {"x", "m", true, true}, {"y", "m", true, true},
      {"z", "m", true, true},     {"vx", "m_s", true},    {"vy", "m_s", true},
      {"vz", "m_s", true},        {"mass", "kg", true},   {"fixed", "", true, false, true}};
  for (auto& row : read_csv(text, file, columns, notes, header)) {
    const std::string key = entry_key("nodes", spec.nodes.size());
    notes.locations[key] = row.where;
    keep_to_ranges(row, key, custom_node_params(), notes);
    spec.nodes.push_back({text_cell(row, "name", ""),
                          {cell(row, "x", 0), cell(row, "y", 0), cell(row, "z", 0)},
                          {cell(row, "vx", 0), cell(row, "vy", 0), cell(row, "vz", 0)},
                          cell(row, "mass", 0),
                          cell(row, "fixed", 0) != 0.0});
  }
}

void add_csv_rods(std::string_view text, const std::string& file, std::string_view header, CustomSpec& spec,
                  SceneNotes& notes) {
  static const std::vector<CsvColumn> columns = {{"a", "", false, true},
                                                 {"b", "", false, true},
                                                 {"name", ""},
                                                 {"mass", "kg", true},
                                                 {"density", "kg_m3", true},
                                                 {"area", "m2", true},
                                                 {"group", ""},
                                                 {"length", "m", true},
                                                 {"youngs_modulus", "Pa", true},
                                                 {"strength", "Pa", true},
                                                 {"second_moment", "m4", true},
                                                 {"elastic", "", true, false, true},
                                                 {"segments", "", true},
                                                 {"free_length", "m", true}};
  for (auto& row : read_csv(text, file, columns, notes, header)) {
    const std::string key = entry_key("rods", spec.rods.size());
    notes.locations[key] = row.where;
    if (row.numbers.contains("mass") && row.numbers.contains("density"))
      notes.add(row.where, key + ".density", mass_twice);
    keep_to_ranges(row, key, custom_rod_params(), notes);
    const auto elastic = cell(row, "elastic");
    spec.rods.push_back({text_cell(row, "name", ""),
                         {text_cell(row, "a", ""), text_cell(row, "b", "")},
                         cell(row, "mass"),
                         cell(row, "density", 0.0),
                         cell(row, "area", 0.0),
                         text_cell(row, "group", "rod"),
                         cell(row, "length", 0.0),
                         cell(row, "youngs_modulus", not_given),
                         cell(row, "strength", not_given),
                         cell(row, "second_moment", 0.0),
                         elastic ? std::optional(*elastic != 0.0) : std::nullopt,
                         static_cast<long>(cell(row, "segments", 0.0)),
                         cell(row, "free_length", 0.0)});
  }
}

CustomSpec read_custom(TableReader& table, const std::string& folder, SceneNotes& notes,
                       std::vector<SceneElement>& constraints) {
  const std::size_t before = notes.problems.size();
  CustomSpec spec;
  const ParamSet values = table.read(custom_params());
  spec.lumped_mass = values.text("mass") == "lumped";
  spec.material = rod_material(values);
  try {
    check_rod_model(spec.material);
  } catch (const StructureError& error) {
    // A modulus may be that of each rod.
    if (error.key != "youngs_modulus") table.problem(error.key, error.message);
  }
  read_nodes(table, spec, notes);
  if (const auto file = file_of(table, "nodes_file", values.text("nodes_file"), folder, notes))
    add_csv_nodes(file->text, file->path, "", true, spec, notes);
  read_rods(table, spec, notes);
  if (const auto file = file_of(table, "rods_file", values.text("rods_file"), folder, notes))
    add_csv_rods(file->text, file->path, "", spec, notes);
  read_constraints(table, folder, notes, constraints);
  note_problems(spec, before, table, notes);
  return spec;
}

}  // namespace unfurl
