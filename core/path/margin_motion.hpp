// SPDX-License-Identifier: BSD-3-Clause
// The motion of a margin: one way along the path, until it arrives, stalls, meets a stop or its time is up.
#pragma once

#include <optional>

#include "core/path/margin.hpp"
#include "core/path/margin_law.hpp"
#include "core/path/path_watch.hpp"
#include "core/simulate/one_sided.hpp"

namespace unfurl {

class MarginMotion {
 public:
  MarginMotion(std::shared_ptr<const Model> model, const SolverOptions& options,
               std::shared_ptr<const Path> path, const std::map<std::string, double>& factors);

  const Path& path() const { return *path_; }
  MarginLaw& law() { return law_; }
  const MarginLaw& law() const { return law_; }
  double speed() const { return speed_; }  // at the start, ds/dt of the path

  // At rest in s, when and which way what pulls exceeds what holds there: friction, a jam, at the start the
  // stops it lies against. Nothing: not before `end`.
  struct Release {
    double t = 0.0, sense = 0.0;
  };
  std::optional<Release> release(double s, double from, double end) const;
  // The first place on the way where a stop bars it, and which.
  std::optional<std::pair<double, std::string>> barred(double sense, double end) const;
  // Stops that a way ends on there, how fast their gaps close by it, and what they have closed by from the
  // start.
  struct Met {
    const StopSide* stop;
    double closing, change;
  };
  std::vector<Met> met(double sense, double end) const;

  // goal: where it arrives; nothing: where it is at the end time. At rest it waits until the end time;
  // patience: it is followed for so many of those while it moves.
  void run(double sense, std::optional<double> goal, double end_time, bool record, double patience = 1.0);

  MarginEnd ended() const { return ended_; }
  const std::string& stop() const { return stop_; }
  double released() const { return released_; }  // when it first set out
  double t() const { return motion_.t(); }
  double way() const { return sense_ * motion_.s(); }
  double time_at(double way) const;  // when it was last there; behind its end, the end
  void at(double t, double& way, double& speed) const;
  const std::vector<MarginReach>& reaches() const { return reaches_; }  // of one sector, without fold angles
  // Where the margin falls and rises again between two of them, the least such.
  const std::optional<MarginReach>& least() const { return least_; }

 private:
  void begin();
  double nearest_to_stop(std::size_t stop, double sense, double a, double b) const;
  std::optional<double> pushed_on(double end) const;
  bool set_out(double end_time, bool first);
  bool follow(double from, double to);
  double turn_between(double a, double b) const;
  double last_time(double a, double b, bool turns) const;
  struct Work {
    double driven = 0.0, resisted = 0.0;
  };
  double force_at(std::size_t group, double t) const;
  Work work_between(double a, double b) const;
  MarginReach reach_at(double t, const Work& since) const;
  void look_for_least(double a, double b);
  void account(double a, double b);
  void turn_cable(std::size_t side);
  double speed_at(double t) const;
  double pull_at(double t) const;
  std::optional<std::size_t> against_stop(double sense) const;
  void check_energy() const;

  std::shared_ptr<const Model> model_;
  SolverOptions options_;
  std::shared_ptr<const Path> path_;
  MarginLaw law_;
  OneSided sides_;
  PathWatch watch_;
  State start_;
  std::vector<TimeEdge> edges_;
  double speed_ = 0.0;

  PathMotion motion_;
  double sense_ = 1.0, released_ = 0.0;
  std::optional<double> goal_;
  bool record_ = true, resting_ = false;
  double driven_ = 0.0, resisted_ = 0.0;
  double crowd_time_ = -1.0;
  long crowd_ = 0;
  MarginEnd ended_ = MarginEnd::stalls;
  std::string stop_;
  std::vector<MarginReach> reaches_;
  std::optional<MarginReach> least_;
};

}  // namespace unfurl
