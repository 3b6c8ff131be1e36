// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/integrators/carried_sum.hpp"
#include "core/integrators/dvm.hpp"
#include "core/integrators/full_newton.hpp"
#include "core/integrators/settling.hpp"
#include "core/integrators/stage_equations.hpp"
#include "core/integrators/stiff_correction.hpp"
#include "core/math/anderson.hpp"
#include "core/math/saddle_solver.hpp"

namespace unfurl {

// The step of core/integrators/dvm.hpp, for its own sources only.
class Dvm final : public Integrator {
 public:
  Dvm(const System& system, const SolverOptions& options, bool careful = false)
      : system_(system),
        c_(options.nodes, options.stages),
        eq_(system, c_, options.constraints_at == "ends"),
        G_(system.jacobian_pattern()),
        small_(is_small(system, c_.s)),
        saddle_(system.mass(), G_, std::max(c_.s - 1, 2),
                small_ ? SaddleSolver::standard_regularisation : 0.02 * SaddleSolver::standard_regularisation,
                SaddleSolver::Order::sparse_first) {
    const Index n = system.solved_coordinates(), m = system.constraints();
    rhs_f_.assign(static_cast<std::size_t>(n * (c_.s - 1)), 0.0);
    rhs_g_.assign(static_cast<std::size_t>(m * (c_.s - 1)), 0.0);
    previous_.setZero(n, c_.s - 1);
    consistent_f_.setZero(n, c_.s - 1);
    for (std::size_t i = 0; i < last_.size(); ++i) last_[i].setZero(i % 2 == 0 ? n : m, c_.s - 1);
    y_to_lambda_.setZero(c_.s - 1, c_.s - 1);
    for (VectorXd* v : {&p1_, &w1_, &end_z_, &pull_}) v->setZero(n);
    end_q_.setZero(system.coordinates());
    for (VectorXd* v : {&mu_, &rate_}) v->setZero(m);
    pose_.setZero(system.coordinates());
    halfway_ = c_.basis.values(0.5);
    slopes_ = c_.basis.derivative_matrix();
    if (eq_.at_ends) analyse_mass();
    steerable_ = !eq_.at_ends && !system.constant_forces() && !system.elastic_rods() &&
                 system.solved_coordinates() * (c_.s - 1) > few_unknowns;
    if (!small_) left_constraint_ = 1000.0;
    harmless_ = careful ? 0 : small_ ? harmless : harmless_in_large;
    restart();
  }

  StepReport step(State& state, double h) override {
    StepReport report;
    start(state, h);
    if (h != matrices_h_) set_matrices(h);
    predict(state, h);
    if (!frozen_) freeze(eq_.start_pose(), report);
    if (weak_rows_ < 0) weak_rows_ = saddle_.rows_below(weak_pivot);
    if (stiff_) stiff_ = forces_are_stiff();
    tight_ = !stiff_ && !eq_.at_ends && needs_care();
    if (slow_ && !tight_ && !stiff_ && !eq_.at_ends) freeze_in_the_middle(report);
    if (!(tight_ && tight_iterations(state, report))) iterate(state, h, report);
    slow_ = !tight_ && !stiff_ && report.newton_iterations > (slow_ ? slow_even_so : slow_iterations);
    if (slow_ && steerable_) stiff_ = is_stiff(), slow_ = !stiff_;
    if (report.ok()) finish(state, h, report);
    if (!report.ok()) restart();
    return report;
  }

  double longest_step(const State& state, double h, double whole) override;
  bool inside(const State& start, double h, double share, VectorXd& z, VectorXd& w) const override;

  void stop_waves_of(double h) override { whole_ = h; }
  void restart() override {
    have_history_ = false;
    frozen_ = false;
    weak_rows_ = -1;
    slow_ = stiff_ = false;
    finely_ = 0;
    settling_.restart();
    unheld_.h = 0;
    newton_.forget();
    eq_.restart();
  }

 private:
  // Levels: 1 is round-off. Up to `accepted` a stalled iteration counts as converged.
  static constexpr double wanted = 1.5, wanted_constraint = constraint_level_wanted, accepted = 30.0;
  // A system of which a part has more unknowns than this is not given the full Newton matrix, whose factors
  // grow too fast; instead its weak modes may keep a larger constraint error. Its regularisation is below the
  // sigma^2 of those, 1e-14 in a folded ring of a thousand units, and near round-off in what is redundant.
  static constexpr Index full_newton_unknowns = 2500;
  // With no more than these the full Newton matrix is cheaper than a correction that knows of forces, and
  // with more stiffness, h omega or h c / m, the one that converges.
  static constexpr Index few_unknowns = 80;
  static constexpr double most_steered = 30;
  static constexpr int max_frozen_iterations = 30;
  // More iterations than these make the next step freeze G in its middle, which takes a third of them away;
  // it goes on while that is worth a factorisation.
  static constexpr int slow_iterations = 8, slow_even_so = 5;
  // Weak modes: what the level accepts of a constraint's error, divided by the smallest singular value, may
  // move the structure by this share of the motion of the step; else the step is solved with care: errors
  // grow where a motion is unstable, in a ring of joints a thousandfold while it opens. Singular values above
  // `strong` are never looked at.
  static constexpr double harmless = 1e-10, harmless_in_large = 1e-6, strong = 1e-3;
  static constexpr double nothing = 1e-4;  // of what is harmless: such steps are solved so far
  // Where a singular value sigma is a length of the pose, rounding leaves eps / sigma of it, and eps /
  // sigma^2 of a velocity that the constraints are asked for there.
  static constexpr double weak_pivot = 1e-6 * 1e-6;  // sigma^2
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr double most_prolonged = 4;  // steps of the last one's length
  static constexpr double slowest_still = 30;  // that of modes whose velocity is held, far above
  static constexpr double unheld = 100;        // h omega of a rod, from above, whose velocity at ends is held
  static constexpr double resolved =
      1.5;  // h omega, from above, per stage but one: the ends tell forces of waves

