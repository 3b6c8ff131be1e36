// SPDX-License-Identifier: BSD-3-Clause
// One sector of a symmetric structure, with equations of its own.
//
// Of every n entries that turns take onto each other the first is kept. It may reach into the next sector: a
// node there is an image, tied to its source by three linear rows, x' = c + R^k (x - c), which elimination
// takes out again. Linear rows of the whole are written for the nodes of the sector, and those that say the
// same are dropped. What acts on the whole ring, a drive or spring on the fold angle, acts on every sector
// with an n-th of its stiffness. Energies of the whole are n times the sector's.
//
// A state of the sector is one of the whole: positions and velocities turned n times, multipliers of equal
// rows equal (of a row that the ring has once n times the sector's).
#pragma once

#include <functional>
#include <memory>

#include "core/path/symmetry.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

class Sector {
 public:
  // Throws SectorRefused.
  explicit Sector(std::shared_ptr<const Model> whole);

  int order() const { return symmetry_.order; }
  const std::shared_ptr<const Model>& model() const { return sector_; }
  // The run of the whole, from one of the sector. Throws SectorRefused where the whole's equations of motion
  // or constraints say something else than the sector's: whatever was overlooked shows there.
  Simulation whole(Simulation run) const;

 private:
  VectorXd expand(const VectorXd& q, bool positions) const;  // of all nodes of the whole
  State whole_state(const State& state, bool multipliers) const;
  void lift_multipliers(const VectorXd& lambda, VectorXd& out) const;
  std::vector<Event> whole_events(const std::vector<Event>& events) const;
  void compare(const State& of_sector, const State& of_whole) const;

  std::shared_ptr<const Model> whole_, sector_;
  Symmetry symmetry_;
  std::vector<int> node_at_;        // of the whole -> of the sector, of sources; -1: it is an image
  std::vector<int> rod_at_;         // likewise
  std::vector<int> constraint_at_;  // likewise, of those that are not linear
};

// As simulate(), or what takes its place: one sector of a symmetric structure is solved, and the answer is
// that of the whole.
Simulation simulate_sector(
    const std::shared_ptr<const Model>& model, const SolverOptions& options,
    const std::function<Simulation(const std::shared_ptr<const Model>&, const SolverOptions&)>& solve);

}  // namespace unfurl
