// SPDX-License-Identifier: BSD-3-Clause
// Which stops hold and what sticks after an event: all at once, as their equations ask.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/simulate/one_sided.hpp"

namespace unfurl {

// With n_i the gradient of a gap or of what friction acts on, D_ij = n_i . M^-1 n_j under the constraints
// (push_responses.hpp), u_i the rates:
//
//     impacts    u+ = u- + D P,        0 <= P_i  _|_  u+_i + e_i min(u-_i, 0) >= 0     stops that are touched
//     forces     s'' = D f + s''_0,    0 <= f_i  _|_  s''_i >= 0                       stops at rest
//                                      |f_i| <= tau_s: s''_i = 0, or f_i = -sgn(s''_i) tau_k    friction at
//                                      rest f_i = -sgn(u_i) tau_k                           friction that
//                                      slips
//
// A stop is a unilateral constraint in both (Moreau 1988 with Newton's law of impact, in as many blows as it
// takes to push on nothing that is being left: impact.hpp), no impulse passes through dry friction. Of
// several solutions that differ in forces alone, those held are independent rows.
struct ModeChange {
  struct Impact {
    std::size_t stop;
    double energy_lost;  // [J]
    bool held = false;   // it was before the rates jumped
  };
  State state = {};  // after the impulses
  std::vector<Impact> impacts = {};
  bool changed = false;                  // some mode is another than before
  std::vector<std::size_t> turned = {};  // those of them that are worth telling
  std::string failure = {};              // not empty: nothing of this has an answer, and why
  bool strikes(std::size_t stop) const {
    return std::ranges::find(impacts, stop, &Impact::stop) != impacts.end();
  }
};

// What comes of it that `which` have crossed in a state of `base`'s coordinates; `base`: the model without
// what is one-sided. Changes the modes of `sides`. An impact ends in rest where it is slow, or what acts
// brings it back so soon that its series has accumulated. `left`: what locating the crossing left of zero of
// the forces of those that were held (Crossing). `later`: forces and limits are taken so much later, as of
// what begins with nothing. `crowd`: which have crossed without end; what comes back within a step rests.
ModeChange change_modes(OneSided& sides, const Model& base, const State& state,
                        const std::vector<std::size_t>& which, const VectorXd& left = {}, double later = 0.0,
                        bool crowd = false);

}  // namespace unfurl
