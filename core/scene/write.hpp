// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/scene/scene.hpp"

namespace unfurl {

// The scene as a TOML file that stands alone: overrides applied, every parameter written out, lists from CSV
// files inline, numbers with all their digits. Reading it back gives an equal scene. `idle`: given values of
// forces and constraints that mean nothing beside what else is given, but may where that is varied.
enum class IdleValues { left_out, written };
std::string scene_text(const Scene& scene, IdleValues idle = IdleValues::left_out);

// One entry of [[structure.nodes]], of [[structure.rods]], with a blank line before it.
std::string custom_node_text(const CustomNode& node);
std::string custom_rod_text(const CustomRod& rod);
// The same on one line: {name = "A", ...}.
std::string inline_text(const CustomNode& node);
std::string inline_text(const CustomRod& rod);

// Those values alone, as comments.
std::string idle_text(const Scene& scene);

// A parameter's value as TOML, numbers with all their digits.
std::string toml_value(const ParamValue& value);

// Text as a TOML basic string, quotes included.
std::string toml_string(std::string_view text);

}  // namespace unfurl
