// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/dense_output.hpp"

#include <algorithm>
#include <cmath>

#include "core/simulate/initial_state.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {
namespace {

constexpr std::size_t most_idle = 4;
constexpr double too_short =
    1e-7;  // share of the way between the states, below which a straight line will do
constexpr int most_pieces = 8;
constexpr int closest_stages = 8;

}  // namespace

bool is_short_step(const State& a, const State& b) {
  constexpr double good = 0.02;
  const VectorXd mean = (b.z - a.z) / (b.t - a.t);
  const auto size = [](const VectorXd& w) { return w.lpNorm<Eigen::Infinity>(); };
  return mean.size() == 0 ||
         size(mean - 0.5 * (a.w + b.w)) <= good * std::max({size(a.w), size(b.w), size(mean)});
}

SolverOptions closest_steps(SolverOptions options) {
  options.method = "dvm";
  options.stages = closest_stages;
  options.nodes = "lobatto";
  options.constraints_at = "nodes";
  return options;
}

State on_cubic(const State& a, const State& b, double t) {
  const double h = b.t - a.t, u = (t - a.t) / h, v = 1 - u;
  State s = a;
  s.t = t;
  if (a.angles.size() == b.angles.size()) s.angles = v * a.angles + u * b.angles;
  s.z = v * v * (1 + 2 * u) * a.z + u * v * v * h * a.w + u * u * (3 - 2 * u) * b.z - u * u * v * h * b.w;
  s.w = 6 * u * v / h * (b.z - a.z) + v * (1 - 3 * u) * a.w + u * (1 - 3 * v) * b.w;
  return s;
}

DenseOutput::Engine DenseOutput::borrow(const std::shared_ptr<const Model>& model, State start, double h) {
  {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::find_if(idle_.begin(), idle_.end(), [&](const Engine& e) { return e.model == model; });
    if (found != idle_.end()) {
      Engine engine = std::move(*found);
      idle_.erase(found);
      return engine;
    }
  }
  Engine made{model, find_method(options_.method)->make(model->system, options_)};
  // In its first step a method looks closely at which rows are redundant; in all others it knows, and their
  // last digits are other ones. Whatever is asked first is answered as what is asked again.
  (void)made.integrator->step(start, h);
  return made;
}

void DenseOutput::give_back(Engine engine) {
  const std::lock_guard lock(mutex_);
  if (idle_.size() == most_idle) idle_.erase(idle_.begin());
  idle_.push_back(std::move(engine));
}

State DenseOutput::between(const std::shared_ptr<const Model>& model, const State& a, const State& b,
                           double t, const StepReport& step) {
  const double h = t - a.t;
  if (!(h > 0)) return a;
  if (t >= b.t) return b;
  State state = a;
  if (h <= too_short * (b.t - a.t)) {
    state.t = t;
    state.z += h * a.w;
    state.w += h / (b.t - a.t) * (b.w - a.w);
    return state;
  }
  // Next to a singular pose a step loses digits that shorter ones keep.
  int pieces = step.singular_event ? 4 : 1;
  // No step of any method need have led so far.
  if (options_.method == "dvm" && options_.stages == closest_stages && !is_short_step(a, b))
    pieces = most_pieces;
  Engine engine = borrow(model, a, h);
  if (step.contradictions) engine.integrator->expect_contradictions();
  engine.integrator->stop_waves_of(b.t - a.t);
  bool solved = false;
  for (; pieces <= most_pieces && !solved; pieces *= 2) {
    state = a;
    engine.integrator->restart();
    solved = true;
    for (int i = 0; i < pieces && solved; ++i) solved = engine.integrator->step(state, h / pieces).ok();
  }
  give_back(std::move(engine));
  if (!solved) {
    state = on_cubic(a, b, t);
    project(model->system, state);
  }
  state.t = t;
  return state;
}

}  // namespace unfurl
