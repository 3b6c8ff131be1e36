// SPDX-License-Identifier: BSD-3-Clause
// The time that a motion takes whose forces depend on the pose alone: a quadrature.
//
// Released at rest at s_0, energy gives s'^2 = 2 W, W(s) = integral of Q from s_0, so that
//
//     T = integral ds / sqrt(2 W) = integral 2 x dx / sqrt(2 W(s_0 + x^2))
//
// whose integrand is smooth, also at the start: there W = (s - s_0) D with the divided difference D of Q's
// integral, and nothing cancels (math/chebyshev.hpp).
#pragma once

#include <functional>
#include <vector>

#include "core/path/path.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {

// From rest at `from` to `to` under a constant force on the nodes [3 n, N]. NaN where the motion does not get
// there (it begins the other way, or turns before), or hardly does, so that the quadrature does not converge.
double time_from_rest(const Path& path, const VectorXd& force, double from, double to);

// s of the deployed pose next to s = 0, where the deployment's remaining() first falls to zero from above,
// forwards or backwards, within so many pieces.
std::optional<double> deployed_pose(const Path& path, const Deployment& deployment, bool forward,
                                    long most_pieces);

// The first time behind `from` at which a function of time is above zero, looked for in steps of h that end
// at edges, where a load is largest: before the jump where one jumps. `until` where there is none.
double first_time_above(const std::function<double(double t)>& f, double from, double until, double h,
                        const std::vector<TimeEdge>& edges);

}  // namespace unfurl
