// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/force_density.hpp"

#include <cmath>
#include <string>

#include "core/math/factors.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {

void find_form(const std::vector<NetMember>& members, const std::vector<bool>& fixed,
               const std::vector<Vec3>& loads, std::vector<Vec3>& positions) {
  std::vector<Index> place(fixed.size(), -1);
  Index free = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) place[i] = free++;
  MatrixXd right(free, 3);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (place[i] >= 0) right.row(place[i]) = loads[i].transpose();
  std::vector<Eigen::Triplet<double>> entries;
  for (const NetMember& m : members)
    for (const auto& [here, there] : {std::pair{m.a, m.b}, std::pair{m.b, m.a}}) {
      const Index row = place[static_cast<std::size_t>(here)],
                  column = place[static_cast<std::size_t>(there)];
      if (row < 0) continue;
      entries.emplace_back(row, row, m.density);
      if (column >= 0)
        entries.emplace_back(row, column, -m.density);
      else
        right.row(row) += m.density * positions[static_cast<std::size_t>(there)].transpose();
    }
  SparseColumns D(free, free);
  D.setFromTriplets(entries.begin(), entries.end());
  const SparseCholesky solver(D);
  const MatrixXd x = solver.ok() ? solver.solve(right) : MatrixXd();
  const VectorXd pivots = solver.pivots().cwiseAbs();
  // A part without a fixed node leaves a pivot that is round-off of its densities.
  const bool held =
      x.rows() == free && x.allFinite() && (free == 0 || pivots.minCoeff() > 1e-12 * pivots.maxCoeff());
  if (!held)
    throw StructureError("",
                         "form finding has no solution: some nodes of the net hang on nothing that is fixed");
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (place[i] >= 0) positions[i] = x.row(place[i]).transpose();
}

}  // namespace unfurl
