// SPDX-License-Identifier: BSD-3-Clause
// Steps that throw rods over a dead centre which their drives do not reach.
#pragma once

#include <optional>

#include "core/simulate/singular_poses.hpp"

namespace unfurl {

// Rods that a drive leads to near a dead centre have two poses for every place of the drive, one on either
// side: a long step may end in the wrong one, where the constraints hold as well.
//
// With the singular vectors u, v of the smallest singular value of G, the constraints along v are a parabola,
//     c x^2 / 2 = u^T g(t) + constant,    c x = u^T G v,
// x the way from the dead centre: sides are told by the sign of u^T G v, and how near the motion comes within
// the step by the drives' own g.
class DeadCentres {
 public:
  explicit DeadCentres(const System& system) : system_(system) {}

  // Where a step that led from one state to the other has to end at the latest, to stay on its side; nothing:
  // it did. Where drives turn round within the step, at so little a distance from the dead centre that the
  // step does not tell it from none, there.
  struct Verdict {
    double latest;  // [s]
    bool turns;
  };
  std::optional<Verdict> judge(const State& from, const State& to);
  // Whether a state is one of a dead centre, as far as doubles tell.
  bool in_one(const State& state);

 private:
  bool slows(double from, double to) const;
  bool prepare(const State& from, const State& to);
  std::optional<Verdict> parabola(const State& near, const State& far, double sigma);

  const System& system_;
  std::optional<SmallestSingularValue> sigma_;
  bool known_ = false;  // sigma_ is, or there is none
  double left_ = 0;     // by so much the Jacobian may change from the last state on before it loses rank
};

}  // namespace unfurl
