// SPDX-License-Identifier: BSD-3-Clause
// A part of the structure that a person points at.
#pragma once

#include <string>

namespace unfurl {

struct Selection {
  enum class Kind { none, rod, node };
  Kind kind = Kind::none;
  std::string name;  // of the whole structure's rod or node; a name outlives a new run

  bool operator==(const Selection&) const = default;
};

}  // namespace unfurl
