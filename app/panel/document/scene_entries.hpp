// SPDX-License-Identifier: BSD-3-Clause
// Entries of [[loads]], [[forces]] and [[constraints]] that the panel adds to a scene and takes away again.
#pragma once

#include <string>
#include <string_view>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/document/selection.hpp"

namespace unfurl {

// A first version of an entry of `table` ("loads", "forces", "constraints"), to be changed by hand, as an
// override: "constraints[1]={kind = \"angle\", ...}". It acts on what is selected, where that fits the kind,
// else on what moves, and the scene can be run with it as it stands. A drive moves to where the structure can
// go (the fold to the deployed pose but a little, an angle by 15 degrees, a distance by a tenth at most), a
// stop is near (of the fold: at the deployed pose). `extra`: members beside, "tension_only = true". Throws
// SceneError that says why where there is no such entry, or the scene has no sound structure.
std::string new_entry(const SceneDocument& document, std::string_view table, std::string_view kind,
                      const Selection& selected, std::string_view extra = {});

SceneDocument with_entry(SceneDocument document, std::string entry);
// Without an entry that the panel added, and edits of it; the ones behind it move up. `key`: "forces[2]".
SceneDocument without_entry(SceneDocument document, const std::string& key);
bool is_added(const SceneDocument& document, const std::string& key);

}  // namespace unfurl
