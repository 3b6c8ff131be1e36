// SPDX-License-Identifier: BSD-3-Clause
// The equations of motion of a structure as an index-3 DAE (paper eq. 13-14), in the coordinates that are
// solved for:
//
//     M z'' + G(z)^T lambda = F(t, z, z'),   Phi(z, t) = Phi(z) - g(t) = 0
//
// whose derivatives read G z' = g'(t) and G z'' + z'^T Hess Phi z' = g''(t); g = 0 in all rows but those that
// prescribe a motion.
//
// Node coordinates are q = q_0 + B z. With elimination, B spans the null space of the linear constraints,
// which then hold exactly and leave the equations; without it, B = I.
//
// Angles that count their turns are taken near those of the state that the System follows; at first, of t =
// 0. A copy shares the equations and follows a state of its own. What is not told to follow another state is
// immutable and may be shared by threads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/constraints/constraint.hpp"
#include "core/forces/force.hpp"
#include "core/math/interleaved.hpp"
#include "core/math/linear_elimination.hpp"
#include "core/math/types.hpp"
#include "core/structure/structure.hpp"
#include "core/system/reduced_sum.hpp"
#include "core/system/state.hpp"

namespace unfurl {

class ElasticRods;

class System {
 public:
  System(const Structure& structure, bool eliminate_linear);
  ~System();
  System(const System&);
  System(System&&) noexcept;
  // The same equations with the loads of this structure, which is the same but for them; of little cost.
  System loaded(const Structure& structure) const;
  // Becomes the other one where the two differ by their loads only; false where they do not.
  bool take_loads_of(const System& other);

  // Angles that count turns (followed_angles of the structure), and taking them near those of a state.
  Index followed_angles() const;
  void follow(const State& state);
  System at(const State& state) const;  // a copy that follows it; of no cost where no angle is followed
  // A time, near those angles; axial forces of the rods that give, where lengths do not tell them.
  Moment moment(double t, const double* tension = nullptr) const;
  // The angles of a later state, counted on from those of the state that is followed.
  void count_on(State& later);

  // Keep every entry of the mass matrix, zeros too: factorisations are dense then. For comparison.
  void fill_mass();

  Index coordinates() const;               // 3 n, of all solved nodes
  const std::vector<int>& ghosts() const;  // nodes that are nowhere in space (Node::ghost)
  Index integrals() const;           // coordinates that are integrals of controllers: nothing moves with them
  Index solved_coordinates() const;  // size of z
  Index constraints() const;         // m, rows of Phi: those that are kept
  Index linear_constraints() const;  // how many rows were eliminated or could be
  bool eliminated() const;

  // Node coordinates and velocities from the solved ones, and back (exact where q fulfils the linear
  // constraints).
  void expand(const ConstVec& z, MutVec q) const;
  void expand_rate(const ConstVec& w, MutVec v) const;
  VectorXd reduce(const ConstVec& q) const;
  VectorXd reduce_rate(const ConstVec& v) const;
  void reduce_force(const ConstVec& f, MutVec r) const;  // r = B^T f
  void reduce_sizes(const ConstVec& f, MutVec r) const;  // r = |B|^T |f|: what may cancel in B^T f

  // Where, for each solved coordinate, the node coordinates stand of all nodes that it moves and, at this
  // moment, of those that the forces on these depend on: the pattern of a matrix (allocates).
  SparseRows felt_coordinates() const;
  SparseRows felt_coordinates(double t, const ConstVec& q, const ConstVec& v) const;

  const SparseRows& mass() const;       // of z, symmetric positive definite, constant [kg]
  const SparseRows& node_mass() const;  // of q [kg]

  // In node coordinates (fast kernels; callers expand first).
  void add_applied_force(double t, const ConstVec& q, const ConstVec& v, double scale,
                         MutVec f) const;                          // f += scale F
  bool constant_forces() const;                                    // true: F does not depend on t, q, v
  void constraint(double t, const ConstVec& q, MutVec phi) const;  // Phi(q, t) [m]
  bool rheonomic() const;                                          // some g depends on t
  void target_rate(double t, MutVec rate) const;  // g'(t) [m/s]; zero where nothing is driven
  void add_constraint_force(const ConstVec& q, const ConstVec& lambda, double scale,
                            MutVec f) const;  // f += scale G^T lambda
  // v^T Hess Phi v - g''(t) [m/s^2]: the acceleration level is G a = -bias.
  void constraint_bias(double t, const ConstVec& q, const ConstVec& v, MutVec bias) const;

  // The same for the stages of a step at once, each vector interleaved with those of the other stages (z, f,
  // r, phi, lambda: `poses` columns; of Q, which has a column more, those from `first` on).
  struct StageScratch {
    VectorXd q, f, row;  // for kinds of constraints that are asked pose by pose
    Interleaved moves;
  };
  void expand_stages(const Interleaved& z, Index first, Interleaved& Q) const;
  void reduce_force_stages(const Interleaved& f, Interleaved& r) const;
  void constraint_stages(const double* t, const Interleaved& Q, Index first, Interleaved& phi,
                         StageScratch& scratch) const;
  // What motions D from the pose q0 change of Phi: round-off is relative to D. False where a kind does not
  // offer that.
  bool constraint_changes(const ConstVec& q0, const Interleaved& D, Interleaved& phi,
                          StageScratch& scratch) const;
  // The same of one motion u of the nodes, of the rows whose kinds offer it; others are left as they are.
  void put_changes(const ConstVec& q0, const ConstVec& u, MutVec change) const;
  void add_constraint_force_stages(const Interleaved& Q, Index first, const Interleaved& lambda,
                                   const double* scale, Interleaved& f, StageScratch& scratch) const;

