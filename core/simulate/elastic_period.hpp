// SPDX-License-Identifier: BSD-3-Clause
// The fastest waves of rods that give, swings on springs and sines, and whether a step follows them.
#pragma once

#include <string>

#include "core/integrators/solver_options.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

class OneSided;

// The shortest period of small motions about a state that rigid rows allow [s]; infinite where no rod gives
// or bends and nothing swings on a spring, or a taut cable, for its stiffness and damping. To about a
// percent.
double fastest_elastic_period(const Model& model, const State& state);

// Of the period of a swing on springs, the longest step that follows it.
double swing_share_of(const SolverOptions& options);

// What is said where the steps of a run are longer than a quarter of that period, with both numbers and what
// there is to choose; empty: nothing. Of a method that damps what it does not resolve, nothing. Of what
// swings on springs, more stages of dvm follow in a longer step what fewer would not, and adaptive steps what
// they go by at the start or went by behind it, `swing` [1/s] as of Stepper.
std::string elastic_step_warning(const Model& model, const State& start, const SolverOptions& options,
                                 double swing = 0);

// The same of the fastest sine that the structure prescribes. `exact`: states are what they are with any
// step, as along a path; what is said then is that so few of them do not tell it.
std::string wave_step_warning(const Structure& structure, const SolverOptions& options, bool exact = false);

// The same of cable i, which begins to pull: of how what it holds back swings on it. More stages of dvm
// follow in a longer step what fewer would not.
std::string cable_step_warning(const OneSided& sides, std::size_t i, const System& system, const State& state,
                               const SolverOptions& options);

}  // namespace unfurl
