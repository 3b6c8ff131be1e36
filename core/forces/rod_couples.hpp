// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "core/constraints/constraint.hpp"
#include "core/forces/force.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

// What loads one rod R across, from its hinge h to its other end A, beside its inertia and weight. What acts
// with Q along a measure s puts Q ds/dx on nodes, which may belong to several rods; of the direction d of
// each angle in s, a term of a sum or s itself, that is R's, wherever the angle's hinge is, the part
//
//     C = Q ds/dd at A,   -C at h
//
// is R's own. It is told by nodes for the angles alone, in the places of theirs. Bending stiffness beside A
// or h is such a couple of three nodes. What a row puts on h that holds a node on R, as a pin between R's
// ends or a slider, is R's, too: C is the opposite of all of that at h.
class RodCouples {
 public:
  struct Line {
    Line(const Structure& structure, int rod, int hinge);
    bool along(int from, int to) const { return from == hinge && (to == other || to == end); }
    bool tells(const Measure& angle, std::size_t from) const;  // by its nodes `from` and the next one
    bool tells(const Measure& measure) const;                  // an angle in it
    // Is it, or a term of it, one that acts on nodes of plates or of the whole structure, and so on both ends
    // of R, but on no rod alone?
    bool beside(const Measure& measure, const Deployment& deployment) const;

    int hinge, other;
    int end;  // that of the rod which R is a part of, where R was cut to bend
  };
  using Rows = std::vector<std::unique_ptr<ConstraintBlock>>;
  // Of all forces of `bare` but those marked in `apart`, and of its rows.
  RodCouples(const Structure& bare, const SparseRows& node_mass, const Rows& rows, int rod, int hinge,
             const std::vector<char>& apart);

  Vec3 of_forces(const Moment& at, const double* q, const double* v) const;
  // Q = -lambda along each row.
  Vec3 of_rows(const double* q, const VectorXd& lambda) const;
  // Q = 1 along the measure of a force that is apart.
  Vec3 of_measure(std::size_t force, const double* q) const;

 private:
  // Of a measure with nodes of its own: the structure's nodes where they are; and the nodes at which C is the
  // sum of sign times the force.
  struct End {
    int node;
    double sign;
  };
  struct Told {
    std::vector<int> nodes;
    std::vector<End> ends;
  };
  struct OfForce {
    Told told;
    std::unique_ptr<ForceBlock> block;
  };
  struct OfRow {
    Told told;
    std::unique_ptr<ConstraintBlock> block;  // of the rows of one constraint
    Index row;                               // the first of them
  };
  struct OfMeasure {
    Told told;
    MeasureFunction measure;
    std::size_t force;
  };
  void add_force(const Structure& bare, const SparseRows& node_mass, std::size_t index, const Force& force);
  void add_rows(const Structure& bare, const Rows& rows, int rod);
  void tell(Measure& measure, Told& told) const;
  Told tell_bending(const std::vector<int>& nodes) const;
  bool holds_on_rod(const Structure& bare, const Constraint& c, bool carries) const;
  VectorXd with_own(const double* x, const Told& told) const;

  int nodes_;
  Line line_;
  std::vector<OfForce> forces_;
  std::vector<OfRow> rows_;
  std::vector<OfMeasure> measures_;
};

}  // namespace unfurl
