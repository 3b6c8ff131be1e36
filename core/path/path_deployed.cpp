// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_deployed.hpp"

#include <cmath>
#include <optional>

#include "core/integrators/index1.hpp"
#include "core/simulate/deployed_event.hpp"

namespace unfurl {
namespace {

// The last time before now at which the sine of the fold angle was that.
std::optional<double> time_at_sine(const PathWatch& watch, const PathMotion& motion, double step,
                                   double wanted) {
  const auto sine = [&](double t) {
    double s = 0, v = 0;
    motion.at(t, s, v);
    return watch.remaining(s);
  };
  double b = motion.t(), a = b;
  for (double h = step; sine(a) < wanted; h *= 1.5) {
    if (a <= 0) return std::nullopt;
    b = a;
    a = std::max(0.0, a - h);
  }
  for (int it = 0; it < 60; ++it) (sine(0.5 * (a + b)) < wanted ? b : a) = 0.5 * (a + b);
  return b;
}

}  // namespace

void limit_multipliers(System followed, const PathWatch& watch, const PathMotion& motion, double step,
                       const std::function<State(double t, double s, double v)>& state, State& event) {
  constexpr double farthest = 3e-2, span = 12, from_start = 0.25, slow = 1e-3;
  constexpr int count = 9, poles = 3;
  const double start = std::abs(watch.remaining(0.0));
  const double far = std::min(farthest, from_start * start);
  Index1 index1(followed, true);
  std::vector<NearDeployed> samples;
  VectorXd a(event.z.size());
  double s = 0, v = 0;
  const std::optional<double> from = time_at_sine(watch, motion, step, far);
  bool rests = false;
  if (from) {
    motion.at(*from, s, v);
    const double speed = std::abs(v);
    motion.at(event.t, s, v);
    rests = std::abs(v) < slow * speed;
  }
  for (int i = 0; i < count; ++i) {
    const double u = 0.5 - 0.5 * std::cos(pi * (i + 0.5) / count);
    const double share = 1 + u * (1 / span - 1);
    const auto t = rests ? event.t - share * (event.t - *from)
                         : time_at_sine(watch, motion, step, far + u * (far / span - far));
    if (!t) continue;
    motion.at(*t, s, v);
    State near = state(*t, s, v);
    followed.follow(near);
    if (index1.evaluate(*t, near.z, near.w, a, near.lambda))
      samples.push_back({rests ? event.t - *t : watch.remaining(s), std::move(near)});
  }
  if (samples.size() < 3) return;
  followed.follow(event);
  event.lambda = multipliers_at_deployed(index1, samples, event, rests ? poles : 1);
}

}  // namespace unfurl
