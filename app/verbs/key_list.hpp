// SPDX-License-Identifier: BSD-3-Clause
// The keys of scene files: for a terminal, for programs, for the page docs/scene.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/key_tables.hpp"

namespace unfurl {

std::vector<std::string_view> list_names();                         // what `unfurl list` has
std::string keys_text(const std::vector<const KeyTable*>& tables);  // 80 columns
std::string keys_json(const std::vector<const KeyTable*>& tables);
std::string keys_markdown(const std::vector<const KeyTable*>& tables);

}  // namespace unfurl
