// SPDX-License-Identifier: BSD-3-Clause
// What drives a deployment against what resists it, along the only way that the structure can move.
//
// At a pose s the force of source k along the path is Q_k = F_k . dq/ds (path_forces.hpp), times its
// uncertainty factor. Those that push the way the structure deploys are drives, the others resist:
//
//     static margin  = sum of drives / sum of resistances - 1               at rest in every pose
//     dynamic margin = (K_0 + work of drives) / work of resistances - 1     along the motion from its start
//
// The second has inertia and rates in it: the kinetic energy is K = K_0 + work of drives - work of
// resistances, so that the margin is K over what has been resisted, and 0 where the motion stalls. At the
// start it is the static one. Where nothing resists a margin is infinite; at a dead centre, where all Q_k are
// zero at once, the static one is the less of the limits from either side.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/integrators/solver_options.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

struct MarginSource {
  std::string name, kind;
  double factor = 1.0;
  double largest_drive = 0.0, largest_resistance = 0.0;  // on the way [Margin::unit]
};

struct MarginPoint {
  double s = 0.0;           // along the path, the way it deploys [m kg^1/2]
  double fold_angle = 0.0;  // [rad]; NaN: the structure has none
  VectorXd forces;          // of the sources; drives > 0 [Margin::unit]
  double margin = 0.0;      // static
  double t = 0.0;           // of the loads over time
};

struct MarginReach {  // of the motion
  double s = 0.0, t = 0.0, fold_angle = 0.0;
  double kinetic = 0.0, driven = 0.0, resisted = 0.0;  // energies since the start, of the whole structure [J]
  double margin() const;
};

enum class MarginEnd {
  arrives,    // at the end of the path that was looked at
  stalls,     // its speed is used up, or it never sets out
  stopped,    // an end stop bars the way
  time,       // it is up
  other_way,  // the motion sets out against the way, and is not followed
};

// What a stop or a latch that the way ends on has to bear there, with the factors. At rest it is what drives
// less what resists, dry friction and dampers aside, by virtual work on what the stop limits or the latch
// holds: one that pushes on is borne, one that pulls back by latches alone.
struct MarginLoad {
  std::string name, kind;  // "stop", "cable", "latch"
  bool turns = false;      // of an angle: [N m] and [rad/s]; else [N] and [m/s]
  double load = 0.0;       // pushes on, < 0: pulls back; infinite where what it acts on is stationary
  double speed = 0.0;      // of what it acts on, as it is met; NaN: the motion does not get there
  double energy = 0.0;     // kinetic, of the whole structure or, of one of several latches, its share [J]
};

struct Margin {
  std::vector<MarginSource> sources;
  std::string unit;  // of forces: "N m" per radian of fold angle, else "N/kg^1/2" per s
  std::vector<MarginPoint> points;
  MarginPoint worst;                // of the static margins
  std::vector<MarginReach> motion;  // with the factors
  double dynamic_min =
      std::numeric_limits<double>::infinity();  // NaN: none, it sets out the other way with a speed
  double dynamic_at = 0.0;                      // s
  bool arrives = false;                         // the motion reaches the end of the path that was looked at
  MarginEnd end = MarginEnd::stalls;
  std::string stop;    // that bars the way, in the motion or, where it ends before, behind that
  double sense = 1.0;  // s of the path by s here
  double end_fold = std::numeric_limits<double>::quiet_NaN(), end_s = 0.0;  // of the way
  std::vector<MarginLoad> loads;                                            // there
};

// From the pose at the start to the deployed one, or to an end stop before it; where there is none, as far as
// the motion goes in options.end_time. A structure at rest waits for loads over time that exceed what holds
// it. Factors by the names of sources, 1 where not named; cables pull where they are stretched.
// Throws PathRefused where there is no path or a drive prescribes the motion, StudyError for a factor of what
// is not there.
Margin margin_of(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                 const std::map<std::string, double>& factors = {});

// "the motion stalls at 31 deg": how it ends, and where, as told.
std::string told_end(const Margin& margin, const std::string& place);

// A hinge between two rods, at their ends or between them, that jams with a friction torque, all else as in
// the margin.
struct StuckHinge {
  std::string name;
  double static_torque = 0.0;  // that holds the structure in some pose if it comes to rest there [N m]
  double stall_torque = 0.0;   // that stalls the motion from the start [N m]
  double stall_at = 0.0;       // s of that
  double stall_fold = 0.0;     // its fold angle [rad]
  double turn = 0.0;           // of the hinge from the start to the end [rad]
};
// Every hinge that turns, or where the motion stalls at its start or sets out the other way would turn, with
// no torque to stall it; then, where they are no more than most_for_pairs, every two of them, jammed alike.
// Where all that acts depends on the pose alone the stall follows from the energy of the motion without the
// jam, K(s) = torque times the angle turned so far. Dampers, motors and loads over time act otherwise in a
// slower motion: there it is the torque at which the motion with the jam comes to rest on its way, with
// nothing that sets it free before options.end_time; what moves then is followed further.
std::vector<StuckHinge> stuck_hinges(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                                     const Margin& margin, std::size_t most_for_pairs);

}  // namespace unfurl