  // Jacobian with respect to z [m x size of z]; `pattern` allocates it once, `jacobian` only writes values.
  // `scratch` is grown once.
  SparseRows jacobian_pattern() const;
  void jacobian(const ConstVec& q, SparseRows& G, std::vector<double>& scratch) const;
  // sum_k lambda_k Hess Phi_k with respect to z (for a full Newton matrix; allocates).
  SparseRows curvature(const ConstVec& q, const ConstVec& lambda) const;

  double kinetic_energy(const ConstVec& w) const;  // [J]
  // Of solved coordinates, M_ii; infinite of integrals of controllers, whose numbers no rate is to be told
  // by.
  VectorXd moving_mass() const;
  double potential_energy(const ConstVec& q) const;  // gravity and springs [J]
  double load_work(const ConstVec& q) const;         // of the constant loads since q = 0 [J]

  // Power of the forces that have no potential [W]: loads that vary, or dampers (negative).
  bool has_power(bool dissipative) const;
  double power(bool dissipative, double t, const ConstVec& q, const ConstVec& v,
               const double* tension = nullptr) const;  // of the rods that give; nullptr: lengths tell
  // What dissipative forces that are left out of power() have taken by the pose of the state that is
  // followed, up to a constant [J].
  double taken(const ConstVec& q) const;
  // dF/dz and dF/dz' of the forces that vary, for Newton matrices (allocates).
  void force_derivatives(double t, const ConstVec& q, const ConstVec& v, SparseRows& by_z,
                         SparseRows& by_w) const;
  // The same for those who ask at every step.
  void force_derivatives(double t, const ConstVec& q, const ConstVec& v, ForceDerivatives& found) const;

  // Rods that give (indices of Structure::rods) and their axial forces, of all that each stands for [N].
  const std::vector<int>& giving_rods() const;
  void giving_rod_forces(double t, const ConstVec& q, const ConstVec& v, MutVec force) const;
  // What methods that take these forces as unknowns ask for; nullptr: no rod gives.
  const ElasticRods* elastic_rods() const;
  // f += scale (F without that of rods that give), where these have such axial forces.
  void add_other_force(double t, const ConstVec& q, const ConstVec& v, const ConstVec& tension, double scale,
                       MutVec f) const;
  bool by_tension() const;  // some such force depends on them
  // d|d|/dz of these rods, and the derivatives of their rows (elastic_rods.hpp) by z and z' (allocate).
  SparseRows giving_rod_directions(const ConstVec& q) const;
  void giving_rod_rows(const ConstVec& q, const ConstVec& v, SparseRows& by_z, SparseRows& by_w) const;
  // dF/dz and dF/dz' where these forces are given, and dF/dN without their own pull (allocate).
  void force_derivatives(double t, const ConstVec& q, const ConstVec& v, const ConstVec& tension,
                         SparseRows& by_z, SparseRows& by_w) const;
  SparseRows tension_derivatives(double t, const ConstVec& q, const ConstVec& v,
                                 const ConstVec& tension) const;
  // f += scale * what rods with these axial forces pull their nodes with.
  void add_giving_rod_forces(const ConstVec& q, const ConstVec& force, double scale, MutVec f) const;

  const std::vector<Drive>& drives() const;  // kept rows that prescribe a motion

  const VectorXd& constraint_lengths() const;                // [m] per kept row
  const std::vector<std::string>& constraint_names() const;  // per kept row
  // Kept row of each rod; -1: it gives, and is none.
  const std::vector<int>& rod_rows() const;
  std::vector<int> sources() const;  // per kept row: index in Structure::constraints, -1: a rod
  // First kept row of Structure::constraints[constraint]; -1 where it was eliminated.
  int constraint_row(int constraint) const;

  // Every constraint of the structure, eliminated ones included (for check and diagnostics).
  Index all_constraints() const;
  void all_constraint_values(double t, const ConstVec& q, MutVec phi) const;  // [m]
  // G v - g'(t) [m/s]; `scratch` is grown once.
  void all_constraint_rates(double t, const ConstVec& q, const ConstVec& v, MutVec rate,
                            std::vector<double>& scratch) const;
  SparseRows all_jacobian(const ConstVec& q) const;  // of the node coordinates
  std::vector<std::string> all_names() const;
  // Of them, those that follow from the others of their own constraint, whatever the pose: not to be counted.
  std::vector<int> implied_rows(const ConstVec& q) const;
  // Of them, those that eliminated ones imply to the digits of positions: no equations.
  std::vector<int> rows_of_digits() const;
  std::vector<int> all_sources() const;  // indices in Structure::constraints, -1: a rod
  VectorXd all_lengths() const;

 private:
  SparseRows felt(ForceDerivative by_nodes) const;
  struct Data;
  struct Constant {
    VectorXd loads, force;  // force: of all that does not depend on t, q or v, loads among it [N]
  };
  void set_loads(const Structure& structure);
  void measure_angles(const State& state);
  void find_implied_rows();

  std::shared_ptr<Data> data_;
  std::shared_ptr<const Constant> constant_;
  // Of the state that is followed, and where it was measured last; empty: none is followed.
  VectorXd angles_, rates_, measured_, measured_rates_;
  VectorXd q_, v_;  // where it was measured
  std::vector<double> gradient_;
  double since_ = 0.0;
};

}  // namespace unfurl
