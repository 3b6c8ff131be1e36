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

  enum class Side { unknown, kept, turns, lost };
  // Whether a step led from one state to the other on one side of a dead centre, which drives do not reach;
  // `turns`: they turn round within the step at `turn`, at so little a distance from it that the step does
  // not tell it from none.
  struct Verdict {
    Side side = Side::unknown;
    double turn = 0;  // [s]
  };
  Verdict judge(const State& from, const State& to);
  // Whether a state is that of a dead centre, as far as doubles tell. Behind judge().
  bool in_one(const State& state);

 private:
  bool slows(double from, double to) const;
  bool prepare(const State& from, const State& to);
  bool beside(const State& in_one, const SmallestSingularValue::Pair& pair, double c) const;
  Verdict parabola(const State& near, const State& far, const SmallestSingularValue::Pair& pair);

  const System& system_;
  std::optional<SmallestSingularValue> sigma_;
  bool known_ = false;  // sigma_ is, or there is none
  VectorXd known_at_;   // coordinates, from which on
  double left_ = 0;     // the Jacobian may change by so much before it loses rank
};

}  // namespace unfurl
