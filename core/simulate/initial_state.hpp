// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "core/math/saddle_solver.hpp"
#include "core/math/types.hpp"
#include "core/structure/structure.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// The state at t = 0, with the velocities projected on the constraints in the mass metric (least kinetic
// energy of the change) and the multipliers of the index-1 equations.
struct InitialState {
  State state;
  // Largest of the nodes that have a velocity: by how much the projection changed it [m/s]. Drives set others
  // out.
  double velocity_change = 0;
};
InitialState initial_state(const Structure& structure, const System& system);

// What to tell the user where the projection took away more than round-off; empty otherwise.
std::string velocity_warning(const InitialState& start, const Structure& structure);

struct CannotFactorise : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The rates w for which B w is nearest to the node velocities v in the mass metric and G w = g'(t): what an
// impulse of the constraints alone makes of v. Throws CannotFactorise.
VectorXd fitted_rates(const System& system, double t, const ConstVec& q, const ConstVec& v);

// Move z to the nearest point of Phi = 0 and w to G w = 0, both in the mass metric, leaving directions
// without rank alone. For states that are nearly right already: one or two Newton steps.
void project(const System& system, State& state);

// The same for many states of one model.
class Projector {
 public:
  explicit Projector(const System& system);
  void operator()(State& state);

 private:
  System system_;
  SparseRows jacobian_;
  SaddleSolver saddle_;
  std::vector<double> scratch_;
};

}  // namespace unfurl
