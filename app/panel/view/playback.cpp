// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/view/playback.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

Playback advanced(Playback playback, double seconds, double start, double end) {
  if (!playback.playing) return playback;
  const double span = end - start;
  playback.t += seconds * playback.speed;
  if (playback.t < end) return playback;
  if (playback.loop && span > 0) {
    playback.t = start + std::fmod(playback.t - start, span);
  } else {
    playback.t = end;
    playback.playing = false;
  }
  return playback;
}

Playback toggled(Playback playback, double start, double end) {
  playback.playing = !playback.playing;
  if (playback.playing && playback.t >= end) playback.t = start;
  playback.t = std::clamp(playback.t, start, end);
  return playback;
}

}  // namespace unfurl
