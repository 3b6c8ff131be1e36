// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/custom.hpp"
#include "tests/bench/cases.hpp"

namespace unfurl::bench {

Structure chain_of_rods(int rods) {
  CustomSpec spec;
  for (int i = 0; i <= rods; ++i)
    spec.nodes.push_back({"N" + std::to_string(i), {0.1 * i, 0, 0}, {0, 0, 0}, 0.0, i == 0});
  for (int i = 0; i < rods; ++i)
    spec.rods.push_back({"", {"N" + std::to_string(i), "N" + std::to_string(i + 1)}, 0.1});
  Structure structure = build_custom(spec);
  structure.gravity = {0, 0, -9.81};
  return structure;
}

}  // namespace unfurl::bench
