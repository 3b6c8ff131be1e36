// SPDX-License-Identifier: BSD-3-Clause
// Fonts that were on the machine where the program was built, in the program: render/CMakeLists.txt writes
// the source.
#pragma once

#include <string_view>
#include <vector>

namespace unfurl {

struct EmbeddedFont {
  std::string_view name;  // of the file
  std::string_view bytes;
};

const std::vector<EmbeddedFont>& embedded_fonts();

}  // namespace unfurl
