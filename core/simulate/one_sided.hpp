// SPDX-License-Identifier: BSD-3-Clause
// What acts on one side only: end stops, which push or are out of touch, cables, which pull or are slack, dry
// friction, which holds or slips, and motors, which give what is asked of them or what they can.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/forces/motor.hpp"
#include "core/forces/pin_loads.hpp"
#include "core/integrators/independent_parts.hpp"
#include "core/integrators/index1.hpp"
#include "core/integrators/solver_options.hpp"
#include "core/simulate/crossing.hpp"
#include "core/simulate/simulation.hpp"
#include "core/simulate/stops.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// Each of them is at any time in one of its modes, and in each the motion is smooth:
//
//     stop      out of touch (gap > 0)           margin: the gap
//               held: a constraint at its limit  margin: the force with which it pushes
//     cable     slack: no force                  margin: -min(s - rest, n / (k + c / h))
//               pulls: a spring on both sides    margin: min(s - rest, n / (k + c / h)),  n = k (s - rest) +
//               c s'
//     friction  sticks: a constraint             margin: tau_s - |its force|, of all that can only move
//                                                together as one (friction_hold.hpp)
//               slips: -slip tau_k along s       margin: slip s'
//               stands where others hold it: no force and no constraint, margin: 2 zero - |s'|
//     motor     one part of its law               margin: its room (forces/motor.hpp)
//
// A margin that falls below zero ends the mode. Margins come in units of what counts as zero: 1e-11 of the
// structure's length, a part of the largest multiplier, for friction that slips 1e-13 of the length in a step
// and a hundred times that where it stands. A cable with damping c pulls with n where it is both stretched
// and n > 0, so that it never pushes.
class OneSided {
 public:
  OneSided(const Structure& structure, const SolverOptions& options);

  bool empty() const { return active_.empty(); }
  std::size_t size() const { return active_.size(); }  // stops first, then cables, friction and motors
  bool is_stop(std::size_t i) const { return i < stops_.size(); }
  bool is_cable(std::size_t i) const { return i >= stops_.size() && i < first_friction(); }
  const Force& cable(std::size_t i) const { return cables_[i - stops_.size()].law; }
  const MeasureFunction& cable_length(std::size_t i) const { return cables_[i - stops_.size()].length; }
  bool is_friction(std::size_t i) const { return i >= first_friction() && i < first_motor(); }
  bool is_motor(std::size_t i) const { return i >= first_motor(); }
  std::size_t first_friction() const { return stops_.size() + cables_.size(); }
  std::size_t first_motor() const { return first_friction() + frictions_.size(); }
  bool any_friction() const { return !frictions_.empty(); }
  bool only_friction(const std::vector<std::size_t>& which) const {
    return std::all_of(which.begin(), which.end(), [this](std::size_t i) { return is_friction(i); });
  }
  // A held stop, a cable that pulls, what sticks, a motor that gives less than it is asked for.
  bool active(std::size_t i) const { return active_[i]; }
  bool any_active() const;  // what is not as in the model without any of it
  bool any_reeled() const;  // cables that are paid out or drawn in
  const Stops& stops() const { return stops_; }
  // "leaves stop NAME", "NAME pulls", ...: that the mode has begun; of friction, for each that acts there.
  std::vector<Event> events(std::size_t i, double t) const;

  // `t`: of a stop that is let go, where its force has fallen to zero (leaves()).
  void set_active(std::size_t i, bool active, double t = std::numeric_limits<double>::quiet_NaN());
  // Is a stop not yet clear of what let it go?
  bool any_leaving() const { return (let_go_.array() == let_go_.array()).any(); }
  // A stop that is passed by less than rounding or by what a start or its leaving left of it counts as
  // touched there, and so with the room of a motor whose regime has just begun.
  void touch(const System& system, const State& state);
  // A stop that is held or whose gap counts as zero.
  bool touches(std::size_t i, const System& system, const State& state) const;
  // Cables that are stretched and pull, and what motors give.
  void find_laws(const System& system, const State& state);
  // All cables and motors by the law that knows all of its modes, until one is set; whether they were not.
  bool relax_laws();
  // A cable or motor whose margin is used up goes on by the next part of its law.
  void turn_law(std::size_t i, const System& system, const State& state);
  // Cables and motors whose margins are used up in this state, as where rates have jumped.
  std::vector<std::size_t> laws_left(const System& system, const State& state);

