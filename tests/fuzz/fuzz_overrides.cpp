// SPDX-License-Identifier: BSD-3-Clause
// --set: the first byte picks a scene, each line is one.
#include "tests/fuzz/fuzz.hpp"

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/scene_error.hpp"
#include "core/scene/text_file.hpp"

using namespace unfurl;

void unfurl::fuzz::try_text(std::string_view text) {
  static const std::string scenes[] = {read_text_file(UNFURL_ROOT "/assets/scenes/four_bar.toml").text,
                                       read_text_file(UNFURL_ROOT "/assets/scenes/hoop6_motor.toml").text,
                                       read_text_file(UNFURL_ROOT "/assets/scenes/pendulum.toml").text};
  if (text.empty() || text.size() > 2000) return;
  const auto lines = lines_of(text.substr(1));
  if (lines.size() > 12) return;
  try {
    read_scene_text(scenes[static_cast<unsigned char>(text[0]) % 3], "fuzz.toml", lines);
  } catch (const SceneError&) {
  }
}
