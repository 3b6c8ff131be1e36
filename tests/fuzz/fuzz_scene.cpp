// SPDX-License-Identifier: BSD-3-Clause
// Scene text: read or refused with a place; what is written of it reads back as the same scene.
#include "tests/fuzz/fuzz.hpp"

#include "core/scene/reader.hpp"
#include "core/scene/scene_error.hpp"
#include "core/scene/write.hpp"

using namespace unfurl;

void unfurl::fuzz::try_text(std::string_view text) {
  if (text.size() > 20000) return;
  std::string written;
  try {
    written = scene_text(read_scene_text(text, "fuzz.toml"));
  } catch (const SceneError&) {
    return;
  }
  require(scene_text(read_scene_text(written, "written.toml")) == written, "a written scene reads back");
}
