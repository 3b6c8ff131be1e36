// SPDX-License-Identifier: BSD-3-Clause
// End stops: limits that a measure may touch but not pass.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/simulate/trajectory.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

// How the limit of a stop moves.
struct LimitMotion {
  double rate = 0.0, acceleration = 0.0;
};

// One side of a stop; its gap is +(s - limit) or -(s - limit), at least 0. An impact with the approach speed
// u = -gap' > 0 gives the impulse J along the gap's gradient n, constraints answering,
//
//     M (w+ - w-) + G^T mu = J n,   G w+ = g',   gap'+ = restitution u,   loss = (1 - restitution^2) u^2 / 2a
//
// with a the gap's rate under a unit impulse. Below rest_speed the stop is held as a constraint instead,
// until its force would have to pull.
struct StopSide {
  std::string name;
  Measure measure;
  MeasureFunction function;
  double limit, sign;
  double restitution, rest_speed;
  int followed;  // index in State::angles; -1: it counts no turns
  int stop;      // index in Structure::stops
  TimeFunction reel;
  bool reeled = false;  // a cable: the limit is reel(t)

  double at(double t) const { return reeled ? reel(t) : limit; }
  double rate(double t) const { return reeled ? reel.derivative(1, t) : 0.0; }

  double near(const State& state) const {
    return followed >= 0 && followed < state.angles.size() ? state.angles[followed] : function.reference();
  }
};

class Stops {
 public:
  // One for each finite limit of the structure's stops.
  explicit Stops(const Structure& structure);

  bool empty() const { return stops_.empty(); }
  std::size_t size() const { return stops_.size(); }
  const StopSide& operator[](std::size_t i) const { return stops_[i]; }

  double gap(std::size_t i, const System& system, const State& state) const;
  // The same, of the state's node coordinates and velocities, with its rate.
  double gap(std::size_t i, const State& state, const VectorXd& q, const VectorXd& v, double& rate) const;
  double gap_rate(std::size_t i, const System& system, const State& state) const;
  // Gaps within this count as touching: of lengths [m], and of a measure's values [m] or [rad].
  double touching() const { return of_length_; }
  double touching(const MeasureFunction& s) const { return s.is_angle() ? of_angle : of_length_; }

  void stop_reels(double t);  // at their lengths then
  // These stops become constraints, the last ones of the structure, in their order.
  void hold(const std::set<std::size_t>& held, Structure& structure) const;
  bool is_held(std::size_t i, const Structure& structure) const;  // has it such a constraint?
  // The row that holds stop i in such a model.
  static int held_row(std::size_t i, const Model& model, const std::set<std::size_t>& held);
  // The force with which stop i pushes in a state of a model that holds them so, negative where it pulls [N]
  // or [N m].
  double push(std::size_t i, const Model& model, const std::set<std::size_t>& held, const State& state) const;

 private:
  static constexpr double of_angle = 1e-11;
  std::vector<StopSide> stops_;
  double of_length_;
};

}  // namespace unfurl
