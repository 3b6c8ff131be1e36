// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/reference_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/math/largest.hpp"
#include "core/structure/node_positions.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/table.hpp"

namespace unfurl {
namespace {

constexpr std::size_t window = 8;  // states that an interpolant goes through
constexpr double before_singular = 0.995;
constexpr int levels = 8;
constexpr double first_turn = 0.2;  // of a rod in a step of the first level [rad]
constexpr double most_bytes = 128e6;

// Weights of positions and velocities at a time t: with the Lagrange basis l_i of the times t_i,
//
//     q(t) = sum_i l_i(t)^2 [ (1 - 2 l_i'(t_i) (t - t_i)) q_i + (t - t_i) v_i ]
struct HermiteWeights {
  std::array<double, window> q, v;
};

HermiteWeights hermite_weights(const double* times, double t) {
  HermiteWeights out{};
  for (std::size_t i = 0; i < window; ++i) {
    double basis = 1, slope = 0;  // l_i(t), l_i'(t_i)
    for (std::size_t k = 0; k < window; ++k) {
      if (k == i) continue;
      basis *= (t - times[k]) / (times[i] - times[k]);
      slope += 1 / (times[i] - times[k]);
    }
    const double from = t - times[i];
    out.q[i] = basis * basis * (1 - 2 * slope * from);
    out.v[i] = basis * basis * from;
  }
  return out;
}

// Solutions of a motion, within an amount of CPU time.
class ReferenceSolver {
 public:
  ReferenceSolver(const std::shared_ptr<const Model>& model, const SolverOptions& like, double cpu_s,
                  const StudyHooks& hooks)
      : model_(model), hooks_(hooks), cpu_s_(cpu_s), begin_(thread_cpu_seconds()) {
    options_.end_time = like.end_time;
    options_.sparse = like.sparse;
    options_.eliminate_linear = like.eliminate_linear;
    options_.adaptive = true;
  }

  bool out_of_time() const { return out_of_time_; }
  double left() const { return cpu_s_ - (thread_cpu_seconds() - begin_); }

  // Nothing as soon as its speed tells that it would take too long.
  std::optional<Simulation> solve(int stages, double turn, double end) {
    options_.stages = stages;
    options_.turn = turn;
    options_.end_time = end;
    options_.step = end / 32 * (turn / first_turn);
    const double start = thread_cpu_seconds();
    double fraction = 0;
    bool hopeless = false;
    SimulationHooks own;
    own.progress = [&](double done) { fraction = done; };
    own.cancelled = [&] {
      const double spent = thread_cpu_seconds() - start, rest = left();
      const bool slow = spent > 0.1 * cpu_s_ && spent * (1 - fraction) > 3 * fraction * rest;
      hopeless = rest < 0 || slow;
      return hopeless || hooks_.stopped();
    };
    Simulation out = simulate(model_, options_, own);
    out_of_time_ = hopeless || 2.2 * out.cpu_s > left();
    if (hopeless) return std::nullopt;
    if (out.status == RunStatus::stopped) throw Cancelled();
    return out;
  }

 private:
  const std::shared_ptr<const Model>& model_;
  const StudyHooks& hooks_;
  SolverOptions options_;
  double cpu_s_, begin_;
  bool out_of_time_ = false;  // no further solution would fit
};

// Solution after solution with smaller steps, until they agree to `goal` [m] or come no closer; nothing where
// no two of them could be had.
std::optional<ReferenceMotion> tightest(ReferenceSolver& solver, double end, double goal) {
  std::optional<ReferenceMotion> best, last;
  // Whether it is much better than the best before.
  const auto keep = [&](ReferenceMotion& candidate) {
    const double least = best ? best->uncertainty() : std::numeric_limits<double>::infinity();
    const double own = candidate.uncertainty();
    if (own < least) best = std::move(candidate);
    return own < 0.5 * least;
  };
  double turn = first_turn;
  int worse = 0;
  for (int level = 0; level < levels && worse < 2; ++level, turn /= 2) {
    const auto solution = solver.solve(level % 2 ? 7 : 8, turn, end);
    if (!solution) break;
    if (solution->status != RunStatus::completed) continue;
    ReferenceMotion next(solution->trajectory);
    // Two may agree by chance: one is as good as it agrees with those before and after it.
    if (last) {
      last->widen(next.compare(*last));
      worse = keep(*last) ? 0 : worse + 1;
    }
    const bool enough = next.uncertainty() <= goal || 2 * static_cast<double>(next.bytes()) > most_bytes;
    last = std::move(next);
    if (enough || 2.2 * solution->cpu_s > solver.left()) break;
  }
  if (last && worse < 2 && std::isfinite(last->uncertainty())) keep(*last);
  return best;
}

}  // namespace

namespace {

// Cables that stretch and motors change their law there: a bend, that of the first state is known. A jerk is
// none.
constexpr std::array bend_kinds{"taut", "slack", "saturated", "unsaturated"};
constexpr std::array break_kinds{"contact", "free", "slip", "stick", "reversal"};

bool is_one_of(const auto& kinds, const Event& event) {
  return std::ranges::find(kinds, event.kind) != kinds.end();
}

}  // namespace

JudgedSpan judged_span(const Simulation& run) {
  const double start = run.trajectory.start_time();
  for (const Event& event : run.events) {
    if (!(event.t < run.options.end_time)) continue;
    if (event.name == "deployed") return {before_singular * event.t, "the deployed pose"};
    if (event.name.find("stop ") != std::string::npos)
      return {before_singular * event.t, "the first end stop"};
    if (is_one_of(break_kinds, event) ||
        (is_one_of(bend_kinds, event) && (event.t > start || event.energy_lost > 0)))
      return {before_singular * event.t, "the first time that " + event.name};
  }
  return {run.options.end_time};
}

std::string one_sided_at_start(const Simulation& run) {
  const Trajectory& all = run.trajectory;
  std::size_t first = 0;
  while (first + 1 < all.size() && all.time(first + 1) == all.start_time()) ++first;
  const Structure &structure = all.model(first).structure, &plain = all.structure();
  if (structure.constraints.size() > plain.constraints.size())
    return structure.constraints[plain.constraints.size()].name;
  for (const Force& force : structure.forces)
    if (force.slip != 0) return force.name + " (slips)";
  return "";
}

void require_plain_start(const Simulation& run) {
  const std::string name = one_sided_at_start(run);
  if (!name.empty())
    throw ReferenceError("what acts on one side only does so from the start: " + name +
                         "; the reference solutions know neither stops nor taut cables nor dry friction");
  if (!(judged_span(run).end > 0))
    throw ReferenceError("the motion begins at an end stop: there is nothing to measure");
}

ReferenceMotion::ReferenceMotion(const Trajectory& trajectory) {
  if (trajectory.size() < 2 * window) throw ReferenceError("too few states to interpolate");
  const Index in_space = space_coordinates(trajectory.structure());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    t_.push_back(trajectory.time(i));
    q_.push_back(trajectory.node_positions(i).head(in_space));
    v_.push_back(trajectory.node_velocities(i).head(in_space));
  }
}

