// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/report.hpp"

#include <time.h>

#include <cstdio>
#include <fstream>
#include <ostream>

namespace unfurl::bench {
namespace {

std::string number(double value, const char* format = "%.4g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

Report::Report(std::ostream& out) : out_(out) {}

void Report::begin(const std::string& title) {
  out_ << "\n" << title << "\n";
}

void Report::add(Row row) {
  char line[200];
  std::snprintf(line, sizeof line, "  %-62s %10s %-12s %-12s %s\n", row.what.c_str(),
                number(row.value).c_str(), row.unit.c_str(),
                row.target.empty() ? "" : ("target " + row.target).c_str(),
                row.error > 0 ? ("error " + number(row.error, "%.1e") + " m").c_str() : "");
  out_ << line << std::flush;
  rows_.push_back(std::move(row));
}

bool Report::write_csv(const std::string& path) const {
  std::ofstream file(path);
  file << "group,what,value,unit,target,error_m\n";
  for (const Row& r : rows_)
    file << r.group << ",\"" << r.what << "\"," << number(r.value, "%.9g") << "," << r.unit << ",\""
         << r.target << "\"," << (r.error > 0 ? number(r.error, "%.3e") : "") << "\n";
  return static_cast<bool>(file.flush());
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace unfurl::bench
