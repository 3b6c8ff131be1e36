// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/scene_error.hpp"

#include <utility>

namespace unfurl {

std::string problem_text(const SceneProblem& problem) {
  const SourceLocation& where = problem.where;
  std::string text = where.file;
  const bool option = text == override_source || text == varied_source;
  if (where.line > 0)
    text.append(":").append(std::to_string(where.line)).append(":").append(std::to_string(where.column));
  if (!problem.key.empty()) text.append(text.empty() ? "" : option ? " " : ": ").append(problem.key);
  return text.append(text.empty() ? "" : ": ").append(problem.message);
}

namespace {

std::string all_of(const std::vector<SceneProblem>& problems) {
  constexpr std::size_t most = 50;  // lines worth reading at once
  std::string text;
  for (std::size_t i = 0; i < problems.size() && i < most; ++i)
    text.append(i ? "\n" : "").append(problem_text(problems[i]));
  if (problems.size() > most)
    text.append("\n... and ").append(std::to_string(problems.size() - most)).append(" more");
  return text;
}

}  // namespace

SceneError::SceneError(std::vector<SceneProblem> problems)
    : Error(all_of(problems)), problems_(std::move(problems)) {}

}  // namespace unfurl
