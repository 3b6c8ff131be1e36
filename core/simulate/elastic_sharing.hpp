// SPDX-License-Identifier: BSD-3-Clause
// How the rods of a rigid motion share the forces that rigid rods leave open, where they have a modulus.
#pragma once

#include <deque>
#include <memory>

#include "core/math/least_energy.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Of every kept row [m/N]; zero: a guide or a rigid rod. Empty where no rod is elastic.
VectorXd row_compliance(const Model& model);
// The same at a time, of C in G x = C lambda: of a rod of the length l (1 + e), e = alpha dT, the row is (1 +
// e) times its stretch, the axial force (1 + e) times the multiplier (constraints/rod_length.hpp).
VectorXd row_compliance(const Model& model, double t);

// Multipliers of least complementary energy in place of those of least norm, along the states of a model.
class ElasticSharing {
 public:
  // Does nothing where no rod is elastic or where everything is determined anyway.
  ElasticSharing(const Model& model, bool all_determined);
  // lambda at the node coordinates q. `limit`: at a pose where the rank falls and the given multipliers are
  // the limit along the motion (StepReport::singular_event); so is then what is added to them.
  void share(double t, const VectorXd& q, bool limit, VectorXd& lambda);

 private:
  struct Change {
    double t;
    VectorXd lambda;
  };
  VectorXd at_limit(double t) const;

  const System& system_;
  const Structure& structure_;
  SparseRows G_;
  std::vector<double> scratch_;
  std::unique_ptr<LeastEnergy> least_;
  std::deque<Change> last_;  // of the states before
};

}  // namespace unfurl
