// SPDX-License-Identifier: BSD-3-Clause
// unfurl list structures|methods|figures|scenes|constraints|forces|looks|surfaces|measures|columns|keys: what
// there is to choose from.
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/verbs/key_list.hpp"
#include "core/diagnostics/columns.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/forces/force.hpp"
#include "core/integrators/integrator.hpp"
#include "core/scene/elements.hpp"
#include "core/scene/key_tables.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/surfaces.hpp"
#include "core/structures/family.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/wrapped.hpp"
#include "render/plot/figures.hpp"
#include "render/scene/look.hpp"

namespace unfurl {

namespace {

struct Item {
  std::string name, help;
  const std::vector<ParamSpec>* params = nullptr;
};

std::vector<Item> structure_items() {
  std::vector<Item> items;
  for (const auto& family : families())
    items.push_back({std::string(family.kind), std::string(family.help), &family.params()});
  items.push_back(
      {"custom", "nodes, rods and constraints listed in the scene or in CSV files beside it", nullptr});
  return items;
}

std::vector<Item> method_items() {
  std::vector<Item> items;
  for (const auto& method : methods())
    items.push_back({std::string(method.name), std::string(method.help), nullptr});
  return items;
}

std::vector<Item> figure_items() {
  std::vector<Item> items;
  for (const auto& kind : figure_kinds())
    items.push_back({std::string(kind.name), std::string(kind.help), nullptr});
  return items;
}

std::vector<Item> scene_items() {
  std::vector<Item> items;
  for (const auto& scene : library_scenes()) items.push_back({scene.name, scene.title, nullptr});
  if (items.empty()) throw UnreadableScene(no_library());
  return items;
}

std::vector<Item> measure_items() {
  std::vector<Item> items;
  for (const auto& measure : named_measures())
    items.push_back({std::string(measure.name), std::string(measure.help), nullptr});
  items.push_back({"max:COLUMN", "largest value of a column of series.csv; also min: and final:", nullptr});
  return items;
}

std::vector<Item> column_items() {
  std::vector<Item> items = {{"t_s", "time", nullptr}};
  for (const auto& column : diagnostic_columns())
    items.push_back({std::string(column.name), std::string(column.label), nullptr});
  return items;
}

std::string element_help(std::string_view help, Members members) {
  const std::string_view names = members_text(members);
  return std::string(help) + (names.empty() ? "" : "; " + std::string(names));
}

std::vector<Item> constraint_items() {
  std::vector<Item> items;
  for (const auto& kind : scene_constraints())
    items.push_back({std::string(kind.kind), element_help(kind.help, kind.members), &kind.params()});
  return items;
}

std::vector<Item> force_items() {
  std::vector<Item> items;
  for (const auto& kind : force_kinds())
    items.push_back({std::string(kind.kind), element_help(kind.help, kind.members),
                     kind.params ? &kind.params() : nullptr});
  for (const auto& kind : scene_forces())
    if (std::ranges::none_of(force_kinds(), [&](const ForceKind& row) { return row.kind == kind.kind; }))
      items.push_back({std::string(kind.kind), element_help(kind.help, kind.members), &kind.params()});
  return items;
}

std::vector<Item> look_items() {
  std::vector<Item> items;
  for (const auto& look : looks()) items.push_back({std::string(look.name), std::string(look.help), nullptr});
  return items;
}

std::vector<Item> surface_items() {
  std::vector<Item> items;
  for (const auto& kind : surface_kinds())
    items.push_back({std::string(kind.name), std::string(kind.help), nullptr});
  return items;
}

constexpr std::string_view entry_note =
    "Every entry may also have a name, for messages and columns, and enabled = false, as if it were not "
    "there.";

constexpr std::string_view column_note =
    "A drive, motor or winch NAME adds NAME.angle_rad, NAME.angle_deg, NAME.torque_N_m and "
    "NAME.torque_unique (of a length NAME.value_m, NAME.force_N and NAME.force_unique), NAME.power_W and "
    "NAME.energy_J; a support NAME.reaction_N, NAME.reaction_x_N, _y_N, _z_N and NAME.reaction_unique; a "
    "structure its own lengths (column_pitch_m and row_pitch_m of a reentrant_sheet, and its poisson_ratio) "
    "and surfaces (surface_rms_m of a mesh_reflector: what its front net is off the paraboloid). Energies "
    "of dampers, drives and impacts and what belongs to a fold angle are there where the scene has them.";

constexpr std::string_view measure_note =
    "Every column but the time is one with max:, min: or final: before it, those of drives and supports and "
    "a structure's "
    "own, too, as final:surface_rms_m of a mesh_reflector; unfurl list columns.";

constexpr std::string_view surface_note =
    "An entry of [[surfaces]] spans its nodes, named in order around the edge; it is shown only, without "
    "mass "
    "or force. unfurl list keys surfaces: its keys.";

struct List {
  std::string_view name;
  std::vector<Item> (*items)();
  std::string_view note = {};  // below the list for people
};

constexpr List lists[] = {{"structures", structure_items},
                          {"methods", method_items},
                          {"figures", figure_items},
                          {"scenes", scene_items},
                          {"constraints", constraint_items, entry_note},
                          {"forces", force_items, entry_note},
                          {"looks", look_items},
                          {"surfaces", surface_items, surface_note},
                          {"measures", measure_items, measure_note},
                          {"columns", column_items, column_note}};

constexpr std::size_t line_width = 80;

void print_text(const std::vector<Item>& items) {
  std::size_t width = 0;
  for (const auto& item : items) width = std::max(width, item.name.size() + 2);
  const std::string indent(width, ' '), key_indent(23, ' ');
  for (const auto& item : items) {
    std::cout << wrapped(item.help, line_width, item.name + std::string(width - item.name.size(), ' '),
                         indent);
    if (!item.params) continue;
    for (const auto& spec : *item.params) {
      std::string first = "    " + std::string(spec.name) + " ";
      first.resize(std::max(first.size(), key_indent.size()), ' ');
      std::cout << wrapped(std::string(spec.help) + "; " + range_text(spec) +
                               (spec.required ? "; required" : "; default " + default_text(spec)),
                           line_width, first, key_indent);
    }
  }
}

void print_json(const std::vector<Item>& items) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& item : items) {
    nlohmann::ordered_json entry = {{"name", item.name}, {"help", item.help}};
    if (item.params)
      for (const auto& spec : *item.params)
        entry["parameters"].push_back({{"name", spec.name},
                                       {"unit", spec.unit},
                                       {"default", default_text(spec)},
                                       {"range", range_text(spec)},
                                       {"help", spec.help}});
    json.push_back(std::move(entry));
  }
  std::cout << json.dump(2) << "\n";
}

}  // namespace

