// SPDX-License-Identifier: BSD-3-Clause
// One step of a method. Integrators know nothing of structures or scenes: they see a System and a State.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/integrators/solver_options.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl {

class Integrator {
 public:
  virtual ~Integrator() = default;
  // Advance `state` by h [s]. Where the report is not ok, `state` is unchanged.
  [[nodiscard]] virtual StepReport step(State& state, double h) = 0;
  // Forget what was learnt from earlier steps (predictors): the next state does not follow the last one.
  virtual void restart() = 0;
  // The longest step, up to h, with which to go on from a state: what follows on restart() may have to be
  // resolved although nothing of it is left after a step. h may be what is left of a `whole` one. Asked once
  // before a step.
  virtual double longest_step(const State& /*state*/, double h, double /*whole*/) { return h; }
  // Coordinates and rates at this share of the last step, if that was one of size h from `start`, on its own
  // polynomial. False where the method has none that tells more than the cubic of the step's ends.
  virtual bool inside(const State& /*start*/, double /*h*/, double /*share*/, VectorXd& /*z*/,
                      VectorXd& /*w*/) const {
    return false;
  }
  // A step of the same run has reported that rows contradict each other (StepReport).
  virtual void expect_contradictions() {}
  // Shorter steps are parts of one of this length: they stop what it stops of waves.
  virtual void stop_waves_of(double /*h*/) {}
};

// What a method claims about itself; the conformance test checks every claim of every row.
struct Claims {
  int order = 0;  // of the position error for these options
  bool symplectic = false;
  bool symmetric = false;  // a step back with -h undoes a step
  bool implicit = false;
  bool holds_positions = false;          // |Phi| at round-off after every step
  bool holds_velocities = false;         // |G v| at round-off after every step
  bool conserves_momentum_maps = false;  // (angular) momenta of a symmetric motion, to round-off
  bool damps = false;                    // takes the energy of what a step does not resolve, and means to
};

struct Method {
  std::string_view name;
  std::string_view help;
  Claims (*claims)(const SolverOptions&);
  // Workspaces are allocated here, once.
  std::unique_ptr<Integrator> (*plain)(const System& system, const SolverOptions& options);

  // The method on a system that must outlive it; every step begins near the angles of its state and counts
  // them on.
  std::unique_ptr<Integrator> make(const System& system, const SolverOptions& options) const;
};

std::span<const Method> methods();
const Method* find_method(std::string_view name);
// Does the order of the method depend on the number of stages?
bool order_depends_on_stages(const SolverOptions& options);

}  // namespace unfurl
