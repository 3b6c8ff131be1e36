// SPDX-License-Identifier: BSD-3-Clause
// Where in a run the panel is, and how it moves on.
#pragma once

namespace unfurl {

struct Playback {
  double t = 0;      // [s] of the motion
  double speed = 1;  // seconds of motion per second
  bool playing = false, loop = true;
};

// After `seconds` of the user's time, in a run from `start` to `end` [s]. Stops at the end unless it loops.
Playback advanced(Playback playback, double seconds, double start, double end);
// Play or pause; from the end it begins again.
Playback toggled(Playback playback, double start, double end);

}  // namespace unfurl
