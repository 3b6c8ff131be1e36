// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/integrators/integrator.hpp"

namespace unfurl {

// Discrete variational (Galerkin) method: on a step, q_d(t) is the polynomial through s nodes Q_1..Q_s, the
// action is integrated by quadrature, of s - 1 Gauss points where forces vary (galerkin.hpp), and made
// stationary (paper section 3; Marsden & West 2001, section 2.2.6):
//
//     D_k S = (1/h) M sum_i K_ki Q_i + h sum_j w_j l_k(tau_j) F(tau_j) - h b_k G(Q_k)^T lambda_k
//     p_0 + D_1 S = 0,   D_k S = 0 (1 < k < s),   Phi(Q_k) = 0 (k = 2..s)
//     p_1 = D_s S,       G(Q_s) M^-1 p_1 = 0 fixes lambda_s
//
// constraints_at = nodes: multipliers and constraints at every node; with Lobatto nodes the variational
// Lobatto IIIA-IIIB pair (Jay 1996), order 2 s - 2. constraints_at = ends: as printed in the paper (eq. 17),
// order 2 whatever s, because the motion between the ends is free flight.
//
// Stage equations are solved by a simplified Newton iteration: with G frozen at one pose, multiplying by C^-1
// leaves s - 1 right-hand sides of one saddle-point system of the size of one pose. Where that does not
// contract, G is frozen afresh, then a full Newton iteration is tried. Forces too stiff for it go to the full
// Newton iteration at once, or, of structures with many coordinates, to corrections that know their
// derivatives (stiff_correction.hpp).
//
// The claims are those of rigid rods and of forces that vary. Of elastic rods that turn through many of their
// periods in a step (h omega > 100) the velocities of stretching are taken out at its end
// (elastic_stages.hpp): such waves lose their energy, and a run back does not bring them back.
Claims dvm_claims(const SolverOptions& options);
std::unique_ptr<Integrator> make_dvm(const System& system, const SolverOptions& options);
// The same with every step solved as next to a dead centre, where no digit of the constraints may be lost:
// for references and for the last way to a singular pose. At half the speed.
const Method& careful_dvm();

}  // namespace unfurl
