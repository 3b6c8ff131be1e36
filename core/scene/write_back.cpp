// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/write_back.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/scene/overrides.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

namespace {

struct Replacement {
  std::size_t begin, end;  // bytes
  std::string text;
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

// Behind the TOML value that begins at `at`; the text is known to be TOML.
std::size_t value_end(std::string_view text, std::size_t at) {
  int depth = 0;
  std::size_t end = at;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end = string_end(text, at);
      if (depth == 0) return end;
      continue;
    }
    if (c == '#' && depth == 0) return end;
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (depth == 0 && (c == '\n' || c == ',' || c == ']' || c == '}')) return end;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    ++at;
    if (c != ' ' && c != '\t' && c != '\r') end = at;
    if (depth == 0 && (c == ']' || c == '}')) return end;
  }
  return end;
}

// A member of a table, or an item of an array by its index.
const TomlTree* member(const TomlTree& tree, const std::string& step) {
  if (tree.kind != TomlTree::Kind::array) return tree.find(step);
  std::size_t index = tree.items.size();
  std::from_chars(step.data(), step.data() + step.size(), index);
  return index < tree.items.size() ? &tree.items[index] : nullptr;
}

// Behind the last line of a table's own values.
std::optional<std::size_t> end_of_table(std::string_view text, const TomlTree& table) {
  std::optional<std::size_t> end;
  for (const auto& [name, value] : table.entries) {
    if (value.kind == TomlTree::Kind::table) continue;
    if (value.kind == TomlTree::Kind::array && !value.items.empty() &&
        value.items.front().kind == TomlTree::Kind::table)
      continue;
    const std::size_t line = text.find('\n', value_end(text, offset_of(text, value.where)));
    end = std::max(end.value_or(0), line == text.npos ? text.size() : line + 1);
  }
  return end;
}

// The members of an inline table, a line each.
std::string member_lines(const std::string& table) {
  const std::string text = "value = " + table;
  const TomlTree root = parse_toml(text, "");
  std::string lines;
  for (const auto& [name, value] : root.entries.front().value.entries) {
    const std::size_t begin = offset_of(text, value.where);
    lines += name + " = " + text.substr(begin, value_end(text, begin) - begin) + "\n";
  }
  return lines;
}

Replacement at_the_end(std::string_view text, const std::string& lines) {
  const char* gap = text.empty() || text.ends_with('\n') ? "\n" : "\n\n";
  return {text.size(), text.size(), gap + lines};
}

// What makes the key have the value; nullopt where the text has no place for it.
std::optional<Replacement> replacement(std::string_view text, const TomlTree& root, std::string_view key,
                                       const std::string& value) {
  const std::vector<std::string> steps = place_of_key(root, std::string(key));
  const bool entry = key.ends_with(']');
  if (steps.size() == 1 && key.find_first_of(".[") != key.npos) return std::nullopt;  // it leads nowhere
  const TomlTree* table = &root;
  for (std::size_t i = 0; i + 1 < steps.size() && table; ++i) table = member(*table, steps[i]);
  if (table) {
    if (const TomlTree* found = member(*table, steps.back())) {
      const std::size_t begin = offset_of(text, found->where);
      return Replacement{begin, value_end(text, begin), value};
    }
  }
  const std::string line = steps.back() + " = " + value + "\n";
  if (steps.size() >= 2 && entry) {  // a new entry of a list
    std::string list;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) list += (i == 0 ? "" : ".") + steps[i];
    return at_the_end(text, "[[" + list + "]]\n" + member_lines(value));
  }
  if (table) {
    const auto end = end_of_table(text, *table);
    if (!end) return std::nullopt;
    const bool broken = *end > 0 && text[*end - 1] != '\n';
    return Replacement{*end, *end, (broken ? "\n" : "") + line};
  }
  if (steps.size() != 2) return std::nullopt;
  return at_the_end(text, "[" + steps[0] + "]\n" + line);
}

// As TOML: a bare word becomes a string.
std::string toml_text(const std::string& value) {
  try {
    parse_toml("value = " + value + "\n", "");
    return value;
  } catch (const SceneError&) {
    return toml_string(value);
  }
}

std::optional<std::string> edited(std::string text, const std::string& name,
                                  const std::vector<std::string>& overrides) {
  for (const std::string& entry : overrides) {  // one by one: each sees what the ones before it made
    const std::size_t equals = entry.find('=');
    if (equals == entry.npos) return std::nullopt;
    const auto change = replacement(text, parse_toml(text, name), std::string_view(entry).substr(0, equals),
                                    toml_text(entry.substr(equals + 1)));
    if (!change) return std::nullopt;
    text.replace(change->begin, change->end - change->begin, change->text);
  }
  return text;
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
      Scene written = read_scene_text(*result, name, {}, folder);
      // The file keeps its title, which the command line drops where it may not fit any more (title.hpp).
      if (!sets_title(overrides)) written.title = scene.title;
      if (scene_text(written) == meant) return {*std::move(result), false};
    }
  } catch (const SceneError&) {  // the text has the key in a way that the search above does not know
  }
  if (!sets_title(overrides)) scene.title_pattern = title_in(parse_toml(text, name));
  return {scene_text(scene), true};
}

}  // namespace unfurl
