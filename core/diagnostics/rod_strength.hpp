// SPDX-License-Identifier: BSD-3-Clause
// What the rods bear, of those that have a modulus: axial stress, and in compression their share of Euler's
// load. Both from the axial force of rod_forces, the mean over a rod's length.
#pragma once

#include "core/diagnostics/diagnostics.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

// P = pi^2 E I / l^2: at which a straight rod with pinned ends buckles [N]; infinite where rigid or where the
// second moment is not known. Of a part of a cut rod, that of the whole: parts are joined stiffly.
double euler_load(const Rod& rod);

// Of an axial force N, tension positive [N]; NaN for a rod without a modulus.
double axial_stress(const Rod& rod, double force);    // N / A [Pa]
double stress_ratio(const Rod& rod, double force);    // |N| / (A strength); 1: all that it may bear
double buckling_ratio(const Rod& rod, double force);  // max(0, -N) / P; 1: it buckles

// One of these for all rods and states [states x rods of the solved model].
MatrixXd over_rods(const Structure& structure, const Diagnostics& diagnostics,
                   double (*quantity)(const Rod&, double force));

// The largest magnitude among them: where, when, and whether the force that it follows from is unique.
struct WorstRod {
  double value = 0.0;  // with its sign
  Index rod = -1;      // of the solved structure; -1: none is known
  double t = 0.0;      // [s]
  bool unique = true;
};
WorstRod worst_rod(const Structure& structure, const Diagnostics& diagnostics,
                   double (*quantity)(const Rod&, double force));

// What is left: 1 / ratio - 1. Infinite where nothing is borne.
double margin_of(double ratio);

bool any_elastic(const Structure& structure);
bool any_strength(const Structure& structure);  // of those that are elastic

}  // namespace unfurl
