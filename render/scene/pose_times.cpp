// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/pose_times.hpp"

#include <algorithm>

namespace unfurl {

std::vector<std::size_t> equal_steps(const Trajectory& run, std::size_t count) {
  std::vector<double> way{0.0};
  VectorXd last = run.positions(0);
  for (std::size_t i = 1; i < run.size(); ++i) {
    const VectorXd next = run.positions(i);
    way.push_back(way.back() + (next - last).norm());
    last = next;
  }
  std::vector<std::size_t> states;
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = way.back() * static_cast<double>(k) / static_cast<double>(count);
    const auto at = std::lower_bound(way.begin(), way.end(), wanted) - way.begin();
    if (states.empty() || static_cast<std::size_t>(at) > states.back())
      states.push_back(static_cast<std::size_t>(at));
  }
  return states;
}

std::vector<double> pose_times(const Trajectory& run, std::size_t count) {
  std::vector<double> times;
  if (count > 1)
    for (const std::size_t i : equal_steps(run, count - 1)) times.push_back(run.time(i));
  times.push_back(run.end_time());
  return times;
}

}  // namespace unfurl
