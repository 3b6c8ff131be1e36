// SPDX-License-Identifier: BSD-3-Clause
// Simulates beside the window: the newest request only.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/runs/motion.hpp"
#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// A finished run and what belongs to it; immutable.
struct LiveRun {
  long id = 0;  // of the request that asked for it
  SceneDocument document;
  Scene scene;
  MotionKey motion;  // what it is a solution of
  Simulation simulation;
  Diagnostics diagnostics;
  std::vector<std::string> warnings;
};

struct SimulationOutcome {
  long id = 0;                         // of the request
  std::shared_ptr<const LiveRun> run;  // null: the scene is at fault, and why follows
  std::vector<SceneProblem> problems;
  std::string message;  // of other failures
};

class Simulator {
 public:
  // `wake` is called from the worker whenever there is something new to look at.
  explicit Simulator(std::function<void()> wake = {});
  ~Simulator();  // cancels what runs
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  // Replaces a request that waits and cancels one that runs. Returns the request's number.
  long submit(SceneDocument document);
  void cancel();
  // What finished since the last call; only ever of the newest request.
  std::optional<SimulationOutcome> take();
  bool busy() const;
  double progress() const { return progress_; }  // 0..1 of what runs
  long started() const { return started_; }      // how many requests began to run

 private:
  void work();
  SimulationOutcome run(long id, const SceneDocument& document);
  bool stale(long id) const { return newest_ != id; }
  void notify(double fraction);

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<SceneDocument> waiting_;
  std::optional<SimulationOutcome> finished_;
  std::atomic<long> newest_{0}, started_{0};
  std::atomic<double> progress_{0};
  bool running_ = false, ending_ = false;
  std::thread thread_;  // last: it uses the members above
};

}  // namespace unfurl
