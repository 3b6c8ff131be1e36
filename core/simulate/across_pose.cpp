// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/across_pose.hpp"

#include <algorithm>
#include <utility>

#include "core/math/barycentric.hpp"
#include "core/math/lagrange.hpp"
#include "core/simulate/free_motion.hpp"
#include "core/simulate/initial_state.hpp"

namespace unfurl {

AcrossPose::AcrossPose(const State& from, const std::vector<double>& lengths, const Step& step) {
  solved_.push_back(from);
  for (const double length : lengths) {
    State state = from;
    if (step(state, length)) solved_.push_back(std::move(state));
  }
}

std::size_t AcrossPose::first_around(std::size_t before, std::size_t points) const {
  return std::min(before - std::min(before, points / 2), solved_.size() - points);
}

bool AcrossPose::at(const System& system, double t, State& out, const Beside& beside, bool behind,
                    std::size_t points) const {
  const auto next =
      std::partition_point(solved_.begin(), solved_.end(), [&](const State& state) { return state.t < t; });
  if (next == solved_.begin() || (next == solved_.end()) != behind || solved_.size() < points) return false;
  const auto before = static_cast<std::size_t>(next - solved_.begin());
  const std::size_t first = first_around(before, points);
  out = solved_[before - 1];
  if (out.tension.size() > 0) return false;
  const State left = out;
  out.t = t;
  out.z.setZero();
  out.w.setZero();
  VectorXd away(static_cast<Index>(points));
  for (std::size_t a = 0; a < points; ++a) away[static_cast<Index>(a)] = solved_[first + a].t - t;
  const VectorXd weights = Barycentric(away).values(0.0);
  for (std::size_t a = 0; a < points; ++a) {
    out.z += weights[static_cast<Index>(a)] * solved_[first + a].z;
    out.w += weights[static_cast<Index>(a)] * solved_[first + a].w;
  }
  if (beside && !beside(out)) return false;
  project(system, out);
  if (system.followed_angles() > 0) system.at(left).count_on(out);
  return true;
}

void AcrossPose::between(double t, State& state, VectorXd& acceleration) const {
  const std::size_t points = std::min(most_points, solved_.size());
  const auto next = std::ranges::find_if(solved_, [&](const State& solved) { return solved.t > t; });
  const std::size_t first = first_around(static_cast<std::size_t>(next - solved_.begin()), points);
  const auto time = [&](std::size_t a) { return solved_[first + a].t; };
  state.z.setZero(), state.w.setZero(), acceleration.setZero(state.w.size());
  for (std::size_t a = 0; a < points; ++a) {
    const double weight = lagrange_weight(a, points, t, time);
    state.z += weight * solved_[first + a].z;
    state.w += weight * solved_[first + a].w;
    acceleration += lagrange_slope(a, points, t, time) * solved_[first + a].w;
  }
}

bool AcrossPose::move_free(const System& system, const std::vector<Index>& free, const State& from,
                           State& out) const {
  constexpr double found = 1e-9;  // of the size
  if (free.empty()) return true;
  if (from.tension.size() > 0) return false;
  System followed = system;
  followed.follow(from);
  FreeMotion motion(followed, free);
  std::vector<double> bends;  // of the polynomials
  for (const State& state : solved_) bends.push_back(state.t);
  State state = from;
  const double error = motion.move(state, out.t, bends, [this](double t, State& led, VectorXd& acceleration) {
    between(t, led, acceleration);
  });
  if (!(error <= found * out.z.lpNorm<Eigen::Infinity>())) return false;
  out.z(free) = state.z(free);
  out.w(free) = state.w(free);
  return true;
}

}  // namespace unfurl
