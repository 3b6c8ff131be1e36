// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/dead_centres.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/golden_section.hpp"
#include "core/math/singular_values.hpp"

namespace unfurl {
namespace {

// Singular values of rows of length 1: rounding, and where sides are worth asking for.
constexpr double no_distance = 1e-7, near_one = 0.2;

}  // namespace

// Nothing leads to a dead centre and rests or turns round there but a drive that does so itself.
bool DeadCentres::slows(double from, double to) const {
  constexpr double much = 0.7;
  return std::ranges::any_of(system_.drives(), [&](const Drive& drive) {
    const double before = drive.target.derivative(1, from), behind = drive.target.derivative(1, to);
    return before * behind <= 0 || std::abs(before) < much * std::abs(behind) ||
           std::abs(behind) < much * std::abs(before);
  });
}

bool DeadCentres::prepare(const State& from, const State& to) {
  if (known_) return sigma_.has_value();
  known_ = true;
  if (system_.solved_coordinates() == 0 ||
      std::max(system_.constraints(), system_.solved_coordinates()) > max_singular_size)
    return false;
  sigma_.emplace(system_, system_.constraints() - std::max(rank_at(system_, from.z), rank_at(system_, to.z)));
  if (sigma_->all_zeros()) sigma_.reset();
  return sigma_.has_value();
}

std::optional<DeadCentres::Verdict> DeadCentres::judge(const State& from, const State& to) {
  const double before = std::exchange(left_, 0.0);
  if (system_.drives().empty() || !slows(from.t, to.t) || !prepare(from, to)) return std::nullopt;
  sigma_->moved(from.z);
  const double way = sigma_->moved(to.z);
  if (before > way) return left_ = before - way, std::nullopt;
  const double behind = sigma_->at(to.z);
  if (!(behind <= way)) return left_ = behind, std::nullopt;
  left_ = behind;
  const double ahead = sigma_->at(from.z);
  std::optional<Verdict> verdict;
  if (ahead < behind) {
    verdict = parabola(from, to, ahead);
  } else {
    sigma_->at(to.z);
    verdict = parabola(to, from, behind);
  }
  if (!verdict) return verdict;
  left_ = 0;
  if (!verdict->turns) verdict->latest = 0.5 * (from.t + to.t);
  return verdict;
}

std::optional<DeadCentres::Verdict> DeadCentres::parabola(const State& near, const State& far, double sigma) {
  constexpr double own = 0.5;  // of the squared distance: what the next power of it may change
  constexpr double alike = 4;  // of that at the step's other end
  constexpr int samples = 32, cuts = 40;
  if (!(sigma < near_one)) return std::nullopt;
  const SmallestSingularValue::Pair pair = sigma_->pair();
  const double other = sigma_->between(pair, far.z), way = pair.v.dot(far.z - near.z);
  if (!(other < 0)) return std::nullopt;
  const double c = (other - sigma) / way, x = sigma / c, square = x * x;
  double led = 0;
  for (const Drive& drive : system_.drives()) led = std::max(led, std::abs(pair.u[drive.row]));
  if (sigma < no_distance || !(led > 10 * sigma)) return std::nullopt;
  const auto at = [&](double t) {
    double moved = 0;
    for (const Drive& drive : system_.drives())
      moved += pair.u[drive.row] / pair.lengths[drive.row] * drive.scale *
               (drive.target(t) - drive.target(near.t));
    return square + 2 * moved / c;
  };
  const double there = std::pow(other / c, 2), told = at(far.t);
  if (!(told < alike * there && there < alike * told)) return std::nullopt;
  const double part = (far.t - near.t) / samples;
  int least = 0;
  for (int k = 1; k <= samples; ++k)
    if (at(near.t + k * part) < at(near.t + least * part)) least = k;
  double t = near.t + least * part, bottom = at(t);
  if (0 < least && least < samples)
    t = golden_section(at, t - std::abs(part), t + std::abs(part), cuts), bottom = at(t);
  if (bottom > own * square) return Verdict{0, false};
  if (bottom < -square) return std::nullopt;
  return Verdict{t, true};
}

bool DeadCentres::in_one(const State& state) {
  return !(sigma_->at(state.z) > 10 * no_distance);
}

}  // namespace unfurl
