// SPDX-License-Identifier: BSD-3-Clause
// Ways to drive a scene to an extreme.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/study/scene_variation.hpp"

namespace unfurl {

// A scene made harder by a number; `value` is what an atlas shows on its axis.
struct Extreme {
  std::string name;   // "mass_ratio"
  std::string label;  // "mass of chord rods, times"
  std::vector<double> values;
  bool log = true;
  // The model and options at a value; throws SceneError where it cannot be built.
  std::function<std::shared_ptr<const Model>(double value, SolverOptions& options)> build;
};

struct ExtremeKind {
  std::string_view name, help;
  // Nothing where the scene has not what it takes.
  std::optional<Extreme> (*make)(const SceneSource& source);
};
// To add one: a function and a row.
std::span<const ExtremeKind> extreme_kinds();

}  // namespace unfurl