  static bool is_small(const System& system, int stages);

  void analyse_mass();
  void start(const State& state, double h);
  void set_matrices(double h);
  void predict(const State& state, double h);
  void freeze(const ConstVec& q, StepReport& report);
  void freeze_in_the_middle(StepReport& report);
  void iterate(const State& state, double h, StepReport& report);
  bool frozen_iterations(StepReport& report);
  bool is_stiff();
  bool forces_are_stiff() const {  // where they were looked at last
    const double limit = steerable_ ? 0.3 : 1.0;
    return eq_.h_rate() > limit || eq_.h_omega() > limit;
  }
  bool stiff_iterations(const State& state, StepReport& report);
  bool steered_iterations(const State& state, StepReport& report);
  double part_of_whole(double h) const { return std::abs(h) / std::max(whole_, std::abs(h)); }
  struct Stall {
    double best = infinity;
    int without_gain = 0;
  };
  bool needs_care();
  bool some_part_needs_care();
  bool nothing_moves(std::vector<Stall>& stalls, double enough, int patience) const;
  bool ends_weakly(StepReport& report);
  bool tight_iterations(const State& state, StepReport& report);
  void arrive(State& state);
  template <LaneCount K>
  void accelerate(bool extrapolate);
  double left_alone(Index r) const {  // of Phi [m]
    return tight_ ? 0.0 : feed_ ? wanted_constraint * eq_.constraint_noise(r) : infinity;
  }
  void correct(StepReport& report);
  template <LaneCount K>
  void correct_stages();
  void correct_at_ends(StepReport& report);
  void settle_end();
  void let_go(double h);
  void still(double h);
  void hold_lengths(double h, StepReport& report);
  void finish(State& state, double h, StepReport& report);

  const System& system_;
  GalerkinCoefficients c_;
  StageEquations eq_;
  SparseRows G_;
  bool small_ = true;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  SparseLdlt mass_factor_;  // ends variant only
  FullNewton newton_;
  std::optional<StiffCorrection> steering_;  // made when first needed
  std::vector<double> rhs_f_, rhs_g_;
  VectorXd p1_, w1_, end_z_, end_q_, pull_, mu_, rate_, pose_, halfway_;
  Interleaved previous_, consistent_f_;
  std::array<Interleaved, 4> last_;                 // momentum, phi, dX, lambda of the last iteration
  MatrixXd prolong_, momentum_to_f_, y_to_lambda_;  // -h C^-1; -C_kj / (h^2 b_k)
  double matrices_h_ = 0;                           // the step that they are for
  MatrixXd slopes_;                                 // l_k'(c_i)
  double previous_h_ = 0;
  bool have_history_ = false;
  double left_constraint_ = 8.0;  // level of constraint error that weak modes may keep
  bool careful_ = false;
  bool feed_ = true;
  bool slow_ = false;  // the last step took many iterations
  double whole_ = 0;   // steps are parts of one of this length
  struct {
    VectorXd z, w, left_z, left_w;
    double h = 0;
  } unheld_;  // where the last step of this length would have ended without hold_lengths(), and what it left
  Settling settling_;
  bool stiff_ = false;  // forces are too stiff at this step for an iteration that knows nothing of them
  bool steerable_ = false;
  bool steered_ = false;   // corrections know of the forces, by steering_
  bool by_parts_ = false;  // of the care of this step: the parts' own motions ask for it
  bool frozen_ = false;    // saddle_ holds a factorisation near the present pose

  double harmless_ = harmless;
  double needed_pivot_ = 0;  // of the weakest mode, for this step to do without care
  bool tight_ = false;       // this step is solved with care for weak modes
  Index weak_rows_ = -1;     // that look so at the start of the step; -1: not known
  Index never_weak_ = 0;     // as many as may look so and are none but redundant
  CarriedSum carried_;
  Anderson weak_modes_;
  int finely_ =
      0;  // so many steps have factors in twice the digits at once, as one before did not do without
};

}  // namespace unfurl