namespace {

// The keys of scene files; `table` is empty for all of them.
int list_keys(const std::string& table, const Arguments& arguments) {
  std::vector<const KeyTable*> tables = find_key_tables(table);
  std::vector<std::string_view> names;
  for (const KeyTable& row : key_tables()) {
    names.push_back(row.name);
    if (table.empty()) tables.push_back(&row);
  }
  if (tables.empty())
    throw UsageError("no table of keys " + in_quotes(table) + did_you_mean(table, names, "unfurl list keys"));
  std::cout << (arguments.json       ? keys_json(tables)
                : arguments.markdown ? keys_markdown(tables)
                                     : keys_text(tables));
  return exit_ok;
}

bool is_key_table(std::string_view name) {
  return name == "solver" || name == "render" || name == "scene";
}

int list_items(const List& list, const Arguments& arguments) {
  if (arguments.json) {
    print_json(list.items());
    return exit_ok;
  }
  print_text(list.items());
  if (!list.note.empty()) std::cout << "\n" << wrapped(list.note, line_width);
  return exit_ok;
}

}  // namespace

std::vector<std::string_view> list_names() {
  std::vector<std::string_view> names = {"keys", "solver", "render", "scene"};
  for (const List& list : lists) names.push_back(list.name);
  return names;
}

int cmd_list(const Arguments& arguments) {
  const std::string& name = arguments.names.front();
  const bool keys = name == "keys" || is_key_table(name);
  if (name != "keys" && arguments.names.size() > 1)
    throw UsageError("unexpected argument " + in_quotes(arguments.names[1]) + "; only keys has tables");
  if (!keys && arguments.markdown) throw UsageError("--markdown is for list keys");
  if (arguments.json && arguments.markdown)
    throw UsageError("--json and --markdown are two forms; choose one");
  if (name == "keys") return list_keys(arguments.names.size() > 1 ? arguments.names[1] : "", arguments);
  if (keys) return list_keys(name, arguments);
  for (const List& list : lists)
    if (list.name == name) return list_items(list, arguments);
  throw UsageError("no list " + in_quotes(name) + did_you_mean(name, list_names(), "unfurl help list"));
}

}  // namespace unfurl
