// SPDX-License-Identifier: BSD-3-Clause
// Forces whose measure turns back where the motion goes on.
#pragma once

#include <string>
#include <vector>

#include "core/system/system.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// A distance turns back at 0, an angle without a sign where its lines come to lie along each other. A spring
// that is not free of force there, and a motor, then pull the other way from one moment to the next: the step
// across that is of first order, and nothing in it shows. Nor does it where they pass close by, and the force
// turns round within a step.
class TurningBack {
 public:
  explicit TurningBack(const Structure& structure);

  // Whose measure has turned back between two states of a system, once for each: what a user is told.
  std::vector<std::string> between(const System& system, const State& before, const State& after);
  void archive(Archive& archive) { archive(said_); }

 private:
  struct Term {
    std::size_t force;  // of the structure
    std::string name;
    Measure measure;
    double free;  // value without a force; NaN: there is none
  };

  std::vector<Term> terms_;
  std::vector<bool> said_;  // of the structure's forces
};

}  // namespace unfurl
