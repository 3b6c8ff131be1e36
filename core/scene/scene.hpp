// SPDX-License-Identifier: BSD-3-Clause
// What a scene file says, checked; plain data.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/integrators/solver_options.hpp"
#include "core/scene/elements.hpp"
#include "core/scene/render_options.hpp"
#include "core/scene/scene_error.hpp"
#include "core/scene/surfaces.hpp"
#include "core/structure/structure.hpp"
#include "core/structures/custom.hpp"

namespace unfurl {

struct SceneLoad {
  std::vector<std::string> nodes;  // names or globs
  Vec3 force = Vec3::Zero();       // [N]
  SourceLocation where;
  bool enabled = true;  // false: as if it were not there
};

struct Scene {
  std::string name;             // file stem or built-in name: "hoop6"
  std::string title;            // with the parameters that it names
  std::string title_pattern;    // as given, "{units}-unit ring antenna"; empty: the title itself
  std::string kind;             // structure.kind
  ParamSet structure;           // the family's parameters (empty for custom)
  CustomSpec custom;            // for kind = "custom"
  Vec3 gravity = Vec3::Zero();  // [m/s^2]
  std::vector<SceneLoad> loads;
  std::vector<SceneElement> forces, constraints;
  SceneElement deployment;  // [deployment]: its terms are what it measures; without any, the scene has none
  std::vector<SceneSurface> surfaces;  // shown only
  SolverOptions solver;
  RenderOptions render;
  std::map<std::string, double> variables;          // [variables], worked out
  std::set<std::string> worked_out;                 // dotted keys whose values come of expressions or braces
  std::vector<SceneProblem> warnings;               // what is given and does nothing
  std::vector<SceneProblem> warnings_on_path;       // and what does nothing where the path is solved
  std::map<std::string, SourceLocation> locations;  // dotted key -> where it was given, for later messages
  std::map<std::string, std::string> units;         // of the keys that overrides change: dotted key -> unit
  std::set<std::string> files;                      // that it names, as paths
};

}  // namespace unfurl
