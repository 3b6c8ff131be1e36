// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/hand.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

namespace {

constexpr double wiggle_time = 2.0;    // there and back [s]
constexpr double wiggle_reach = 0.12;  // of the node that moves most, in units of the structure's size

}  // namespace

void Hand::take(const std::shared_ptr<const LiveRun>& run, double t) {
  if (poses_ && run_ == run && (t_ == t || wiggled_ < 0)) return;
  const Trajectory& trajectory = run->simulation.trajectory;
  std::size_t i = 0;  // a state that was solved for: its constraints hold
  while (i + 1 < trajectory.size() && trajectory.time(i + 1) <= t + 1e-12) ++i;
  run_ = run;
  t_ = t;
  start_ = q_ = trajectory.node_positions(i);
  poses_ = std::make_unique<FreePoses>(trajectory.model(i).structure, start_, trajectory.state(i).angles);
  wiggled_ = -1;
}

void Hand::pull(const std::shared_ptr<const LiveRun>& run, double t, const std::string& node,
                const Vec3& target) {
  if (wiggled_ >= 0) let_go();
  take(run, t);
  for (const NodeCopy& copy : run_->simulation.trajectory.structure().node_copies)
    if (copy.name == node) {
      q_ = poses_->pulled(q_, copy.source, copy.map.transpose() * (target - copy.offset));
      return;
    }
}

void Hand::wiggle(const std::shared_ptr<const LiveRun>& run, double t) {
  const int next = poses_ && run_ == run ? wiggled_ + 1 : 0;
  if (next == 0) {
    let_go();
    take(run, t);
    motions_ = poses_->motions(start_);
  }
  phase_ = 0;
  wiggled_ = next < static_cast<int>(motions_.cols()) ? next : -1;
  q_ = start_;
  if (wiggled_ < 0) poses_.reset();
}

void Hand::advance(double seconds) {
  if (wiggled_ < 0) return;
  phase_ = std::fmod(phase_ + seconds / wiggle_time, 1.0);
  const double share = std::sin(2 * 3.14159265358979 * phase_);
  q_ = poses_->moved(start_, motions_.col(wiggled_), share * wiggle_reach * poses_->size());
}

void Hand::let_go() {
  poses_.reset();
  run_.reset();
  wiggled_ = -1;
}

std::optional<VectorXd> Hand::pose() const {
  if (!poses_) return std::nullopt;
  return whole_positions(run_->simulation.trajectory.structure(), q_);
}

}  // namespace unfurl
