// SPDX-License-Identifier: BSD-3-Clause
// What a user would write without Unfurl, as well as it can be done: classical Runge-Kutta on the index-1
// equations, with independent constraint rows picked once and SuiteSparse's KLU for the linear systems.
#pragma once

#include <memory>

#include "core/integrators/integrator.hpp"

namespace unfurl::bench {

// The rows are picked by a dense rank-revealing QR at the pose q (node coordinates): for small systems.
std::unique_ptr<Integrator> make_rk4_klu(const System& system, const ConstVec& q);

}  // namespace unfurl::bench
