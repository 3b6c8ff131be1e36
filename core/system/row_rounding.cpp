// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/system/system_data.hpp"

namespace unfurl {
namespace {

// Rows [first, end) of one constraint, and which of them the others or nothing at all make up: Gram-Schmidt
// from the largest row on. Scaled so that what is left of a row is to be compared with 1.
void add_dependent(const SparseRows& G, int first, int end, double negligible, std::vector<int>& dependent) {
  using Row = Eigen::SparseVector<double>;
  const auto length = [](const Row& row) { return row.size() > 0 ? row.norm() : 0.0; };
  std::vector<std::pair<int, Row>> rest;
  for (int r = first; r < end; ++r) rest.emplace_back(r, G.row(r).transpose());
  while (!rest.empty()) {
    const auto most = std::max_element(rest.begin(), rest.end(), [&](const auto& a, const auto& b) {
      return length(a.second) < length(b.second);
    });
    const double norm = length(most->second);
    if (norm <= negligible) break;
    const Row unit = most->second / norm;
    rest.erase(most);
    for (auto& [r, row] : rest) row -= Row(unit * unit.dot(row));
  }
  for (const auto& [r, row] : rest) dependent.push_back(r);
}

}  // namespace

void System::Data::move_origin() {
  constexpr double far = 100, rounded = 64 * std::numeric_limits<double>::epsilon();
  const double reach = coordinates > 0 ? start.lpNorm<Eigen::Infinity>() : 0.0;
  if (!eliminated || rows == 0 || !(reach > far * lengths.maxCoeff())) return;
  origin.resize(B.cols());
  for (Index i = 0; i < origin.size(); ++i) origin[i] = start[free_coordinates[static_cast<std::size_t>(i)]];
  q0 += B * origin;
  // The start itself has no error but its own rounding.
  for (Index i = 0; i < coordinates; ++i)
    if (std::abs(q0[i] - start[i]) <= rounded * reach) q0[i] = start[i];
}

void System::Data::clear_rounding(const std::vector<double>& node_entries, SparseRows& G) const {
  // A few products and sums; coefficients of what was eliminated are of order one.
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  const double* entry = node_entries.data();
  const int* const row_start = G.outerIndexPtr();
  double* const values = G.valuePtr();
  for (std::size_t r = 0, rows_of_G = row_ends.size(); r < rows_of_G; ++r) {
    const double* const row_end = node_entries.data() + row_ends[r];
    double whole = 0;
#pragma GCC unroll 2
    for (; entry != row_end; ++entry) whole = std::max(whole, std::abs(*entry));
    const double bound = rounding * whole;
    double* const end = values + row_start[r + 1];
    const double* x = values + row_start[r];
    while (x != end && !(std::abs(*x) > bound)) ++x;
    if (x == end) std::fill(values + row_start[r], end, 0.0);
  }
  for (const int r : implied) std::fill(values + row_start[r], values + row_start[r + 1], 0.0);
}

// Of rows those that know no positions (`there`, `here`: node entries at two poses) and have a coefficient
// that does not cancel are equations, however small that is.
void System::Data::keep_own_coefficients(std::vector<int>& these, double negligible,
                                         const std::vector<double>& there,
                                         const std::vector<double>& here) const {
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  if (these.empty()) return;
  VectorXd sum(pattern.nonZeros()), whole(sum.size());
  sums.of(here.data(), sum.data());
  const VectorXd sizes = Eigen::Map<const VectorXd>(here.data(), std::ssize(here)).cwiseAbs();
  sums.magnitudes().of(sizes.data(), whole.data());
  std::erase_if(these, [&](int row) {
    const auto r = static_cast<std::size_t>(row);
    for (auto e = static_cast<std::size_t>(row > 0 ? row_ends[r - 1] : 0),
              end = static_cast<std::size_t>(row_ends[r]);
         e < end; ++e)
      if (std::abs(here[e] - there[e]) > rounding * std::abs(here[e])) return false;
    for (Index e = pattern.outerIndexPtr()[row]; e < pattern.outerIndexPtr()[row + 1]; ++e)
      if (std::abs(sum[e]) > negligible * whole[e]) return true;
    return false;
  });
}

// A row that follows from the eliminated ones has no gradient in any pose that these allow, where one that is
// next to a singular pose has one elsewhere: two poses, far from the start and from each other, tell.
void System::find_implied_rows() {
  constexpr double digits = 1e-7;  // of positions; what is given with fewer is refused
  Data& d = *data_;
  if (!d.eliminated || d.rows == 0) return;
  std::vector<int> source = sources();
  for (const Drive& drive : d.drives) source[static_cast<std::size_t>(drive.row)] = -1;
  const auto same = [&](Index r, Index s) {
    return source[static_cast<std::size_t>(r)] == source[static_cast<std::size_t>(s)];
  };
  const Index n = solved_coordinates();
  SparseRows G = d.pattern;
  std::vector<double> scratch;
  std::vector<Eigen::Triplet<double>> entries;
  const VectorXd start = reduce(d.start);
  const double far = d.lengths.maxCoeff();
  VectorXd q(d.coordinates), z(n), whole(d.rows);
  std::vector<double> before;
  for (int pose = 0; pose < 2; ++pose) {
    before.swap(scratch);
    for (Index i = 0; i < n; ++i)
      z[i] = start[i] + far * std::cos(1.0 + pose + (2.3 + pose) * static_cast<double>(i));
    expand(z, q);
    jacobian(q, G, scratch);
    const double* entry = scratch.data();
    for (Index r = 0; r < d.rows; ++r) {
      const double* const end = scratch.data() + d.row_ends[static_cast<std::size_t>(r)];
      for (whole[r] = 0; entry < end; ++entry) whole[r] = std::max(whole[r], std::abs(*entry));
    }
    for (int r = 0; r < G.rows(); ++r) {
      if (source[static_cast<std::size_t>(r)] < 0) continue;
      double most = std::numeric_limits<double>::min();
      for (Index s = r; s >= 0 && same(s, r); --s) most = std::max(most, whole[s]);
      for (Index s = r; s < d.rows && same(s, r); ++s) most = std::max(most, whole[s]);
      for (SparseRows::InnerIterator it(G, r); it; ++it)
        if (it.value() != 0)
          entries.emplace_back(r, static_cast<int>(it.col() + pose * n), it.value() / most);
    }
  }
  SparseRows both(d.rows, 2 * n);
  both.setFromTriplets(entries.begin(), entries.end());
  for (int first = 0, end; first < d.rows; first = end) {
    for (end = first + 1; end < d.rows && same(end, first);) ++end;
    if (source[static_cast<std::size_t>(first)] >= 0) add_dependent(both, first, end, digits, d.implied);
  }
  d.keep_own_coefficients(d.implied, digits, before, scratch);
  std::sort(d.implied.begin(), d.implied.end());
}

std::vector<int> System::rows_of_digits() const {
  std::vector<int> rows;
  if (data_->implied.empty()) return rows;
  int first_kept = 0;
  for (const ConstraintBlock* block : data_->kept) {
    int first = 0;
    auto at = data_->all.begin();
    for (; at != data_->all.end() && *at != block; ++at) first += (*at)->rows();
    for (const int row : data_->implied)
      if (at != data_->all.end() && row >= first_kept && row < first_kept + block->rows())
        rows.push_back(first + row - first_kept);
    first_kept += block->rows();
  }
  return rows;
}

}  // namespace unfurl
