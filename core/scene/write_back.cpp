// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/write_back.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "core/scene/overrides.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/toml_statements.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

namespace {

struct Replacement {
  std::size_t begin, end;  // bytes
  std::string text;
  const TomlTree* gone = nullptr;  // what stood there, in the tree of the text
};

// The byte of a line and column (in characters, from 1).
std::size_t offset_of(std::string_view text, const SourceLocation& where) {
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  for (int line = 1; line < where.line && at < text.size(); ++line) at = text.find('\n', at) + 1;
  for (int column = 1; column < where.column && at < text.size(); ++column) do
      ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U);
  return at;
}

// A member of a table, or an item of an array by its index.
const TomlTree* member(const TomlTree& tree, const std::string& step) {
  if (tree.kind != TomlTree::Kind::array) return tree.find(step);
  std::size_t index = tree.items.size();
  std::from_chars(step.data(), step.data() + step.size(), index);
  return index < tree.items.size() ? &tree.items[index] : nullptr;
}

// The members of an inline table, a line each.
std::string member_lines(const std::string& table) {
  const std::string text = "value = " + table;
  const TomlTree root = parse_toml(text, "");
  std::string lines;
  for (const auto& [name, value] : root.entries.front().value.entries) {
    const std::size_t begin = offset_of(text, value.where);
    lines += name + " = " + text.substr(begin, toml_value_end(text, begin) - begin) + "\n";
  }
  return lines;
}

using KeyPath = std::vector<std::string>;

// As a key, dotted; parts that are no bare words in quotes.
std::string key_text(const KeyPath& path, std::size_t from) {
  std::string key;
  for (std::size_t i = from; i < path.size(); ++i) {
    const bool bare = !path[i].empty() && std::ranges::all_of(path[i], [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
             c == '-';
    });
    key += (i == from ? "" : ".") + (bare ? path[i] : toml_string(path[i]));
  }
  return key;
}

bool begins_with(const KeyPath& path, const KeyPath& beginning) {
  return path.size() >= beginning.size() && std::equal(beginning.begin(), beginning.end(), path.begin());
}

Replacement at_the_end(std::string_view text, const std::string& lines) {
  const char* gap = text.empty() || text.ends_with('\n') ? "\n" : "\n\n";
  return {text.size(), text.size(), gap + lines};
}

// A line behind a statement, indented as that is.
Replacement behind(std::string_view text, const TomlStatement& statement, const std::string& line) {
  const std::size_t before = text.find_last_not_of(" \t", statement.begin - 1);
  const std::size_t first = statement.begin == 0 || before == text.npos ? 0 : before + 1;
  const std::string indent(text.substr(first, statement.begin - first));
  const bool broken = text[statement.end - 1] != '\n';
  return {statement.end, statement.end, (broken ? "\n" : "") + indent + line};
}

// A line above the first table and the comments on it, but below those that begin the file.
Replacement above_tables(std::string_view text, const std::vector<TomlStatement>& statements,
                         const std::string& line) {
  if (statements.empty()) return at_the_end(text, line);
  const std::size_t first = text.size() - without_byte_order_mark(text).size();
  const auto line_of = [&](std::size_t byte) {
    const std::size_t end = byte <= first ? text.npos : text.rfind('\n', byte - 1);
    return end == text.npos ? first : end + 1;
  };
  const std::size_t header = line_of(statements.front().begin);
  std::size_t at = header;
  while (at > first) {
    const std::size_t above = line_of(at - 1);
    if (text[std::min(text.find_first_not_of(" \t", above), at)] != '#') return {at, at, line + "\n"};
    at = above;
  }
  return {header, header, line + "\n"};
}

// Inside the brackets of an inline table or list.
Replacement inside_brackets(std::string_view text, const TomlTree& brackets, const std::string& entry) {
  const std::size_t open = offset_of(text, brackets.where);
  std::size_t at = open + 1;
  if (!brackets.items.empty())
    at = toml_value_end(text, offset_of(text, brackets.items.back().where));
  else if (!brackets.entries.empty())
    at = text.find_last_not_of(" \t", toml_value_end(text, open) - 2) + 1;
  else
    return {at, at, entry};
  // An item that has a line of its own is followed by another.
  const std::size_t line = text.find_last_of("\n", at) + 1, first = text.find_first_not_of(" \t", line);
  const std::size_t next = text.find_first_not_of(" \t\r,", at);
  const bool own_line = line > open && next != text.npos && text[next] == '\n';
  return {at, at, own_line ? ",\n" + std::string(text.substr(line, first - line)) + entry : ", " + entry};
}

