// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/rigid_twin.hpp"

namespace unfurl {

Structure rigid_twin(const Structure& structure, const ConstVec& q) {
  Structure twin = structure;
  for (std::size_t i = 0; i < twin.nodes.size(); ++i)
    twin.nodes[i].position = q.segment<3>(3 * static_cast<Index>(i));
  for (Rod& rod : twin.rods) {
    const double length =
        (q.segment<3>(3 * static_cast<Index>(rod.b)) - q.segment<3>(3 * static_cast<Index>(rod.a))).norm();
    if (rod.elastic()) rod.youngs_modulus *= length / rod.natural_length();
    rod.length = length;
    rod.gives = false;
    rod.free_length = rod.expansion = 0.0;
  }
  return twin;
}

}  // namespace unfurl
