// SPDX-License-Identifier: BSD-3-Clause
// Nodes and rods as CSV: the columns of nodes_file and rods_file of a scene (custom_reader.hpp), and besides
// no first line, nodes without names, and rods between numbers of nodes.
#include <algorithm>
#include <charconv>
#include <optional>

#include "core/scene/csv_table.hpp"
#include "core/scene/custom_reader.hpp"
#include "core/scene/imported_shape.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/text/name_index.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::optional<double> csv_number(const std::string& cell) {
  double x = 0.0;
  const char* begin = cell.data() + (cell.size() > 1 && cell[0] == '+' && cell[1] != '-' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), x);
  return error == std::errc() && end == cell.data() + cell.size() ? std::optional(x) : std::nullopt;
}

// What the columns are where the first line holds numbers already; empty: it names them.
std::string_view header_of(std::string_view text, bool nodes) {
  text = without_byte_order_mark(text);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto records = csv_records(text.substr(at, end - at));
    at = end + 1;
    if (records.empty()) continue;
    const auto& cells = records.front();
    if (!csv_number(cells.back())) return "";
    if (!nodes) return "a,b";
    return cells.size() == 4 ? "name,x,y,z" : "x,y,z";
  }
  return "";
}

// What a scene would read as an expression.
void refuse_expression(const std::string& text, const char* key, const SourceLocation& where) {
  if (text.starts_with('='))
    ImportPlace{where, key}.fail(in_quotes(text) + " begins with =, as expressions do; give it another name");
}

void throw_problems(const SceneNotes& notes) {
  if (!notes.problems.empty()) throw SceneError(notes.problems);
}

// Rods whose ends are numbers: from 0, or from 1, as 0 or the number of nodes among them tells.
void name_ends(CustomSpec& rods, const std::vector<CustomNode>& nodes, const std::string& file) {
  long lowest = static_cast<long>(nodes.size()), highest = 0;
  const auto index_of = [](const std::string& cell) -> std::optional<long> {
    const auto x = csv_number(cell);
    return x ? as_whole_number(*x) : std::nullopt;
  };
  for (const CustomRod& rod : rods.rods)
    for (const std::string& end : rod.nodes)
      if (const auto i = index_of(end)) {
        lowest = std::min(lowest, *i);
        highest = std::max(highest, *i);
      }
  const long count = static_cast<long>(nodes.size()), base = lowest > 0 && highest == count ? 1 : 0;
  const ImportPlace place{{file, 0, 0}, "a, b"};
  if (lowest > 0 && highest < count)
    place.fail("go from " + std::to_string(lowest) + " to " + std::to_string(highest) + " and there are " +
               std::to_string(count) +
               " nodes: nothing tells whether they count from 0 or from 1; give the nodes a column 'name'");
  for (std::size_t r = 0; r < rods.rods.size(); ++r)
    for (std::string& end : rods.rods[r].nodes) {
      const auto i = index_of(end);
      if (!i || *i < base || *i >= count + base)
        ImportPlace{{file, 0, 0}, "rods[" + std::to_string(r) + "]"}.fail(
            "an end is a node's name, or its number from " + std::to_string(base) + " to " +
            std::to_string(count - 1 + base) + "; got " + in_quotes(end));
      end = nodes[static_cast<std::size_t>(*i - base)].name;
    }
}

}  // namespace

ImportedShape read_csv_lists(const TextFile& nodes, const TextFile& rods) {
  SceneNotes notes;
  ImportedShape shape;
  shape.file = nodes.path;
  CustomSpec found;
  add_csv_nodes(nodes.text, nodes.path, header_of(nodes.text, true), false, found, notes);
  add_csv_rods(rods.text, rods.path, header_of(rods.text, false), found, notes);
  throw_problems(notes);
  if (found.nodes.empty()) ImportPlace{{nodes.path, 0, 0}, "nodes"}.fail("there are none");
  if (found.rods.empty()) ImportPlace{{rods.path, 0, 0}, "rods"}.fail("there are none");
  NameIndex names;
  for (std::size_t i = 0; i < found.nodes.size(); ++i) {
    CustomNode& node = found.nodes[i];
    if (node.name.empty()) node.name = "V" + std::to_string(i);
    const ImportPlace place{notes.locations.at("structure.nodes[" + std::to_string(i) + "]"), "name"};
    refuse_expression(node.name, "name", place.where);
    shape.node_places.push_back(place.where);
    if (names.add(node.name) >= 0) place.fail("there is already a node " + in_quotes(node.name));
    shape.add_node(node, {place.where, ""});
  }
  const bool by_name = std::ranges::any_of(found.rods, [&](const CustomRod& rod) {
    return std::ranges::any_of(rod.nodes, [&](const std::string& end) { return names.find(end) >= 0; });
  });
  if (!by_name) name_ends(found, found.nodes, rods.path);
  for (std::size_t r = 0; r < found.rods.size(); ++r) {
    const ImportPlace place{notes.locations.at("structure.rods[" + std::to_string(r) + "]"), ""};
    refuse_expression(found.rods[r].name, "name", place.where);
    refuse_expression(found.rods[r].group, "group", place.where);
    shape.rod_places.push_back(place.where);
    int ends[2];
    for (std::size_t k = 0; k < 2; ++k) {
      ends[k] = names.find(found.rods[r].nodes[k]);
      if (ends[k] < 0)
        place.fail("there is no node " + in_quotes(found.rods[r].nodes[k]) +
                   did_you_mean(found.rods[r].nodes[k], names.names()));
    }
    const std::size_t count = shape.spec.rods.size();
    if (shape.add_rod(ends[0], ends[1], "rod", place) < count)
      place.fail("there is already a rod from " + in_quotes(found.rods[r].nodes[0]) + " to " +
                 in_quotes(found.rods[r].nodes[1]));
    shape.spec.rods.back() = found.rods[r];
  }
  return shape;
}

}  // namespace unfurl
