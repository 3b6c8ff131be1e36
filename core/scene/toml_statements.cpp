// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/toml_statements.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/scene/toml_tree.hpp"

namespace unfurl {

namespace {

bool is_quote(char c) {
  return c == '"' || c == '\'';
}

// The first such character behind `at` that stands in no string.
std::size_t find_unquoted(std::string_view text, std::size_t at, char wanted) {
  while (at < text.size() && text[at] != wanted) at = is_quote(text[at]) ? string_end(text, at) : at + 1;
  return at;
}

// The parts of a dotted key.
std::vector<std::string> parts_of_key(std::string_view key) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < key.size();) {
    if (is_quote(key[at])) {
      const std::size_t end = string_end(key, at);
      const std::string line = "value = " + std::string(key.substr(at, end - at));
      parts.push_back(parse_toml(line, "").entries.front().value.text);
      at = end;
    } else if (key[at] == '.' || key[at] == ' ' || key[at] == '\t') {
      ++at;
    } else {
      const std::size_t end = std::min(key.find_first_of(". \t", at), key.size());
      parts.emplace_back(key.substr(at, end - at));
      at = end;
    }
  }
  return parts;
}

std::size_t behind_line(std::string_view text, std::size_t at) {
  return std::min(text.find('\n', at), text.size() - 1) + 1;
}

// The tables that headers name, with the entries of lists counted.
class TomlHeaders {
 public:
  std::vector<std::string> table(const std::vector<std::string>& parts, bool entry) {
    std::vector<std::string> path;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      path.push_back(parts[i]);
      if (entry && i + 1 == parts.size()) ++counts_[path];
      const auto list = counts_.find(path);
      if (list != counts_.end()) path.push_back(std::to_string(list->second - 1));
    }
    return path;
  }

 private:
  std::map<std::vector<std::string>, std::size_t> counts_;
};

}  // namespace

std::vector<TomlStatement> toml_statements(std::string_view text) {
  std::vector<TomlStatement> statements;
  std::vector<std::string> table;
  TomlHeaders headers;
  std::size_t at = text.size() - without_byte_order_mark(text).size();
  while ((at = text.find_first_not_of(" \t\r\n", at)) != text.npos) {
    if (text[at] == '#') {
      at = behind_line(text, at);
      continue;
    }
    TomlStatement made;
    made.begin = at;
    made.header = text[at] == '[';
    if (made.header) {
      const bool entry = text.substr(at).starts_with("[[");
      const std::size_t name = at + (entry ? 2 : 1), close = find_unquoted(text, name, ']');
      table = headers.table(parts_of_key(text.substr(name, close - name)), entry);
      made.table = made.path = table;
      made.end = behind_line(text, close);
    } else {
      const std::size_t equals = find_unquoted(text, at, '=');
      made.table = made.path = table;
      for (std::string& part : parts_of_key(text.substr(at, equals - at)))
        made.path.push_back(std::move(part));
      made.value = std::min(text.find_first_not_of(" \t", equals + 1), text.size());
      made.end = behind_line(text, toml_value_end(text, made.value));
    }
    at = made.end;
    statements.push_back(std::move(made));
  }
  return statements;
}

std::size_t toml_value_end(std::string_view text, std::size_t at) {
  int depth = 0;
  std::size_t end = at;
  while (at < text.size()) {
    const char c = text[at];
    if (is_quote(c)) {
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

bool has_toml_comment(std::string_view text) {
  return find_unquoted(text, 0, '#') < text.size();
}

}  // namespace unfurl
