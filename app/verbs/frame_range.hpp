// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace unfurl {

struct FrameRange {
  std::size_t first = 0, end = 0;  // without the end
};

// "A:B", "A:", ":B" or "A" (that one frame) of a film of `frames` frames; empty: all. Throws UsageError where
// it is not of that form or begins behind the film's end.
FrameRange frame_range(const std::string& text, std::size_t frames);

}  // namespace unfurl
