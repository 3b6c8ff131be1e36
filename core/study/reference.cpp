// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/integrators/dvm.hpp"
#include "core/integrators/integrator.hpp"
#include "core/math/largest.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structure/time_edges.hpp"
#include "core/study/extrapolation.hpp"
#include "core/study/table.hpp"

namespace unfurl {
namespace {

using Solution = std::optional<std::vector<VectorXd>>;
using Stepper = std::function<bool(State&, double h)>;

// Ends of steps inside one interval: so many equal parts, cut at the edges of time, which no step may
// straddle.
std::vector<double> step_ends(double begin, double end, int parts, const std::vector<TimeEdge>& edges) {
  std::vector<double> ends;
  auto edge = edges.begin();
  for (int k = 1; k <= parts; ++k) {
    const double target = k == parts ? end : begin + (end - begin) * k / parts;
    for (; edge != edges.end() && edge->t < target; ++edge)
      if (!same_instant(edge->t, target) && !same_instant(ends.empty() ? begin : ends.back(), edge->t))
        ends.push_back(edge->t);
    ends.push_back(target);
  }
  return ends;
}

// Node coordinates at the comparison times, with so many equal steps between two of them.
Solution solve(const Model& model, const Stepper& step, double end, int intervals, int parts,
               const StudyHooks& hooks) {
  State state = initial_state(model.structure, model.system).state;
  VectorXd q(model.system.coordinates());
  model.system.expand(state.z, q);
  std::vector<VectorXd> out{q};
  const double H = end / intervals;
  const std::vector<TimeEdge> edges = time_edges(model.structure, H / parts);
  for (int i = 0; i < intervals; ++i) {
    for (const double target : step_ends(H * i, H * (i + 1), parts, edges)) {
      if (hooks.stopped()) throw Cancelled();
      // Which of both is the earlier one by rounding is no matter: what jumps is seen behind it only.
      const auto jump = std::ranges::find_if(edges, [&](const TimeEdge& e) {
        return e.jump && same_instant(target, e.t) && same_instant(e.t, target);
      });
      const bool jumps = jump != edges.end();
      if (!step(state, (jumps ? before_jump(std::min(target, jump->t)) : target) - state.t))
        return std::nullopt;
      state.t = jumps ? std::max(target, jump->t) : target;
    }
    model.system.expand(state.z, q);
    out.push_back(q);
  }
  return out;
}

double farthest(const std::vector<VectorXd>& q, Index in_space) {  // from the start
  double way = 0;
  for (const VectorXd& now : q)
    way = larger(way, node_distance(now.head(in_space), q.front().head(in_space)));
  return way;
}

double difference(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b, Index in_space) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = larger(largest, node_distance(a[i].head(in_space), b[i].head(in_space)));
  return largest;
}

// A family of solutions, tighter with every level; `steps` says how many steps a level takes.
struct Ladder {
  std::function<Solution(int level)> solve;
  int levels;
  Index in_space;  // coordinates that are compared
};

struct Best {
  Solution solution;
  double uncertainty = std::numeric_limits<double>::infinity();
  int level = 0;
};

Best tighten(const Ladder& ladder, double goal) {
  Best best;
  Solution last = ladder.solve(0);
  int worse = 0;
  for (int level = 1; level < ladder.levels && worse < 2; ++level) {
    Solution next = ladder.solve(level);
    if (last && next) {
      const double apart = difference(*last, *next, ladder.in_space);
      ++worse;
      if (apart < best.uncertainty) best = {next, apart, level}, worse = 0;
      if (apart <= goal) break;
    }
    last = std::move(next);
  }
  return best;
}

Ladder extrapolated(const Model& model, double end, int intervals, const StudyHooks& hooks) {
  return {[&, end, intervals](int level) {
            Extrapolation method(model.system);
            return solve(
                model, [&](State& s, double h) { return method.step(s, h); }, end, intervals, 1 << level,
                hooks);
          },
          7, space_coordinates(model.structure)};
}

// Odd levels with 7 nodes, even ones with 8, so that neighbours differ in more than the step.
Ladder variational(const Model& model, double end, int intervals, const StudyHooks& hooks) {
  return {[&, end, intervals](int level) {
            SolverOptions options;
            options.stages = level % 2 ? 7 : 8;
            const auto method = careful_dvm().make(model.system, options);
            return solve(
                model, [&](State& s, double h) { return method->step(s, h).ok(); }, end, intervals,
                2 << level, hooks);
          },
          6, space_coordinates(model.structure)};
}

// How near a second method comes to a solution, with finer and finer steps until that is enough or it comes
// no nearer; infinite where it never runs through.
double distance_of_other(const Ladder& other, const std::vector<VectorXd>& solution, double enough) {
  double nearest = std::numeric_limits<double>::infinity();
  int worse = 0;
  for (int level = 0; level < other.levels && worse < 2 && nearest > enough; ++level) {
    const Solution next = other.solve(level);
    const double apart =
        next ? difference(*next, solution, other.in_space) : std::numeric_limits<double>::quiet_NaN();
    worse = std::isinf(nearest) || apart < 0.5 * nearest ? 0 : worse + 1;
    if (apart < nearest) nearest = apart;
  }
  return nearest;
}

// The finest steps of both ladders are a 64th of an interval; these are 16 of solver.step where a study has
// no steps of its own.
std::string told_cure(const Model& model, double interval) {
  constexpr double finest = 1.0 / 64, share = 0.25;  // of a period
  const double period = fastest_elastic_period(model, initial_state(model.structure, model.system).state);
  if (!(finest * interval > share * period))
    return "give the motion an earlier solver.end_time, before it becomes chaotic or singular";
  return "steps of " + short_number(finest * interval) +
         " s, its finest, do not resolve the fastest swing on springs or wave of rods, " +
         short_number(period) + " s: solver.step = " + short_number(period);
}

}  // namespace

