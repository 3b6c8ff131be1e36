// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/impact.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/math/box_complementarity.hpp"

namespace unfurl {
namespace {

constexpr double rate_rounding = 1e-14;  // of the largest rate
constexpr double loss_rounding = 1e-13;  // of what an impulse does on the rates before and behind it
// Of all rates before an impact: it stops everything, and what acts, not what rounding leaves of the motion,
// tells whether the stop is left.
constexpr double all_stopped = 1e-13;
// Masses of r to one that lose nothing take pi sqrt(r), 31413 of 1e8 to one; from 1e9 to one on, rounding
// leaves D without rank, and there is no answer. What goes on behind that many, seconds of work, is stopped.
constexpr int most_blows = 1'000'000;

class Blows {
 public:
  Blows(const OneSided& sides, const std::vector<std::size_t>& sides_of, const std::vector<bool>& crossed,
        const PushResponses& responses, const MatrixXd& D,
        const std::function<bool(std::size_t, double)>& rests, State& state)
      : sides_(sides),
        sides_of_(sides_of),
        crossed_(crossed),
        responses_(responses),
        D_(D),
        rests_(rests),
        state_(state),
        low_(VectorXd::Zero(D.rows())) {
    out_.struck.assign(sides_of.size(), false);
    out_.lost = low_;
  }

  Impacts run() {
    const double fastest = state_.w.lpNorm<Eigen::Infinity>();
    for (int blow = 0; blow <= most_blows && find(blow); ++blow)
      if (!strike()) return std::move(out_);
    if (state_.w.lpNorm<Eigen::Infinity>() <= all_stopped * fastest) state_.w.setZero();
    return std::move(out_);
  }

 private:
  std::size_t side(Index row) const { return sides_of_[static_cast<std::size_t>(row)]; }
  bool fail_at(Index row) {
    out_.pushed_against = row;
    return false;
  }

  // Which rows are approached, and what they ask of the rates. False where none is, or one has no answer.
  bool find(int blow) {
    const Index count = D_.rows();
    u_ = responses_.rates(state_.w);
    b_ = u_, high_ = low_, hit_ = low_;
    for (Index r = 0; r < count; ++r) {
      const std::size_t i = side(r), k = static_cast<std::size_t>(r);
      if (!sides_.is_stop(i)) continue;
      const bool movable = responses_.movable(r);
      high_[r] = movable ? std::numeric_limits<double>::infinity() : 0.0;
      const bool new_here = blow == 0 && crossed_[k] && !sides_.active(i);
      if (!(u_[r] < (new_here ? -sides_.rounded_rate(i) : -sides_.zero_rate(i)))) continue;
      if (!movable) {
        // No impulse moves it. What others hold needs no hold of its own; what they lead past its limit,
        // however slowly, has none.
        const double still = crossed_[k] ? sides_.zero_rate(i) : sides_.stops()[i].rest_speed;
        if (-u_[r] <= std::max(still, 1e-9 * sides_.fastest(i, state_))) continue;
        return fail_at(r);
      }
      out_.struck[k] = true;
      hit_[r] = 1.0;
      if (blow < most_blows && !sides_.active(i) && !rests_(i, -u_[r]))
        b_[r] += sides_.stops()[i].restitution * u_[r];
    }
    return !hit_.isZero(0);
  }

  // All that is approached at once. False where there is no answer.
  bool strike() {
    std::optional<BoxSolution> impulses = solve();
    while (impulses && takes_back(impulses->x)) impulses = solve();
    if (!impulses) return fail_at(std::find(hit_.begin(), hit_.end(), 1.0) - hit_.begin());
    responses_.give(impulses->x, state_.w);
    // What is pushed unstruck, as what rests on another stop, gives or takes by rounding: a share of each.
    const VectorXd after = responses_.rates(state_.w), pushes = shared(*impulses);
    VectorXd lost = -0.5 * pushes.cwiseProduct(u_ + after);
    const VectorXd rounds = loss_rounding * pushes.cwiseProduct(u_.cwiseAbs() + after.cwiseAbs());
    lost = (lost.array().abs() > rounds.array()).select(lost, 0);  // of what is thrown back as it came
    const double all = -0.5 * impulses->x.dot(u_ + after), of_struck = lost.dot(hit_),
                 share = of_struck > 0 ? all / of_struck : 1.0;
    out_.lost += share * lost.cwiseProduct(hit_);
    return true;
  }

