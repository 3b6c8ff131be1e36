// SPDX-License-Identifier: BSD-3-Clause
// Whose the checkpoint of an unfinished run is.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/scene/scene.hpp"

namespace unfurl {

inline constexpr std::string_view checkpoint_magic = "unfurl checkpoint 1\n";

// With which the checkpoint of a run of this scene by this very program begins: another build may step
// otherwise.
std::string checkpoint_head(const Scene& scene);

// An unfinished run lies in the folder, whosever it is.
bool holds_checkpoint(const std::filesystem::path& directory);
// The folder holds a run that one of this scene by this very program goes on with.
bool holds_checkpoint_of(const Scene& scene, const std::filesystem::path& directory);

}  // namespace unfurl
