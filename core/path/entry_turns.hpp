// SPDX-License-Identifier: BSD-3-Clause
// Entries of a structure turned about its axis, and whether two are the same: every field takes part.
#pragma once

#include <vector>

#include "core/path/symmetry.hpp"

namespace unfurl {

// A turn with the node that each node goes to.
struct NodeTurn {
  Mat3 turn = Mat3::Identity();
  std::vector<int> to;

  std::vector<int> nodes(const std::vector<int>& from) const;
  Measure measure(const Measure& from) const;
  LinearForm form(const LinearForm& from) const;  // of differences of positions alone, or none
  Force force(const Force& from) const;
  Constraint constraint(const Constraint& from) const;
};

// Equal but for their names; directions to round-off, lengths of them and all other numbers exactly. `size`:
// of the structure, of which a length that is measured has the rounding [m].
bool same_entry(const Measure& a, const Measure& b);
bool same_entry(const Force& a, const Force& b, double size);
bool same_entry(const Constraint& a, const Constraint& b, double size);
bool same_entry(const Rod& a, const Rod& b);  // whichever way round
bool same_form(const LinearForm& a, const LinearForm& b);

}  // namespace unfurl
