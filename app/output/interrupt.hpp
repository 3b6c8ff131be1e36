// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and requests to terminate: every verb ends within a second, with exit code 130, and what is finished
// is kept. Files are whole or not there, so most work may simply end; the rest says that it does not.
#pragma once

namespace unfurl {

// From now on SIGINT, SIGTERM and the terminal's SIGHUP end the program, and the programs that it started, at
// once; while an InterruptGuard lives, they raise a flag first. A limit on the size of files does not: it is
// an error of writing.
void end_on_signals();

// While one lives, a first signal raises the flag, for what takes no long time to come to an end by itself;
// the program is ended 0.8 s later, or by a second signal.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

// While one lives, what is finished is being written: only a second signal ends the program.
class FinishedWork {
 public:
  FinishedWork();
  ~FinishedWork();
  FinishedWork(const FinishedWork&) = delete;
  FinishedWork& operator=(const FinishedWork&) = delete;
};

bool interrupted();
// The flag went up at least this long ago: what is left of the work after a run is not worth waiting for.
bool interrupted_for(double seconds);

// Work that was given up because the flag is up; nothing is wrong.
struct Interrupted {};
void throw_if_interrupted();  // Interrupted

// Is a bar on the terminal, that a last word has to wipe away?
void bar_is_shown(bool shown);

}  // namespace unfurl
