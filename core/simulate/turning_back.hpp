// SPDX-License-Identifier: BSD-3-Clause
// Forces, constraints and stops whose measure turns back where the motion goes on.
#pragma once

#include <string>
#include <vector>

#include "core/system/system.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// A distance turns back at 0, an angle without a sign where its lines come to lie along each other. A spring
// that is not free of force there, and a motor, then pull the other way from one moment to the next: the step
// across that is of first order, and nothing in it shows. Nor does it where they pass close by, and the force
// turns round within a step. What a constraint holds turns round, too; a stop beyond whose limit the measure
// turns back within a step is not met.
class TurningBack {
 public:
  explicit TurningBack(const Structure& structure);

  // Whose measure has turned back between two states of a system, once for each: what a user is told.
  std::vector<std::string> between(const System& system, const State& before, const State& after);
  void archive(Archive& archive) { archive(said_); }

 private:
  enum class Of { force, constraint, stop };
  struct Term {
    Of of;
    std::size_t index;  // in said_
    std::string name;
    Measure measure;
    double
        free;  // value without a force; NaN: there is none. Of a stop: where it turns back within its limits
  };
  void add(Of of, std::size_t index, const std::string& name, const Measure& measure, double free);

  std::vector<Term> terms_;
  std::vector<bool> said_;  // of the structure's forces, constraints and stops
};

// That a step of h may lead a measure that a constraint holds to where it turns back, or a side of an angle
// onto its axis, in words; empty: none.
std::string at_its_end(const Structure& structure, const System& system, const State& state, double h);

}  // namespace unfurl
