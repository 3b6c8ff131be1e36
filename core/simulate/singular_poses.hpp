// SPDX-License-Identifier: BSD-3-Clause
// Poses of a run in which a structure gains ways to move.
#pragma once

#include <memory>

#include "core/math/interleaved.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/math/sparse_part.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

// A system's kept Jacobian, in poses that several look at in turn.
class JacobianInPoses {
 public:
  explicit JacobianInPoses(const System& system)
      : system_(system), pattern_(system.jacobian_pattern()), G_(pattern_), q_(system.coordinates()) {}
  const System& system() const { return system_; }
  // With the values of no pose in particular: orders of elimination go by their sizes.
  const SparseRows& pattern() const { return pattern_; }
  const SparseRows& at(const ConstVec& z);

 private:
  const System& system_;
  SparseRows pattern_, G_;
  VectorXd z_, q_;
  std::vector<double> scratch_;
};

// The smallest singular value sigma of a system's Jacobian G (rows of length 1, solved coordinates, kept
// rows) that is not zero everywhere, followed from pose to pose: block inverse iteration with G G^T + e I or
// G^T G + e I, whichever has fewer zeros, warm-started, then the singular values of G on the block
// (Rayleigh-Ritz), which converge like the square of the block's error. `redundant`: how many rows depend on
// others in every pose; their zeros are passed over. `count`: so many of the smallest are known. Of some
// coordinates alone, where no row joins them to others: what is weak elsewhere, and stays so, would hide how
// these come near a singular pose.
class SmallestSingularValue {
 public:
  SmallestSingularValue(std::shared_ptr<JacobianInPoses> jacobian, SparsePart part, Index redundant,
                        Index count = 1);
  // There is none: rods between fixed nodes alone. Nothing else may be asked then.
  bool all_zeros() const { return zeros_ >= block_.rows(); }
  double at(const ConstVec& z);  // NaN where the factorisation broke down
  // From one iteration, which the last pose's vectors make good enough to follow sigma by; from as many as it
  // takes where sigma has changed much.
  double estimate(const ConstVec& z);
  // How far the Jacobian has moved since this was asked last (infinite the first time), in the norm of all
  // its entries: by Weyl's inequality no singular value has changed by more.
  double moved(const ConstVec& z);
  // What at() has found, by rising sigma: unit vectors u of the rows and v of the coordinates with
  // G v = sigma u, and how long the rows were; of all rows and coordinates, 0 and 1 of those that are not
  // looked at.
  struct Pair {
    double sigma;
    VectorXd u, v, lengths;
  };
  std::vector<Pair> pairs() const;
  double between(const Pair& pair, const ConstVec& z);  // u^T G(z) v

 private:
  void jacobian(const ConstVec& z);
  bool place(const ConstVec& z);
  double settle(double tolerance);
  void stir(Index column);
  void improve();  // one iteration

  std::shared_ptr<JacobianInPoses> whole_;
  SparsePart part_;
  std::vector<Index> from_;  // of each entry of G_, in the whole
  bool by_rows_ = false;     // the block lies in the space of the rows
  Index zeros_ = 0;          // of the matrix that is iterated with, in every pose
  Index count_;
  SparseRows G_;
  SaddleSolver saddle_;
  VectorXd z_, sigma_;          // z_: the pose of G_
  VectorXd lengths_;            // of its rows
  VectorXd seen_;               // entries of G_ at the pose that moved() saw last
  Interleaved rows_, columns_;  // the two parts of some of the saddle-point system's unknowns
  MatrixXd block_;              // columns: singular vectors, by rising sigma
};

// Of the kept Jacobian in a pose, rows of length 1.
Index rank_at(JacobianInPoses& jacobian, const SparsePart& part, const ConstVec& z);
// Of a system those that neither rows nor masses join, and that have rows.
std::vector<SparsePart> parts_with_rows(const JacobianInPoses& jacobian);

// Rows of the kept Jacobian less its rank, the largest rank of a few states of [first, last]: a pose that is
// singular for a moment does not count.
Index structural_redundancy(const Trajectory& trajectory, std::size_t first, std::size_t last);

// The last state's pose has less rank than usual in the run, singular values below `flat` of the largest
// counting for nothing: deployed poses are located to 1e-9 or so. Where the Jacobian has more than
// max_singular_size rows or columns, by the rows that a state halfway determines and the last one does not,
// and assumed for a larger `flat`.
bool singular_at_end(const Trajectory& trajectory, double flat = 1e-6);

// The deployed pose `event`, which follows the last state, is so far from singular ones that its equations
// say what its forces are. No dead centre is: a fold angle of 0 or 180 degrees is not looked at.
bool regular_when_deployed(Trajectory& trajectory, const State& event);

// Adds an event "singular pose" to `run` for every time between two states at which sigma dips below a
// hundredth of its largest value in the run and to a half of its heights before and after. The start and the
// end of a run are no dips: a ring that ends deployed ends at a singular pose, and its event is "deployed".
// States are looked at after the run, and poses inside steps in which a rod turns far; nothing where the
// Jacobian has more than max_singular_size rows or columns, every second, third, ... where states abound.
// Once `cancelled` says so, the events so far are all.
inline constexpr Index max_singular_size = 300;
void record_singular_poses(Simulation& run, const std::function<bool()>& cancelled = {});
// The same in two: what is found, which another thread may do, and the entry among the events of the run.
std::vector<Event> find_singular_poses(const Trajectory& trajectory,
                                       const std::function<bool()>& cancelled = {});
void record_singular_poses(Simulation& run, const std::vector<Event>& found);

}  // namespace unfurl
