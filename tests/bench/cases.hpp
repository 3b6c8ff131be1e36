// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "tests/bench/report.hpp"

namespace unfurl::bench {

void ring_cases(Report& report);     // the six-unit ring: cost of an accuracy, equal steps, sector
void ladder_cases(Report& report);   // the ladder at 30 m/s beside IDA
void factor_cases(Report& report);   // our factorisation beside others, on real patterns
void rival_cases(Report& report);    // an adaptive DOP853 with KLU: ring, sector, ladder, chain
void run_cases(Report& report);      // `unfurl run`: what it costs beside its stepping
void study_cases(Report& report);    // the path, margins, sweeps, a sector that is found
void scaling_cases(Report& report);  // rings of 6 to 10 000 units, a chain of 1000 rods: time and memory

// Rods of 0.1 m in a row, the first pinned, gravity across.
Structure chain_of_rods(int rods);

}  // namespace unfurl::bench
