// SPDX-License-Identifier: BSD-3-Clause
// A study beside the panel: what `unfurl study` and `unfurl sweep` do, of the scene that is shown.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/runs/motion.hpp"
#include "app/panel/runs/worker.hpp"
#include "core/study/study.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

struct StudyRequest {
  enum class Kind { precision, sweep };
  Kind kind = Kind::precision;
  // Speed against accuracy: methods over a ladder of steps.
  std::vector<std::string> methods;
  double largest_step = 0, smallest_step = 0;  // [s]; 0: the ladder of the command line
  // A measure over a parameter.
  std::string key;  // dotted
  double from = 0, to = 1;
  int count = 9;
  std::string measure = "deploy_time";

  bool operator==(const StudyRequest&) const = default;
};

struct StudyOutcome {
  StudyRequest request;
  SceneDocument document;
  std::vector<Figure> figures;
  std::string sentence;  // what came of it, for a person
  std::string message;   // why there is nothing
  // Of speed against accuracy: the numbers, and what motion they are of.
  std::shared_ptr<const Study> study = nullptr;
  MotionKey motion = nullptr;
};

// "unfurl study hoop6 -o study --steps 0.04:0.0025 --methods dvm": the same on the command line.
std::string study_command(const StudyRequest& request, const SceneDocument& document);

// A cancelled study (stop()) holds the points that it has.
class StudyJob : public Worker<std::pair<StudyRequest, SceneDocument>, std::shared_ptr<const StudyOutcome>> {
 public:
  explicit StudyJob(std::function<void()> wake = {});
};

}  // namespace unfurl
