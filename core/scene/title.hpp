// SPDX-License-Identifier: BSD-3-Clause
// Titles that stay true when parameters change.
#pragma once

#include <string>

#include "core/scene/toml_tree.hpp"

namespace unfurl {

/// The title of the scene `tree` (overrides applied), `own` as its file has it, `name` where it has none.
///
/// "{units}-unit ring antenna" takes the value of the key `units` of [structure], as a word up to twelve:
/// "Six-unit ring antenna". A title without such a place says what the file says of the structure: where a
/// key of [structure] was changed since, it is dropped for the scene's name and what was changed, "pendulum:
/// angle = 30". Braces around anything but a name are text, and a doubled brace is a brace. `unknown`: set to
/// a name in braces that is no number, text or whole number among the structure's keys.
std::string scene_title(const TomlTree& tree, const TomlTree& own, const std::string& name,
                        std::string* unknown = nullptr);

/// Does the title have a place for a parameter?
bool is_title_pattern(const std::string& title);

/// What a scene file must give as its title for it to be that text, whatever braces are in it.
std::string title_that_says(const std::string& text);

}  // namespace unfurl
