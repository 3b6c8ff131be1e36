// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace unfurl {

// Another program that runs beside this one. It is never left to run on: the destructor ends it, and so does
// end_children() when this program is ended by a signal.
class ChildProcess {
 public:
  // Its standard streams; -1: /dev/null.
  struct Streams {
    int input = -1, output = -1, error = -1;
  };

  // How end_children() ends it: what keeps its work when it is asked to end is asked once, by whoever is
  // first.
  enum class Ending { killed, asked };

  ChildProcess() = default;
  ~ChildProcess();  // kills it
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // words[0] is looked for in PATH. In a process group of its own, so that Ctrl-C at the terminal reaches
  // this program and not that one. 0 or an errno.
  int start(const std::vector<std::string>& words, const Streams& streams, Ending ending = Ending::killed);
  // Waits at most so long [s]; < 0: for ever. Its exit code, 128 + N where signal N ended it, -1 where none
  // was started; nothing: it runs on.
  std::optional<int> wait(double seconds = -1);
  // Nothing happens where it has ended already: its number may be another's by now.
  void send(int signal);

 private:
  bool reap();

  std::mutex mutex_;  // of pid_: waiting and signals may come from two threads
  pid_t pid_ = -1;
  int code_ = -1;
};

// Kills all children there are, or asks them to end. May be called in a signal handler.
void end_children();

}  // namespace unfurl
