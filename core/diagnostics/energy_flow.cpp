#include "core/diagnostics/energy_flow.hpp"

#include <memory>

#include "core/integrators/index1.hpp"
#include "core/math/quadrature.hpp"
#include "core/model/time_edges.hpp"

namespace unfurl {
namespace {

// Quintic Hermite interpolation on a step of length h at u = (t - t_0) / h.
struct Ends {
  const State &a, &b;
  const VectorXd &accel_a, &accel_b;
  double h;

  VectorXd value(double u) const {
    const double v = 1 - u, u3 = u * u * u, v3 = v * v * v;
    return v3 * (1 + 3 * u + 6 * u * u) * a.z + h * u * v3 * (1 + 3 * u) * a.w +
           h * h / 2 * u * u * v3 * accel_a + u3 * (1 + 3 * v + 6 * v * v) * b.z -
           h * v * u3 * (1 + 3 * v) * b.w + h * h / 2 * v * v * u3 * accel_b;
  }
  VectorXd rate(double u) const {
    const double v = 1 - u, u2 = u * u, v2 = v * v;
    return 30 * u2 * v2 / h * (b.z - a.z) + v2 * (1 - 3 * u) * (1 + 5 * u) * a.w +
           u2 * (1 - 3 * v) * (1 + 5 * v) * b.w + h / 2 * u * v2 * (2 - 5 * u) * accel_a -
           h / 2 * v * u2 * (2 - 5 * v) * accel_b;
  }
};

class FlowIntegrator {
 public:
  explicit FlowIntegrator(const System& system)
      : system_(system),
        index1_(system_),
        loads_(system.has_power(false)),
        dampers_(system.has_power(true)),
        drives_(!system.drives().empty()),
        lambda_(system.constraints()) {}

  bool idle() const { return !loads_ && !dampers_ && !drives_; }

  VectorXd acceleration(const State& state) {
    VectorXd a(state.z.size());
    system_.follow(state);
    if (!index1_.evaluate(state.t, state.z, state.w, a, lambda_)) a.setZero();
    return a;
  }

  // Adds the step's work to the last entries.
  void add(const Ends& ends, EnergyFlow& flow) {
    static const Quadrature gauss = gauss_legendre(3);
    system_.follow(ends.a);
    VectorXd q(system_.coordinates()), v(q.size()), unused(ends.a.z.size());
    for (Index i = 0; i < gauss.nodes.size(); ++i) {
      const double u = gauss.nodes[i], t = ends.a.t + u * ends.h, weight = ends.h * gauss.weights[i];
      const VectorXd z = ends.value(u), w = ends.rate(u);
      system_.expand(z, q);
      system_.expand_rate(w, v);
      if (loads_) flow.load_work.back() += weight * system_.power(false, t, q, v);
      if (dampers_) flow.dissipated.back() -= weight * system_.power(true, t, q, v);
      if (!drives_ || !index1_.evaluate(t, z, w, unused, lambda_)) continue;
      for (const Drive& d : system_.drives())
        flow.drive_work.back() -= weight * d.scale * lambda_[d.row] * d.target.derivative(1, t);
    }
  }

 private:
  System system_;  // follows the states
  Index1 index1_;
  bool loads_, dampers_, drives_;
  VectorXd lambda_;
};

}  // namespace

EnergyFlow energy_flow(const Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  EnergyFlow flow{{0.0}, {0.0}, {0.0}, {0.0}};
  std::unique_ptr<FlowIntegrator> integrator;
  const Model* model = nullptr;
  VectorXd before, after;
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    for (auto* list : {&flow.load_work, &flow.dissipated, &flow.drive_work, &flow.impact_loss})
      list->push_back(list->back());
    const State &a = trajectory.state(i), &b = trajectory.state(i + 1);
    if (same_instant(a.t, b.t)) {  // an impulse; where time goes on a little, of a drive
      const double gain =
          trajectory.model(i + 1).system.kinetic_energy(b.w) - trajectory.model(i).system.kinetic_energy(a.w);
      (b.t > a.t ? flow.drive_work : flow.impact_loss).back() += b.t > a.t ? gain : -gain;
      after.resize(0);
      continue;
    }
    if (model != &trajectory.model(i + 1)) {
      model = &trajectory.model(i + 1);
      integrator = std::make_unique<FlowIntegrator>(model->system);
      after.resize(0);
    }
    if (integrator->idle()) continue;
    before = after.size() ? after : integrator->acceleration(a);
    after = integrator->acceleration(b);
    integrator->add({a, b, before, after, b.t - a.t}, flow);
  }
  return flow;
}

}  // namespace unfurl
