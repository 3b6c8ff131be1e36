// SPDX-License-Identifier: BSD-3-Clause
// The columns of series.csv with what they are, for lists and help.
#pragma once

#include <string_view>
#include <vector>

namespace unfurl {

struct DiagnosticColumn {
  std::string_view name, label;  // "kinetic_energy_J", "kinetic energy"
};
std::vector<DiagnosticColumn> diagnostic_columns();  // in the order of diagnostic_names()

}  // namespace unfurl
