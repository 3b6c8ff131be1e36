// SPDX-License-Identifier: BSD-3-Clause
// Comma-separated text (RFC 4180) with one header line, for nodes and rods that come from a file of their
// own.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_error.hpp"
#include "core/scene/table_reader.hpp"

namespace unfurl {

// Columns a file may have; `number` columns must hold finite numbers.
struct CsvColumn {
  std::string_view name;
  std::string_view unit;  // the header may carry it as a suffix: "x_m"
  bool number = false;
  bool required = false;
  bool boolean = false;  // 1 or 0, also true or false, as in TOML
};

struct CsvRow {
  SourceLocation where;
  std::map<std::string, std::string, std::less<>> texts;
  std::map<std::string, double, std::less<>> numbers;  // an empty cell is absent
};

// All rows that are right; what is wrong is noted with file:line. Blank lines and lines that begin with # are
// skipped. `header`: in place of a first line that names the columns.
std::vector<CsvRow> read_csv(std::string_view text, const std::string& file,
                             const std::vector<CsvColumn>& columns, SceneNotes& notes,
                             std::string_view header = {});

// The cells of every record, the header's too, unjudged; not a last one that ends within quotes.
std::vector<std::vector<std::string>> csv_records(std::string_view text);

}  // namespace unfurl
