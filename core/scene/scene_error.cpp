// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/scene_error.hpp"

#include <utility>

namespace unfurl {

std::string problem_text(const SceneProblem& problem) {
  const SourceLocation& where = problem.where;
  std::string text = where.file;
  if (where.line > 0)
    text.append(":").append(std::to_string(where.line)).append(":").append(std::to_string(where.column));
  if (!problem.key.empty())
    text.append(text.empty() ? "" : text == override_source ? " " : ": ").append(problem.key);
  return text.append(text.empty() ? "" : ": ").append(problem.message);
}

SceneError::SceneError(std::vector<SceneProblem> problems) : problems_(std::move(problems)) {
  constexpr std::size_t most = 50;  // lines worth reading at once
  for (std::size_t i = 0; i < problems_.size() && i < most; ++i)
    text_.append(i ? "\n" : "").append(problem_text(problems_[i]));
  if (problems_.size() > most)
    text_.append("\n... and ").append(std::to_string(problems_.size() - most)).append(" more");
}

}  // namespace unfurl
