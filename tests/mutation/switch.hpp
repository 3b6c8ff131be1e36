// SPDX-License-Identifier: BSD-3-Clause
// Included before every source of core in a mutation build: which of the seeded errors is switched on. The
// environment variable UNFURL_MUTANT names one by its number; without it the code is as written.
#pragma once

#include <cstdlib>

namespace unfurl_mutation {

inline const int chosen = [] {
  const char* number = std::getenv("UNFURL_MUTANT");
  return number ? std::atoi(number) : -1;
}();
inline bool on(int mutant) {
  return mutant == chosen;
}
// What a term is multiplied with: -1, 2 or 0 where the error is on.
inline int sign(int mutant) {
  return on(mutant) ? -1 : 1;
}
inline int twice(int mutant) {
  return on(mutant) ? 2 : 1;
}
inline int keep(int mutant) {
  return on(mutant) ? 0 : 1;
}
// What an index or a count is off by.
inline int one(int mutant) {
  return on(mutant) ? 1 : 0;
}

}  // namespace unfurl_mutation
