// SPDX-License-Identifier: BSD-3-Clause
// Measures position errors of finished runs beside the window, against a reference of their motion.
#pragma once

#include <deque>
#include <limits>
#include <list>

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

  // Of this run and of earlier ones of its motion that are not measured yet. A reference of another motion
  // that is being solved is given up at once. A motion's reference is solved once.
  void measure(std::shared_ptr<const LiveRun> run);
  // Rest while something more urgent runs, and go on.
  void hold(bool on) { worker_.hold(on); }
  std::vector<RunError> take();  // what was measured since the last call; begins with what came meanwhile
  bool busy() const { return worker_.busy() || has_work(); }
  bool ready() const { return worker_.ready(); }
  long begun() const { return begun_; }    // references
  long solved() const { return solved_; }  // of those, to the end

 private:
  struct Known {
    MotionKey motion;
    std::shared_ptr<const ReferenceMotion> reference;  // null: there is none, and why
    std::string why;
  };
  using Runs = std::vector<std::shared_ptr<const LiveRun>>;  // of one motion
  using Meter = Worker<Runs, std::vector<RunError>>;
  bool has_work() const;
  void begin();
  std::vector<RunError> errors_of(const Runs& runs, const Meter::Task& task);
  std::optional<Known> find(const MotionKey& motion);
  Known solve(const std::shared_ptr<const LiveRun>& run, const Meter::Task& task);
  void remember(Known known);

  std::deque<std::shared_ptr<const LiveRun>> waiting_;
  MotionKey wanted_;
  std::mutex mutex_;
  std::list<Known> known_;  // the latest first
  std::atomic<long> begun_{0}, solved_{0};
  Meter worker_;  // last: it uses the members above
};

}  // namespace unfurl
