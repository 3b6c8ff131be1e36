// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_deployed.hpp"

#include <cmath>
#include <optional>

#include "core/integrators/index1.hpp"
#include "core/path/path_scope.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/singular_poses.hpp"

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
                       const StateOnPath& state, State& event) {
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

void DrivenPoses::limit_at_rest(System followed, double s, double unit, bool timed, const StateOnPath& state,
                                State& at) {
  if (!timed && at_rest_.size() > 0) {
    at.lambda = at_rest_;
    return;
  }
  constexpr double farthest = 3e-2, span = 12, from_start = 0.25;
  constexpr int count = 9;
  const double far = std::copysign(std::min(farthest * unit, from_start * std::abs(s)), s);
  Index1 index1(followed, true);
  std::vector<NearDeployed> samples;
  VectorXd a(at.z.size());
  for (int i = 0; i < count; ++i) {
    const double u = 0.5 - 0.5 * std::cos(pi * (i + 0.5) / count), share = 1 + u * (1 / span - 1);
    State near = state(at.t, s - share * far, 0);
    followed.follow(near);
    if (index1.evaluate_at_rest(near, a, near.lambda))
      samples.push_back({share * std::abs(far) / unit, std::move(near)});
  }
  if (samples.size() < 3) return;
  followed.follow(at);
  at.lambda = at_rest_ = multipliers_at_deployed(index1, samples, at);
}

bool DrivenPoses::singular_at(const Trajectory& trajectory, const PathWatch& watch, double unit, double s,
                              double v) {
  const double near = 1e-9 * unit;
  just_deployed_ = false;
  if (known_ && std::abs(s - *known_) <= near) return singular_;
  just_deployed_ = watch.is_deployed(s);
  if (!just_deployed_ && std::abs(v) * step_ > near) return false;
  known_ = s;
  at_rest_.resize(0);
  return singular_ = singular_at_end(trajectory);
}

bool DrivenPoses::rests(const PathDrive& drive, double t) const {
  constexpr double rounded = 1e-10;
  const double way = rounded * std::abs(drive.target(t) - drive.target(0));
  return std::abs(drive.target.derivative(1, t)) * step_ <= way &&
         std::abs(drive.target.derivative(2, t)) * step_ * step_ <= way;
}

double driven_along(const Structure& structure, const System& system, const PathLaw& law,
                    const PathDrive& drive, double t, double s, const VectorXd& z, const VectorXd& rate,
                    const VectorXd& bend) {
  return (drive.target.derivative(2, t) - driven_second_rate(structure, system, z, rate, bend)) /
         law.table().at(drive.column, s).slope;
}

void DrivenPoses::tell_effort(const Path& path, PathLaw& law, const PathDrive& drive, double s, double v,
                              double t, const System& system, State& state) const {
  VectorXd z, tangent;
  const auto number = path.piece_of(s);
  if (!number || !path.point(s, z, tangent)) return;
  const PathPiece& piece = *path.piece(*number);
  const VectorXd bend = v * v * piece.bend(piece.x_of(s));
  law.look_from(s);
  const double along = driven_along(structure_, path.system(), law, drive, t, s, z, v * tangent, bend);
  const double effort = (along - law.at(s, v, t).Q) / law.table().at(drive.column, s).slope;
  for (const Drive& d : system.drives()) state.lambda[d.row] = -effort / d.scale;
}

}  // namespace unfurl
