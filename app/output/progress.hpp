// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace unfurl {

// A bar on stderr with the time left, redrawn in place; where stderr is no terminal, a line every ten
// seconds. Nothing at all where `quiet` is asked for.
class Progress {
 public:
  Progress(std::string task, bool quiet);
  ~Progress();  // takes the bar away
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(double fraction);  // 0..1
  // With counts: "57 of 149 frames".
  void show(std::size_t done, std::size_t of, const char* things);

 private:
  void print(double fraction, const std::string& counts);
  double seconds() const;  // since it began

  std::string task_;
  bool quiet_, terminal_;
  int percent_ = -1;
  long told_ = 0;  // lines [10 s]
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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
