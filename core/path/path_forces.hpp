// SPDX-License-Identifier: BSD-3-Clause
// What acts along a path: every force of a structure as
//
//     Q = size(t) p(s) - c(s) s',     p = F(q, 0) . dq/ds,   c = -(F(q, u dq/ds) - F(q, 0)) . dq/ds / u
//
// with u so large, in any units, that of F(q, 0), which may be the rounding of large forces that balance,
// nothing is left in the difference. It holds for loads, springs, dampers and motors at full voltage, whose
// forces are linear in the velocities; dry friction by the sense in which it slips; and the measures that
// stops, cables and drives go by.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/forces/force.hpp"
#include "core/path/path_table.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

// Why the path cannot describe what a structure holds: a kind of force, constraint or measure that is not on
// its list. Empty: all are. A kind that is new is refused until somebody has put it on the list.
std::string unknown_to_path(const Structure& structure);

class PathForces final : public PathFunctions {
 public:
  struct Source {
    std::string name, kind;
    Index position = 0, damping = -1;  // columns of the table; -1: it does not damp
    bool timed = false;                // then the position's column is for size 1
    TimeFunction size = {};
    int cable = -1;           // index in `cables`
    bool turns_back = false;  // it acts on an angle without an axis, which does where its sides lie in line
    int friction = -1;  // index in `frictions`; the position's column is then -ds/dpath of its measure s
    // What rounding of the time leaves in the size, in its coefficients over a step.
    double size_noise(double t) const { return timed ? 4e-15 * std::abs(t * size.derivative(1, t)) : 0.0; }
  };
  struct Cable {
    std::string name;
    Index measure = 0;  // column of its length
    double rest = 0.0, stiffness = 0.0, damping = 0.0;
  };
  struct Friction {
    std::string name;
    double kinetic = 0.0, holding = 0.0;
  };
  // separately: a column for every source, for their shares; otherwise those that always act the same way
  // have one in common.
  PathForces(const Structure& structure, const Path& path, bool separately);

  Index add_measure(const Measure& measure);  // its column; before a table is made
  // Of the deployment: what remains of a measure, or sine and, behind it, cosine of the angle to the deployed
  // pose, of which remaining_of_fold() is not smooth.
  Index add_remaining();

  const std::vector<Source>& sources() const { return sources_; }
  const std::vector<Cable>& cables() const { return cables_; }
  const std::vector<Friction>& frictions() const { return frictions_; }

  Index size() const override { return columns_; }
  VectorXd first_angles() const override;
  void evaluate(const VectorXd& q, const VectorXd& dq, VectorXd& angles, VectorXd& value,
                VectorXd& scale) const override;
  std::string whose(Index column) const override;

 private:
  struct Term {
    std::unique_ptr<ForceBlock> block;
    VectorXd constant;  // the force itself where it is constant
    Index position = 0, damping = -1;
    Index first_angle = 0;
    std::vector<MeasureFunction> angles;
  };
  struct Tracked {
    MeasureFunction measure;
    Index column = 0, angle = -1;
  };
  void add_term(const Structure& one, std::string_view kind, const Source& source, const System& system);

  const Structure& structure_;
  double length_;  // what a change of a measure is compared with [m]
  Index columns_ = 0, angle_count_ = 0;
  std::vector<Source> sources_;
  std::vector<Cable> cables_;
  std::vector<Friction> frictions_;
  std::vector<Term> terms_;
  std::vector<Tracked> measures_;
  Index remaining_ = -1, remaining_angles_ = 0;
};

}  // namespace unfurl