  // Where stops meet one freedom at once the impulses are one choice of many, and rounding makes it. What
  // each loses is told by the least of them, of least sum D_rr P_r^2: twice the nearest to the last, at a
  // small cost.
  VectorXd shared(const BoxSolution& impulses) const {
    bool any = false;
    for (Index r = 0; r < D_.rows(); ++r)
      any = any || (hit_[r] > 0 && !impulses.held[static_cast<std::size_t>(r)] &&
                    std::abs(impulses.w[r]) <= sides_.zero_rate(side(r)));
    if (!any) return impulses.x;
    constexpr double cost = 1e-5;
    const VectorXd costs = cost * D_.diagonal();
    MatrixXd D = D_;
    D.diagonal() += costs;
    VectorXd x = low_;
    for (int k = 0; k < 2; ++k) {
      const auto nearest = solve_box(D, b_ - costs.cwiseProduct(x), low_, high_);
      if (!nearest) return impulses.x;
      x = nearest->x;
    }
    return x;
  }

  // A push on what is being left would give energy: it is not to be in this blow. Without it another may be.
  bool takes_back(const VectorXd& pushes) {
    bool any = false;
    for (Index r = 0; r < D_.rows(); ++r)
      if (pushes[r] > 0 && u_[r] > sides_.zero_rate(side(r))) any = true, high_[r] = 0;
    return any;
  }

  std::optional<BoxSolution> solve() {
    // Two stops on either side of what hardly moves: whether it leaves the one as fast as it meets the other
    // is known as well as its rates are.
    VectorXd of_rates(D_.rows());
    for (Index r = 0; r < D_.rows(); ++r) of_rates[r] = rate_rounding * sides_.fastest(side(r), state_);
    auto impulses = solve_box(D_, b_, low_, high_, of_rates);
    if (impulses) return impulses;
    // What two of them hold between them has no rate, whatever a method that drifts leaves of one.
    for (Index r = 0; r < D_.rows(); ++r)
      if (hit_[r] == 0 && std::abs(u_[r]) <= sides_.zero_rate(side(r))) u_[r] = b_[r] = 0;
    impulses = solve_box(D_, b_, low_, high_, of_rates);
    if (impulses) return impulses;
    // They throw it at each other; friction gives no impulses, and passes none on.
    std::vector<Index> pushing;
    for (Index r = 0; r < D_.rows(); ++r)
      if (high_[r] > 0) pushing.push_back(r);
    for (std::vector<Index>& rows : joined_rows(D_(pushing, pushing))) {
      for (Index& r : rows) r = pushing[static_cast<std::size_t>(r)];
      if (!solve_box(D_(rows, rows), b_(rows), low_(rows), high_(rows), of_rates(rows))) b_(rows) = u_(rows);
    }
    return solve_box(D_, b_, low_, high_, of_rates);
  }

  const OneSided& sides_;
  const std::vector<std::size_t>& sides_of_;
  const std::vector<bool>& crossed_;
  const PushResponses& responses_;
  const MatrixXd& D_;
  const std::function<bool(std::size_t, double)>& rests_;
  State& state_;
  const VectorXd low_;
  VectorXd u_, b_, high_, hit_;
  Impacts out_;
};

}  // namespace

Impacts strike_stops(const OneSided& sides, const std::vector<std::size_t>& sides_of,
                     const std::vector<bool>& crossed, const PushResponses& responses, const MatrixXd& D,
                     const std::function<bool(std::size_t, double)>& rests, State& state) {
  return Blows(sides, sides_of, crossed, responses, D, rests, state).run();
}

std::string what_pushes(const OneSided& sides, std::size_t i, double t, const System& system, bool movable) {
  const StopSide& at = sides.stops()[i];
  const LimitMotion limit = sides.limit_motion(i, t);
  if (at.reeled && (limit.rate < 0 || (limit.rate == 0 && limit.acceleration < 0)))
    return "the cable " + at.name + " is drawn in further than what it runs along gives way";
  const VectorXd mass = system.mass().diagonal();
  const bool unlike = movable && mass.maxCoeff() > 1e8 * mass.minCoeff();
  return (at.reeled ? "a drive pulls at the cable "
          : unlike  ? "a drive or what weighs some 1e9 times as much pushes against the stop "
                    : "a drive pushes against the stop ") +
         at.name;
}

}  // namespace unfurl
