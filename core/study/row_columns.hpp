// SPDX-License-Identifier: BSD-3-Clause
// A table's columns, each declared once: how its cell is written and read again.
#pragma once

#include <cmath>
#include <span>
#include <type_traits>

#include "core/study/table.hpp"

namespace unfurl {

// Of rows that are kept as T. To add a column: a line in the table's list.
template <class T>
struct RowColumn {
  const char* name;
  std::string (*get)(const T&);         // exact: what `set` reads is what it was
  void (*set)(T&, const std::string&);  // nothing where the value is in the row's key
  bool number = true;                   // its cells are numbers
};

// A member of T or of what `part` of it refers to.
template <class T, auto part, auto member>
constexpr RowColumn<T> number_column(const char* name) {
  return {name,
          [](const T& row) {
            if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(part(row).*member)>>)
              return std::to_string(part(row).*member);
            else
              return exact_number(part(row).*member);
          },
          [](T& row, const std::string& cell) {
            auto& value = part(row).*member;
            if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(value)>>)
              value = static_cast<std::remove_cvref_t<decltype(value)>>(std::lround(number_of(cell)));
            else
              value = number_of(cell);
          }};
}

template <class T>
std::vector<std::string> column_names(std::span<const RowColumn<T>> columns) {
  std::vector<std::string> names;
  for (const RowColumn<T>& column : columns) names.emplace_back(column.name);
  return names;
}

template <class T>
std::vector<std::size_t> number_columns(std::span<const RowColumn<T>> columns) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].number) numbers.push_back(i);
  return numbers;
}

template <class T>
std::vector<std::string> cells_of(std::span<const RowColumn<T>> columns, const T& row) {
  std::vector<std::string> cells;
  for (const RowColumn<T>& column : columns) cells.push_back(column.get(row));
  return cells;
}

template <class T>
void read_cells(std::span<const RowColumn<T>> columns, const std::vector<std::string>& cells, T& row) {
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i].set(row, cells[i]);
}

}  // namespace unfurl
