#include "core/scene/scene_error.hpp"

#include <utility>

namespace unfurl {

std::string problem_text(const SceneProblem& problem) {
  const bool override_ = problem.where.file == "--set";
  std::string text = problem.where.file;
  if (problem.where.line > 0)
    text += ":" + std::to_string(problem.where.line) + ":" + std::to_string(problem.where.column);
  if (!problem.key.empty()) text += (text.empty() ? "" : override_ ? " " : ": ") + problem.key;
  return text.empty() ? problem.message : text + ": " + problem.message;
}

SceneError::SceneError(std::vector<SceneProblem> problems) : problems_(std::move(problems)) {
  constexpr std::size_t most = 50;  // lines worth reading at once
  for (std::size_t i = 0; i < problems_.size() && i < most; ++i)
    text_ += (i ? "\n" : "") + problem_text(problems_[i]);
  if (problems_.size() > most) text_ += "\n... and " + std::to_string(problems_.size() - most) + " more";
}

}  // namespace unfurl
