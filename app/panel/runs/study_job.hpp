// SPDX-License-Identifier: BSD-3-Clause
// A study beside the panel: what `unfurl study` and `unfurl sweep` do, of the scene that is shown.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/runs/motion.hpp"
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

class StudyJob {
 public:
  // `wake` is called from the worker whenever there is something new to look at.
  explicit StudyJob(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~StudyJob();  // cancels what runs
  StudyJob(const StudyJob&) = delete;
  StudyJob& operator=(const StudyJob&) = delete;

  void start(StudyRequest request, SceneDocument document);  // nothing where one runs
  void cancel() { cancelled_ = true; }
  bool running() const { return running_; }
  double progress() const { return progress_; }  // 0..1
  // What finished since the last call; null: nothing. A cancelled one holds the points it has.
  std::shared_ptr<const StudyOutcome> take();

 private:
  void work(const StudyRequest& request, const SceneDocument& document);

  std::function<void()> wake_;
  std::atomic<bool> running_{false}, cancelled_{false};
  std::atomic<double> progress_{0};
  std::mutex mutex_;
  std::shared_ptr<const StudyOutcome> finished_;
  std::thread thread_;
};

}  // namespace unfurl