  // What a stop or friction acts along: sign * s.
  const MeasureFunction& measure(std::size_t i) const;
  double sign(std::size_t i) const { return is_stop(i) ? stops_[i].sign : 1.0; }
  double near(std::size_t i, const State& state) const;
  LimitMotion limit_motion(std::size_t i, double t) const;  // of a reeled cable; else it stays
  // Of friction: its forces, the sense in which it slips (0: it does not), and setting that.
  double holding(std::size_t i) const { return friction(i).holding + friction(i).by_load; }
  double kinetic(std::size_t i) const { return friction(i).kinetic + friction(i).by_load; }
  // Friction that depends on the forces of pins, at a state of `model`, which must be that of the present
  // modes.
  void weigh(const Model& model, const State& state);
  int slip(std::size_t i) const { return friction(i).slip; }
  void set_slip(std::size_t i, int slip);
  // The only sense in which an angle without a sign leaves 0 or pi, a distance 0: their gradients end there.
  // 0: of other measures, which no force moves there.
  int away_from_kink(std::size_t i, const System& system, const State& state) const;
  // Friction on a distance that is nothing: from here on it grows, whatever the rate of a moment ago.
  bool comes_to_zero(std::size_t i, const System& system, const State& state) const;
  void stand(std::size_t i) { active_[i] = false, frictions_[i - first_friction()].slip = 0; }
  void stick(std::size_t i, const System& system, const State& state);
  // Of frictions that stand and stops that touch by those that hold: c_ji of friction_hold.hpp, sides by
  // sides.
  void set_shares(MatrixXd c) { shares_ = std::move(c); }
  // What counts as zero, of what a stop or friction acts along and of its rates: what comes to a zero length,
  // or angle, in a step. Of accelerations nothing does but what rounding leaves of what they are the sum of.
  double touching(std::size_t i) const { return stops_.touching(measure(i)); }
  double zero_rate(std::size_t i) const { return touching(i) / step_; }
  // Does an impact on a stop end in rest, as slow ones do?
  bool impact_rests(std::size_t i, double approach) const {
    return stops_[i].restitution * approach <= stops_[i].rest_speed;
  }
  // Is what leaves a stop at this rate met again within a share of a step, by what pulls it back alone?
  bool comes_again(double rate, double pull, double share) const {
    return pull > 0 && 2 * rate <= pull * share * step_;
  }
  static constexpr double no_flight = 4e-6;  // of a step: about as short as crossing.cpp can tell
  // Is a stop that throws back at this rate the end of a series? Of restitution e its rest takes 1 / (1 - e)
  // times as long as that flight. What another stop throws back comes sooner and is no such series.
  bool series_ends(std::size_t i, double rate, double pull) const {
    const double e = stops_[i].restitution, accumulated = 1e-4 * e;
    return comes_again(rate, pull, e < 1 ? std::max(accumulated, no_flight) : no_flight);
  }
  // Of rates at which nothing holds: what rounding the length leaves in a step.
  double rounded_rate(std::size_t i) const { return rounded_share * zero_rate(i); }
  // As fast as the fastest coordinate is [m/s], or as that turns [rad/s].
  double fastest(std::size_t i, const State& state) const {
    return state.w.lpNorm<Eigen::Infinity>() * touching(i) / stops_.touching();
  }

