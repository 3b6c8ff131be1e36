// SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ: vertices (v), lines (l), faces (f); all other lines are passed over.
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/scene/imported_shape.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::vector<std::string_view> obj_words(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view blank = " \t\r";
  for (std::size_t at = line.find_first_not_of(blank); at < line.size();
       at = line.find_first_not_of(blank, at)) {
    const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

double obj_number(std::string_view word, const ImportPlace& place) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double x = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(x))
    place.fail("a coordinate is a finite number; got " + in_quotes(word));
  return x;
}

// "7", "7/1/3" or "-1", the last vertex so far.
int obj_vertex(std::string_view word, std::size_t count, const ImportPlace& place) {
  const std::string_view index = word.substr(0, word.find('/'));
  long i = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), i);
  const long n = static_cast<long>(count);
  if (error != std::errc() || end != index.data() + index.size() || i == 0 || i > n || i < -n)
    place.fail("names a vertex by 1 to " + std::to_string(n) +
               ", as many as stand above, or by -1 for the last; got " + in_quotes(word));
  return static_cast<int>(i > 0 ? i - 1 : n + i);
}

void read_obj_line(const std::vector<std::string_view>& words, const ImportPlace& place,
                   ImportedShape& shape) {
  if (words.empty()) return;
  if (words[0] == "v") {
    if (words.size() < 4)
      place.fail("a vertex has three coordinates, v X Y Z; got " + std::to_string(words.size() - 1));
    CustomNode node{"V" + std::to_string(shape.spec.nodes.size() + 1)};
    for (std::size_t k = 0; k < 3; ++k)
      node.position[static_cast<Eigen::Index>(k)] = obj_number(words[k + 1], place);
    return shape.add_node(std::move(node), place);
  }
  if (words[0] != "l" && words[0] != "f") return;
  std::vector<int> nodes;
  for (std::size_t k = 1; k < words.size(); ++k)
    nodes.push_back(obj_vertex(words[k], shape.spec.nodes.size(), place));
  if (words[0] == "f") return shape.add_plate(nodes, "edge", place);
  if (nodes.size() < 2) place.fail("a line joins two vertices or more; got " + std::to_string(nodes.size()));
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) shape.add_rod(nodes[k], nodes[k + 1], "line", place);
}

}  // namespace

ImportedShape read_obj(const std::string& marked, const std::string& file) {
  const std::string_view text = without_byte_order_mark(marked);
  if (const auto obstacle = find_bad_encoding(text); !obstacle.message.empty())
    ImportPlace{locate(text, obstacle.offset, file), ""}.fail(obstacle.message);
  ImportedShape shape;
  shape.file = file;
  std::string joined;  // of a line that goes on behind a backslash
  int number = 0, first = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    line = line.substr(0, line.find('#'));  // a comment ends with its line, whatever its last letter
    const bool goes_on = line.ends_with('\\') && at < text.size();
    if (goes_on) line.remove_suffix(1);
    joined.append(line).append(1, ' ');
    if (goes_on) continue;
    const auto words = obj_words(joined);
    read_obj_line(words, {{file, first, 1}, words.empty() ? "" : std::string(words[0])}, shape);
    joined.clear();
    first = number + 1;
  }
  if (shape.spec.nodes.empty()) ImportPlace{{file, 0, 0}, "v"}.fail("there are no vertices, lines v X Y Z");
  if (shape.spec.rods.empty())
    ImportPlace{{file, 0, 0}, "l"}.fail("nothing joins its vertices: lines l A B or faces f A B C ...");
  return shape;
}

}  // namespace unfurl
