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

void WeakRows::count_falling(const State& from, const State& to, double share) {
  constexpr double any = 1, lost_rank = 1e-10;
  if (parts_.size() < 2) return;
  std::vector<bool> falls;
  for (FreeMotion& part : parts_)  // a row that others explain in the one state alone has no pivot there
    falls.push_back(part.rows_below(to, lost_rank) > part.rows_below(from, lost_rank) ||
                    part.weakest_pivot(to, any) < share * part.weakest_pivot(from, any));
  if (std::ranges::count(falls, true) > 0) counts_ = std::move(falls);
}

bool WeakRows::another_falls(const State& from, const State& to, double bound) {
  constexpr double falls = 0.9;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    if (counts_[p]) continue;
    const double pivot = parts_[p].weakest_pivot(to, bound);
    if (pivot < bound && pivot < falls * parts_[p].weakest_pivot(from, 1)) return true;
  }
  return false;
}

}  // namespace unfurl
