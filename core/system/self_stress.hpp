// SPDX-License-Identifier: BSD-3-Clause
// Forces that balance themselves: what a rigid model leaves open.
#pragma once

#include <string>
#include <vector>

#include "core/system/mobility.hpp"

namespace unfurl {

/// Multipliers y [N] of a few constraints that hold each other in balance without any load, G^T y = 0: any
/// multiple of them may be added to the forces of a rigid model.
struct SelfStress {
  struct Member {
    int row = 0;         ///< of all constraints, as System::all_names() lists them
    double force = 0.0;  ///< relative to the largest, which is 1; of rods tension positive
  };
  std::vector<Member> members;  ///< in the order of their rows; as few as carry this state
};

struct ForceBalance {
  std::vector<SelfStress> states;  ///< a basis: one through every redundant row, the last of its members
  std::vector<char> determined;  ///< per row of all constraints: the force is unique (implied rows have none)
  bool listed = true;            ///< false: too large a structure, there are states but none is listed
};

/// Of the structure at the pose q [3 n]; `mobility` of the same pose.
///
/// A redundant row is a combination of independent rows before it: the coefficients are least squares with
/// the independent rows, which have full rank. Dense, so listed for up to `max_listed_coordinates`.
/// rods: of the structure, the last of all constraints; those that have a modulus share the load, so that
/// their forces are determined (empty: none has).
ForceBalance force_balance(const System& system, const ConstVec& q, const Mobility& mobility,
                           const std::vector<Rod>& rods = {});
inline constexpr Index max_listed_coordinates = 900;

}  // namespace unfurl
