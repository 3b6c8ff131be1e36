// SPDX-License-Identifier: BSD-3-Clause
// What may be added to a scene, under the names that engineers know.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

struct ElementOffer {
  std::string_view table;  // "loads", "forces", "constraints"
  std::string_view kind;
  std::string name;             // "Motor at a hinge"
  std::string sentence;         // what it does
  std::string_view extra = {};  // what makes it this one of its kind: "tension_only = true"
};

// Of a table: well-known ones first, then every other kind under its own name.
std::vector<ElementOffer> element_offers(std::string_view table);

}  // namespace unfurl
