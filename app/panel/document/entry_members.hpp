// SPDX-License-Identifier: BSD-3-Clause
// The nodes, rods and directions by which a new entry can begin.
#pragma once

#include <string>
#include <vector>

#include "app/panel/document/free_reach.hpp"
#include "app/panel/document/selection.hpp"
#include "core/scene/elements.hpp"

namespace unfurl {

// ", key = value" behind what there is.
void add_member(std::string& text, std::string_view key, const ParamValue& value);

// Best first, as TOML: "nodes = [\"A\", \"B\"]". What is selected is among them where that fits the kind;
// else nodes that move come before those that do not. `kind` null: [[loads]]. Empty: there are none.
std::vector<std::string> entry_members(const ElementKind* kind, const Structure& structure,
                                       const Selection& selected, const FreeReach& reach);

}  // namespace unfurl
