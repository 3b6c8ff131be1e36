// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/sparse_ldlt.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "core/math/interleaved.hpp"

namespace unfurl {

// Elimination tree and row patterns of L (Liu 1990; the up-looking method of Davis 2006, "Direct Methods",
// ch. 4).
void SparseLdlt::analyse(const SparseRows& upper, const std::vector<int>& order) {
  n_ = upper.rows();
  const auto n = static_cast<std::size_t>(n_);
  order_ = order;
  std::vector<int> position(n);
  for (std::size_t k = 0; k < n; ++k) position[static_cast<std::size_t>(order[k])] = static_cast<int>(k);

  std::vector<std::vector<std::pair<int, int>>> columns(n);  // permuted upper triangle: (row, source)
  int source = 0;
  for (int r = 0; r < upper.outerSize(); ++r)
    for (SparseRows::InnerIterator it(upper, r); it; ++it, ++source) {
      const int a = position[static_cast<std::size_t>(r)], b = position[static_cast<std::size_t>(it.col())];
      columns[static_cast<std::size_t>(std::max(a, b))].emplace_back(std::min(a, b), source);
    }
  entry_start_.assign(1, 0);
  entry_row_.clear();
  entry_source_.clear();
  for (auto& column : columns) {
    std::sort(column.begin(), column.end());
    for (const auto& [row, from] : column) {
      entry_row_.push_back(row);
      entry_source_.push_back(from);
    }
    entry_start_.push_back(static_cast<int>(entry_row_.size()));
  }

  std::vector<int> parent(n, -1), mark(n, -1), count(n, 0), stack;
  reach_start_.assign(1, 0);
  reach_.clear();
  for (int k = 0; k < n_; ++k) {
    const auto uk = static_cast<std::size_t>(k);
    mark[uk] = k;
    stack.clear();
    for (int e = entry_start_[uk]; e < entry_start_[uk + 1]; ++e) {
      for (int i = entry_row_[static_cast<std::size_t>(e)]; mark[static_cast<std::size_t>(i)] != k;
           i = parent[static_cast<std::size_t>(i)]) {
        const auto ui = static_cast<std::size_t>(i);
        if (parent[ui] == -1) parent[ui] = k;
        mark[ui] = k;
        ++count[ui];
        stack.push_back(i);
      }
    }
    std::sort(stack.begin(), stack.end());  // ascending is a topological order of the tree
    reach_.insert(reach_.end(), stack.begin(), stack.end());
    reach_start_.push_back(static_cast<int>(reach_.size()));
  }
  column_start_.assign(n + 1, 0);
  for (std::size_t k = 0; k < n; ++k) column_start_[k + 1] = column_start_[k] + count[k];
  const auto nonzeros = static_cast<std::size_t>(column_start_[n]);
  row_index_.assign(nonzeros, 0);
  l_.assign(nonzeros, 0.0);
  pivot_.assign(n, 0.0);
  inverse_pivot_.assign(n, 0.0);
  work_.assign(n, 0.0);
  std::vector<int> free(column_start_.begin(), column_start_.end() - 1);
  slot_.clear();
  for (int k = 0; k < n_; ++k)
    for (int r = reach_start_[static_cast<std::size_t>(k)]; r < reach_start_[static_cast<std::size_t>(k) + 1];
         ++r) {
      slot_.push_back(free[static_cast<std::size_t>(reach_[static_cast<std::size_t>(r)])]++);
      row_index_[static_cast<std::size_t>(slot_.back())] = k;
    }
  permuted_.assign(8 * n, 0.0);
}

// How many columns of L from i on, `most` of them at most, have the same rows behind the last one: each has
// the next one's index for its first row, and one row more than that.
inline int columns_alike(int i, int most, const int* start, const int* rows) {
  int n = 1;
  for (; n < most; ++n, ++i)
    if (start[i + 1] - start[i] != start[i + 2] - start[i + 1] + 1 || rows[start[i]] != i + 1) break;
  return n;
}

// y[rows[p]] -= l[0][p] x[0], then l[1][p] x[1] and so on, for p < count: `width` rows that follow each other
// by one instruction, to the same bits.
template <int width, std::size_t columns>
inline void subtract_columns(const std::array<const double*, columns>& l,
                             const std::array<double, columns>& x, const int* rows, int count, double* y) {
  using Pack = Lanes<LaneCount(width, width)>;
  int p = 0;
  while (p < count) {
    double* const to = y + rows[p];
    if (p + width <= count && rows[p + width - 1] - rows[p] == width - 1) {
      Pack left(to);
      for (std::size_t k = 0; k < columns; ++k) left = left - x[k] * Pack(l[k] + p);
      left.store(to);
      p += width;
    } else {
      for (std::size_t k = 0; k < columns; ++k) *to -= l[k][p] * x[k];
      ++p;
    }
  }
}

bool SparseLdlt::factorise(const double* values, double most) {
  constexpr Index many = 8;  // entries of a column, in the mean: of fewer, one by one is as fast
  if (factor_nonzeros() < many * n_) return eliminate<1>(values, most);
  bool held = false;
  with_widest([this, values, most, out = &held](auto width) { *out = eliminate<width()>(values, most); });
  return held;
}

template <int width>
bool SparseLdlt::eliminate(const double* values, double most) {
  const int n = static_cast<int>(n_);
  double* const y = work_.data();
  double* const l = l_.data();
  double* const inverse_pivot = inverse_pivot_.data();
  const int* const rows = row_index_.data();
  const int* const start = column_start_.data();
  const int* entry_row = entry_row_.data();
  const int* entry_source = entry_source_.data();
  const int* entry_end = entry_start_.data() + 1;
  const int* reach = reach_.data();
  const int* slot = slot_.data();
  const int* reach_end = reach_start_.data() + 1;
  for (int k = 0; k < n; ++k) {
    for (const int* const end = entry_row_.data() + entry_end[k]; entry_row != end;
         ++entry_row, ++entry_source)
      y[*entry_row] += values[*entry_source];
    const double own = y[k];
    double d = own;
    y[k] = 0.0;
    for (const int* const end = reach_.data() + reach_end[k]; reach != end; ++reach, ++slot) {
      const int i = *reach;
      if constexpr (width > 1) {
        // Columns i and those behind it that are alike.
        const auto take = [&](auto number) {
          constexpr int columns = number();
          std::array<const double*, columns> of{};
          std::array<double, columns> x{};
          for (int j = 0; j < columns; ++j) {
            double& xj = x[static_cast<std::size_t>(j)];
            xj = std::exchange(y[i + j], 0.0);
            for (int p = 0; p < j; ++p) xj -= l[start[i + p] + j - p - 1] * x[static_cast<std::size_t>(p)];
            of[static_cast<std::size_t>(j)] = l + start[i + j] + columns - 1 - j;
          }
          const int behind = start[i + columns - 1];
          subtract_columns<width>(of, x, rows + behind, slot[columns - 1] - behind, y);
          for (int j = 0; j < columns; ++j) {
            const double xj = x[static_cast<std::size_t>(j)], lki = xj * inverse_pivot[i + j];
            d -= lki * xj;
            l[slot[j]] = lki;
          }
          reach += columns - 1, slot += columns - 1;
        };
        const int alike = columns_alike(i, std::min(static_cast<int>(end - reach), 4), start, rows);
        if (alike == 4) take(std::integral_constant<int, 4>());
        if (alike == 3) take(std::integral_constant<int, 3>());
        if (alike == 2) take(std::integral_constant<int, 2>());
        if (alike > 1) continue;
      }
      const double yi = y[i];
      y[i] = 0.0;
      const int free = *slot;
      for (int p = start[i]; p < free; ++p) y[rows[p]] -= l[p] * yi;
      const double lki = yi * inverse_pivot[i];
      d -= lki * yi;
      l[free] = lki;
    }
    // The pivot of a row of -C is its Schur complement in C + G A^-1 G^T: no weaker than what C has there.
    if (own < 0.0 && d > 0.5 * own) d = own;  // only round-off is left of a redundant row
    if (d == 0.0 || !std::isfinite(d) || d >= most) {
      std::fill(work_.begin(), work_.end(), 0.0);
      return false;
    }
    pivot_[static_cast<std::size_t>(k)] = d;
    inverse_pivot[k] = 1.0 / d;
  }
  return true;
}

double SparseLdlt::largest_pivot() const {
  return pivot_.empty() ? 0.0 : *std::max_element(pivot_.begin(), pivot_.end());
}

template <int R>
void SparseLdlt::solve_fixed(double* const b) const {
  with_wide<R>([b, n = static_cast<int>(n_), l = l_.data(), rows = row_index_.data(),
                start = column_start_.data(), inverse_pivot = inverse_pivot_.data()](auto lanes) {
    using Row = Lanes<lanes()>;
    for (int j = 0; j < n; ++j) {
      const Row bj(b + j * R);
#pragma GCC unroll 2
      for (int p = start[j], end = start[j + 1]; p < end; ++p) {
        double* const to = b + static_cast<Index>(rows[p]) * R;
        (Row(to) - l[p] * bj).store(to);
      }
    }
    for (int j = n - 1; j >= 0; --j) {
      Row bj = inverse_pivot[j] * Row(b + j * R);
#pragma GCC unroll 2
      for (int p = start[j], end = start[j + 1]; p < end; ++p)
        bj = bj - l[p] * Row(b + static_cast<Index>(rows[p]) * R);
      bj.store(b + j * R);
    }
  });
}

void SparseLdlt::solve_ordered(double* b, int columns) const {
  with_columns(columns, [&](auto k) { solve_fixed<k()>(b); });
}

void SparseLdlt::subtract_product(const double* values, const double* x, double* r) const {
  const int* row = entry_row_.data();
  const int* source = entry_source_.data();
  for (int k = 0, n = static_cast<int>(n_); k < n; ++k) {
    const double xk = x[k];
    double sum = 0;
    for (const int* const diagonal = entry_row_.data() + entry_start_[static_cast<std::size_t>(k) + 1] - 1;
         row != diagonal; ++row, ++source) {
      const double value = values[*source];
      sum += value * x[*row];
      r[*row] -= value * xk;
    }
    sum += values[*source] * xk;
    r[k] -= sum;
    ++row, ++source;
  }
}

void SparseLdlt::solve(double* x, int columns) const {
  double* const b = permuted_.data();
  for (std::size_t k = 0; k < order_.size(); ++k)
    std::copy_n(x + static_cast<Index>(order_[k]) * columns, columns, b + static_cast<Index>(k) * columns);
  solve_ordered(b, columns);
  for (std::size_t k = 0; k < order_.size(); ++k)
    std::copy_n(b + static_cast<Index>(k) * columns, columns, x + static_cast<Index>(order_[k]) * columns);
}

}  // namespace unfurl
