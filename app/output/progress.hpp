// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace unfurl {

// A bar on stderr, redrawn in place; nothing at all where stderr is not a terminal or `quiet` is asked for.
class Progress {
 public:
  Progress(std::string task, bool quiet);
  ~Progress();  // takes the bar away
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(double fraction);  // 0..1

 private:
  std::string task_;
  bool shown_;
  int percent_ = -1;
};

// For work that cannot say how far it is: after a second, what it is and for how long it has been at it.
class Waiting {
 public:
  Waiting(std::string task, bool quiet);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false, shown_ = false;
  std::thread thread_;
};

}  // namespace unfurl
