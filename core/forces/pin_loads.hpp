// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/constraints/constraint.hpp"
#include "core/forces/elastic_rods.hpp"
#include "core/forces/force.hpp"
#include "core/forces/rod_couples.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

// The forces that load hinges whose dry friction is mu r |F| (friction.hpp). F is that with which the pin
// pulls the rod R from the hinge h to the first node A of the angle: of R's share M_R of the mass matrix, its
// length (its row of G, or what it pulls with where it gives), and the couples C that act on R wherever their
// hinges are, of springs, motors, dampers, friction and rows of its angles, also in sums, each a force at A
// and its opposite at h (rod_couples.hpp),
//
//     F = (M_R (a - g))_h + lambda_R dPhi_R/dx_h + C_A     or with N d|d|/dx_h in place of the second,
//
// N as the step has it where lengths do not tell (Moment::tension),
//
// with the accelerations and multipliers of the pose and its velocities, in node coordinates,
//
//     [ M  G^T ] [a     ]   [ F_0 - sum_k slip_k tau_k ds_k/dq ]
//     [ G   0  ] [lambda] = [ g'' - v^T Hess Phi v             ],   tau_k = tau_k0 + mu r |F_k|
//
// of all forces F_0 but this friction, whose torques load the pins, too: a fixed point, found by iteration
// from tau_k0, which contracts where mu r is small beside the rods. So F is a function of time, pose and
// velocities like any other force.
class PinLoads {
 public:
  PinLoads(const Structure& structure, const SparseRows& node_mass);
  // |F| of each entry of Structure::forces [N]; 0 of those without such friction, NaN where there is no
  // fixed point or the equations cannot be solved. d|F|/dN where R gives, but for what follows through the
  // accelerations.
  struct Loads {
    std::vector<double> size, by_tension;
  };
  Loads evaluate(const Moment& at, const double* q, const double* v) const;
  // The rod R of an entry where that gives: its place among those; -1: it does not.
  int giving_rod(std::size_t force) const;

  // The most that mu r may be at this pose [m], of each entry of Structure::forces; infinite of those without
  // such friction. From there on the torque raises the pin's force by more than it takes to make it: the
  // hinge locks itself, and there is no fixed point. Of a rod of length l without mass it is l.
  std::vector<double> longest_arms(double t, const double* q) const;
  // A hinge that is so at this pose; of none, empty strings.
  struct SelfLocking {
    std::string friction,
        problem;  // the name of its friction; what is wrong with its pin_friction, and a cure
  };
  static SelfLocking self_locking(const Structure& structure, const SparseRows& node_mass, double t,
                                  const double* q);

  // mu r of a friction [m]; 0: its torque does not depend on a force.
  static double arm(const Force& force) { return force.kind == "friction" ? force.size.offset : 0.0; }
  static bool any(const Structure& structure);
  // The rod from the hinge to the first node of a friction's angle; -1: no rod.
  static int rod_of(const Structure& structure, const Force& force);

 private:
  struct Pin {
    std::size_t force;
    MeasureFunction measure;
    int followed;
    double kinetic, arm;
    int slip, rod, hinge, other;
    int row, giving;  // its place among the rods that do not give, and among those that do; one of them is -1
    RodCouples couples;
  };
  // Of accelerations and multipliers that go with each other.
  struct Response {
    VectorXd a, lambda;
  };
  void add_pin(const Structure& structure, std::size_t force, int rod, int followed,
               const SparseRows& node_mass);
  // The part of F that is linear in them, and the rest.
  Vec3 linear_load(const Pin& pin, const double* q, const Response& r) const;
  Vec3 given_load(const Pin& pin, const Moment& at, const double* q, const double* v) const;
  // From the other node to the hinge, of length one.
  static Vec3 along(const Pin& pin, const double* q) {
    return (node_vector(q, pin.hinge) - node_vector(q, pin.other)).normalized();
  }
  SparseRows jacobian(const double* q) const;
  std::vector<Response> responses(const Moment& at, const double* q, const double* v,
                                  const SparseRows& G) const;
  // Of each pin the force that a unit torque of its friction, against `slip`, puts on its nodes.
  VectorXd unit_torque(const Pin& pin, const Moment& at, const double* q, double slip) const;

  Structure bare_;  // without this friction
  SparseRows mass_;
  std::unique_ptr<ElasticRods> rods_;  // that give; null: there are none
  std::vector<std::unique_ptr<ForceBlock>> forces_;
  std::vector<std::unique_ptr<ConstraintBlock>> constraints_;
  Index rows_ = 0, rod_row_ = 0;  // all rows of constraints; the first of a rod
  std::vector<Pin> pins_;
};

}  // namespace unfurl