// A new key of the table that the first `depth` steps lead to.
Replacement into_table(std::string_view text, const TomlTree& table, const KeyPath& steps, std::size_t depth,
                       const std::string& value) {
  const std::vector<TomlStatement> statements = toml_statements(text);
  const KeyPath path(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(depth));
  const TomlStatement* last = nullptr;  // of the table's own, under its header or with dots
  for (const TomlStatement& s : statements) {
    if (!s.header && begins_with(path, s.path))
      return inside_brackets(text, table, key_text(steps, depth) + " = " + value);
    if (s.header ? s.path == path
                 : begins_with(path, s.table) && s.path.size() > depth && begins_with(s.path, path))
      last = &s;
  }
  if (depth == 0 && steps.size() > 1)
    return at_the_end(text, "[" + steps[0] + "]\n" + key_text(steps, 1) + " = " + value + "\n");
  const std::string line = key_text(steps, last ? last->table.size() : depth) + " = " + value + "\n";
  if (last) return behind(text, *last, line);
  return depth == 0 ? above_tables(text, statements, line)
                    : at_the_end(text, "[" + key_text(path, 0) + "]\n" + line);
}

// A new entry of the list that all steps but the last lead to; null: it has none yet.
Replacement into_list(std::string_view text, const TomlTree* list, const KeyPath& steps,
                      const std::string& value) {
  const KeyPath path(steps.begin(), steps.end() - 1);
  if (list)
    for (const TomlStatement& s : toml_statements(text))
      if (!s.header && begins_with(path, s.path)) return inside_brackets(text, *list, value);
  return at_the_end(text, "[[" + key_text(path, 0) + "]]\n" + member_lines(value));
}

// Entries under headers of their own in the place of those that are there; nullopt: there are none, or
// something else stands among them.
std::optional<Replacement> in_place_of_entries(std::string_view text, const KeyPath& path,
                                               const std::string& value) {
  std::optional<Replacement> change;
  const std::vector<TomlStatement> statements = toml_statements(text);
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const TomlStatement& s = statements[i];
    if (s.table.size() <= path.size() || !begins_with(s.table, path)) continue;
    if (change && change->end != statements[i - 1].end) return std::nullopt;
    if (!change) change = Replacement{s.begin, s.end, ""};
    change->end = s.end;
  }
  if (!change) return std::nullopt;
  const std::string line = "value = " + value;
  const TomlTree root = parse_toml(line, "");
  for (const TomlTree& item : root.entries.front().value.items) {
    const std::size_t begin = offset_of(line, item.where), end = toml_value_end(line, begin);
    change->text += (change->text.empty() ? "[[" : "\n[[") + key_text(path, 0) + "]]\n" +
                    member_lines(line.substr(begin, end - begin));
  }
  return change;
}

// What makes the key have the value; nullopt where the text has no place for it.
std::optional<Replacement> replacement(std::string_view text, const TomlTree& root, std::string_view key,
                                       const std::string& value) {
  KeyPath steps = place_of_key(root, std::string(key));
  if (steps.size() == 1 && key.find_first_of(".[") != key.npos) return std::nullopt;  // it leads nowhere
  const TomlTree* deepest = &root;
  std::size_t depth = 0;
  while (depth < steps.size()) {
    const TomlTree* next = member(*deepest, steps[depth]);
    if (!next) break;
    deepest = next;
    ++depth;
  }
  if (depth == steps.size()) {
    std::optional<Replacement> change = in_place_of_entries(text, steps, value);
    const std::size_t begin = offset_of(text, deepest->where);
    if (!change) change = Replacement{begin, toml_value_end(text, begin), value};
    change->gone = deepest;
    return change;
  }
  if (!key.ends_with(']')) return into_table(text, *deepest, steps, depth, value);
  if (value.starts_with('{')) {
    const bool list = deepest->kind == TomlTree::Kind::array;
    return into_list(text, list ? deepest : nullptr, steps, value);
  }
  // A component of a vector that is not there: the others are zero.
  std::string vector = "[";
  for (const char* i : {"0", "1", "2"})
    vector += (*i == '0' ? "" : ", ") + (steps.back() == i ? value : "0.0");
  steps.pop_back();
  return into_table(text, *deepest, steps, depth, vector + "]");
}

