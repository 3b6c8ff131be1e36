#include "core/scene/scene.hpp"

#include <utility>

namespace unfurl {

namespace {

std::string problem_text(const SceneProblem& problem) {
  std::string text = problem.where.file;
  if (problem.where.line > 0)
    text += ":" + std::to_string(problem.where.line) + ":" + std::to_string(problem.where.column);
  if (!problem.key.empty())
    text += (text.empty() ? "" : (problem.where.file == "--set" ? " " : ": ")) + problem.key;
  return text.empty() ? problem.message : text + ": " + problem.message;
}

}  // namespace

SceneError::SceneError(std::vector<SceneProblem> problems) : problems_(std::move(problems)) {
  for (const auto& problem : problems_) text_ += (text_.empty() ? "" : "\n") + problem_text(problem);
}

const std::vector<ParamSpec>& render_params() {
  static const std::vector<ParamSpec> params = [] {
    const RenderOptions fallback;
    ParamSpec size = vector_param("size", "pixels", {double(fallback.width), double(fallback.height)},
                                  "width and height of the pictures");
    size.min = 16;
    size.max = 8192;
    return std::vector<ParamSpec>{
        std::move(size),
        real_param("fps", "frames/s", fallback.fps, 0.1, 1000, "frames per second of the film"),
        real_param("speed", "", fallback.speed, 1e-6, 1e6, "seconds of motion per second of film"),
    };
  }();
  return params;
}

}  // namespace unfurl
