// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/mass_matrix.hpp"

namespace unfurl {

SparseRows node_mass_matrix(const Structure& structure) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int i, int j, double m) {
    for (int k = 0; k < 3; ++k) entries.emplace_back(3 * i + k, 3 * j + k, m);
  };
  for (const Rod& rod : structure.rods) {
    const double m = rod.mass * rod.multiplicity;
    if (m == 0.0) continue;
    const double own = structure.lumped_mass ? m / 2 : m / 3;
    add(rod.a, rod.a, own);
    add(rod.b, rod.b, own);
    if (!structure.lumped_mass) {
      add(rod.a, rod.b, m / 6);
      add(rod.b, rod.a, m / 6);
    }
  }
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    add(static_cast<int>(i), static_cast<int>(i),
        structure.nodes[i].mass);  // also keeps the diagonal in the pattern
  const auto n = 3 * static_cast<Index>(structure.nodes.size());
  SparseRows M(n, n);
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

}  // namespace unfurl
