// SPDX-License-Identifier: BSD-3-Clause
// Is what the program says of a mechanism true?
#pragma once

#include <string>

#include "tests/random/mechanism.hpp"

namespace unfurl::random {

// agrees: with the independent solver, and with the laws that hold of it. set_aside: the independent solver
// cannot say (a singular pose, a graze, contradictory constraints). failed: the program is wrong, or says
// nothing where there is an answer.
struct Verdict {
  enum class Kind { agrees, set_aside, failed } kind = Kind::agrees;
  // The first words say the kind of failure, numbers follow after a colon. Of what agrees with shorter steps
  // only: that.
  std::string why;
  double error = 0;  // of the finer run against the independent solver, relative to what is allowed
  bool failed() const { return kind == Kind::failed; }
};

Verdict judge(const Mechanism& mechanism, std::uint64_t seed);

// The smallest mechanism found that fails in the same way, by leaving out one thing after another.
Mechanism shrunk(Mechanism mechanism, std::uint64_t seed, const Verdict& verdict);

}  // namespace unfurl::random
