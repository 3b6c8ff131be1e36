// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/mode_change.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include "core/math/box_complementarity.hpp"
#include "core/math/factors.hpp"
#include "core/simulate/acting.hpp"
#include "core/simulate/impact.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/push_responses.hpp"

namespace unfurl {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-8;  // of the largest push
// Of an acceleration, of all that it is the sum of; of one that no push changes, of what cancels where it
// does not: it is told by no more than PushResponses::movable() tells.
constexpr double sum_rounding = 1e-12, immovable_rounding = 1e-6;
// Of what friction could do to an acceleration: squares of rates of rounding, unlike in rows of one freedom.
constexpr double no_load = 1e-30;
// Of the forces: where one falls to zero is located to a share of that (one_sided.cpp), either way.
constexpr double located = 1e-9;
constexpr double a_little = 1e-6;  // of what friction holds

class Change {
 public:
  Change(OneSided& sides, const Model& base, const State& state, const std::vector<std::size_t>& which,
         const VectorXd& left, double later, bool crowd)
      : sides_(sides),
        base_(base),
        system_(base.system.at(state)),
        which_(which),
        left_(left),
        later_(later),
        crowd_(crowd) {
    out_.state = state;
  }

  ModeChange run() {
    std::vector<std::size_t> laws = sides_.laws_left(system_, out_.state);
    for (const std::size_t i : which_)
      if (!sides_.is_stop(i) && !sides_.is_friction(i) && std::ranges::find(laws, i) == laws.end())
        laws.push_back(i);
    turn_laws(laws);
    find_rows();
    if (rows_.empty()) return std::move(out_);
    std::optional<Acting> acting(std::in_place, sides_, base_, out_.state, rows_, later_);
    const PushResponses& responses = acting->responses;
    if (!responses.ok()) return failed("the constraint matrix cannot be factorised where modes change");
    D_ = responses.matrix();
    spread_.resize(D_.rows());
    for (Index i = 0; i < D_.rows(); ++i) {
      movable_.push_back(responses.movable(i));
      spread_[i] = responses.spread(i);
    }
    settle(responses);
    const VectorXd before = out_.state.w;
    std::set<std::size_t> ended;  // stops whose series of impacts has accumulated
    const auto end = [&](std::size_t i, double approach) {
      return crowd_ || ended.contains(i) || sides_.impact_rests(i, approach);
    };
    for (std::size_t known = 0;; known = ended.size()) {
      if (!strike(responses, end)) return std::move(out_);
      // What is asked of motors and how cables are stretched may have jumped with the rates.
      if (!out_.impacts.empty() && turn_laws(sides_.laws_left(system_, out_.state)))
        acting.emplace(sides_, base_, out_.state, rows_, later_);
      if (!choose(acting->responses)) return std::move(out_);
      for (Index r = 0; r < count(); ++r)
        if (series_ends(r, solution_.w[r]) && series_ends(r, without_rates(acting->responses, r)))
          ended.insert(side(r));
      if (ended.size() == known) break;
      out_.state.w = before;
      out_.impacts.clear();
    }
    assign();
    return std::move(out_);
  }

 private:
  bool turn_laws(const std::vector<std::size_t>& laws) {
    for (const std::size_t i : laws) sides_.turn_law(i, system_, out_.state), tell(i);
    return !laws.empty();
  }
  std::size_t side(Index row) const { return rows_[static_cast<std::size_t>(row)]; }
  bool movable(Index row) const { return movable_[static_cast<std::size_t>(row)]; }
  bool crossed(Index row) const { return std::find(which_.begin(), which_.end(), side(row)) != which_.end(); }
  Index count() const { return static_cast<Index>(rows_.size()); }
  ModeChange failed(const std::string& why) {
    out_.failure = why;
    return std::move(out_);
  }
  bool fail_at(Index row) {
    return out_.failure = what_pushes(sides_, side(row), out_.state.t + later_, system_, movable(row)), false;
  }
  void tell(std::size_t i) {
    if (std::ranges::find(out_.turned, i) == out_.turned.end()) out_.turned.push_back(i);
    out_.changed = true;
  }

