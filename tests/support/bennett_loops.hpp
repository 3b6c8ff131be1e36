// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <sstream>
#include <string>
#include <utility>

#include "core/math/types.hpp"

namespace unfurl::testing {

// Bennett's loop, of rods that form its four links: it moves, though 14 lengths hold 12 coordinates.
inline std::string bennett_loops(int first, int end, double apart) {
  const std::array<std::pair<const char*, Vec3>, 8> nodes{{
      {"A1", {0, 0, -0.1}},
      {"A2", {0, 0, 0.1}},
      {"B1", {0.2816178659701636, 0.9616772518252036, -0.0766044443118978}},
      {"B2", {0.4024224206811742, 0.917707989746613, 0.0766044443118978}},
      {"C1", {-0.5898430596292608, -0.1809584357947804, 0.3793692317667702}},
      {"C2", {-0.65026692613533, -0.0623388399279029, 0.5286285625733748}},
      {"D1", {-1.5027138229377353, -0.0965925826289071, -0.0258819045102526}},
      {"D2", {-1.5027138229377353, 0.0965925826289066, 0.0258819045102516}},
  }};
  std::ostringstream text, rods;
  text.precision(17);
  text << "[structure]\nkind = 'custom'\nnodes = [\n";
  for (int k = first; k < end; ++k) {
    for (const auto& [name, x] : nodes)
      text << "{name = '" << name << "_" << k << "', position = [" << x[0] + apart * k << ", " << x[1] << ", "
           << x[2] << "], fixed = " << (name[0] < 'C' ? "true" : "false") << "},\n";
    for (const char* rod : {"C1-C2", "D1-D2", "B1-C1", "B1-C2", "B2-C1", "B2-C2", "C1-D1", "C1-D2", "C2-D1",
                            "C2-D2", "D1-A1", "D1-A2", "D2-A1", "D2-A2"})
      rods << "{nodes = ['" << std::string(rod, 2) << "_" << k << "', '" << rod + 3 << "_" << k
           << "'], mass = 0.3},\n";
  }
  text << "]\nrods = [\n"
       << rods.str() << "]\n[gravity]\nacceleration = [0, 0, -9.81]\n"
       << "[solver]\nstages = 6\nstep = 0.01\nend_time = 0.7\n";
  return text.str();
}

}  // namespace unfurl::testing
