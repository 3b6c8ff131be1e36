// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/measured_event.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

std::optional<State> step_to_zero(const State& from, double h,
                                  const std::function<double(const State&)>& left,
                                  const std::function<bool(double length, State& state)>& solve) {
  constexpr double nothing = 1e-15;  // of a fraction: below what its value is rounded to
  constexpr int most = 100;
  State to = from;
  if (!solve(h, to)) return std::nullopt;
  double low = 0, high = h, at_low = left(from), at_high = left(to);
  if (at_high > 0) return std::nullopt;
  for (int side = 0, i = 0; i < most && at_high < -nothing && high - low > nothing * h; ++i) {
    const double length = low + (high - low) * at_low / (at_low - at_high);
    State next = from;
    if (!solve(length, next)) return std::nullopt;
    const double f = left(next);
    const int now = f > 0 ? 1 : -1;
    if (now > 0) {
      low = length, at_low = f;
      if (side == now) at_high *= 0.5;
    } else {
      high = length, at_high = f;
      if (side == now) at_low *= 0.5;
    }
    side = now;
    to = std::move(next);
    if (std::abs(f) <= nothing) break;
  }
  return to;
}

bool deploys_regularly(const Structure& structure) {
  return structure.deployment.measured ||
         std::ranges::all_of(structure.rods, [](const Rod& rod) { return rod.gives; });
}

std::optional<State> step_to_deployed(const Model& model, Integrator& integrator, const State& from, double h,
                                      double margin) {
  if (!deploys_regularly(model.structure)) return std::nullopt;
  VectorXd q(model.system.coordinates());
  const auto left = [&](const State& state) {
    model.system.expand(state.z, q);
    return model.structure.deployment.remaining(q, state.angles) - margin;
  };
  return step_to_zero(from, h, left, [&](double length, State& state) {
    integrator.restart();
    return integrator.step(state, length).ok();
  });
}

std::optional<Dip> step_to_dip(const Model& model, const std::function<std::unique_ptr<Integrator>()>& fresh,
                               const State& from, const State& to, double h, double rounded,
                               const Probe* behind) {
  if (!deploys_regularly(model.structure)) return std::nullopt;
  struct At {
    double length, left, rate;
  };
  VectorXd q(model.system.coordinates());
  const auto at = [&](double length, const State& state) {
    model.system.expand(state.z, q);
    return At{length, model.structure.deployment.remaining(q, state.angles), remaining_rate(model, state)};
  };
  // A fall at twice the first rate would get there. (Tangents are no bound: an angle without an axis has a
  // kink where its sides lie in line, and may bend either way on both sides of it.)
  const auto may_dip = [rounded](const At& a, const At& b) {
    return a.left > rounded && b.left > -rounded && a.rate < 0 && b.rate > 0 &&
           a.left + 2 * a.rate * (b.length - a.length) <= rounded;
  };
  At low = behind ? at(behind->at, behind->state) : at(0, from), high = at(h, to);
  if (!may_dip(low, high)) return std::nullopt;
  const std::unique_ptr<Integrator> integrator = fresh();
  constexpr int most = 60;
  constexpr double settled = 1e-14;  // of the step
  constexpr double nearly =
      1e-6;  // rounding, of coordinates next to a singular pose or a method's, hides more
  std::optional<Dip> touched;
  for (int i = 0; i < most && (touched || may_dip(low, high)); ++i) {
    // The rate's zero by its secant, and every third time by halves.
    const double secant = low.length - low.rate * (high.length - low.length) / (high.rate - low.rate);
    const double length = i % 3 == 2 ? 0.5 * (low.length + high.length) : secant;
    State state = from;
    integrator->restart();
    if (!(length > low.length && length < high.length)) return touched;
    const StepReport report = integrator->step(state, length);
    const Dip unsolved{.length = length, .touches = true, .solved = false};
    if (!report.ok() || report.weak_end) return touched ? touched : unsolved;
    const At middle = at(length, state);
    if (middle.left < -rounded) return Dip{length};
    const double change = touched ? std::abs(length - touched->length) : h;
    if (middle.left <= rounded) touched = Dip{length, true};
    if (change <= settled * h) return touched;
    (middle.rate < 0 ? low : high) = middle;
    if (!touched && std::max(low.left, high.left) < nearly && !may_dip(low, high)) return unsolved;
  }
  return touched;
}

double remaining_rate(const Model& model, const State& state) {
  VectorXd q(model.system.coordinates()), v(q.size());
  model.system.expand(state.z, q);
  model.system.expand_rate(state.w, v);
  return model.structure.deployment.remaining_rate(q, v);
}

}  // namespace unfurl
