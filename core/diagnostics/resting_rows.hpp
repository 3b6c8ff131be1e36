// SPDX-License-Identifier: BSD-3-Clause
// What may hold a structure at rest beside its constraints, and what that leaves undetermined.
#pragma once

#include <vector>

#include "core/simulate/stops.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Friction, stops and inextensible cables of a model. At a state some of them rest: friction that does not
// move, be it held by a row of the model, by what others hold or not at all, and stops that are touched and
// cables that are taut without a row. Each may then bear a force along its measure. The model has rows for an
// independent subset, which is one choice where there are others.
class RestingRows {
 public:
  explicit RestingRows(const Model& model);

  bool empty() const { return frictions_.empty() && stops_.empty(); }
  // Each of them, 1: it rests. next: the state behind it, nullptr: there is none. step: of the method [s].
  std::vector<char> at(const State& state, const State* next, double step) const;
  // G with a row, its gradient at the node coordinates q, for each that rests, behind its own; its columns
  // are the solver's coordinates or the nodes'.
  SparseRows behind(const SparseRows& G, const ConstVec& q, const std::vector<char>& rests) const;
  // Compliances of the rows of such a G before it had those, and 0 of these; none stay none.
  static VectorXd behind(const VectorXd& compliance, Index rows);
  // By added row; of cables their side among the stops, -1 for all else.
  std::vector<int> cables(const std::vector<char>& rests) const;
  std::vector<Measure> measures(const std::vector<char>& rests) const;

 private:
  struct Friction {
    Measure measure;
    MeasureFunction function;
    bool slips;
  };
  const MeasureFunction& function(std::size_t i) const {
    return i < frictions_.size() ? frictions_[i].function : stops_[i - frictions_.size()].function;
  }

  const Model& model_;
  bool led_;  // by a drive, which may stop it: else what slips is at rest for a moment only
  std::vector<Friction> frictions_;
  Stops stops_;
  std::vector<char> held_;  // of the stops
};

}  // namespace unfurl
