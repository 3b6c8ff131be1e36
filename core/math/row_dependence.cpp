// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/row_dependence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

namespace unfurl {
namespace {

struct Entry {
  int column;
  double value;
};

class RowEchelon {
 public:
  explicit RowEchelon(const SparseRows& A)
      : work_(VectorXd::Zero(A.cols())),
        held_(static_cast<std::size_t>(A.cols()), 0),
        solved_for_(held_.size(), -1),
        users_(held_.size(), 0) {
    for (Index k = 0; k < A.nonZeros(); ++k) ++users_[at(A.innerIndexPtr()[k])];
  }

  // What the rows solved so far leave of row r of A, entries beyond `tolerance` of its largest one, and that
  // one.
  double clear(const SparseRows& A, Index r, double tolerance, std::vector<Entry>& left) {
    for (SparseRows::InnerIterator it(A, r); it; ++it) {
      add(static_cast<int>(it.col()), it.value());
      --users_[at(static_cast<int>(it.col()))];
    }
    double size = 0;
    for (const int c : columns_) size = std::max(size, std::abs(work_[c]));
    for (; !next_.empty(); next_.pop()) {
      const std::vector<Entry>& row = solved_[at(next_.top())];
      const double share = work_[row.front().column];
      if (share == 0) continue;
      for (const Entry& e : row) add(e.column, -share * e.value);
    }
    left.clear();
    for (const int c : columns_) {
      if (solved_for_[at(c)] < 0 && std::abs(work_[c]) > tolerance * size) left.push_back({c, work_[c]});
      work_[c] = 0, held_[at(c)] = 0;
    }
    columns_.clear();
    std::ranges::sort(left, {}, &Entry::column);
    return size;
  }

  // For the coordinate that the fewest rows hold, of those within half of the largest entry.
  void solve(std::vector<Entry> row) {
    constexpr double threshold = 0.5;
    double size = 0;
    for (const Entry& e : row) size = std::max(size, std::abs(e.value));
    std::size_t best = row.size();
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (std::abs(row[k].value) < threshold * size) continue;
      const auto rank = [&](std::size_t of) { return users_[at(row[of].column)]; };
      if (best == row.size() || rank(k) < rank(best) ||
          (rank(k) == rank(best) && std::abs(row[k].value) > std::abs(row[best].value) * (1 + 1e-9)))
        best = k;
    }
    std::swap(row.front(), row[best]);
    for (std::size_t k = row.size(); k-- > 0;) row[k].value /= row.front().value;
    for (const Entry& e : row) ++users_[at(e.column)];
    solved_for_[at(row.front().column)] = static_cast<int>(solved_.size());
    solved_.push_back(std::move(row));
  }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  void add(int column, double value) {
    work_[column] += value;
    if (held_[at(column)]) return;
    held_[at(column)] = 1;
    columns_.push_back(column);
    if (const int solved = solved_for_[at(column)]; solved >= 0) next_.push(solved);
  }

  std::vector<std::vector<Entry>> solved_;  // x_column + sum value x_c = 0, that of the column first
  VectorXd work_;                           // a row; 0 between two of them
  std::vector<char> held_;                  // 1: it has an entry in that column
  std::vector<int> columns_;                // of these entries
  // Solved rows whose columns it holds: each holds columns of later ones only.
  std::priority_queue<int, std::vector<int>, std::greater<>> next_;
  std::vector<int> solved_for_;  // which of them has this column for its own; -1: none
  std::vector<int> users_;       // of rows solved and still to come, that hold a column
};

}  // namespace

RowDependence dependence_of_rows(const SparseRows& A, double tolerance) {
  RowDependence out;
  RowEchelon echelon(A);
  std::vector<Entry> left;
  for (int r = 0; r < A.rows(); ++r) {
    const double size = echelon.clear(A, r, tolerance, left);
    double most = 0;
    for (const Entry& e : left) most = std::max(most, std::abs(e.value));
    if (left.empty()) {
      out.rows.push_back(r);
      continue;
    }
    out.least = std::min(out.least, most / size);
    out.entries += std::ssize(left);
    echelon.solve(left);
  }
  return out;
}

}  // namespace unfurl
