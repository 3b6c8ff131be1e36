// SPDX-License-Identifier: BSD-3-Clause
// Which forces of a run its model determines.
//
// Where constraints are redundant, any state of self-stress may be added to their forces: the multipliers
// that are reported are those of least norm, one choice among many. A multiplier that no such state contains
// is unique (math/determined_rows.hpp). That is a matter of the structure's shape, not of its pose: it
// changes only where what holds it changes (contact, latch, rest) and, for a moment, at singular poses.
//
// Several frictions, stops and drives that hold one freedom at rest are redundant like rows: whether they
// have any in the model or not (resting_rows.hpp), they may share as they like.
//
// Rods that have a modulus share the load (elastic_sharing.hpp): then their forces are unique, and those of
// guides and rigid rods where these determine them among themselves. At a singular pose, where the rank falls
// for a moment, what the rigid model leaves open stays open.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/resting_rows.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// Per kept row of a model and of what else rests, at poses that are not singular, 1: determined. Empty:
// nothing is known yet.
struct KnownUniqueness {
  std::vector<char> rigidly, usual;  // by rigid rods alone; where rods share by their moduli
  std::vector<char> rests = {};      // where of friction and stops this rests (RestingRows)
  void archive(Archive& archive) { archive(rigidly), archive(usual), archive(rests); }
};

// Per kept row of a run's constraints, at every state. A few states of each model are examined: its ends,
// three between them and those beside the singular poses that the run names.
class ForceUniqueness {
 public:
  explicit ForceUniqueness(const Simulation& run) : ForceUniqueness(run, {}, false) {}
  // `before`: of the model of the first state. It is examined at its end and at singular poses then; not at
  // its end where that is the end of a window only and the run goes on.
  ForceUniqueness(const Simulation& run, const KnownUniqueness& before, bool goes_on);

  // 1: unique, per kept row of the model that the state belongs to, and behind these of what rests. At a
  // singular pose without redundancy the forces that are carried over as the limit along the motion
  // (StepReport::singular_event) stay unique.
  const std::vector<char>& at(std::size_t state) const;
  // False: a singular pose, where more than usual is open.
  bool regular(std::size_t state) const { return singular_.count(state) == 0; }
  // What rests at the state, as RestingRows::at says it.
  const std::vector<char>& rests(std::size_t state) const {
    return std::prev(rests_.upper_bound(state))->second;
  }
  // Is the force of this cable, by its side among the stops, taut as it may be without a row?
  bool unique_without_row(std::size_t state, int cable) const {
    return !std::prev(open_cables_.upper_bound(state))->second.contains(cable);
  }
  // True: rigid rods determine every force of the state's model, whatever moduli they have.
  bool all_by_rigid_rods(std::size_t state) const;
  const KnownUniqueness& known() const { return known_; }  // of the model of the last state
  std::size_t examined() const { return examined_; }       // states

 private:
  void examine(const Simulation& run, const RestingRows& resting, std::size_t first, std::size_t last,
               bool ends);
  void open_where_rank_falls(const Simulation& run, const std::map<std::size_t, std::vector<char>>& seen);

  KnownUniqueness known_;
  std::size_t examined_ = 0;
  // By the first state of those of a model in which the same rests.
  std::map<std::size_t, std::vector<char>> usual_, rests_;
  std::map<std::size_t, bool> rigidly_;
  std::map<std::size_t, std::set<int>> open_cables_;
  std::map<std::size_t, std::vector<char>> singular_;
};

// Per rod, 0: waves of elastic rods that the step does not resolve (State::tension_error) may change its
// axial force by more than 1 % of the largest; beside such a rod, 0 for all rigid ones. Empty: none is
// changed so much.
std::vector<char> followed_forces(const Model& model, const State& state, const VectorXd& axial_force);

// By state, where some of its multipliers are said by round-off of the pose, next to a singular one: how far
// each may be off (StateForces::doubt), of all kept rows.
using DoubtfulStates = std::map<std::size_t, VectorXd>;

// Enters what is unique into diagnostics of the run's states that have everything else: flags of rods and
// the columns that say so. Doubt below 1e-9 of the run's largest force is none: something at rest;
// nor below 1e-12 of what acts on the nodes: something that falls freely. Both of what constraints join.
void mark_unique(const Trajectory& trajectory, const ForceUniqueness& uniqueness,
                 const DoubtfulStates& doubtful, Diagnostics& diagnostics);

// The same where nobody looked for it: nothing is called unique, and the columns are NaN.
void leave_unique_open(Diagnostics& diagnostics);

// The largest axial force among all rods that are shown, and states: its magnitude, or of tensions or
// compressions alone.
enum class Pull { either, tension, compression };
struct PeakForce {
  double force_N = 0.0;  // tension positive; 0 where there is no rod
  Index rod = -1;        // of the solved structure; -1: there is none, or nothing is known
  double t = 0.0;        // [s]
  bool unique = true;    // of this rod at this state, and of any other that has the same force
};
PeakForce peak_rod_force(const Diagnostics& diagnostics, Pull pull = Pull::either);

// How many of the shown rods have a unique force, at every pose that is not singular.
std::size_t unique_rods(const Structure& structure, const Diagnostics& diagnostics);

}  // namespace unfurl
