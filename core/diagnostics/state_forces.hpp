// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/integrators/independent_parts.hpp"
#include "core/integrators/index1.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Doubt of multipliers beyond which what a pose next to a singular one says of them is not called unique; of
// the largest multiplier of what constraints join them with.
inline constexpr double most_doubt = 1e-4;

// What the index-1 equations say at a state, in solved coordinates.
struct SolvedPoint {
  VectorXd acceleration, lambda;
  bool known = false;   // false: nothing
  double weakness = 0;  // Index1Lanes::weakness
};

// What the index-1 equations say at the states of a run, which are best asked for in their order: those that
// follow are solved along.
class StateForces {
 public:
  static constexpr std::size_t reach = 8;
  // `ahead`: what another one found at the first states already; null: nothing.
  explicit StateForces(const Trajectory& trajectory, const std::vector<SolvedPoint>* ahead = nullptr)
      : trajectory_(trajectory), ahead_(ahead) {}

  // Multipliers of state i, least-norm where rows are redundant; NaN where the equations have no solution. At
  // an event in a singular pose they are the extrapolated ones that the state holds. Accelerations are those
  // of the nodes, NaN where they are not known [m/s^2]. Where a pose is so near to a singular one that its
  // round-off changes them, both are those of the nearest pose that fulfils the constraints, or interpolated
  // between the nearest ones before and behind that tell more, of which none is more than `reach` states
  // behind.
  VectorXd multipliers(std::size_t i, VectorXd& node_acceleration);
  // By how much each of the multipliers that were asked for last may be off for that; empty: it is none of
  // those poses.
  const VectorXd& doubt() const { return doubt_; }
  // Where it is more than most_doubt of these multipliers of state i, 0 elsewhere; empty: nowhere.
  VectorXd large_doubt(std::size_t i, const VectorXd& lambda);
  // NaN for what is joined so with rows that are in doubt.
  void forget_beside(std::size_t i, const VectorXd& doubt, VectorXd& lambda, VectorXd& node_acceleration);
  // The same as the equations give it: not known at an event in a singular pose.
  const SolvedPoint& at(std::size_t i);
  // Whether the pose of state i is so near to a singular one that errors of it count many times in its
  // forces.
  bool near_singular(std::size_t i);

 private:
  void solve_from(std::size_t i);
  std::vector<std::size_t> beside(std::size_t i, int way, std::size_t most) const;
  bool smooth(std::size_t i);
  bool tells_nothing(std::size_t i, double weakness);
  bool stays(std::size_t i, const VectorXd& lambda);
  // A solution and its doubt.
  struct Close {
    double t = 0;
    SolvedPoint point;
    VectorXd doubt;
  };
  Close look_closely(std::size_t model_of, const State& state);
  Close limit_behind(std::size_t i) const;
  bool rests(std::size_t i, const std::vector<std::size_t>& states) const;
  using Looks = std::map<double, Close>;  // beside a state, by time: each once, for all parts that ask for it
  void interpolate(std::size_t i, Index part, Looks& looks, Close& here);
  const IndependentParts& parts(std::size_t i);  // which say nothing of what is small in each other

  // States whose solutions are kept: those around the one that is asked for.
  static constexpr std::size_t kept = 16;
  struct Kept {
    std::size_t i = static_cast<std::size_t>(-1);
    SolvedPoint point;
  };
  const Trajectory& trajectory_;
  const std::vector<SolvedPoint>* ahead_;
  const Model* model_ = nullptr;
  std::optional<Index1Lanes> lanes_;  // of that model
  std::array<Kept, kept> kept_;       // state i at i % kept
  std::optional<IndependentParts> parts_;
  const Model* parts_of_ = nullptr;
  std::unique_ptr<System> system_;  // of the model that was looked at closely last
  std::unique_ptr<Index1> one_;
  const Model* close_ = nullptr;  // that model
  VectorXd doubt_;
  // What was looked at closely last, and what the equations had given there.
  struct Seen {
    std::size_t i = static_cast<std::size_t>(-1);
    VectorXd lambda, doubt;
  };
  Seen seen_;
};

// Per rod of the whole structure [N]: the multiplier of its row, or what its stretch tells.
void axial_forces(const Model& model, const State& state, const VectorXd& q, const VectorXd& v,
                  const VectorXd& lambda, VectorXd& force);

// Stretches of a run whose pose is so near to a singular one that its rounding says forces which are unique
// elsewhere: where a drive rests in a flat pose. The first one's first and last state; the same number twice
// where there is none.
struct Diagnostics;
std::pair<std::size_t, std::size_t> undetermined_states(const Trajectory& trajectory, const Diagnostics& d);

}  // namespace unfurl
