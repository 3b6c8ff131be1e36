// SPDX-License-Identifier: BSD-3-Clause
// ./dev bench: the table of the solver's speed, printed and written as CSV (first argument, else bench.csv).
#include <iostream>

#include "tests/bench/cases.hpp"

int main(int count, char** words) {
  unfurl::bench::Report report(std::cout);
  unfurl::bench::ring_cases(report);
  unfurl::bench::ladder_cases(report);
  unfurl::bench::factor_cases(report);
  unfurl::bench::scaling_cases(report);
  const std::string path = count > 1 ? words[1] : "bench.csv";
  if (!report.write_csv(path)) {
    std::cerr << "cannot write " << path << "\n";
    return 5;
  }
  std::cout << "\n" << path << "\n";
}
