// SPDX-License-Identifier: BSD-3-Clause
// A TOML document as plain data with source locations, so that nothing else needs to know the TOML library.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_error.hpp"

namespace unfurl {

struct TomlEntry;

struct TomlTree {
  enum class Kind { boolean, integer, real, text, array, table, time };

  Kind kind = Kind::table;
  bool boolean = false;
  long integer = 0;
  double real = 0.0;
  std::string text;
  std::vector<TomlTree> items;     // of an array
  std::vector<TomlEntry> entries;  // of a table, in the file's order
  SourceLocation where;            // of the value
  SourceLocation key_where;        // of its key, in a table

  const TomlTree* find(std::string_view key) const;  // entry of a table; nullptr where it has none
  TomlTree* find(std::string_view key);
  // "true", "a whole number", "text", "a table", ...: for error messages.
  std::string describe() const;
};

struct TomlEntry {
  std::string key;
  TomlTree value;
};

// Throws SceneError with the place of the mistake. `file` is the name that locations carry. The text must be
// UTF-8; a UTF-8 byte-order mark is skipped. No input can make it abort or exhaust the stack.
TomlTree parse_toml(std::string_view text, const std::string& file);

// What keeps a text from being read at all.
struct TextObstacle {
  std::size_t offset = 0;  // byte
  std::string message;     // empty: none
};
// The text behind the byte-order mark that some editors begin UTF-8 with.
std::string_view without_byte_order_mark(std::string_view text);
TextObstacle find_bad_encoding(std::string_view text);   // not UTF-8, a foreign byte-order mark, a zero byte
TextObstacle find_toml_obstacle(std::string_view text);  // these, and keys or brackets nested past reason

// Line and column (in characters, from 1) of a byte of the text.
SourceLocation locate(std::string_view text, std::size_t offset, const std::string& file);

// End of the string that opens at i: one past its closing quotes, or the line's end where a one-line string
// stays open.
std::size_t string_end(std::string_view text, std::size_t i);

}  // namespace unfurl
