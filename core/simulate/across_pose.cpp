// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/across_pose.hpp"

#include <algorithm>
#include <utility>

#include "core/math/barycentric.hpp"
#include "core/simulate/initial_state.hpp"

namespace unfurl {

AcrossPose::AcrossPose(const State& from, const std::vector<double>& lengths, const Step& step) {
  solved_.push_back(from);
  for (const double length : lengths) {
    State state = from;
    if (step(state, length)) solved_.push_back(std::move(state));
  }
}

bool AcrossPose::at(const System& system, double t, State& out, bool behind, std::size_t points) const {
  const auto next =
      std::partition_point(solved_.begin(), solved_.end(), [&](const State& state) { return state.t < t; });
  if (next == solved_.begin() || (next == solved_.end()) != behind || solved_.size() < points) return false;
  const auto before = static_cast<std::size_t>(next - solved_.begin());
  const std::size_t first = std::min(before - std::min(before, points / 2), solved_.size() - points);
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
  project(system, out);
  if (system.followed_angles() > 0) system.at(left).count_on(out);
  return true;
}

}  // namespace unfurl
