#pragma once

#include "tests/bench/report.hpp"

namespace unfurl::bench {

void ring_cases(Report& report);     // the six-unit ring: cost of an accuracy, equal steps, sector
void ladder_cases(Report& report);   // the ladder at 30 m/s beside IDA
void scaling_cases(Report& report);  // rings of 6 to 10 000 units, a chain of 1000 rods: time and memory

}  // namespace unfurl::bench
