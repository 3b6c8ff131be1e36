// SPDX-License-Identifier: BSD-3-Clause
// Multipliers in the deployed pose of a motion along a path.
#pragma once

#include <functional>
#include <optional>

#include "core/path/path_watch.hpp"

namespace unfurl {

using StateOnPath = std::function<State(double t, double s, double v)>;

// The deployed pose may be singular: multipliers are smooth functions of the sine of the fold angle, or of
// time where the motion comes to rest there, and extrapolated to it from poses before it, as far out as the
// time loop has them. `state`: that of the model at a time, place and speed; `followed`: its equations, near
// the angles of the last state.
void limit_multipliers(System followed, const PathWatch& watch, const PathMotion& motion, double step,
                       const StateOnPath& state, State& event);

// s'' that a drive prescribes at z, from the rate there and the second one that it has with s'' = 0:
// m'' s'^2 + m' s'' = target''.
double driven_along(const Structure& structure, const System& system, const PathLaw& law,
                    const PathDrive& drive, double t, double s, const VectorXd& z, const VectorXd& rate,
                    const VectorXd& bend);

// Where a drive leads the constraints may lose rank. The equations of such a pose leave open how it goes on,
// and know no more than that of what the drive gives there; the path does: with unit inertia along s
//
//     effort dm/ds = s'' - Q(s, s', t),     m(s) = target(t).
class DrivenPoses {
 public:
  DrivenPoses(const Structure& structure, double step) : structure_(structure), step_(step) {}

  // Whether the last state has such a pose: at rest, or deployed.
  bool singular_at(const Trajectory& trajectory, const PathWatch& watch, double unit, double s, double v);
  // The motion has come to the pose that was asked for last by that state, and it is the deployed one.
  bool just_deployed() const { return just_deployed_; }
  // Nothing moves there for a while.
  bool rests(const PathDrive& drive, double t) const;
  // Multipliers at rest in the state's pose, at s, by poses before it in which all rests, too. Once for all
  // such states there, where nothing that acts changes with time.
  void limit_at_rest(System followed, double s, double unit, bool timed, const StateOnPath& state, State& at);
  // Enters the drive's multiplier of the time t.
  void tell_effort(const Path& path, PathLaw& law, const PathDrive& drive, double s, double v, double t,
                   const System& system, State& state) const;

 private:
  const Structure& structure_;
  const double step_;
  std::optional<double> known_;
  bool singular_ = false;  // at known_
  bool just_deployed_ = false;
  VectorXd at_rest_;  // at known_; empty: nobody has asked
};

}  // namespace unfurl
