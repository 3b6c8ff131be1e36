// SPDX-License-Identifier: BSD-3-Clause
// Steps that throw rods over a dead centre which their drives do not reach.
#pragma once

#include <memory>
#include <vector>

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
  // Whether a state is in that dead centre, as far as doubles tell. Behind such a verdict.
  bool in_one(const State& state);

 private:
  // What no row joins to others, and its drives.
  struct Part {
    std::vector<Drive> drives;
    std::unique_ptr<SmallestSingularValue> sigma;
    VectorXd known_at = {};  // coordinates, from which on
    double left = 0;         // its Jacobian may change by so much before it loses rank
  };
  void find_parts(const State& from, const State& to);
  Verdict judge(Part& part, const State& from, const State& to) const;
  bool beside(const State& in_one, const SmallestSingularValue::Pair& pair, double c) const;
  Verdict parabola(const Part& of, const State& near, const State& far,
                   const SmallestSingularValue::Pair& pair) const;

  const System& system_;
  bool known_ = false;  // which parts there are
  std::vector<Part> parts_;
  Part* judged_ = nullptr;  // of the last verdict
};

}  // namespace unfurl
