// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/energy_flow.hpp"
#include "core/integrators/integrator.hpp"
#include "core/math/largest.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/stress.hpp"

namespace unfurl {
namespace {

constexpr double seconds_each = 40.0;  // of CPU time, which does not count what else the machine does

// Steps without keeping them; looks at every step's energy and constraints, and writes down the largest so
// far at some three hundred counts, spaced by equal factors.
class Marathon {
 public:
  Marathon(const Model& model, const Setting& setting) : system_(model.system), flow_(model) {
    state_ = initial_state(model.structure, system_).state;
    method_ = find_method(setting.options.method)->make(system_, setting.options);
    out_.setting = setting.name;
    out_.step = setting.options.step;
    q_.resize(system_.coordinates());
    phi_.resize(system_.all_constraints());
    lengths_ = system_.all_lengths();
    look();
  }

  LongRun run(long steps, const StudyHooks& hooks) {
    const double begin = thread_cpu_seconds();
    out_.end = "done";
    double next = 1;
    for (long k = 1; k <= steps; ++k) {
      if (k % 256 == 0 && !may_go_on(begin, hooks)) break;
      before_ = state_;
      if (!method_->step(state_, out_.step).ok()) {
        out_.end = "solver failed";
        break;
      }
      flow_.add(before_, state_);
      look();
      out_.steps = k;
      if (!(constraint_ < 0.1)) {
        sample(k);
        out_.end = "constraints lost";
        break;
      }
      if (static_cast<double>(k) < next && k != steps) continue;
      sample(k);
      next *= 1.05;
    }
    return std::move(out_);
  }

 private:
  bool may_go_on(double begin, const StudyHooks& hooks) {
    if (hooks.stopped()) throw Cancelled();
    const double spent = thread_cpu_seconds() - begin;
    if (spent > seconds_each) out_.end = "time is up";
    return spent <= seconds_each;
  }
  void look() {
    system_.follow(state_);
    system_.expand(state_.z, q_);
    const double kinetic = system_.kinetic_energy(state_.w), potential = system_.potential_energy(q_),
                 work = system_.load_work(q_) + flow_.load_work;
    turned_over_.add(kinetic, std::array{potential, work, flow_.dissipated, flow_.drive_work});
    const double energy = kinetic + potential - work + flow_.dissipated - flow_.drive_work;
    if (!first_) first_ = energy;
    energy_error_ = larger(energy_error_, std::abs(energy - *first_));
    system_.all_constraint_values(state_.t, q_, phi_);
    if (phi_.size())
      constraint_ = larger(constraint_, phi_.cwiseQuotient(lengths_).lpNorm<Eigen::Infinity>());
  }
  void sample(long k) {
    out_.step_count.push_back(static_cast<double>(k));
    out_.energy_error.push_back(energy_error_ / turned_over_.value());
    out_.constraint.push_back(constraint_);
  }

  System system_;  // follows the states
  State state_, before_;
  EnergyMeter flow_;
  EnergyTurnedOver turned_over_;
  std::unique_ptr<Integrator> method_;
  LongRun out_;
  VectorXd q_, phi_, lengths_;
  std::optional<double> first_;
  double energy_error_ = 0, constraint_ = 0;
};

}  // namespace

std::vector<LongRun> long_runs(const StressPlan& plan, const StudyHooks& hooks) {
  std::vector<LongRun> out;
  if (plan.long_steps == 0) return out;
  const Scene scene = plan.source.read();
  const auto model = build_model(scene);
  for (const Setting& setting : plan.settings)
    out.push_back(Marathon(*model, setting).run(plan.long_steps, hooks));
  return out;
}

}  // namespace unfurl
