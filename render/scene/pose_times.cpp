// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/pose_times.hpp"

#include <algorithm>

namespace unfurl {

namespace {

// What all nodes have gone together at each state.
std::vector<double> way_gone(const Trajectory& run) {
  std::vector<double> way{0.0};
  VectorXd last = run.positions(0);
  for (std::size_t i = 1; i < run.size(); ++i) {
    const VectorXd next = run.positions(i);
    way.push_back(way.back() + (next - last).norm());
    last = next;
  }
  return way;
}

}  // namespace

std::vector<std::size_t> equal_steps(const Trajectory& run, std::size_t count) {
  const std::vector<double> way = way_gone(run);
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
  const std::vector<double> way = way_gone(run);
  std::vector<double> times;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(count - 1);
    if (k == 0 || !(way.back() > 0)) {  // at rest: equal steps of time
      times.push_back(run.start_time() + share * (run.end_time() - run.start_time()));
      continue;
    }
    // Between two states the way is taken as even.
    const double wanted = way.back() * share;
    const auto i = static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(std::lower_bound(way.begin(), way.end(), wanted) - way.begin(), 1));
    const double u = (wanted - way[i - 1]) / (way[i] - way[i - 1]);
    times.push_back(run.time(i - 1) + u * (run.time(i) - run.time(i - 1)));
  }
  times.push_back(run.end_time());
  return times;
}

}  // namespace unfurl
