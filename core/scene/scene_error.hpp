// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a scene, and where.
#pragma once

#include <string>
#include <vector>

#include "core/text/error.hpp"

namespace unfurl {

inline constexpr const char* override_source = "--set";  // where overrides are said to come from
inline constexpr const char* varied_source = "--vary";   // and those of a sweep's axes

struct SourceLocation {
  std::string file;          // as the user named it, override_source or varied_source
  int line = 0, column = 0;  // from 1; 0: unknown

  bool operator==(const SourceLocation&) const = default;
};

// One mistake: "FILE:LINE:COLUMN: KEY: message".
struct SceneProblem {
  SourceLocation where;
  std::string key;  // dotted: "structure.post_length"
  std::string message;
};

// "FILE:LINE:COLUMN: KEY: message" or, for an override, "--set KEY: message", "--vary KEY: message".
std::string problem_text(const SceneProblem& problem);

// All mistakes found in one reading. what() joins them, one line each.
class SceneError : public Error {
 public:
  explicit SceneError(std::vector<SceneProblem> problems);
  const std::vector<SceneProblem>& problems() const { return problems_; }

 private:
  std::vector<SceneProblem> problems_;
};

}  // namespace unfurl
