// SPDX-License-Identifier: BSD-3-Clause
// Scenes that tests write out: their models, their runs, what is wrong with them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"

namespace unfurl::testing {

inline std::shared_ptr<const Model> model_of(const std::string& text,
                                             const std::vector<std::string>& changes = {}) {
  return build_model(read_scene_text(text, "s.toml", changes));
}

// What is said against a scene, or against the model of it; empty: nothing.
inline std::string error_of(const std::string& text, const std::vector<std::string>& changes = {}) {
  try {
    model_of(text, changes);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

inline Simulation run_scene(const std::string& text, const std::vector<std::string>& changes = {}) {
  const Scene scene = read_scene_text(text, "s.toml", changes);
  return simulate(build_model(scene), scene.solver);
}

// Of all nodes where a run ended [3 n].
inline VectorXd end_positions(const Simulation& run) {
  return run.trajectory.node_positions(run.trajectory.size() - 1);
}

// The largest magnitude of a column.
inline double largest(const Diagnostics& d, const char* column) {
  double m = 0;
  for (const double x : d.at(column).values) m = std::max(m, std::abs(x));
  return m;
}

}  // namespace unfurl::testing
