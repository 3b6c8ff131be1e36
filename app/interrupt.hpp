#pragma once

namespace unfurl {

// While one lives, Ctrl-C (and a request to terminate) only raises a flag, so that what is finished can be
// kept; a second one ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

bool interrupted();
// The flag went up at least this long ago: what is left of the work after a run is not worth waiting for.
bool interrupted_for(double seconds);

}  // namespace unfurl