  void find_rows() {
    for (std::size_t i = 0; i < sides_.stops().size(); ++i)
      if (std::ranges::find(which_, i) != which_.end() || sides_.touches(i, system_, out_.state))
        rows_.push_back(i);
    for (std::size_t i = sides_.first_friction(); i < sides_.first_motor(); ++i) rows_.push_back(i);
    struck_ = passes_ = stops_ = std::vector<bool>(rows_.size(), false);
    for (std::size_t k = 0; k < rows_.size(); ++k) stops_[k] = sides_.is_stop(rows_[k]);
  }

  // A state may miss the constraints by what the method drifts from them, `met` does not: what holds has no
  // rate all the same, no impact leaves any of that, and friction turns round where u is zero. It stays so,
  // and what rested does.
  void settle(const PushResponses& responses) {
    const State met = which_.empty() ? out_.state : hand_over(base_, out_.state, base_).state;
    const VectorXd u = responses.rates(out_.state.w), u_met = responses.rates(met.w);
    std::vector<bool> still(rows_.size(), false);
    std::vector<Index> rows;
    const auto held = [&](Index r) { return !which_.empty() && sides_.active(side(r)); };
    const auto keep = [&](Index r) {
      const bool rests = held(r) || at_rest(r, u[r]) || at_rest(r, u_met[r]);
      if (!movable(r) || !rests || !independent(D_, still, r)) return;
      still[static_cast<std::size_t>(r)] = true;
      rows.push_back(r);
    };
    bool drifts = false, turns = false;
    for (Index r = 0; r < count(); ++r) {
      const double off = held(r) ? u_met[r] : sides_.is_stop(side(r)) ? u_met[r] - u[r] : 0.0;
      drifts = drifts || std::abs(off) > sides_.zero_rate(side(r));
      if (sides_.is_friction(side(r)) && crossed(r)) keep(r), turns = !rows.empty();
    }
    if (!drifts && !turns) return;
    for (Index r = 0; r < count(); ++r)
      if (held(r) || (turns && sides_.is_friction(side(r)))) keep(r);
    if (!turns) located_ = out_.state;
    out_.state = met;
    std::erase_if(rows, [&](Index r) { return passes(r, u_met[r]); });
    if (rows.empty()) return;
    VectorXd impulses = VectorXd::Zero(count());
    impulses(rows) = -Cholesky(D_(rows, rows)).solve(VectorXd(u_met(rows)));
    responses.give(impulses, out_.state.w);
  }

  // Friction that turns round where it hardly moves anything, as a slider at its dead centre: what the
  // method's error left of the rate is not for an impulse to take, which would stop all else; the motion goes
  // through. More than friction gives in a step is no settling, unless it counts as zero all the same and
  // stops nothing that is faster.
  bool passes(Index r, double rate) {
    const std::size_t i = side(r);
    if (!sides_.is_friction(i) || sides_.active(i)) return false;
    return passes_[static_cast<std::size_t>(r)] =
               std::abs(rate) > given_in_step(r) && std::abs(rate) * spread_[r] > sides_.zero_rate(i);
  }
  double given_in_step(Index r) const {
    const std::size_t i = side(r);
    return D_(r, r) * sides_.holding(i) * sides_.touching(i) / sides_.zero_rate(i);
  }

  // The stops that are approached. False where there is no answer.
  bool strike(const PushResponses& responses, const std::function<bool(std::size_t, double)>& rests) {
    std::vector<bool> crossed_rows(rows_.size());
    for (Index r = 0; r < count(); ++r) crossed_rows[static_cast<std::size_t>(r)] = crossed(r);
    Impacts impact = strike_stops(sides_, rows_, crossed_rows, responses, D_, rests, out_.state);
    if (impact.pushed_against >= 0) return fail_at(impact.pushed_against);
    struck_ = std::move(impact.struck);
    for (Index r = 0; r < count(); ++r)
      if (struck_[static_cast<std::size_t>(r)])
        out_.impacts.push_back({side(r), impact.lost[r], sides_.active(side(r))});
    return true;
  }

