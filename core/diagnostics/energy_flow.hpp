// SPDX-License-Identifier: BSD-3-Clause
// Energy that goes in and out without a potential: what closes the energy balance of loads that vary,
// dampers, drives and impacts.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/diagnostics/damped_rods.hpp"
#include "core/diagnostics/driven_tables.hpp"
#include "core/diagnostics/drives.hpp"
#include "core/diagnostics/state_forces.hpp"
#include "core/integrators/index1.hpp"
#include "core/math/quadrature.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

// Since the start, at every state [J]; zeros where a scene has no such thing.
struct EnergyFlow {
  std::vector<double> load_work, dissipated, drive_work, impact_loss;
  std::vector<std::vector<double>> of_drives = {};  // what each of drive_channels() has put in
};

// Whether something besides loads gives work by a law of its own: motors, winches, elastic rods that warm.
bool motors_or_warmed(const Structure& structure);

// What dry friction takes is exact: a force times the way. Powers are integrated over each step with three
// Gauss points (order 6) on the quintic that has the coordinates, rates and accelerations of the states at
// both ends: an independent quadrature, whatever the method, of order 6 where the forces are smooth within
// steps. The power -lambda g' of drives and of rods that warm takes its multipliers from the index-1
// equations at those points, or at four Lobatto points, of which two are the states, where nothing but drives
// puts in energy. Where rods give and a step does not resolve their waves, lengths between states do not tell
// forces: the Gauss points are then the step's own, with the axial forces that it has found there, and what
// dampers of these rods take is that of the step's own rates (damped_rods.hpp). Where it does not resolve the
// waves of other forces, either, as of rods that bend, the multipliers are the step's own, too. Where the
// table of a drive has points within a step, between which what it asks for bends faster than that quadrature
// follows, it is taken between these points, on the cubic through coordinates and rates and at the rates that
// the table prescribes. Where
// dampers are stiff (c / m beyond 2 / h), what they take comes from the difference of two motions that are
// nearly one, which no interpolant tells. What they and dampers beside them take is then that of the states
// and its rates there, and the motion between the states, of what hangs together with theirs, the cubic
// through coordinates and rates: order 4.
class EnergyMeter {
 public:
  explicit EnergyMeter(const Model& model);
  // Nothing goes in or out but by potentials and constant loads: no step needs to be added.
  bool idle() const { return !loads_ && !dampers_ && !drives_; }
  // The step from a to b, which follows on the last one; `at_b` where that is known of b already. In a
  // singular pose the equations do not say it.
  void add(const State& a, const State& b, SolvedPoint at_b = {}, bool singular_at_b = false,
           bool singular_at_a = false);
  void jump() { fresh_ = false; }                        // velocities have changed within no time
  double load_work = 0, dissipated = 0, drive_work = 0;  // so far [J]
  // Told every point of the quadrature: its weight [s], the time, node coordinates, velocities, multipliers.
  std::function<void(double, double, const VectorXd&, const VectorXd&, const VectorXd&)> at_point = {};
  const System& system() const { return system_; }

 private:
  SolvedPoint at_state(const State& state);  // where nothing is known the acceleration is zero
  double damping_power(const State& state, const VectorXd& acceleration, double after, double later = 0);
  double damping_bound(const State& state);
  double dampers_take(double t, const VectorXd& v, const double* tension) const;  // at q_ [W]
  VectorXd rod_forces(const State& state);                                        // of those that give [N]
  double taken(const State& state);
  double energy(const State& state);
  struct Ends {  // of a step: states, accelerations
    State a = {}, b = {};
    VectorXd by_a = {}, by_b = {};
  };
  Ends trusted_ends(const State& a, const State& b);
  void smooth_ends(const State& a, const State& b);  // finds by_a_ and by_b_
  VectorXd between_stages(const State& b, double u) const;
  bool gone_ = false, rings_ = false;  // in the last step of these, the rates of something
  double most_power_ = 0;              // of dampers there [W]
  double taken_by_stiff(const State& a, const State& b, double fastest, double between, double lost);

  System system_;  // follows the states
  bool loads_, dampers_, drives_;
  DrivenTables tables_;
  DampedRods damped_rods_;
  bool by_tension_ = false;  // powers depend on the forces of rods that give
  bool rods_apart_ = false;  // in this step, from what is said of dampers otherwise
  std::unique_ptr<Index1> index1_;
  SolvedPoint before_, after_;
  VectorXd by_a_, by_b_;  // accelerations at the ends of the step, as its motion has them
  bool fresh_ = false;    // after_ is of the last state, and velocities have not changed since
  VectorXd q_, v_, unused_, lambda_, target_rate_, stiff_rate_;
  ForceDerivatives derivatives_;
  SparseRows damping_;                 // of them, by rates
  std::vector<Index> parts_, damped_;  // of each coordinate; by dampers, too
  VectorXd stiff_;   // 1: a coordinate that a stiff damper moves, or what hangs together with it
  double last_ = 0;  // time of the state that after_ is of
  Quadrature own_;   // Gauss points of steps that tell the forces of rods there
};

// The same along the states of a run, each in its turn; zeros unless it is `booked`.
class RunEnergyFlow {
 public:
  RunEnergyFlow(const Trajectory& run, bool booked);
  // The step that ends in state i > 0; `forces` of the run, where they are asked for anyway: one
  // factorisation a state serves both.
  void step_to(std::size_t i, StateForces* forces);
  const EnergyFlow& so_far() const { return flow_; }

 private:
  void meter_of(const Model& model);
  bool explain_impulse(const Model& rows, const State& a, const State& b, double gain);

  const Trajectory& trajectory_;
  bool booked_;
  std::vector<DriveChannel> drives_;
  EnergyFlow flow_;
  std::unique_ptr<EnergyMeter> meter_;
  const Model* model_ = nullptr;  // of the meter
};

}  // namespace unfurl
