// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl::testing {

// Four nodes in space, two rods and a fold angle: what the tables of constraints and forces are tried on.
inline Structure table_structure() {
  Structure s;
  s.nodes = {
      {"a", {0.1, 0.2, 0.3}}, {"b", {1.3, -0.4, 0.6}}, {"c", {0.7, 1.9, -0.8}}, {"d", {-0.6, 0.5, 1.1}}};
  s.rods = {{"ab", 0, 1, 1.0, 1.5, "rod", 0.01, 1.0}, {"bc", 1, 2, 1.0, 2.0, "rod", 0.01, 1.0}};
  const Vec3 n = Vec3(1, 2, 2) / 3;
  s.deployment.fold_sine = {{0, 1}, {n, -n}, 0.3};
  s.deployment.fold_cosine = {{1, 3}, {Vec3(0.5, 0, 1), n}, 1.2};
  return s;
}

}  // namespace unfurl::testing
