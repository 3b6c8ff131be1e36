// SPDX-License-Identifier: BSD-3-Clause
// Included before every source of core in a mutation build: which of the seeded errors is switched on. The
// environment variable UNFURL_MUTANT names one by its number; without it the code is as written.
#pragma once

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

namespace unfurl_mutation {

inline const int chosen = [] {
  const char* number = std::getenv("UNFURL_MUTANT");
  return number ? std::atoi(number) : -1;
}();
// Which switches were passed by: added at the end to the file that UNFURL_REACHED names.
struct Reached {
  std::atomic<bool> at[200000];
  ~Reached() {
    const char* path = std::getenv("UNFURL_REACHED");
    std::FILE* file = path ? std::fopen(path, "a") : nullptr;
    if (!file) return;
    for (int k = 0; k < 200000; ++k)
      if (at[k].load(std::memory_order_relaxed)) std::fprintf(file, "%d\n", k);
    std::fclose(file);
  }
};
inline Reached reached;
inline bool on(int mutant) {
  reached.at[mutant].store(true, std::memory_order_relaxed);
  return mutant == chosen;
}
// What a term is multiplied with: -1, 2 or 0 where the error is on. Twice what is true or false is no error:
// it does not compile, and another is drawn.
struct Factor {
  int value;
};
template <class T, std::enable_if_t<!std::is_same<T, bool>::value, int> = 0>
auto operator*(Factor factor, const T& term) {
  return factor.value * term;
}
inline Factor sign(int mutant) {
  return {on(mutant) ? -1 : 1};
}
inline Factor twice(int mutant) {
  return {on(mutant) ? 2 : 1};
}
inline Factor keep(int mutant) {
  return {on(mutant) ? 0 : 1};
}
// The left side of a comparison that is tried with its boundary. Two reals are equal by design only, which no
// test can force: there it does not compile.
template <class T, std::enable_if_t<!std::is_floating_point<T>::value, int> = 0>
const T& edge(const T& left) {
  return left;
}
// What an index or a count is off by.
inline int one(int mutant) {
  return on(mutant) ? 1 : 0;
}

}  // namespace unfurl_mutation
