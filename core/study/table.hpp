// SPDX-License-Identifier: BSD-3-Clause
// Results as plain text cells: what CSV files, Markdown tables and journals are made of.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

struct Table {
  std::vector<std::string> columns;  // names with unit suffix: "cpu_median_s"
  std::vector<std::vector<std::string>> rows;

  // Index of a column; throws std::out_of_range.
  std::size_t column(std::string_view name) const;
};

std::string csv_line(const std::vector<std::string>& cells);  // ends with a line break
std::string csv_text(const Table& table);
// Text of anybody's as one line of Markdown: neither HTML nor commands to a terminal.
std::string markdown_line(std::string_view text);
std::string markdown_text(const Table& table);  // a pipe table; numbers to the right

// Shortest text that reads back as the same double; "nan" and "inf" where it is none.
std::string exact_number(double value);
// With so many significant digits, as people write it: "4.92", "1230", "1.2e-9".
std::string short_number(double value, int digits = 3);
// Back from either; NaN where the text is no number.
double number_of(std::string_view text);
bool is_number(std::string_view text);

}  // namespace unfurl
