// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/linear_elimination.hpp"

namespace unfurl {

// Which of the linear constraints A q = b to eliminate. Every one that is eliminated saves a coordinate and a
// multiplier. But one coordinate may come to act on very many (a ring's radius, the width of a mast), and
// with it on every rod: the factors of the equations of motion then fill up. So rows may be kept as equations
// instead (`kept` of the result), which changes the cost and no result. Massless coordinates have no equation
// of motion and are eliminated in any case.
//
// M: mass of the node coordinates q. G: Jacobian of the other constraints by q; its pattern matters.
LinearElimination choose_elimination(const SparseRows& A, const ConstVec& b, const SparseRows& M,
                                     const SparseRows& G);

}  // namespace unfurl
