#pragma once

#include <string>

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

}  // namespace unfurl
