#include "core/math/linear_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <map>

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

}  // namespace

LinearElimination eliminate(const SparseRows& A, const ConstVec& b, double tolerance) {
  const Index n = A.cols();
  LinearElimination result;
  std::vector<Pivot> pivots;
  std::vector<int> pivot_of(static_cast<std::size_t>(n), -1);
  std::vector<std::vector<int>> users(static_cast<std::size_t>(n));  // pivots whose rows hold a column
  for (int r = 0; r < A.outerSize(); ++r) {
    Row row;
    double rhs = b[r];
    for (SparseRows::InnerIterator it(A, r); it; ++it)
      if (it.value() != 0.0) row[static_cast<int>(it.col())] += it.value();
    const double size = largest(row);
    substitute(row, rhs, pivots, pivot_of);
    std::erase_if(row, [&](const auto& e) { return std::abs(e.second) <= tolerance * size; });
    if (row.empty()) {
      auto& list = std::abs(rhs) <= 1e-9 * std::max({1.0, size, std::abs(b[r])}) ? result.redundant
                                                                                 : result.inconsistent;
      list.push_back(r);
      continue;
    }
    auto best = row.begin();
    for (auto it = row.begin(); it != row.end(); ++it)
      if (std::abs(it->second) > std::abs(best->second) * (1 + 1e-9)) best = it;
    Pivot pivot{best->first, {}, rhs / best->second};
    for (const auto& [c, a] : row)
      if (c != pivot.column) pivot.row[c] = a / best->second;
    const int index = static_cast<int>(pivots.size());
    for (int user :
         users[static_cast<std::size_t>(pivot.column)]) {  // keep earlier rows free of the new pivot
      Pivot& old = pivots[static_cast<std::size_t>(user)];
      const auto at = old.row.find(pivot.column);
      if (at == old.row.end()) continue;
      const double a = at->second;
      old.row.erase(at);
      old.rhs -= a * pivot.rhs;
      for (const auto& [c, v] : pivot.row) {
        old.row[c] -= a * v;
        users[static_cast<std::size_t>(c)].push_back(user);
      }
    }
    for (const auto& [c, v] : pivot.row) users[static_cast<std::size_t>(c)].push_back(index);
    pivot_of[static_cast<std::size_t>(pivot.column)] = index;
    pivots.push_back(std::move(pivot));
  }

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
