// What a scene file says, checked; plain data.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/integrators/solver_options.hpp"
#include "core/model/structure.hpp"
#include "core/structures/custom.hpp"

namespace unfurl {

struct SourceLocation {
  std::string file;  // as the user named it; "--set" for an override
  int line = 0, column = 0;
};

// One mistake: "FILE:LINE:COLUMN: KEY: message".
struct SceneProblem {
  SourceLocation where;
  std::string key;      // dotted: "structure.post_length"
  std::string message;
};

// All mistakes found in one reading. what() joins them, one line each.
class SceneError : public std::exception {
 public:
  explicit SceneError(std::vector<SceneProblem> problems);
  const char* what() const noexcept override { return text_.c_str(); }
  const std::vector<SceneProblem>& problems() const { return problems_; }

 private:
  std::vector<SceneProblem> problems_;
  std::string text_;
};

struct SceneLoad {
  std::vector<std::string> nodes;  // names or globs
  Vec3 force = Vec3::Zero();       // [N]
  SourceLocation where;
};

struct RenderOptions {
  int width = 1280, height = 720;  // [pixels]
  double fps = 30.0;               // frames per second of the film
  double speed = 1.0;              // seconds of motion per second of film
};

struct Scene {
  std::string name;   // file stem or built-in name: "hoop6"
  std::string title;
  std::string kind;   // structure.kind
  ParamSet structure; // the family's parameters (empty for custom)
  CustomSpec custom;  // for kind = "custom"
  Vec3 gravity = Vec3::Zero();  // [m/s^2]
  std::vector<SceneLoad> loads;
  SolverOptions solver;
  RenderOptions render;
  std::map<std::string, SourceLocation> locations;  // dotted key -> where it was given, for later messages
};

const std::vector<ParamSpec>& render_params();

}  // namespace unfurl
