// SPDX-License-Identifier: BSD-3-Clause
// How rods are joined, read off their motion: around which axis each end turns, which rods lie side by side.
// Nothing here is solved: it tells how the hardware that makes this motion possible would be built.
#pragma once

#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

// A unit direction over the samples of a motion; empty: there is none.
using DirectionTrack = std::vector<Vec3>;

enum class JointKind {
  none,   // no rod ends here
  ball,   // ends turn every way, or there is but one
  hinge,  // all ends turn around one axis
  hub     // each end turns around an axis of its own
};

struct RodEnd {
  int rod = 0, end = 0;  // end 0: a, 1: b
};

// Two rods that cross, pinned to one another or not.
struct RodCrossing {
  int rod = 0, other = 0;
  int pin = -1;  // the node at which they are pinned; -1: none
};

class Joints {
 public:
  // times [s], ascending; poses: the places of all copied nodes then. radius: drawn, per copied rod [m].
  // center: of the motion; plane_normal: of a motion in a plane, else zero.
  Joints(const Structure& structure, std::vector<double> times, const std::vector<std::vector<Vec3>>& poses,
         const std::vector<double>& radius, const Vec3& center, const Vec3& plane_normal);

  const std::vector<double>& times() const { return times_; }
  JointKind kind(int node) const { return kinds_[static_cast<std::size_t>(node)]; }
  const std::vector<RodEnd>& ends(int node) const { return ends_[static_cast<std::size_t>(node)]; }
  // The axis around which a rod's end turns at a time; zero: none is known.
  Vec3 axis(const RodEnd& end, double t) const;
  // At a hinge: which layer of its pin an end has. Ends that keep their angle share one.
  int layer(const RodEnd& end) const { return layers_[index(end)]; }
  // To which side a rod is moved so that it passes those that it crosses, a unit vector; zero: none.
  Vec3 side(int rod, double t) const;
  const std::vector<RodCrossing>& crossings() const { return crossings_; }

 private:
  static std::size_t index(const RodEnd& e) { return static_cast<std::size_t>(2 * e.rod + e.end); }
  Vec3 direction(const RodEnd& end, std::size_t sample) const;  // unit, away from the node
  DirectionTrack normal_of(const RodEnd& a, const RodEnd& b) const;
  DirectionTrack axis_of(const RodEnd& end, const std::vector<RodEnd>& ends) const;
  double angle_range(const RodEnd& a, const RodEnd& b) const;  // [rad]
  Vec3 at(const DirectionTrack& track, double t) const;
  void find_axes(const Structure& structure, const Vec3& plane_normal);
  void find_layers(int node);
  void find_crossings(const Structure& structure, const std::vector<double>& radius);
  void find_pins(const Structure& structure, const std::vector<double>& radius);
  void find_sides(const Vec3& center);
  std::size_t middle() const { return times_.size() / 2; }

  std::vector<double> times_;
  const std::vector<std::vector<Vec3>>& poses_;  // used while this is made
  const std::vector<RodCopy>& rods_;
  std::vector<JointKind> kinds_;
  std::vector<std::vector<RodEnd>> ends_;  // per node
  std::vector<DirectionTrack> axes_;       // per end
  std::vector<int> layers_;                // per end
  std::vector<RodCrossing> crossings_;
  std::vector<DirectionTrack> sides_;  // per rod
};

}  // namespace unfurl
