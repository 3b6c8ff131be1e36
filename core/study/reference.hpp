// SPDX-License-Identifier: BSD-3-Clause
// The motion that errors are measured against.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/simulate/trajectory.hpp"
#include "core/text/error.hpp"

namespace unfurl {

class Team;

// What long work asks and tells while it runs.
struct StudyHooks {
  std::function<void(double fraction)> progress = {};  // 0..1
  std::function<bool()> cancelled = {};
  int threads = 1;
  Team* team = nullptr;  // others who work on the same; none: all of it is this one's

  bool stopped() const { return cancelled && cancelled(); }
  void tell(double fraction) const {
    if (progress) progress(fraction);
  }
};

struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

// No two solutions agree well enough to judge anything by.
struct ReferenceError : Error {
  using Error::Error;
};

struct Reference {
  std::vector<double> t;    // comparison times [s], equally spaced from 0 to the end
  std::vector<VectorXd> q;  // node coordinates there [3 n]
  // Largest distance of a node between the last two solutions and, where there is one, from that of a second
  // method [m].
  double uncertainty = 0;
  double size = 0;         // size_of_motion() [m]
  bool confirmed = false;  // by a second method; if not, the one only agrees with itself
  std::string how;         // "Bulirsch-Stoer extrapolation of order 16 with 120 steps"
};

// Solved with step after halved step until two solutions agree to round-off or come no closer: by
// extrapolation of the index-1 equations, and where singular poses stop those, by dvm with 8 nodes against 7.
// Solutions of one kind share much, their round-off above all: the other method is then brought as near as it
// comes. Throws ReferenceError where no two solutions, or not both methods, agree to a millionth of the
// structure's size; Cancelled.
// `enough`: an agreement that is enough, of the size; 0: round-off.
Reference solve_reference(const std::shared_ptr<const Model>& model, double end, int intervals,
                          const StudyHooks& hooks, double enough = 0);

// Largest distance between equal nodes of two configurations [m].
double node_distance(const ConstVec& a, const ConstVec& b);
// Largest distance between two nodes' coordinates along an axis at the start: what "size" means [m].
double structure_size(const Model& model);
// What errors are measured by [m]: the structure's size, and where all nodes are in one place, as one alone
// is, the farthest that a node goes from its start.
double size_of_motion(const Model& model, const Trajectory& trajectory);

}  // namespace unfurl
