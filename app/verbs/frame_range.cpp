// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/frame_range.hpp"

#include <algorithm>
#include <charconv>

#include "app/output/exit_code.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::size_t number(const std::string& part, const std::string& text) {
  std::size_t value = 0;
  const char* end = part.data() + part.size();
  const auto result = std::from_chars(part.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end)
    throw UsageError("--frames must be FIRST:END, two whole numbers (END itself is left out), or one; got " +
                     in_quotes(text));
  return value;
}

}  // namespace

FrameRange frame_range(const std::string& text, std::size_t frames) {
  FrameRange range{0, frames};
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string end = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (!first.empty() || colon == std::string::npos) range.first = number(first, text);
  if (colon == std::string::npos)
    range.end = range.first + 1;
  else if (!end.empty())
    range.end = number(end, text);
  if (range.first >= range.end) throw UsageError("--frames " + text + " names no frame");
  if (range.first >= frames)
    throw UsageError("--frames " + text + " begins behind the film's end: it has " + std::to_string(frames) +
                     " frames, from 0");
  range.end = std::min(range.end, frames);
  return range;
}

}  // namespace unfurl
