// SPDX-License-Identifier: BSD-3-Clause
// Rings that are all alike: whether a structure, with everything that acts on it, is the same after a turn.
//
// A turn by 2 pi / n about an axis along x, y or z through the mean of the nodes is a symmetry where it takes
// nodes onto nodes and every entry of the structure onto an entry: rods, masses, loads, forces, drives,
// constraints. Linear constraints are compared as the space that they leave, since one such space has many
// sets of rows: a point of it in general position is turned and has to fulfil them all. What starts so stays
// so: forces of a symmetric state are symmetric.
#pragma once

#include <string>
#include <vector>

#include "core/path/path.hpp"

namespace unfurl {

// Why a structure is not solved as one of its sectors; names the entry that is unlike the others.
struct SectorRefused : PathRefused {
  using PathRefused::PathRefused;
};

// An entry as the turned image of another: that of index `source`, turned `turns` times.
struct TurnedImage {
  int source = 0, turns = 0;
};

struct Symmetry {
  int order = 1;  // n
  Vec3 axis = Vec3::UnitZ(), centre = Vec3::Zero();
  std::vector<TurnedImage> nodes, rods;
  // Of every force and nonlinear constraint; those that act on the whole ring are images of themselves.
  std::vector<TurnedImage> forces, constraints;
  std::vector<char> whole_force, whole_constraint;

  Mat3 turn(int turns) const;
  Vec3 turned(const Vec3& position, int turns) const { return centre + turn(turns) * (position - centre); }
};

bool is_linear(const Constraint& constraint);

// Of the highest order, at least 3. Throws SectorRefused.
Symmetry find_symmetry(const Structure& structure, const System& system);

}  // namespace unfurl
