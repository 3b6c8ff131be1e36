// SPDX-License-Identifier: BSD-3-Clause
// From the text of a scene file to a checked Scene.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.hpp"

namespace unfurl {

// The scene file itself cannot be read.
struct UnreadableScene : Error {
  using Error::Error;
};

// Overrides are "key=value" (scene/overrides.hpp). Throws SceneError with everything that is wrong,
// UnreadableScene.
Scene read_scene_file(const std::string& path, const std::vector<std::string>& overrides = {});

// `name` is what locations call the text. Without a folder the scene may not name files of its own.
Scene read_scene_text(std::string_view text, const std::string& name,
                      const std::vector<std::string>& overrides = {}, const std::string& folder = "");

}  // namespace unfurl
