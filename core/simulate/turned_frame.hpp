// SPDX-License-Identifier: BSD-3-Clause
// A structure that floats and has turned, and the fold angle, which is measured in space.
#pragma once

#include <string>

#include "core/system/system.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// The fold angle's sine and cosine are linear forms along the directions of t = 0 (structure.hpp,
// Deployment). That is the angle of the structure itself as long as it does not turn as a whole: with a tilt
// or spin of x it is off by some x^2 / 2, with units that deploy unlike each other by x. Of the nodes about
// their centre r_i, those at the start s_i,
//
//     A = sum_i r_i s_i^T
//
// is symmetric where every node moves as the symmetry of a ring, or of a mast, asks. Turned by x about an
// axis across j and k it has (A_kj - A_jk) / (A_jj + A_kk) = tan(x), however slender it is. Where supports of
// single nodes leave no rotation there is nothing to be watched.
class TurnedFrame {
 public:
  explicit TurnedFrame(const Structure& structure);

  // What a user is told where that is so for the first time, else nothing.
  std::string at(const System& system, const State& state);
  void archive(Archive& archive) { archive(said_); }

 private:
  MatrixXd start_;    // 3 n, about the centre; empty: there is nothing to be watched
  std::string also_;  // what else is measured along the directions of t = 0
  bool said_ = false;
};

}  // namespace unfurl