  // Does friction move, or does a stop stay out of it, whatever the forces are? By rates that count as zero,
  // where a hold or a crossing says so; else by those that rounding leaves, or friction takes within a step:
  // what goes on so slowly for longer moves.
  bool at_rest(Index r, double rate) const {
    const std::size_t i = side(r);
    const bool struck = struck_[static_cast<std::size_t>(r)];
    double zero = sides_.zero_rate(i);
    if (!crossed(r) && !sides_.active(i) && !struck)
      zero = std::max(2 * sides_.rounded_rate(i),
                      sides_.is_friction(i) ? std::min(zero, given_in_step(r)) : 0.0);
    if (sides_.is_friction(i)) return std::abs(rate) <= 1.0001 * zero;
    return rate <= zero || (struck && rate <= 0);
  }

  // A stop that is left so slowly that the way back ends before the gap counts.
  bool falls_back(Index r, double rate) const {
    return sides_.is_stop(side(r)) && !struck_[static_cast<std::size_t>(r)] && b_[r] < 0 &&
           rate * rate <= -2 * b_[r] * sides_.touching(side(r));
  }

  bool is_pulled_back(Index r) const {
    return sides_.is_stop(side(r)) && movable(r) && !rests_[static_cast<std::size_t>(r)] && rate_[r] > 0 &&
           solution_.w[r] < -zero_acceleration(r);
  }
  bool series_ends(Index r, double acceleration) const {
    return struck_[static_cast<std::size_t>(r)] && is_pulled_back(r) &&
           sides_.series_ends(side(r), rate_[r], -acceleration);
  }
  // What dampers take of a rate brings nothing back.
  double without_rates(const PushResponses& responses, Index r) const {
    State still = out_.state;
    still.w.setZero();
    const VectorXd b = responses.accelerations(base_.structure, still).value;
    return b.size() == count() ? b[r] + D_.row(r).dot(solution_.x) : solution_.w[r];
  }
  // Crossed while it is left: a flight too short to be told, or of a crowd, within a step.
  bool is_no_flight(Index r) const {
    return crossed(r) && (crowd_ || !struck_[static_cast<std::size_t>(r)]) && is_pulled_back(r) &&
           sides_.comes_again(rate_[r], -solution_.w[r], crowd_ ? 1.0 : OneSided::no_flight);
  }

