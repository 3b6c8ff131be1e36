// SPDX-License-Identifier: BSD-3-Clause
// Where in a TOML text its tables and keys stand; the text is known to be TOML.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

// A header, or a key with its value.
struct TomlStatement {
  bool header = false;
  // From the root, part by part, entries of lists by their index: the table that the header above names (of a
  // header, it names itself), and what the statement gives.
  std::vector<std::string> table, path;
  std::size_t begin = 0, value = 0, end = 0;  // bytes: its first, its value's first, behind its line break
};

std::vector<TomlStatement> toml_statements(std::string_view text);

// Behind the value that begins at `at`.
std::size_t toml_value_end(std::string_view text, std::size_t at);

bool has_toml_comment(std::string_view text);

}  // namespace unfurl
