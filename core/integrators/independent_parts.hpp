// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/math/coupled_columns.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Parts of a structure that neither masses, constraints nor forces join. What is heavy, fast or far away in
// one says nothing about what round-off leaves in another.
class IndependentParts {
 public:
  explicit IndependentParts(const System& system);
  void join(const SparseRows& rows);  // coordinates that stand in one row of it, with whatever number
  void join_by_forces(const System& system, double t, const VectorXd& q, const VectorXd& v);  // allocates
  bool several() const { return count_ > 1; }
  Index count() const { return count_; }
  Index of(Index coordinate) const { return part_[static_cast<std::size_t>(coordinate)]; }
  Index of_row(Index r) const { return of(first_[static_cast<std::size_t>(r)]); }
  // Of each part the largest magnitude in rows of `columns` numbers, one for each coordinate.
  VectorXd largest(const double* x, Index columns = 1) const;
  VectorXd largest_of_rows(const VectorXd& x) const;  // one number for each constraint row
  VectorXd largest_beside(const VectorXd& x) const;   // the same, of each row that of its part
  VectorXd spread(const VectorXd& of_parts) const;    // to coordinates

 private:
  void number();

  CoupledColumns sets_;
  std::vector<Index> part_, first_;  // first_: a coordinate of each constraint row
  Index count_ = 0;
};

}  // namespace unfurl