  bool choose(const PushResponses& responses) {
    rate_ = responses.rates(out_.state.w);
    State soon = located_ && out_.impacts.empty() ? *located_ : out_.state;
    soon.t += later_;
    PushResponses::Accelerations by_themselves = responses.accelerations(base_.structure, soon);
    b_ = std::move(by_themselves.value);
    if (b_.size() != count()) {
      out_.failure = "the constraint matrix cannot be factorised where modes change";
      return false;
    }
    rounds_ = sum_rounding * by_themselves.terms;
    multiplier_ = std::move(by_themselves.largest_multiplier);
    bool still_there = true;  // and nothing that held has broken, which moves something
    for (Index r = 0; r < count(); ++r) {
      if (!movable(r))
        rounds_[r] = std::max(rounds_[r], immovable_rounding * by_themselves.of_coordinates[r] +
                                              sum_rounding * by_themselves.uncancelled[r]);
      still_there = still_there && std::abs(b_[r]) <= rounds_[r] && !(crossed(r) && sides_.active(side(r)));
    }
    if (still_there) b_.setZero();
    low_ = high_ = solution_.x = VectorXd::Zero(count());
    rests_.assign(rows_.size(), false);
    slips_.assign(rows_.size(), 0);
    std::vector<Index> leaving;  // what sticks and cannot any more, and what stands by it
    for (Index r = 0; r < count(); ++r) {
      const std::size_t i = side(r), k = static_cast<std::size_t>(r);
      if (sides_.is_friction(i) && std::abs(b_[r]) <= no_load * D_(r, r) * sides_.holding(i)) b_[r] = 0;
      const bool turns = crossed(r) && sides_.comes_to_zero(i, system_, out_.state);
      if (passes_[k]) {
        const bool by_force = std::abs(b_[r]) > rounds_[r] || sides_.slip(i) == 0;
        slide(r, turns || (by_force ? b_[r] > 0 : sides_.slip(i) < 0) ? 1 : -1);
        continue;
      }
      if (!at_rest(r, rate_[r]) && !falls_back(r, rate_[r])) {
        if (sides_.is_friction(i)) slide(r, turns || rate_[r] > 0 ? 1 : -1);
        continue;
      }
      if (!movable(r)) {
        if (sides_.is_stop(i) && crossed(r) && b_[r] < -rounds_[r]) return fail_at(r);
        if (sides_.is_friction(i) && std::abs(b_[r]) > rounds_[r])
          slide(r, b_[r] > 0 ? 1 : -1);
        else if (sides_.is_friction(i) && crossed(r))
          slide(r, sides_.away_from_kink(i, system_, out_.state));
        continue;
      }
      rests_[k] = true;
      if (crossed(r) && sides_.active(i)) leaving.push_back(r);
      if (sides_.is_friction(i)) low_[r] = -sides_.holding(i);
      high_[r] = sides_.is_friction(i) ? sides_.holding(i) : infinity;
    }
    still_ = rests_;
    for (Index r = 0; r < count(); ++r)
      if (starts(r)) slide(r, sides_.slip(side(r)));
    if (!solve()) return false;
    forget_left(leaving);
    if (!leaving.empty()) let_go(leaving);
    for (const Index r : leaving) leave(r);
    if (!leaving.empty() && !solve()) return false;
    // Those that do not go after all: others push them back or hold them, or they are back at once.
    for (Index tries = count(); tries >= 0; --tries) {
      bool back = false;
      for (Index r = 0; r < count(); ++r)
        back = ((still_[static_cast<std::size_t>(r)] || is_no_flight(r)) && come_back(r)) || back;
      if (!back) return true;
      if (!solve()) return false;
    }
    return true;
  }

  // What rounding leaves of a row's acceleration, with the pushes.
  double zero_acceleration(Index r) const {
    return rounds_[r] + sum_rounding * D_.row(r).cwiseAbs().dot(solution_.x.transpose().cwiseAbs());
  }

  // What a force gives that was located as zero.
  double located_acceleration(Index r) const {
    const double arm = sides_.stops().touching() / sides_.touching(side(r));  // of what turns
    return zero_acceleration(r) + located * (D_(r, r) * arm * multiplier_[r] +
                                             D_.row(r).cwiseAbs().dot(solution_.x.transpose().cwiseAbs()));
  }

  // A push that was located as zero is zero: what the location left of it is taken off all accelerations, and
  // what rounding leaves of what it was.
  void forget_left(const std::vector<Index>& leaving) {
    for (const Index r : leaving) {
      const double push = solution_.x[r], left = left_.size() > 0 ? left_[static_cast<Index>(side(r))] : 0.0;
      if (!(std::abs(push) <= left)) continue;
      for (Index k = 0; k < count(); ++k) {
        b_[k] += D_(k, r) * push;
        if (std::abs(b_[k]) <= rounds_[k] + sum_rounding / located * left * std::abs(D_(k, r))) b_[k] = 0;
      }
    }
  }

