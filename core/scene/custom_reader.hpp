// SPDX-License-Identifier: BSD-3-Clause
// The [structure] table of a custom scene: nodes, rods and constraints, inline or from CSV files beside the
// scene.
#pragma once

#include <string>
#include <string_view>

#include "core/scene/elements.hpp"
#include "core/scene/table_reader.hpp"
#include "core/structures/custom.hpp"

namespace unfurl {

// Reads and checks the list. `folder` is the scene's own, in which nodes_file and rods_file must lie; empty:
// the scene did not come from a file and may not name any.
// Constraints of kinds that every structure may have go to `constraints`.
CustomSpec read_custom(TableReader& table, const std::string& folder, SceneNotes& notes,
                       std::vector<SceneElement>& constraints);

// The rows of CSV files (csv_table.hpp) behind those that are there; the place of each goes to the notes'
// locations. `named`: the column of names must be there.
void add_csv_nodes(std::string_view text, const std::string& file, std::string_view header, bool named,
                   CustomSpec& spec, SceneNotes& notes);
void add_csv_rods(std::string_view text, const std::string& file, std::string_view header, CustomSpec& spec,
                  SceneNotes& notes);

// Keys of the entries, also for the scene writer.
const std::vector<ParamSpec>& custom_params();
const std::vector<ParamSpec>& custom_node_params();
const std::vector<ParamSpec>& custom_rod_params();

}  // namespace unfurl