// As TOML, and nothing behind it: a bare word becomes a string.
std::string toml_text(const std::string& value) {
  const std::string line = "value = " + value + "\n";
  try {
    const std::size_t begin = offset_of(line, parse_toml(line, "").entries.front().value.where);
    return line.substr(begin, toml_value_end(line, begin) - begin);
  } catch (const SceneError&) {
    return toml_string(value);
  }
}

// The text's own line breaks.
std::string with_line_breaks_of(std::string_view text, const std::string& lines) {
  const std::size_t first = text.find('\n');
  if (first == text.npos || first == 0 || text[first - 1] != '\r') return lines;
  std::string result;
  for (const char c : lines) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

bool any_in(const TomlTree& tree, const std::function<bool(const TomlTree&)>& is_one) {
  return is_one(tree) ||
         std::ranges::any_of(tree.items, [&](const TomlTree& item) { return any_in(item, is_one); }) ||
         std::ranges::any_of(tree.entries,
                             [&](const TomlEntry& entry) { return any_in(entry.value, is_one); });
}

// What a text has that none has that is written anew.
struct OwnOfText {
  bool comments = false, variables = false, expressions = false, repeats = false;

  void add(std::string_view text, const TomlTree& tree) {
    using Tree = TomlTree;
    const auto is_expression = [](const Tree& t) {
      return t.kind == Tree::Kind::text && t.text.starts_with('=');
    };
    comments = comments || has_toml_comment(text);
    variables = variables || tree.find("variables");
    expressions = expressions || any_in(tree, is_expression);
    repeats = repeats || any_in(tree, [](const Tree& t) { return t.find("repeat") != nullptr; });
  }

  std::string words() const {
    std::string all;
    for (const auto& [has, what] : {std::pair(comments, "comments"), std::pair(variables, "variables"),
                                    std::pair(expressions, "expressions"), std::pair(repeats, "repeats")})
      if (has) all += (all.empty() ? "" : ", ") + std::string(what);
    return all;
  }
};

std::optional<WrittenBack> edited(std::string text, const std::string& name,
                                  const std::vector<std::string>& overrides) {
  OwnOfText lost;
  for (const std::string& entry : overrides) {  // one by one: each sees what the ones before it made
    const std::size_t equals = equals_of(entry);
    if (equals == entry.npos) return std::nullopt;
    const TomlTree root = parse_toml(text, name);
    const auto change = replacement(text, root, std::string_view(entry).substr(0, equals),
                                    toml_text(entry.substr(equals + 1)));
    if (!change) return std::nullopt;
    const std::string old = text.substr(change->begin, change->end - change->begin);
    // A value gives way as it is asked to; with a list of entries, or with comments, more goes than that.
    const auto is_entry = [](const TomlTree& tree) { return tree.kind == TomlTree::Kind::table; };
    if (change->gone && (has_toml_comment(old) || any_in(*change->gone, is_entry)))
      lost.add(old, *change->gone);
    text.replace(change->begin, old.size(), with_line_breaks_of(text, change->text));
  }
  return WrittenBack{std::move(text), false, lost.words()};
}

// The title that the text gives, as it gives it; empty: none.
std::string title_in(const TomlTree& root) {
  const TomlTree* title = root.find("title");
  return title && title->kind == TomlTree::Kind::text ? title->text : "";
}

bool sets_title(const std::vector<std::string>& overrides) {
  return std::ranges::any_of(overrides, [](const std::string& text) { return text.starts_with("title="); });
}

}  // namespace

WrittenBack write_back(std::string_view text, const std::string& name,
                       const std::vector<std::string>& overrides, const std::string& folder) {
  Scene scene = read_scene_text(text, name, overrides, folder);
  const std::string meant = scene_text(scene);
  try {
    if (auto result = edited(std::string(text), name, overrides)) {
      Scene written = read_scene_text(result->text, name, {}, folder);
      // The file keeps its title, which the command line drops where it may not fit any more (title.hpp).
      if (!sets_title(overrides)) written.title = scene.title;
      if (scene_text(written) == meant) return *std::move(result);
    }
  } catch (const SceneError&) {  // the text has the key in a way that the search above does not know
  }
  const TomlTree root = parse_toml(text, name);
  if (!sets_title(overrides)) scene.title_pattern = title_in(root);
  OwnOfText lost;
  lost.add(text, root);
  return {scene_text(scene), true, lost.words()};
}

std::string said_of(const WrittenBack& written) {
  const std::string without = written.lost.empty() ? "" : " without its " + written.lost;
  if (written.anew) return "the file has no place for these values: the scene is written anew" + without;
  return written.lost.empty() ? "" : "the list is written anew" + without;
}

}  // namespace unfurl
