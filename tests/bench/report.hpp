// SPDX-License-Identifier: BSD-3-Clause
// A table of measurements: printed as it grows, written as CSV at the end.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace unfurl::bench {

struct Row {
  std::string group;        // "ring", "scaling", ...
  std::string what;         // what was run
  double value = 0;         // the measurement
  std::string unit;         // "s", "us", "ratio", "kB", ...
  std::string target = {};  // "<= 0.125", empty: none
  double error = 0;         // largest node position error [m]; 0: not measured
};

class Report {
 public:
  explicit Report(std::ostream& out);
  void add(Row row);
  // The group's title, once before its rows.
  void begin(const std::string& title);
  bool write_csv(const std::string& path) const;

 private:
  std::ostream& out_;
  std::vector<Row> rows_;
};

// CPU time of the calling thread [s].
double cpu_seconds();

}  // namespace unfurl::bench
