// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/table.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "core/export/csv.hpp"
#include "core/text/xml_text.hpp"

namespace unfurl {

std::size_t Table::column(std::string_view name) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == name) return i;
  throw std::out_of_range("no column " + std::string(name));
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i ? "," : "") + csv_cell(cells[i]);
  return line + "\n";
}

std::string csv_text(const Table& table) {
  std::string text = csv_line(table.columns);
  for (const auto& row : table.rows) text += csv_line(row);
  return text;
}

// "a < b & c" is text as it stands; "<b" would open an element and "&b" an entity.
std::string markdown_line(std::string_view text) {
  const std::string plain = printable_text(text);
  const auto letter = [&](std::size_t i) {
    return i < plain.size() && std::isalpha(static_cast<unsigned char>(plain[i])) != 0;
  };
  std::string out;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const char next = i + 1 < plain.size() ? plain[i + 1] : ' ';
    if (plain[i] == '<' && (letter(i + 1) || next == '/' || next == '!' || next == '?'))
      out += "&lt;";
    else if (plain[i] == '&' && (letter(i + 1) || next == '#'))
      out += "&amp;";
    else
      out += plain[i] == '\n' ? ' ' : plain[i];
  }
  return out;
}

namespace {

// No column of its own.
std::string markdown_cell(const std::string& text) {
  std::string out;
  for (const char c : markdown_line(text)) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

}  // namespace

std::string markdown_text(const Table& table) {
  std::string text = "|", rule = "|";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    bool numeric = !table.rows.empty();
    for (const auto& row : table.rows) numeric = numeric && (row[c].empty() || is_number(row[c]));
    text += " " + markdown_cell(table.columns[c]) + " |";
    rule += numeric ? "---:|" : "---|";
  }
  text += "\n" + rule + "\n";
  for (const auto& row : table.rows) {
    text += "|";
    for (const auto& cell : row) text += " " + markdown_cell(cell) + " |";
    text += "\n";
  }
  return text;
}

std::string exact_number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0).ptr;
  return {buffer.data(), end};
}

std::string short_number(double value, int digits) {
  std::array<char, 40> buffer{};
  const double x = value + 0.0;
  const bool countable = std::abs(x) >= 1 && std::abs(x) < 1e6;  // 1230 rather than 1.23e+03
  std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, x);
  if (countable && std::string_view(buffer.data()).find('e') != std::string_view::npos)
    std::snprintf(buffer.data(), buffer.size(), "%.0f", x);
  std::string text = buffer.data();
  if (const std::size_t e = text.find('e'); e != std::string::npos) {  // 1e-6, as people write it
    std::size_t first = e + (text[e + 1] == '-' ? 2 : 1);
    if (text[first] == '+') text.erase(first, 1);
    while (text[first] == '0' && first + 1 < text.size()) text.erase(first, 1);
  }
  return text;
}

double number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    return std::numeric_limits<double>::quiet_NaN();
  return value;
}

bool is_number(std::string_view text) {
  return text == "nan" || !std::isnan(number_of(text));
}

}  // namespace unfurl
