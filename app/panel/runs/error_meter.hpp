// SPDX-License-Identifier: BSD-3-Clause
// Measures position errors of finished runs beside the window, against a reference of their motion.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <limits>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/panel/runs/simulator.hpp"
#include "core/study/reference_motion.hpp"

namespace unfurl {

struct RunError {
  long run = 0;  // LiveRun::id
  // Largest distance of a node from the reference, and how well that is known [m]; NaN: there is none.
  double error = std::numeric_limits<double>::quiet_NaN(), uncertainty = error;
  double end = 0;        // up to when it was judged [s]
  double cpu_s = 0;      // of the stepping loop up to there [s]; 0: only that of the whole run is known
  std::string why = {};  // there is no reference; empty where there is one but the run did not get through
};

class ErrorMeter {
 public:
  // `wake` is called from the worker whenever there is something new to look at.
  explicit ErrorMeter(std::function<void()> wake = {});
  ~ErrorMeter();  // cancels what it does
  ErrorMeter(const ErrorMeter&) = delete;
  ErrorMeter& operator=(const ErrorMeter&) = delete;

  // Of this run and of earlier ones of its motion that are not measured yet. A reference of another motion
  // that is being solved is given up at once. A motion's reference is solved once.
  void measure(std::shared_ptr<const LiveRun> run);
  // Rest while something more urgent runs, and go on.
  void hold(bool on);
  std::vector<RunError> take();  // what was measured since the last call
  bool busy() const;
  long begun() const { return begun_; }    // references
  long solved() const { return solved_; }  // of those, to the end

 private:
  struct Known {
    MotionKey motion;
    std::shared_ptr<const ReferenceMotion> reference;  // null: there is none, and why
    std::string why;
  };
  void work();
  bool stopped(long task);
  bool has_work() const;  // call locked
  const Known* find(const MotionKey& motion);
  Known solve(const LiveRun& run, const std::shared_ptr<const Model>& model, long task);
  void remember(Known known);
  void report(const Known& known, const std::vector<std::shared_ptr<const LiveRun>>& runs, long task);
  double timed(const LiveRun& run, double end, long task);

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<const LiveRun>> waiting_;
  MotionKey wanted_;
  std::list<Known> known_;  // the latest first
  std::vector<RunError> measured_;
  std::atomic<long> task_{0}, begun_{0}, solved_{0};  // task_: counts motions wanted
  std::atomic<bool> held_{false}, ending_{false};
  bool working_ = false;
  std::thread thread_;  // last: it uses the members above
};

}  // namespace unfurl
