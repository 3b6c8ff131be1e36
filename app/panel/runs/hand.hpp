// SPDX-License-Identifier: BSD-3-Clause
// A structure led by hand: what its constraints allow, without forces and time.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/panel/runs/simulator.hpp"
#include "core/system/free_poses.hpp"

namespace unfurl {

class Hand {
 public:
  // Pulls a node of the whole structure towards a point [m]; the first time from the run's pose at t. Drives
  // let go.
  void pull(const std::shared_ptr<const LiveRun>& run, double t, const std::string& node, const Vec3& target);
  // Shows the next free motion of the run's pose at t, there and back; after the last one none.
  void wiggle(const std::shared_ptr<const LiveRun>& run, double t);
  void advance(double seconds);
  void let_go();

  bool moves() const { return wiggled_ >= 0; }
  int motions() const { return poses_ ? static_cast<int>(motions_.cols()) : 0; }
  int wiggled() const { return wiggled_; }  // -1: none
  // Of the whole structure [3 N]; none: nobody leads it.
  std::optional<VectorXd> pose() const;
  const VectorXd& solved() const { return q_; }  // [3 n]

 private:
  void take(const std::shared_ptr<const LiveRun>& run, double t);

  std::shared_ptr<const LiveRun> run_;
  std::unique_ptr<FreePoses> poses_;  // null: nobody leads it
  VectorXd start_, q_;
  double t_ = 0;
  MatrixXd motions_;
  int wiggled_ = -1;
  double phase_ = 0;  // of a wiggle, in turns
};

}  // namespace unfurl
