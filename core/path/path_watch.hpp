// SPDX-License-Identifier: BSD-3-Clause
// When something happens on a path: a stop is touched, a cable pulls or is slack, the deployed pose is
// reached.
#pragma once

#include <utility>
#include <vector>

#include "core/path/path_motion.hpp"
#include "core/simulate/one_sided.hpp"

namespace unfurl {

class PathWatch {
 public:
  // deployed: whether the deployed pose is watched for, too.
  PathWatch(const Structure& structure, const OneSided& sides, double step, bool deployed = true);

  // Adds what is watched to the law's measures, which are then tabulated; again for every new law.
  void watch(PathLaw& law);
  // As of the state at the start: stops that are passed there count as touched, and the deployed pose as
  // reached anew only behind a margin.
  void begin(const State& start, const System& system);

  // The first margin that falls below zero in (from, to], and when; -1: none. Stops and cables in their
  // order, then the deployed pose.
  // `edge`: a drive has an edge at `to`.
  std::pair<double, int> first_event(const PathMotion& motion, double from, double to, bool edge = false);
  void deployed() { deployed_ = true; }

  // The deployed pose was further away than the margin at that time.
  bool clear(const PathMotion& motion, double t) const;
  double remaining(double s) const { return remaining_at(s).value; }  // as of the deployment
  // The deployed pose, to rounding.
  bool is_deployed(double s) const {
    return deploys_ && std::abs(remaining(s)) <= 1e-9 * std::abs(remaining(0.0));
  }
  // Whether the motion touches this stop, now, and goes on into it.
  bool meets(const PathMotion& motion, std::size_t stop) const;
  double gap_slope(std::size_t stop, double s) const;  // by s
  // In units of what counts as zero: below -1 it has been passed.
  double gap(std::size_t stop, double s) const;
  // Of what side i of friction acts on, by s.
  double friction_slope(std::size_t i, double s) const {
    return law_->table().at(friction_columns_[i - sides_.first_friction()], s).slope;
  }
  // Whether what it acts on changes along the path at all.
  bool friction_moves(std::size_t i) const;

 private:
  ValueAndSlope remaining_at(double s) const;
  // With their rates where those follow from the pose and the speed, 0 otherwise.
  void margins(const PathMotion& motion, double t, VectorXd& out, VectorXd& rates) const;
  double margin(const PathMotion& motion, double t, Index i) const;
  // When a margin that falls at one time and rises at another is least in between.
  double least_between(const PathMotion& motion, Index i, double a, double b) const;
  // Whether stop i is touched at t by what is at rest, and pressed against it.
  bool pressed(const PathMotion& motion, double t, double to, Index i, double margin) const;
  // Whether the stop that is met first stands before the deployed pose, told at t, by more than rounding.
  bool stands_before(const PathMotion& motion, const std::pair<double, int>& met, double t) const;
  double zero_of(const PathMotion& motion, Index i, double a, double b) const;

  const OneSided& sides_;
  bool deploys_, folds_;  // by a fold angle
  double step_;
  const PathLaw* law_ = nullptr;
  std::vector<Index> stop_columns_;
  std::vector<Measure> frictions_;
  std::vector<Index> friction_columns_;
  std::vector<double> shift_;
  Index deployed_column_ = -1;
  double margin_ = 0, rounded_ = 0;  // of the deployed pose; rounded_: Deployment::rounded()
  bool armed_ = false, deployed_ = false;
};

}  // namespace unfurl
