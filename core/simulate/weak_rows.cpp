// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/weak_rows.hpp"

#include <algorithm>
#include <utility>

#include "core/integrators/independent_parts.hpp"

namespace unfurl {

WeakRows::WeakRows(const System& system) {
  const IndependentParts parts(system);
  std::vector<std::vector<Index>> members(static_cast<std::size_t>(parts.count()));
  for (Index i = 0; i < system.solved_coordinates(); ++i)
    members[static_cast<std::size_t>(parts.of(i))].push_back(i);
  for (std::vector<Index>& of_part : members) parts_.emplace_back(system, std::move(of_part));
  counts_.assign(parts_.size(), true);
}

Index WeakRows::below(const State& state, double bound) {
  Index sum = 0;
  for (FreeMotion& part : parts_) sum += part.rows_below(state, bound);
  return sum;
}

double WeakRows::pivot(const State& state, double bound) {
  double least = bound;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (counts_[p]) least = std::min(least, parts_[p].weakest_pivot(state, bound));
  return least;
}

void WeakRows::count_falling(const State& from, const State& to) {
  constexpr double far_weaker = 0.1, any = 1;
  if (parts_.size() < 2) return;
  std::vector<bool> falls;
  for (FreeMotion& part : parts_)
    falls.push_back(part.weakest_pivot(to, any) < far_weaker * part.weakest_pivot(from, any));
  if (std::ranges::count(falls, true) > 0) counts_ = std::move(falls);
}

}  // namespace unfurl
