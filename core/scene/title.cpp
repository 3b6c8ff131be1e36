// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/title.hpp"

#include <array>
#include <optional>

#include "core/structures/family.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {
namespace {

// A piece of a title: a place "{key}", or what stands there itself.
struct Piece {
  std::size_t end;
  std::string key, text;
};

// A brace that is doubled means itself; so does one around anything but a key, which "variables.n" would be,
// too.
Piece piece_at(const std::string& text, std::size_t at) {
  static const std::string letters = "abcdefghijklmnopqrstuvwxyz_", digits = "0123456789";
  const char c = text[at];
  if ((c == '{' || c == '}') && at + 1 < text.size() && text[at + 1] == c) return {at + 2, "", {c}};
  if (c == '{') {
    const bool word = at + 1 < text.size() && letters.find(text[at + 1]) != std::string::npos;
    const std::size_t close = text.find_first_not_of(letters + digits + (word ? "." : ""), at + 1);
    if (close != std::string::npos && text[close] == '}' && close > at + 1)
      return {close + 1, text.substr(at + 1, close - at - 1), ""};
  }
  return {at + 1, "", {c}};
}

std::string number_word(long x, bool first) {
  static constexpr std::array words{"one",   "two",   "three", "four", "five",   "six",
                                    "seven", "eight", "nine",  "ten",  "eleven", "twelve"};
  if (x < 1 || x > static_cast<long>(words.size())) return std::to_string(x);
  std::string word = words[static_cast<std::size_t>(x - 1)];
  if (first) word[0] = static_cast<char>(word[0] - 'a' + 'A');
  return word;
}

// A value as a title says it; nothing where it has none that fits into a line.
std::optional<std::string> said(const TomlTree& value, bool first) {
  switch (value.kind) {
    case TomlTree::Kind::integer:
      return number_word(value.integer, first);
    case TomlTree::Kind::real:
      return shortest_number(value.real);
    case TomlTree::Kind::text:
      return value.text;
    case TomlTree::Kind::boolean:
      return value.boolean ? "true" : "false";
    default:
      return std::nullopt;
  }
}

std::optional<std::string> said_default(const TomlTree& structure, const std::string& key, bool first) {
  const TomlTree* kind = structure.find("kind");
  const Family* family = kind && kind->kind == TomlTree::Kind::text ? find_family(kind->text) : nullptr;
  if (!family) return std::nullopt;
  for (const ParamSpec& spec : family->params()) {
    if (spec.name != key) continue;
    if (const auto* i = std::get_if<long>(&spec.fallback)) return number_word(*i, first);
    if (const auto* x = std::get_if<double>(&spec.fallback)) return shortest_number(*x);
    if (const auto* s = std::get_if<std::string>(&spec.fallback)) return *s;
    if (const auto* b = std::get_if<bool>(&spec.fallback)) return *b ? "true" : "false";
  }
  return std::nullopt;
}

const TomlTree& structure_of(const TomlTree& tree) {
  static const TomlTree none;
  const TomlTree* structure = tree.find("structure");
  return structure && structure->kind == TomlTree::Kind::table ? *structure : none;
}

bool same(const TomlTree& a, const TomlTree& b) {
  const auto number = [](const TomlTree& t) {
    return t.kind == TomlTree::Kind::integer ? static_cast<double>(t.integer) : t.real;
  };
  const auto is_number = [](const TomlTree& t) {
    return t.kind == TomlTree::Kind::integer || t.kind == TomlTree::Kind::real;
  };
  if (is_number(a) && is_number(b)) return number(a) == number(b);
  if (a.kind != b.kind || a.boolean != b.boolean || a.text != b.text || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (!same(a.items[i], b.items[i])) return false;
  for (const auto& [key, value] : a.entries) {
    const TomlTree* other = b.find(key);
    if (!other || !same(value, *other)) return false;
  }
  return true;
}

// "angle = 30, bob_mass = 2": keys of the structure that are not what they were.
std::string changes(const TomlTree& now, const TomlTree& before) {
  std::string text;
  for (const auto& [key, value] : now.entries) {
    const TomlTree* old = before.find(key);
    const bool short_one = said(value, false).has_value();
    if (old ? same(*old, value) : short_one && said_default(now, key, false) == said(value, false)) continue;
    const bool number = value.kind == TomlTree::Kind::integer || value.kind == TomlTree::Kind::real;
    text += (text.empty() ? "" : ", ") + key;
    if (number)
      text +=
          " = " + shortest_number(value.kind == TomlTree::Kind::real ? value.real
                                                                     : static_cast<double>(value.integer));
    else
      text += short_one ? " = " + *said(value, false) : " changed";
  }
  return text;
}

}  // namespace

bool is_title_pattern(const std::string& title) {
  for (std::size_t at = 0; at < title.size();) {
    const Piece piece = piece_at(title, at);
    if (!piece.key.empty()) return true;
    at = piece.end;
  }
  return false;
}

std::string title_that_says(const std::string& text) {
  bool plain = true;
  std::string doubled;
  for (std::size_t at = 0; at < text.size();) {
    const Piece piece = piece_at(text, at);
    plain = plain && piece.end == at + 1;
    for (; at < piece.end; ++at) doubled.append(text[at] == '{' || text[at] == '}' ? 2 : 1, text[at]);
  }
  return plain ? text : doubled;
}

std::string scene_title(const TomlTree& tree, const TomlTree& own, const std::string& name,
                        std::string* unknown) {
  const TomlTree *given = tree.find("title"), *before = own.find("title");
  if (!given || given->kind != TomlTree::Kind::text) return name;
  const std::string& pattern = given->text;
  const TomlTree& structure = structure_of(tree);
  if (!is_title_pattern(pattern)) {
    const bool as_in_file = before && before->kind == TomlTree::Kind::text && before->text == pattern;
    const std::string changed = as_in_file ? changes(structure, structure_of(own)) : "";
    if (!changed.empty()) return name + ": " + changed;
  }
  std::string title;
  for (std::size_t at = 0; at < pattern.size();) {
    const Piece piece = piece_at(pattern, at);
    if (piece.key.empty()) {
      title += piece.text;
    } else {
      const TomlTree* value = structure.find(piece.key);
      const auto text = value ? said(*value, at == 0) : said_default(structure, piece.key, at == 0);
      if (!text && unknown) *unknown = piece.key;
      if (!text) return pattern;
      title += *text;
    }
    at = piece.end;
  }
  return title;
}

}  // namespace unfurl
