// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/rk4_projected.hpp"

#include "core/integrators/projection.hpp"
#include "core/integrators/rk4.hpp"

namespace unfurl {
namespace {

class ProjectedRungeKutta4 final : public RungeKutta4 {
 public:
  explicit ProjectedRungeKutta4(const System& system) : RungeKutta4(system), projection_(system) {}

 protected:
  bool settle(const State& from, double t, VectorXd& z, VectorXd& w, StepReport& report) override {
    const bool placed = projection_.positions(from.t, from.z, t, z);
    report.newton_iterations += projection_.iterations();
    report.right_hand_sides += projection_.iterations() + 1;
    report.factorisations += 2;
    return placed && projection_.velocities(t, z, w);
  }

 private:
  Projection projection_;
};

}  // namespace

Claims rk4_projected_claims(const SolverOptions&) {
  return {.order = 4, .holds_positions = true, .holds_velocities = true};
}

std::unique_ptr<Integrator> make_rk4_projected(const System& system, const SolverOptions&) {
  return std::make_unique<ProjectedRungeKutta4>(system);
}

}  // namespace unfurl