  // Margins and their rates (NaN: not known) of a state of `model`, which must be that of the present modes.
  // Without `forces`, those of what is held are left NaN, which saves a factorisation.
  void measure(const Model& model, const State& state, bool forces, Probe& probe);
  void forget_model() { index1_.reset(), pin_loads_.reset(); }
  // All that changes in a run but for what follows from the model.
  void archive(Archive& archive);

  // `base` in the present modes.
  std::shared_ptr<const Model> model(const Model& base) const;
  // `base` with cables in their modes, all else free.
  Model without_holds(const Model& base) const;
  // `base` with its reels at their length at t for good; cables that do not stretch are none of the held
  // then.
  std::shared_ptr<const Model> stop_reels(const Model& base, double t);

 private:
  static constexpr double rounded_share = 0.01;
  struct Cable {
    std::size_t force;  // of the structure
    std::string name;
    MeasureFunction length;
    Force law;
  };
  // All that acts along one measure, which sticks and slips as one.
  struct Friction {
    struct Pad {
      std::size_t force;  // of the structure
      std::string name;
      double arm;  // mu r of its pin [m]
    };
    std::vector<Pad> pads;
    Measure measure;
    MeasureFunction function;
    int followed;    // index in State::angles; -1: it counts no turns
    double row = 1;  // of its row while it sticks: a multiplier times that is its force or torque
    double kinetic = 0, holding = 0;  // sums of the pads
    double by_load = 0;  // arms times the forces of their pins, of the state that was weighed [N m]
    int slip = 0;
    double held_at = 0.0;
    bool reversed = false;  // it slipped the other way before
  };
  struct Drive {
    std::size_t force;  // of the structure
    std::string name;
    MeasureFunction measure;
    int followed;
    Force law;           // its regime is the present one
    double shift = 0.0;  // of its room: what handing over left of zero where that began
    bool began = false;  // and nobody has looked since
  };
  const Friction& friction(std::size_t i) const { return frictions_[i - first_friction()]; }
  bool laws() const { return !cables_.empty() || !motors_.empty(); }
  void tell(std::size_t i, std::size_t pad, Event& out) const;
  std::set<std::size_t> held() const;
  void follow(const Model& model, const State& state);
  void measure_held(const Model& model, const State& state, Probe& probe);
  void set_laws(Structure& structure) const;
  MotorRooms rooms(const Drive& motor, const VectorXd& q, const VectorXd& v, const State& state);
  double room(const Drive& motor, const VectorXd& q, const VectorXd& v, const State& state) {
    return rooms(motor, q, v, state)[static_cast<std::size_t>(motor.law.motor.regime)];
  }
  bool leaves(std::size_t i, const Model& model, const State& state, double passed, double rate) const;
  void measure_sticking(const VectorXd& zeros, Probe& probe);  // forces that count as none
  void measure_friction(const VectorXd& q, const VectorXd& v, const State& state, std::size_t i,
                        Probe& probe);
  double stretch(const Cable& cable, double t, const VectorXd& q, const VectorXd& v, double& rate);
  double law_margin(std::size_t i, const State& state, const VectorXd& q, const VectorXd& v, double& rate);

  Stops stops_;
  std::vector<Cable> cables_;
  std::vector<Friction> frictions_;
  std::vector<Drive> motors_;
  std::vector<bool> active_;
  bool relaxed_ = false;  // cables and motors are by the law of all their modes
  VectorXd shift_;        // of the stops' gaps [m] or [rad]
  VectorXd let_go_;       // when a stop was that has no room yet; NaN: none such
  MatrixXd shares_;
  VectorXd held_force_;  // of stops and frictions that hold, at the state that is measured
  double step_;
  bool eliminate_linear_, rates_drift_;
  VectorXd gradient_, acceleration_, lambda_;
  std::optional<System> followed_;  // the present model's, near a state's angles
  std::unique_ptr<Index1> index1_;  // of that
  std::optional<IndependentParts> parts_;
  std::unique_ptr<PinLoads> pin_loads_;  // the present model's
};

}  // namespace unfurl