  // Frictions that hold together let go together: all that would not rest if frictions held a little less,
  // and they alone. Which forces are at their limits may be one choice of many.
  void let_go(std::vector<Index>& leaving) {
    if (std::ranges::none_of(leaving, [this](Index r) { return at_limit(r); })) return;
    std::erase_if(leaving, [&](Index r) { return sides_.is_friction(side(r)); });
    VectorXd low = low_, high = high_;
    for (Index r = 0; r < count(); ++r)
      if (sides_.is_friction(side(r)) && rests_[static_cast<std::size_t>(r)])
        low[r] *= 1 - a_little, high[r] *= 1 - a_little;
    const auto solution = solve_box(D_, b_, low, high);
    if (!solution) return;
    solution_.x = solution->x;
    for (Index r = 0; r < count(); ++r)
      if (at_limit(r) && !solution->held[static_cast<std::size_t>(r)] &&
          std::abs(solution->w[r]) > zero_acceleration(r))
        leaving.push_back(r);
  }

  // Friction that rests and bears all that it can.
  bool at_limit(Index r) const {
    return sides_.is_friction(side(r)) && rests_[static_cast<std::size_t>(r)] &&
           std::abs(solution_.x[r]) >= (1 - 2 * a_little) * sides_.holding(side(r));
  }

  // Friction that has begun to slip and has not moved: it does so, unless it is pushed back, beside others
  // that change at once.
  bool starts(Index r) const {
    return rests_[static_cast<std::size_t>(r)] && sides_.is_friction(side(r)) && sides_.slip(side(r)) != 0 &&
           !crossed(r) && out_.impacts.empty();
  }

  void slide(Index r, int sense) {
    slips_[static_cast<std::size_t>(r)] = sense;
    rests_[static_cast<std::size_t>(r)] = false;
    low_[r] = high_[r] = -sense * sides_.kinetic(side(r));
  }

  void leave(Index r) {
    if (!rests_[static_cast<std::size_t>(r)]) return;
    if (sides_.is_friction(side(r)))
      slide(r, solution_.x[r] > 0 ? -1 : 1);
    else
      rests_[static_cast<std::size_t>(r)] = false, high_[r] = 0;
  }
  bool come_back(Index r) {
    const std::size_t i = side(r), k = static_cast<std::size_t>(r);
    const double away = (sides_.is_friction(i) ? slips_[k] : 1) * solution_.w[r],
                 zero = located_acceleration(r);
    const bool others_hold =
        sides_.is_friction(i) && std::abs(away) <= zero && !independent(D_, solution_.held, r);
    if (rests_[k] || (away >= -zero && !others_hold)) return false;
    rests_[k] = true;
    slips_[k] = 0;
    low_[r] = sides_.is_friction(i) ? -sides_.holding(i) : 0.0;
    high_[r] = sides_.is_friction(i) ? sides_.holding(i) : infinity;
    return true;
  }

  // What cannot be held slips, with its kinetic force; that may let others slip.
  bool solve() {
    for (;;) {
      const auto solution = solve_box(D_, b_, low_, high_);
      if (!solution) return out_.failure = "a drive pushes against what stops hold", false;
      solution_ = *solution;
      forget_rounding();
      bool any = false;
      for (Index r = 0; r < count(); ++r) {
        if (!rests_[static_cast<std::size_t>(r)] || !sides_.is_friction(side(r))) continue;
        const bool held = solution_.held[static_cast<std::size_t>(r)];
        if (!at_limit(r)) solution_.w[r] = 0;  // to what solve_box takes as nothing
        if (held || std::abs(solution_.w[r]) <= zero_acceleration(r)) continue;
        slide(r, solution_.w[r] > 0 ? 1 : -1);
        any = true;
      }
      if (!any) return true;
    }
  }

