#include "core/structures/family.hpp"

#include <algorithm>
#include <array>

#include "core/structures/four_bar_ladder.hpp"
#include "core/structures/hoop.hpp"

namespace unfurl {

std::span<const Family> families() {
  static const std::array rows{
      Family{"hoop", "ring antenna of n re-entrant units that share their posts", hoop_params, build_hoop},
      Family{"four_bar_ladder", "row of four-bar windows that passes poses with all rods collinear",
             four_bar_ladder_params, build_four_bar_ladder},
  };
  return rows;
}

const Family* find_family(std::string_view kind) {
  const auto rows = families();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const Family& f) { return f.kind == kind; });
  return it == rows.end() ? nullptr : &*it;
}

}  // namespace unfurl
