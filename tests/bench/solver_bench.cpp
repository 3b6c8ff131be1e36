// SPDX-License-Identifier: BSD-3-Clause
// ./dev bench: the table of the solver's speed, printed and written as CSV (first argument, else bench.csv);
// words behind it name the parts that are wanted: ring, ladder, rival, factor, run, study, scaling.
#include <algorithm>
#include <iostream>
#include <string_view>
#include <utility>

#include "tests/bench/cases.hpp"

int main(int count, char** words) {
  unfurl::bench::Report report(std::cout);
  using namespace unfurl::bench;
  constexpr std::pair<std::string_view, void (*)(Report&)> parts[] = {
      {"ring", ring_cases}, {"ladder", ladder_cases}, {"rival", rival_cases},    {"factor", factor_cases},
      {"run", run_cases},   {"study", study_cases},   {"scaling", scaling_cases}};
  for (const auto& [name, cases] : parts)
    if (count < 3 || std::find(words + 2, words + count, name) != words + count) cases(report);
  const std::string path = count > 1 ? words[1] : "bench.csv";
  if (!report.write_csv(path)) {
    std::cerr << "cannot write " << path << "\n";
    return 5;
  }
  std::cout << "\n" << path << "\n";
}
