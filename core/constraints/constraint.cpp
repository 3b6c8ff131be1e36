// SPDX-License-Identifier: BSD-3-Clause
#include "core/constraints/constraint.hpp"

#include <array>

#include "core/constraints/alignment.hpp"
#include "core/constraints/linear_rows.hpp"
#include "core/constraints/measure_rows.hpp"
#include "core/constraints/rod_length.hpp"

namespace unfurl {

void ConstraintBlock::add_curvature(const double* q, const double* lambda,
                                    std::vector<Eigen::Triplet<double>>& entries) const {
  std::size_t size = 0;
  for (int r = 0; r < rows(); ++r) size += stencil(r).size() * stencil(r).size();
  std::vector<double> hess(size);
  curvature(q, lambda, hess.data());
  const double* h = hess.data();
  for (int r = 0; r < rows(); ++r)
    for (const std::vector<int> c = stencil(r); int j : c)
      for (int i : c) entries.emplace_back(i, j, *h++);
}

std::span<const ConstraintKind> constraint_kinds() {
  static const std::array kinds{
      ConstraintKind{"plane", "a node stays in a plane; normal = its direction", plane_block},
      ConstraintKind{"line", "a node stays on a line; normal = its direction", line_block},
      ConstraintKind{"fixed", "a node stays where it is", fixed_block},
      ConstraintKind{"relation", "a linear relation between nodes (mirror, equality)", relation_block},
      ConstraintKind{"measure",
                     "a length, coordinate, angle or a combination of them is held or driven over time",
                     measure_block},
      ConstraintKind{"collinear", "a node stays on the line through two others", collinear_block},
      ConstraintKind{"coplanar", "a node stays in the plane through three others", coplanar_block},
      ConstraintKind{"rod", "the length of a rod; its multiplier is the axial force", rod_length_block},
  };
  return kinds;
}

}  // namespace unfurl
