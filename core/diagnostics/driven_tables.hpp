// SPDX-License-Identifier: BSD-3-Clause
// Tables and sines that prescribe motions faster than steps follow.
#pragma once

#include <string>
#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

class DrivenTables {
 public:
  explicit DrivenTables(const Structure& structure);
  // The times within a step at which tables have points, ascending, where three Gauss points between its ends
  // do not tell what is prescribed there: of a table that samples a smooth motion finely they do, of one
  // whose values are rounded to the digits of a file, or measured, they do not. Of a sine those that cut a
  // wave into eight.
  std::vector<double> points_within(double from, double to) const;
  bool only_sines() const;  // smooth between all of those times
  // "the table of NAME has 10 points within a step: solver.step = 0.001 follows them": of the finest; empty
  // where none has a point within a step of that length.
  std::string words(double step) const;

 private:
  struct Table {
    std::string name;
    TimeFunction f;
  };
  std::vector<Table> tables_;
};

}  // namespace unfurl
