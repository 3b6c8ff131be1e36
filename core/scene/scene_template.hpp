// SPDX-License-Identifier: BSD-3-Clause
// A commented scene of a kind, to begin one's own from: every key with its range, unit and meaning.
#pragma once

#include <string>
#include <string_view>

namespace unfurl {

// `kind` is a family or "custom". The text is a scene that runs. Throws std::invalid_argument with the
// nearest kind.
std::string scene_template(std::string_view kind);

}  // namespace unfurl
