// SPDX-License-Identifier: BSD-3-Clause
// Constraint kinds. A kind is evaluated in blocks: one virtual call for all constraints of the kind in a
// structure.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/structure/moment.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

// A row that prescribes a motion: what a motor or an actuator does.
struct Drive {
  std::string name;     // for columns and messages; two may have the same
  int constraint = 0;   // index in Structure::constraints: what tells drives apart
  int row = 0;          // of the block, of the kept constraints in System::drives
  double scale = 1.0;   // l: the row is l (s - f); effort along s = -l lambda [N] or [N m]
  bool angle = false;   // s in radians, else in metres
  TimeFunction target;  // f
};

// All constraints of one kind. Every row is scaled to metres. Phi(q, t) = 0, G = dPhi/dq, curvature = Hess
// Phi. q: node coordinates of the solved nodes [3 n]; coordinate index of node i, axis k is 3 i + k.
class ConstraintBlock {
 public:
  virtual ~ConstraintBlock() = default;
  virtual int rows() const = 0;
  virtual bool linear() const = 0;  // G constant in q and t: may be eliminated exactly
  virtual std::string name(int row) const = 0;
  // Index in Structure::constraints of what asked for the row; -1: a rod.
  virtual int source(int row) const = 0;
  virtual double length(int row) const = 0;  // the length to which this row's error is relative [m]
  // Coordinates that row depends on, in the order used by jacobian and curvature.
  virtual std::vector<int> stencil(int row) const = 0;

  // Rows that follow from the others of their own constraint in every pose, so that they are none of its
  // equations: where three are kept of which two say everything, the one to leave out at q.
  virtual std::vector<int> implied_rows(const double* /*q*/) const { return {}; }

  virtual void value(const double* q, double* phi) const = 0;
  // The same near the angles of a moment: of rows that sum up angles that count turns.
  virtual void value_at(const Moment& /*at*/, const double* q, double* phi) const { value(q, phi); }
  // A kind that prescribes values over time is Phi(q, t) = value(q) - g(t); G does not depend on t.
  virtual bool rheonomic() const { return false; }
  // Rows whose g moves.
  virtual void list_drives(std::vector<Drive>& /*drives*/) const {}
  // out[row] += scale * (derivative of g of this order, 0, 1 or 2) at t.
  virtual void add_target(int /*order*/, double /*t*/, double /*scale*/, double* /*out*/) const {}
  // Entries of all rows one after the other, each in the order of its stencil.
  virtual void jacobian(const double* q, double* g) const = 0;
  // f += scale * G(q)^T lambda, without forming G.
  virtual void add_force(const double* q, const double* lambda, double scale, double* f) const = 0;
  // The same for several poses at once: entry i of pose c is q[i * stride + c], those of phi, lambda and f
  // follow each other without gaps (interleaved.hpp), and every pose has its scale. False: not offered, ask
  // pose by pose.
  virtual bool values(int /*poses*/, const double* /*q*/, Index /*stride*/, double* /*phi*/) const {
    return false;
  }
  // What motions from the pose q0 (moves: interleaved, without gaps) change of each row, where nothing
  // cancels: round-off is relative to the motion. Not what time changes of them.
  virtual bool changes(int /*poses*/, const double* /*q0*/, const double* /*moves*/, double* /*phi*/) const {
    return false;
  }
  virtual bool add_forces(int /*poses*/, const double* /*q*/, Index /*stride*/, const double* /*lambda*/,
                          const double* /*scale*/, double* /*f*/) const {
    return false;
  }
  // phi_dd[row] = v^T Hess Phi_row v.
  virtual void bias(const double* q, const double* v, double* phi_dd) const = 0;
  // For each row a dense k x k matrix lambda_row * Hess Phi_row, column by column, k the length of its
  // stencil.
  virtual void curvature(const double* q, const double* lambda, double* hess) const = 0;
  // The same by coordinates, summed up over the rows, without the zeros of rows that are long.
  virtual void add_curvature(const double* q, const double* lambda,
                             std::vector<Eigen::Triplet<double>>& entries) const;
};

struct ConstraintKind {
  std::string_view kind;
  std::string_view help;
  // The block of all constraints of this kind in the structure; nullptr where it has none.
  std::unique_ptr<ConstraintBlock> (*make)(const Structure&);
};
std::span<const ConstraintKind> constraint_kinds();

}  // namespace unfurl
