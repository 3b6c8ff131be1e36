// SPDX-License-Identifier: BSD-3-Clause
// FOLD 1.1 (E. D. Demaine, J. S. Ku, R. J. Lang, github.com/edemaine/fold): the first frame of the file.
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/scene/imported_shape.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/utf8.hpp"

namespace unfurl {

namespace {

using FoldJson = nlohmann::json;

constexpr std::pair<std::string_view, double> fold_units[] = {
    {"unit", 1},  {"m", 1},     {"cm", 0.01},   {"mm", 1e-3},
    {"um", 1e-6}, {"nm", 1e-9}, {"in", 0.0254}, {"pt", 0.0254 / 72}};
constexpr std::pair<std::string_view, const char*> fold_assignments[] = {
    {"B", "boundary"},   {"M", "mountain"}, {"V", "valley"}, {"F", "flat"},
    {"U", "unassigned"}, {"C", "cut"},      {"J", "join"}};

std::string fold_value(const FoldJson& value) {
  const std::string text = value.dump(-1, ' ', false, FoldJson::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, utf8_cut(text, 60)) + "..." : text;
}

template <std::size_t count, class Value>
const Value& one_of(const std::pair<std::string_view, Value> (&rows)[count], const FoldJson& given,
                    const ImportPlace& place) {
  std::string known;
  for (const auto& [name, value] : rows) {
    if (given.is_string() && given.get_ref<const std::string&>() == name) return value;
    known.append(known.empty() ? "" : ", ").append(name);
  }
  place.fail("must be one of " + known + "; got " + fold_value(given));
}

constexpr std::size_t most_brackets = 64;  // a FOLD file needs 5

// What is deeply nested cannot be written into a message: that is recursive.
TextObstacle find_deep_brackets(std::string_view text) {
  std::size_t open = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++open > most_brackets)
      return {i, "brackets nested too deeply"};
    else if (!quoted && (c == ']' || c == '}') && open > 0)
      --open;
  }
  return {};
}

FoldJson parse_fold(std::string_view text, const std::string& file) {
  for (const auto find : {find_bad_encoding, find_deep_brackets})
    if (const auto obstacle = find(text); !obstacle.message.empty())
      ImportPlace{locate(text, obstacle.offset, file), ""}.fail(obstacle.message);
  try {
    return FoldJson::parse(text);
  } catch (const FoldJson::parse_error& error) {
    const std::string words = error.what();
    const std::size_t at = words.find(" - ");
    ImportPlace{locate(text, error.byte > 0 ? error.byte - 1 : 0, file), ""}.fail(
        "not JSON: " + (at == words.npos ? words : words.substr(at + 3)));
  } catch (const FoldJson::exception&) {
    ImportPlace{{file, 0, 0}, ""}.fail("not JSON that can be read: a number is beyond 1e308");
  }
}

class FoldReader {
 public:
  FoldReader(const FoldJson& json, const std::string& file) : json_(json) { shape_.file = file; }

  ImportedShape read() {
    if (!json_.is_object()) place("").fail("a FOLD file is a JSON object, {...}; got " + fold_value(json_));
    read_vertices();
    const bool edges = json_.contains("edges_vertices"), faces = json_.contains("faces_vertices");
    if (!edges && !faces) place("edges_vertices").fail("is missing, and so is faces_vertices");
    if (edges) read_edges();
    if (faces) read_faces();
    if (shape_.plates.empty())
      shape_.notes.emplace_back("there are no faces_vertices: its edges are rods, and nothing is a plate");
    return std::move(shape_);
  }

 private:
  ImportPlace place(const std::string& key) const { return {{shape_.file, 0, 0}, key}; }
  ImportPlace place(const char* key, std::size_t i) const {
    return place(std::string(key) + "[" + std::to_string(i) + "]");
  }

  const FoldJson& list(const char* key) const {
    if (!json_.contains(key)) place(key).fail("is missing");
    const FoldJson& found = json_.at(key);
    if (!found.is_array() || found.empty())
      place(key).fail("must be a list with entries; got " + fold_value(found));
    return found;
  }

  void read_vertices() {
    const double unit =
        json_.contains("frame_unit") ? one_of(fold_units, json_.at("frame_unit"), place("frame_unit")) : 1.0;
    const FoldJson& vertices = list("vertices_coords");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const FoldJson& given = vertices[i];
      const ImportPlace at = place("vertices_coords", i);
      if (given.is_array() && given.size() == 2)
        at.fail("must be three numbers, [x, y, z]; got " + fold_value(given) +
                ": a flat pattern can begin to fold in several ways; give it a little folded");
      CustomNode node{"V" + std::to_string(i)};
      bool sound = given.is_array() && given.size() == 3;
      for (std::size_t k = 0; sound && k < 3; ++k) {
        sound = given[k].is_number();
        if (sound) node.position[static_cast<Eigen::Index>(k)] = unit * given[k].get<double>();
      }
      if (!sound) at.fail("must be three numbers, [x, y, z]; got " + fold_value(given));
      shape_.add_node(std::move(node), at);
    }
  }

  std::vector<int> indices(const FoldJson& given, const ImportPlace& at) const {
    if (!given.is_array()) at.fail("must be a list of vertices; got " + fold_value(given));
    std::vector<int> found;
    for (const FoldJson& index : given) {
      const bool whole = index.is_number_unsigned();
      if (!whole || index.get<std::uint64_t>() >= shape_.spec.nodes.size())
        at.fail("a vertex is a whole number from 0 to " + std::to_string(shape_.spec.nodes.size() - 1) +
                "; got " + fold_value(index));
      found.push_back(static_cast<int>(index.get<std::uint64_t>()));
    }
    return found;
  }

  void read_edges() {
    const FoldJson& edges = list("edges_vertices");
    const FoldJson* names = json_.contains("edges_assignment") ? &list("edges_assignment") : nullptr;
    if (names && names->size() != edges.size())
      place("edges_assignment")
          .fail("must have an entry for each of the " + std::to_string(edges.size()) + " edges; got " +
                std::to_string(names->size()));
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const ImportPlace at = place("edges_vertices", i);
      const auto ends = indices(edges[i], at);
      if (ends.size() != 2) at.fail("an edge has 2 vertices; got " + std::to_string(ends.size()));
      const char* group =
          names ? one_of(fold_assignments, (*names)[i], place("edges_assignment", i)) : "unassigned";
      shape_.add_rod(ends[0], ends[1], group, at);
    }
  }

  void read_faces() {
    const FoldJson& faces = list("faces_vertices");
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const ImportPlace at = place("faces_vertices", i);
      shape_.add_plate(indices(faces[i], at), "unassigned", at);
    }
  }

  const FoldJson& json_;
  ImportedShape shape_;
};

}  // namespace

ImportedShape read_fold(const std::string& text, const std::string& file) {
  const FoldJson json = parse_fold(without_byte_order_mark(text), file);
  return FoldReader(json, file).read();
}

}  // namespace unfurl
