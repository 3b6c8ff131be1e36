// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// Equal rigid links J0-J1-...-JN in a row. `straight`: all at `angle` from the downward vertical in the plane
// of x and z, below J0. `catenary`: hanging at rest between J0 and JN, which stand `span` apart along x at
// equal heights. The weight m g of a link acts in halves on its ends, so every joint passes m g on and with
// the pull H along x link i = 0..N-1 has the slope
//
//     tan(theta_i) = (i - (N - 1)/2) m g / H,      sum_i l cos(theta_i) = span
//
// whatever g is. Which ends are held: none, the start J0, or both.
const std::vector<ParamSpec>& chain_params();
Structure build_chain(const ParamSet& params);

}  // namespace unfurl