double node_distance(const ConstVec& a, const ConstVec& b) {
  double largest = 0;
  for (Index i = 0; i + 2 < a.size(); i += 3) {
    largest = larger(largest, (a.segment<3>(i) - b.segment<3>(i)).norm());
  }
  return largest;
}

double structure_size(const Model& model) {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const Node& node : model.structure.nodes) {
    if (node.ghost) continue;
    lo = lo.cwiseMin(node.position);
    hi = hi.cwiseMax(node.position);
  }
  return model.structure.nodes.empty() ? 0.0 : (hi - lo).maxCoeff();
}

double size_of_motion(const Model& model, const Trajectory& trajectory) {
  double size = structure_size(model);
  for (std::size_t i = 0; !(structure_size(model) > 0) && i < trajectory.size(); ++i)
    size = larger(size, node_distance(trajectory.positions(i), trajectory.positions(0)));
  return size;
}

Reference solve_reference(const std::shared_ptr<const Model>& model, double end, int intervals,
                          const StudyHooks& hooks, double enough) {
  const Index in_space = space_coordinates(model->structure);
  for (const TimeEdge& edge : time_edges(model->structure, end / intervals))
    if (edge.impact && edge.t > 0 && edge.t < end)
      throw ReferenceError("there is no reference across the time of " + short_number(edge.t, 6) +
                           " s, where the velocity or the acceleration of a drive jumps; an earlier "
                           "solver.end_time, or a ramp, helps");
  const Ladder steps = extrapolated(*model, end, intervals, hooks);
  double size = structure_size(*model);
  if (!(size > 0))
    if (const Solution coarse = steps.solve(0)) size = farthest(*coarse, in_space);
  const double goal = std::max(enough, 64 * std::numeric_limits<double>::epsilon()) * size;
  Best best = tighten(steps, goal);
  double apart = std::numeric_limits<double>::infinity();
  const auto least = [&](const Best& b) { return 1e-6 * std::max(size, farthest(*b.solution, in_space)); };
  const auto agrees = [&](const Best& b) { return b.solution && b.uncertainty <= least(b); };  // with itself
  Reference out;
  out.how = "Bulirsch-Stoer extrapolation of order 16 on the index-1 equations with " +
            std::to_string(intervals << best.level) + " basic steps";
  if (!(best.uncertainty <= std::max(goal, 1e-9 * size))) {
    Best other = tighten(variational(*model, end, intervals, hooks), goal);
    if (agrees(best) && agrees(other)) apart = difference(*best.solution, *other.solution, in_space);
    if (other.uncertainty < best.uncertainty) {
      best = std::move(other);
      out.how = "dvm with " + std::string(best.level % 2 ? "7" : "8") + " nodes and " +
                std::to_string(intervals << (best.level + 1)) +
                " steps, because the index-1 equations do not pass this motion";
    }
  } else {
    apart = distance_of_other(variational(*model, end, intervals, hooks), *best.solution,
                              std::max(goal, best.uncertainty));
  }
  if (!agrees(best))
    throw ReferenceError("the reference does not converge: " +
                         (best.solution
                              ? "its best two solutions differ by " + short_number(best.uncertainty) + " m"
                              : std::string("no two solutions run through")) +
                         "; " + told_cure(*model, end / intervals));
  if (apart > least(best) && !std::isinf(apart))
    throw ReferenceError("there is no reference: two methods, each of which agrees with itself to " +
                         short_number(best.uncertainty) + " m, differ by " + short_number(apart) + " m");
  out.confirmed = !std::isinf(apart);
  out.size = size > 0 ? size : farthest(*best.solution, in_space);
  for (int i = 0; i <= intervals; ++i) out.t.push_back(end * i / intervals);
  out.q = std::move(*best.solution);
  out.uncertainty = out.confirmed ? std::max(best.uncertainty, apart) : best.uncertainty;
  return out;
}

}  // namespace unfurl
