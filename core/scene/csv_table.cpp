// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/csv_table.hpp"

#include <charconv>
#include <cmath>

#include "core/scene/toml_tree.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

struct Record {
  int line = 0;  // where it begins
  std::vector<std::string> cells;
  std::string_view fault;  // what is wrong with its quotes
};

// Takes one record after the other from the text.
class Splitter {
 public:
  explicit Splitter(std::string_view text) : text_(text) {}

  bool next(Record& record) {
    while (at_ < text_.size() && (text_[at_] == '#' || blank_line())) skip_line();
    if (at_ >= text_.size()) return false;
    record = {line_, {}, ""};
    do record.cells.push_back(cell(record.fault));
    while (at_ < text_.size() && text_[at_++] == ',');
    if (at_ > 0 && text_[at_ - 1] == '\n') ++line_;
    return true;
  }

 private:
  bool blank_line() const {
    return trimmed(text_.substr(at_, std::min(text_.find_first_of("\r\n", at_), text_.size()) - at_)).empty();
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    if (at_ < text_.size()) ++at_;
    ++line_;
  }

  // Stops at the comma or line end behind the cell.
  std::string cell(std::string_view& fault) {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    std::string value;
    const bool quoted = at_ < text_.size() && text_[at_] == '"';
    if (quoted) value = quoted_cell(fault);
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n') ++at_;
    std::string_view rest = text_.substr(begin, at_ - begin);
    if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
    rest = trimmed(rest);
    if (quoted && !rest.empty()) fault = "has text behind a closing quote";
    return quoted ? value : std::string(rest);
  }

  std::string quoted_cell(std::string_view& fault) {
    std::string value;
    bool closed = false;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '"')) {
        ++at_;
        closed = true;
        break;
      }
      if (text_[at_] == '"') ++at_;
      if (text_[at_] == '\n') ++line_;
      value += text_[at_];
    }
    if (!closed) fault = "has a quote that is not closed";
    return value;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

const CsvColumn* find_column(std::string_view header, const std::vector<CsvColumn>& columns) {
  for (const auto& column : columns) {
    const std::string with_unit = std::string(column.name) + "_" + std::string(column.unit);
    if (header == column.name || (!column.unit.empty() && header == with_unit)) return &column;
  }
  return nullptr;
}

// A column with a unit that is not its own holds other values than this one would.
std::string unknown_column(const std::string& cell, const std::vector<CsvColumn>& columns) {
  std::vector<std::string_view> names;
  for (const auto& column : columns) names.push_back(column.name);
  const std::string_view stem = name_before_unit(cell, names);
  for (const auto& column : columns)
    if (column.name == stem && !column.unit.empty())
      return "unknown column " + in_quotes(cell) + "; give " +
             in_quotes(std::string(stem) + "_" + std::string(column.unit)) +
             ", with the values converted to that unit";
  return "unknown column " + in_quotes(cell) + did_you_mean(cell, names);
}

// The column of each cell; nullptr for unknown ones, which are noted.
std::vector<const CsvColumn*> read_header(const Record& record, const std::string& file,
                                          const std::vector<CsvColumn>& columns, SceneNotes& notes) {
  const SourceLocation where{file, record.line, 1};
  std::vector<const CsvColumn*> found;
  for (const auto& cell : record.cells) {
    const CsvColumn* column = find_column(cell, columns);
    if (!column) notes.add(where, "", unknown_column(cell, columns));
    for (const auto* earlier : found)
      if (column && earlier == column) notes.add(where, "", "column " + in_quotes(cell) + " appears twice");
    found.push_back(column);
  }
  for (const auto& column : columns) {
    bool present = !column.required;
    for (const auto* given : found) present = present || given == &column;
    if (!present) notes.add(where, "", "column " + in_quotes(column.name) + " is missing");
  }
  return found;
}

void read_number(const std::string& cell, const CsvColumn& column, CsvRow& row, SceneNotes& notes) {
  if (cell.empty()) {
    if (column.required) notes.add(row.where, std::string(column.name), "is empty");
    return;
  }
  if (column.boolean && (cell == "true" || cell == "false")) {
    row.numbers[std::string(column.name)] = cell == "true" ? 1.0 : 0.0;
    return;
  }
  const char* begin = cell.data() + (cell[0] == '+' && cell.size() > 1 && cell[1] != '-' ? 1 : 0);
  double x = 0.0;
  const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), x);
  if (error == std::errc::result_out_of_range)
    notes.add(row.where, std::string(column.name),
              "must be 0 or of a size between 1e-307 and 1e308; got " + in_quotes(cell));
  else if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(x) ||
           (column.boolean && x != 0.0 && x != 1.0))
    notes.add(row.where, std::string(column.name),
              std::string("must be ") + (column.boolean ? "true or false" : "a finite number") + "; got " +
                  in_quotes(cell));
  else
    row.numbers[std::string(column.name)] = x;
}

}  // namespace

std::vector<std::vector<std::string>> csv_records(std::string_view text) {
  Splitter splitter(text);
  std::vector<std::vector<std::string>> rows;
  for (Record record; splitter.next(record);)
    if (record.fault.empty()) rows.push_back(std::move(record.cells));
  return rows;
}

std::vector<CsvRow> read_csv(std::string_view text, const std::string& file,
                             const std::vector<CsvColumn>& columns, SceneNotes& notes,
                             std::string_view header_line) {
  text = without_byte_order_mark(text);
  if (const auto obstacle = find_bad_encoding(text); !obstacle.message.empty()) {
    notes.add(locate(text, obstacle.offset, file), "", obstacle.message);
    return {};
  }
  Splitter splitter(text), given(header_line);
  Record record;
  if (!given.next(record) && !splitter.next(record)) {
    notes.add({file, 1, 1}, "", "is empty; the first line must name the columns");
    return {};
  }
  const std::size_t problems = notes.problems.size();
  const auto header = read_header(record, file, columns, notes);
  if (notes.problems.size() > problems) return {};
  std::vector<CsvRow> rows;
  while (splitter.next(record)) {
    CsvRow row{{file, record.line, 1}, {}, {}};
    if (!record.fault.empty()) {
      notes.add(row.where, "", std::string(record.fault));
      continue;
    }
    if (record.cells.size() != header.size()) {
      notes.add(row.where, "",
                "has " + std::to_string(record.cells.size()) + " cells; the header has " +
                    std::to_string(header.size()));
      continue;
    }
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i]->number)
        read_number(record.cells[i], *header[i], row, notes);
      else
        row.texts[std::string(header[i]->name)] = record.cells[i];
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace unfurl