  // Friction, and stops that were met or held before, are held where they rest without a force too; other
  // stops that touch are not, whatever rounding leaves of a force.
  bool wants(Index r) const {
    return sides_.is_friction(side(r)) || struck_[static_cast<std::size_t>(r)] || sides_.active(side(r)) ||
           crossed(r);
  }
  bool bears(Index r) const {
    return std::abs(solution_.x[r]) > rounding * solution_.x.lpNorm<Eigen::Infinity>();
  }
  void forget_rounding() {
    for (Index r = 0; r < count(); ++r)
      if (!wants(r) && !bears(r)) solution_.held[static_cast<std::size_t>(r)] = false;
  }

  // Rows that rest without a force are held too, where they are independent of the others; before them
  // friction that bears something, be it at its limit.
  void hold_resting() {
    std::vector<Index> order(static_cast<std::size_t>(count()));
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_partition(order.begin(), order.end(),
                          [&](Index r) { return sides_.is_friction(side(r)) && bears(r); });
    for (const Index r : order) {
      const auto k = static_cast<std::size_t>(r);
      if (!rests_[k] || solution_.held[k] || !wants(r) || solution_.w[r] > zero_acceleration(r)) continue;
      if (independent(D_, solution_.held, r))
        solution_.held[k] = true;
      else if (sides_.is_stop(side(r)))
        take_over(D_, low_, high_, stops_, r, solution_);
      else
        give_over(D_, stops_, r, solution_);
    }
  }

  void assign() {
    hold_resting();
    for (Index r = 0; r < count(); ++r) {
      const std::size_t i = side(r), k = static_cast<std::size_t>(r);
      const bool holds = rests_[k] && solution_.held[k];
      if (!sides_.is_friction(i)) {
        if (sides_.active(i) != holds) sides_.set_active(i, holds, out_.state.t), tell(i);
        continue;
      }
      const int slip = slips_[k], before = sides_.slip(i);
      if (holds == sides_.active(i) && slip == before) continue;
      if (holds)
        sides_.stick(i, system_, out_.state);
      else if (slip != 0)
        sides_.set_slip(i, slip);
      else
        sides_.stand(i);
      out_.changed = true;
      if (slip != 0 || before != 0) out_.turned.push_back(i);  // what rests still does, by other forces
    }
    if (sides_.any_friction()) share();
  }

  // By D c = d over what is held, stops among it; of what rests by that, be it a stop.
  void share() {
    const auto n = static_cast<Index>(sides_.first_motor());
    MatrixXd c = MatrixXd::Zero(n, n);
    for (Index r = 0; r < count(); ++r) {
      const std::size_t i = side(r);
      const bool stands = sides_.is_friction(i) ? sides_.slip(i) == 0 : still_[static_cast<std::size_t>(r)];
      if (sides_.active(i) || !stands || independent(D_, solution_.held, r)) continue;
      const VectorXd d = past_held(D_, solution_.held, r);
      for (Index k = 0; k < count(); ++k)
        if (k != r) c(static_cast<Index>(i), static_cast<Index>(side(k))) = -d[k];
    }
    sides_.set_shares(std::move(c));
  }

  OneSided& sides_;
  const Model& base_;
  const System system_;
  const std::vector<std::size_t>& which_;
  const VectorXd& left_;  // of the sides' forces, or empty
  const double later_;    // accelerations are those of then
  const bool crowd_;
  ModeChange out_;
  std::optional<State> located_;   // with the drift of what is held, where its forces were found
  std::vector<std::size_t> rows_;  // sides that may push: stops that are touched, then friction
  std::vector<bool> stops_, struck_, passes_, rests_, still_, movable_;
  std::vector<int> slips_;
  MatrixXd D_;
  VectorXd spread_, rate_, b_, rounds_, multiplier_, low_, high_;
  BoxSolution solution_;
};

}  // namespace

ModeChange change_modes(OneSided& sides, const Model& base, const State& state,
                        const std::vector<std::size_t>& which, const VectorXd& left, double later,
                        bool crowd) {
  return Change(sides, base, state, which, left, later, crowd).run();
}

}  // namespace unfurl
