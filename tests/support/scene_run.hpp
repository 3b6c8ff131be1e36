// SPDX-License-Identifier: BSD-3-Clause
// Runs of scenes that tests write out.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"

namespace unfurl::testing {

inline Simulation run_scene(const std::string& text, const std::vector<std::string>& changes = {}) {
  const Scene scene = read_scene_text(text, "test.toml", changes);
  return simulate(build_model(scene), scene.solver);
}

// The largest magnitude of a column.
inline double largest(const Diagnostics& d, const char* column) {
  double m = 0;
  for (const double x : d.at(column).values) m = std::max(m, std::abs(x));
  return m;
}

}  // namespace unfurl::testing
