// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/self_stress.hpp"

#include <algorithm>
#include <cmath>

#include "core/math/determined_rows.hpp"
#include "core/math/factors.hpp"

namespace unfurl {
namespace {

// Of the largest member: coefficients carry round-off of 1e-16 divided by the smallest singular value.
constexpr double no_member = 1e-9;

// y: forces on rows of unit length, of the rows `basis` and `last`. `norm`: of the rows themselves.
SelfStress state_of(const VectorXd& y, const std::vector<int>& basis, int last, const VectorXd& norm) {
  SelfStress state;
  double largest = 0;
  const auto add = [&](int row, double force) {
    if (norm[row] > 0) force /= norm[row];
    if (std::abs(force) > std::abs(largest)) largest = force;
    state.members.push_back({row, force});
  };
  for (std::size_t k = 0; k < basis.size(); ++k) add(basis[k], y[static_cast<Index>(k)]);
  add(last, -1.0);
  std::erase_if(state.members,
                [&](const auto& m) { return std::abs(m.force) <= no_member * std::abs(largest); });
  for (auto& member : state.members) member.force /= largest;
  std::sort(state.members.begin(), state.members.end(),
            [](const auto& a, const auto& b) { return a.row < b.row; });
  return state;
}

}  // namespace

ForceBalance force_balance(const System& system, const ConstVec& q, const Mobility& mobility,
                           const std::vector<Rod>& rods) {
  ForceBalance out;
  const SparseRows rows = system.all_jacobian(q);
  VectorXd compliance = VectorXd::Zero(rows.rows());
  for (std::size_t r = 0; r < rods.size(); ++r)
    compliance[rows.rows() - static_cast<Index>(rods.size() - r)] = rods[r].compliance();
  // A row that others of its constraint imply shares nothing with the rest: it is counted as having no force.
  const std::vector<int> counted = counted_rows(system, q);
  out.determined.assign(static_cast<std::size_t>(rows.rows()), 1);
  const std::vector<char> unique = determined_rows(picked_rows(rows, counted), compliance(counted));
  for (std::size_t k = 0; k < counted.size(); ++k)
    out.determined[static_cast<std::size_t>(counted[k])] = unique[k];
  const std::vector<int>& dependent = mobility.redundant_rows;
  out.listed = dependent.empty() || rows.cols() <= max_listed_coordinates;
  if (dependent.empty() || !out.listed) return out;
  VectorXd norm(rows.rows());
  for (Index r = 0; r < rows.rows(); ++r) norm[r] = rows.row(r).norm();
  const MatrixXd G(unit_rows(system, q));
  std::vector<int> basis;
  for (const int r : counted)
    if (std::find(dependent.begin(), dependent.end(), r) == dependent.end()) basis.push_back(r);
  const MatrixXd shares =
      fitted_columns(G(basis, Eigen::all).transpose(), G(dependent, Eigen::all).transpose());
  for (std::size_t k = 0; k < dependent.size(); ++k)
    out.states.push_back(state_of(shares.col(static_cast<Index>(k)), basis, dependent[k], norm));
  return out;
}

}  // namespace unfurl
