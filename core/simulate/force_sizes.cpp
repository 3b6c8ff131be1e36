// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/force_sizes.hpp"

#include <cmath>

#include "core/integrators/row_noise.hpp"

namespace unfurl {

VectorXd force_sizes(const System& system, const Structure& structure, const State& state,
                     const VectorXd& lambda) {
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  RowNoise noise(system);
  noise.start(q);
  VectorXd f = VectorXd::Zero(q.size());
  SparseRows by_z, by_w;
  if (state.tension.size() > 0) {
    system.add_other_force(state.t, q, v, state.tension, 1.0, f);
    system.add_giving_rod_forces(q, state.tension, 1.0, f);
    system.force_derivatives(state.t, q, v, state.tension, by_z, by_w);
  } else {
    system.add_applied_force(state.t, q, v, 1.0, f);
    system.force_derivatives(state.t, q, v, by_z, by_w);
  }
  noise.add_forces(f);
  noise.add_stiffness(by_z, 1.0);
  noise.add_products(by_w, state.w, 1.0);
  f = system.node_mass().diagonal() * structure.gravity.norm();
  for (const Load& load : structure.loads)
    f.segment<3>(3 * static_cast<Index>(load.node)) += load.force.cwiseAbs();
  noise.add_forces(f);
  noise.add_multipliers(lambda, 1.0);
  return noise.size();
}

double free_acceleration(const System& system, const Structure& structure, const State& state,
                         const VectorXd& lambda) {
  const VectorXd sizes = force_sizes(system, structure, state, lambda);
  return std::sqrt(sizes.cwiseAbs2().cwiseQuotient(system.mass().diagonal()).sum());
}

}  // namespace unfurl
