// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/integrators/integrator.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

inline constexpr double farthest_sample = 3e-2;  // from the pose, as the sine of what is left

// The state at which the fold angle passes zero, found from solved states only. That pose is singular: a step
// that lands on it does not converge. So shortened steps are solved to several small fold angles on the near
// side, and time, coordinates, velocities and multipliers, which are smooth functions of sin(fold), are
// extrapolated from them to 0. The trajectory's last state must lie before the event, its next step (of size
// h) at or behind it. From its state `first` on the motion is smooth: no sample sets out from before that.
// Where it is too near the pose, samples are of the motion that would have led to that state by what acts
// then: `model`, which the integrator is for, is the trajectory's last one but for what begins or ends before
// (pieces_at). Where drives lead there, driven_deployed.hpp does. What remains of a measure that is `touched`
// there, as it rises again behind the pose, falls like the sine or like its square.
std::optional<State> locate_deployed(const Trajectory& trajectory, const Model& model, Integrator& integrator,
                                     double h, std::size_t first, bool touched = false);
// A state before that pose of the same motion, off enough for steps that end there to be solved, be it from
// before `first`.
State far_off_deployed(const Trajectory& trajectory, const Model& model, Integrator& integrator, double h,
                       std::size_t first);
// A state next to that pose, at a time before it, by the same states.
std::optional<State> locate_before_deployed(const Trajectory& trajectory, const Model& model,
                                            Integrator& integrator, double h, std::size_t first, double t);

// A pose next to the deployed one, with its multipliers, and the sine of its fold angle, or what else they
// are smooth functions of that is zero there.
struct NearDeployed {
  double sine;
  State state;
};

// Shares of the samples in the value at zero of the polynomial of `degree` in the sine that fits them best.
VectorXd shares_at_zero(const std::vector<NearDeployed>& samples, int degree);

// Axial forces of the rods that give [rods x samples].
MatrixXd tensions(const System& system, const std::vector<NearDeployed>& samples);
// The same at zero, with what they may be off by. They go in waves, which no polynomial in the sine may
// follow: of the degree from which on it matters least, and in doubt by what higher ones say besides, or what
// the samples are in doubt by.
void tension_at_zero(const System& system, const std::vector<NearDeployed>& samples, State& out);

// The multipliers in the deployed pose, from those of such poses, the farthest one first, and its equations.
// The pose itself is as good as any for all of the multipliers but what its loss of rank leaves open. Of
// that a fit of low degree is truer than interpolation where round-off, d / sine^4, is more than what the
// degree leaves: the degree at which it changes least. Where even that is not known, what is left open is
// chosen as for any multipliers that are not unique: least norm.
// NaN where they grow without bound towards the pose, at most like sine^-poles, or grow and settle to
// nothing.
VectorXd multipliers_at_deployed(Index1& index1, std::vector<NearDeployed> samples, const State& at,
                                 int poles = 1);

}  // namespace unfurl
