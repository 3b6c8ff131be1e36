// SPDX-License-Identifier: BSD-3-Clause
// What pushes along measures do to a motion.
#pragma once

#include "core/math/saddle_solver.hpp"
#include "core/simulate/stops.hpp"
#include "core/structure/measure.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// At the pose of a state, the constraints of the system answering, with n_i = sign_i B^T ds_i/dq,
//
//     M a_i + G^T mu = n_i,  G a_i = 0,     D_ij = n_i . a_j
//
// impulses P_j change the rates sign_i s_i' by D P, forces f_j the accelerations sign_i s_i'' by D f.
class PushResponses {
 public:
  // The system must follow the state.
  PushResponses(const System& system, const State& state);
  bool ok() const { return ok_; }
  void add(const MeasureFunction& s, double sign, double near, const LimitMotion& limit = {});

  Index size() const { return static_cast<Index>(rows_.size()); }
  MatrixXd matrix() const;                           // D
  bool movable(Index i) const;                       // by any push along it, as far as rounding tells
  VectorXd rates(const VectorXd& w) const;           // sign_i s_i'
  double at_most(Index i, const VectorXd& w) const;  // that, were all rates as the fastest
  void leave_last() { rows_.pop_back(); }
  // Of the kinetic energy of rates w what an impulse along measure i takes when it stops that: 1 where
  // nothing else can move, as all rates follow from one.
  double taken(Index i, const VectorXd& w) const;
  void give(const VectorXd& P, VectorXd& w) const;  // w += sum P_i a_i
  // How much faster than what is asked along measure i a push along it makes some coordinate: 1 of a free
  // mass, without a bound at a dead centre.
  double spread(Index i) const;
  // The impulses P, and `lambda` of the constraints, that took rates w to w + dw,
  //     M dw + G^T lambda = sum P_i n_i,
  // of several the least; `unexplained`: the share of dw that none do, in the mass metric.
  VectorXd impulses_of(const VectorXd& dw, VectorXd& lambda, double& unexplained) const;
  // sign_i s_i'' of a state at that pose, by the system's own forces; empty where they have no solution. With
  // the size of what each is the sum of, and what it is where all coordinates are accelerated as the fastest,
  // or as any would be by what acts on it alone.
  struct Accelerations {
    VectorXd value, terms, of_coordinates, uncancelled;
    VectorXd largest_multiplier;  // of what holds there in what each is joined with [N]
  };
  Accelerations accelerations(const Structure& structure, const State& state) const;

 private:
  struct Row {
    const MeasureFunction* measure;
    double sign;
    VectorXd n, a, mu;
    double size;        // of n before linear constraints, which may leave nothing of it
    LimitMotion limit;  // of what s is bounded by: rates and accelerations are relative to it
  };
  VectorXd largest_multipliers(const State& state, const VectorXd& lambda) const;

  const System& system_;
  SparseRows G_;
  SaddleSolver saddle_;
  VectorXd q_;
  std::vector<Row> rows_;
  bool ok_ = false;
};

}  // namespace unfurl