VectorXd ReferenceMotion::positions(double t) const {
  t = std::clamp(t, t_.front(), t_.back());
  const auto after = static_cast<std::size_t>(std::upper_bound(t_.begin(), t_.end(), t) - t_.begin());
  const std::size_t first = std::min(after - std::min(after, window / 2), t_.size() - window);
  const HermiteWeights weights = hermite_weights(t_.data() + first, t);
  VectorXd q = VectorXd::Zero(q_.front().size());
  for (std::size_t i = 0; i < window; ++i) q += weights.q[i] * q_[first + i] + weights.v[i] * v_[first + i];
  return q;
}

std::size_t ReferenceMotion::bytes() const {
  return 2 * sizeof(double) * q_.size() * static_cast<std::size_t>(q_.front().size());
}

double ReferenceMotion::compare(const ReferenceMotion& coarser) {
  uncertainty_ = 0;
  const auto look = [&](const VectorXd& ours, double t) {
    uncertainty_ = larger(uncertainty_, node_distance(coarser.positions(t), ours));
  };
  for (std::size_t i = 0; i < t_.size(); ++i) look(q_[i], t_[i]);
  for (std::size_t i = 1; i < coarser.t_.size(); ++i) {
    const double between = 0.5 * (coarser.t_[i - 1] + coarser.t_[i]);
    look(positions(between), between);
  }
  return uncertainty_;
}

void ReferenceMotion::widen(double uncertainty) {
  if (!(uncertainty <= uncertainty_) || std::isinf(uncertainty_)) uncertainty_ = uncertainty;
}

ReferenceMotion solve_reference_motion(const std::shared_ptr<const Model>& model, const Simulation& run,
                                       double cpu_s, const StudyHooks& hooks) {
  ReferenceSolver solver(model, run.options, cpu_s, hooks);
  const ReferenceError too_long("a reference would take more than " + short_number(cpu_s, 2) +
                                " s of CPU time");
  // Settings that are to be judged may be too coarse to tell where the motion ends.
  const auto probe = solver.solve(5, first_turn, run.options.end_time);
  // The first two solutions take two and four times as long.
  if (!probe || 6 * probe->cpu_s > solver.left()) throw too_long;
  if (probe->status == RunStatus::failed)
    throw ReferenceError("no reference runs through: " + probe->message);
  const double end = judged_span(*probe).end;
  if (!(end > 0)) throw ReferenceError("the motion begins at an end stop");
  const double size = size_of_motion(*model, probe->trajectory);
  const auto best = tightest(solver, end, 64 * std::numeric_limits<double>::epsilon() * size);
  if (best && best->uncertainty() < 1e-6 * size) return *best;
  if (solver.out_of_time()) throw too_long;
  throw ReferenceError(best ? "the best two solutions differ by " + short_number(best->uncertainty()) + " m"
                            : "no reference runs through");
}

double position_error(const Simulation& run, const ReferenceMotion& reference) {
  const Trajectory& trajectory = run.trajectory;
  const bool whole = trajectory.end_time() >= reference.end() * (1 - 1e-12);
  // One that deploys too early has an answer, if a wrong one.
  if (!whole && run.status != RunStatus::deployed) return nan;
  const Index in_space = space_coordinates(trajectory.structure());
  double largest = 0;
  for (std::size_t i = 0; i < trajectory.size() && trajectory.time(i) <= reference.end(); ++i)
    largest = larger(largest, node_distance(reference.positions(trajectory.time(i)),
                                            trajectory.node_positions(i).head(in_space)));
  return largest;
}

}  // namespace unfurl
