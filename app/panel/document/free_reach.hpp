// SPDX-License-Identifier: BSD-3-Clause
// How far nodes and measures go while a structure moves as its constraints let it, about the start.
#pragma once

#include <functional>
#include <vector>

#include "core/scene/elements.hpp"
#include "core/structure/structure.hpp"
#include "core/system/free_poses.hpp"

namespace unfurl {

class FreeReach {
 public:
  // What drives prescribe is held. Of a structure whose free motions cannot be told (FreePoses) nothing is
  // known.
  explicit FreeReach(const Structure& structure);

  bool known() const { return !ways_.empty(); }
  // Of nodes of which nothing is known all but fixed ones do.
  bool moves(int node) const { return moves_[static_cast<std::size_t>(node)] != 0; }

  // How far the value of an element goes below and above the one at t = 0, by some way on which it does not
  // turn back, in the scene's unit.
  struct Range {
    double now = 0, down = 0, up = 0;
  };
  Range of(const SceneElement& element) const;  // now: NaN where it measures nothing

 private:
  // A way by what `pose_after` says of lengths [m].
  void follow(const VectorXd& start, double size, const std::function<VectorXd(double)>& pose_after);
  void pull(const VectorXd& start, FreePoses& free);

  Structure structure_;
  std::vector<std::vector<VectorXd>> ways_;  // poses one behind the other, each way from the start
  std::vector<char> moves_;
};

}  // namespace unfurl
