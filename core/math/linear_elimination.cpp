// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/linear_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace unfurl {
namespace {

using Row = std::map<int, double>;

struct Pivot {
  int column;
  Row row;  // x_column = rhs - sum row[c] x_c, c != column
  double rhs;
};

// Substitute every pivot variable that appears in `row`; pivots' own rows hold free columns only.
void substitute(Row& row, double& rhs, const std::vector<Pivot>& pivots, const std::vector<int>& pivot_of) {
  Row out;
  for (const auto& [c, a] : row) {
    const int p = pivot_of[static_cast<std::size_t>(c)];
    if (p < 0) {
      out[c] += a;
      continue;
    }
    const Pivot& pivot = pivots[static_cast<std::size_t>(p)];
    rhs -= a * pivot.rhs;
    for (const auto& [k, b] : pivot.row) out[k] -= a * b;
  }
  row = std::move(out);
}

double largest(const Row& row) {
  double m = 0;
  for (const auto& [c, a] : row) m = std::max(m, std::abs(a));
  return m;
}

// Rows that may be solved for a coordinate of their own, and what doing so costs.
class Elimination {
 public:
  Elimination(const SparseRows& A, const std::vector<char>& must, Index limit)
      : must_(must),
        limit_(limit),
        pivot_of_(static_cast<std::size_t>(A.cols()), -1),
        users_(pivot_of_.size()) {}

  const std::vector<Pivot>& pivots() const { return pivots_; }
  const std::vector<int>& pivot_of() const { return pivot_of_; }

  // The row's free coordinates alone.
  void reduce(Row& row, double& rhs) const { substitute(row, rhs, pivots_, pivot_of_); }

  // The column to solve the row for: none of those within `threshold` of the largest entry makes less fill,
  // and of these the largest. End: solving for any would let a coordinate act on more than `limit` others.
  Row::const_iterator choose(const Row& row) const {
    constexpr double threshold = 0.5;
    const bool forced = std::any_of(row.begin(), row.end(), [&](const auto& e) { return must(e.first); });
    double size = 0;
    for (const auto& [c, a] : row)
      if (!forced || must(c)) size = std::max(size, std::abs(a));
    auto best = row.end();
    for (auto it = row.begin(); it != row.end(); ++it) {
      if ((forced && !must(it->first)) || std::abs(it->second) < threshold * size) continue;
      if (!forced && densest_after(row, it->first) > limit_) continue;
      if (best == row.end() || users(it->first) < users(best->first) ||
          (users(it->first) == users(best->first) &&
           std::abs(it->second) > std::abs(best->second) * (1 + 1e-9)))
        best = it;
    }
    return best;
  }

  void solve(const Row& row, double rhs, Row::const_iterator at) {
    Pivot pivot{at->first, {}, rhs / at->second};
    for (const auto& [c, a] : row)
      if (c != pivot.column) pivot.row[c] = a / at->second;
    const auto column = static_cast<std::size_t>(pivot.column);
    for (const int user : users_[column]) put_into(pivots_[static_cast<std::size_t>(user)], user, pivot);
    users_[column].clear();
    const int index = static_cast<int>(pivots_.size());
    for (const auto& [c, v] : pivot.row) users_[static_cast<std::size_t>(c)].insert(index);
    pivot_of_[column] = index;
    pivots_.push_back(std::move(pivot));
  }

 private:
  bool must(int column) const { return !must_.empty() && must_[static_cast<std::size_t>(column)] != 0; }
  Index users(int column) const {
    return static_cast<Index>(users_[static_cast<std::size_t>(column)].size());
  }

  Index densest_after(const Row& row, int column) const {
    Index densest = 0;
    for (const auto& [c, a] : row)
      if (c != column) densest = std::max(densest, users(c) + users(column) + 1);
    return densest;
  }

  // Keeps an earlier row free of the new pivot.
  void put_into(Pivot& old, int index, const Pivot& pivot) {
    const auto at = old.row.find(pivot.column);
    const double a = at->second;
    old.row.erase(at);
    old.rhs -= a * pivot.rhs;
    for (const auto& [c, v] : pivot.row) {
      double& entry = old.row[c];
      const double before = std::abs(entry);
      entry -= a * v;
      auto& list = users_[static_cast<std::size_t>(c)];
      if (std::abs(entry) <= 1e-14 * before) {  // cancelled
        old.row.erase(c);
        list.erase(index);
      } else {
        list.insert(index);
      }
    }
  }

  const std::vector<char>& must_;
  Index limit_;
  std::vector<Pivot> pivots_;
  std::vector<int> pivot_of_;
  std::vector<std::set<int>> users_;  // pivots whose rows hold a column
};

// Rows that bring a coordinate that must go come first.
std::vector<int> row_order(const SparseRows& A, const std::vector<char>& must) {
  std::vector<int> order(static_cast<std::size_t>(A.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto later = [&](int r) {
    for (SparseRows::InnerIterator it(A, r); it; ++it)
      if (must[static_cast<std::size_t>(it.col())] && it.value() != 0.0) return 0;
    return 1;
  };
  if (!must.empty())
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return later(i) < later(j); });
  return order;
}

}  // namespace

LinearElimination eliminate(const SparseRows& A, const ConstVec& b, double tolerance) {
  return eliminate_sparsely(A, b, {}, std::numeric_limits<Index>::max(), tolerance);
}

LinearElimination eliminate_sparsely(const SparseRows& A, const ConstVec& b, const std::vector<char>& must,
                                     Index limit, double tolerance) {
  const Index n = A.cols();
  LinearElimination result;
  Elimination elimination(A, must, limit);
  for (const int r : row_order(A, must)) {
    Row row;
    double rhs = b[r];
    for (SparseRows::InnerIterator it(A, r); it; ++it)
      if (it.value() != 0.0) row[static_cast<int>(it.col())] += it.value();
    const double size = largest(row);
    elimination.reduce(row, rhs);
    std::erase_if(row, [&](const auto& e) { return std::abs(e.second) <= tolerance * size; });
    if (!row.empty()) result.least = std::min(result.least, largest(row) / size);
    if (row.empty()) {
      auto& list = std::abs(rhs) <= 1e-9 * std::max({1.0, size, std::abs(b[r])}) ? result.redundant
                                                                                 : result.inconsistent;
      list.push_back(r);
    } else if (const auto at = elimination.choose(row); at != row.end()) {
      elimination.solve(row, rhs, at);
    } else {
      result.kept.push_back(r);
    }
  }
  const auto& pivots = elimination.pivots();
  const auto& pivot_of = elimination.pivot_of();
  std::sort(result.kept.begin(), result.kept.end());

  std::vector<int> z_of(static_cast<std::size_t>(n), -1);
  for (int c = 0; c < n; ++c)
    if (pivot_of[static_cast<std::size_t>(c)] < 0) {
      z_of[static_cast<std::size_t>(c)] = static_cast<int>(result.free_coordinates.size());
      result.free_coordinates.push_back(c);
    }
  result.q0 = VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < n; ++c) {
    const int p = pivot_of[static_cast<std::size_t>(c)];
    if (p < 0) {
      entries.emplace_back(c, z_of[static_cast<std::size_t>(c)], 1.0);
      continue;
    }
    const Pivot& pivot = pivots[static_cast<std::size_t>(p)];
    result.q0[c] = pivot.rhs;
    for (const auto& [k, a] : pivot.row)
      if (std::abs(a) > tolerance) entries.emplace_back(c, z_of[static_cast<std::size_t>(k)], -a);
  }
  result.B.resize(n, static_cast<Index>(result.free_coordinates.size()));
  result.B.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace unfurl
