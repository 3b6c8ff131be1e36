// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/integrator.hpp"

namespace unfurl {

// Generalized-alpha method on the index-3 equations (Chung & Hulbert 1993; Arnold & Bruls 2007, eq. 6-10):
//
//     M w'_1 + G(z_1)^T lambda_1 = F_1,   Phi(z_1) = 0
//     (1 - alpha_m) a_1 + alpha_m a_0 = (1 - alpha_f) w'_1 + alpha_f w'_0
//     z_1 = z_0 + h w_0 + h^2 [(1/2 - beta) a_0 + beta a_1],   w_1 = w_0 + h [(1 - gamma) a_0 + gamma a_1]
//     alpha_m = (2 rho - 1)/(rho + 1),  alpha_f = rho/(rho + 1),
//     gamma = 1/2 + alpha_f - alpha_m,  beta = (gamma + 1/2)^2 / 4
//
// A first step takes a_0 = a_1 (alpha_m = 0, beta = 1/2, gamma = 1): begun with the true acceleration,
// motions of h omega >> 1 would gain h omega times their velocity in what follows. That is of order 1; behind
// edges of time where nothing is so stiff it is the trapezium (alpha_m = alpha_f = gamma = 1/2, beta = 1/4)
// from the true one. rho = solver.rho_inf is what is left of the fastest oscillations in a step: 1 nothing is
// damped (and multipliers may oscillate), 0 all is. w and w' do not fulfil the differentiated constraints
// exactly. Newton's unknowns are dz and lambda / b, b = (1 - alpha_m) / (h^2 beta (1 - alpha_f)), so that its
// matrix is [M G^T; G 0] whatever h (Bottasso, Bauchau & Cardona 2007, scaling of equations and multipliers).
Claims generalized_alpha_claims(const SolverOptions& options);
std::unique_ptr<Integrator> make_generalized_alpha(const System& system, const SolverOptions& options);

}  // namespace unfurl
