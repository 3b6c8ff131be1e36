// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/free_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/structure/node_positions.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {

namespace {

constexpr std::array way_marks{0.02, 0.05, 0.1, 0.2};  // of the node that moves most, of the structure's size
constexpr Index most_ways = 4;                         // free motions that are followed, there and back
constexpr double least_share = 0.25;                   // of a mark; else it is held as soon as it moves
constexpr double moved_at_all = 1e-6;                  // of the structure's size, at the first mark

double largest_move(const VectorXd& from, const VectorXd& to) {
  double most = 0;
  for (Index i = 0; i < from.size(); i += 3)
    most = std::max(most, (to.segment<3>(i) - from.segment<3>(i)).norm());
  return most;
}

Structure with_drives_held(Structure structure) {
  for (Constraint& c : structure.constraints)
    if (c.kind == "measure" && c.target.moves()) {
      const double held = c.target(0.0);
      c.target = TimeFunction();
      c.target.offset = held;
    }
  return structure;
}

}  // namespace

FreeReach::FreeReach(const Structure& structure)
    : structure_(with_drives_held(structure)), moves_(structure.nodes.size(), 0) {
  const VectorXd start = node_positions(structure_);
  double size = 1;
  try {
    FreePoses free(structure_);
    size = free.size();
    const MatrixXd motions = free.motions(start);
    for (Index k = 0; k < std::min(motions.cols(), most_ways); ++k)
      for (const double sense : {1.0, -1.0})
        follow(start, size, [&](double way) { return free.moved(start, motions.col(k), sense * way); });
    if (motions.cols() == 0 && start.size() <= FreePoses::most_coordinates) pull(start, free);
  } catch (const StructureError&) {  // nothing is known
  }
  for (const auto& way : ways_)
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      const Index at = 3 * static_cast<Index>(i);
      if ((way.front().segment<3>(at) - start.segment<3>(at)).norm() > moved_at_all * size) moves_[i] = 1;
    }
  if (known()) return;
  std::ranges::fill(moves_, 1);
  for (const Constraint& c : structure_.constraints)
    if (c.kind == "fixed") moves_[static_cast<std::size_t>(c.nodes.front())] = 0;
}

void FreeReach::follow(const VectorXd& start, double size,
                       const std::function<VectorXd(double)>& pose_after) {
  std::vector<VectorXd> way;
  for (const double mark : way_marks) {
    VectorXd pose = pose_after(mark * size);
    if (largest_move(start, pose) < least_share * mark * size) break;
    way.push_back(std::move(pose));
  }
  if (!way.empty()) ways_.push_back(std::move(way));
}

// Motions of the whole as one rigid body, such as a pendulum's, are no free motions.
void FreeReach::pull(const VectorXd& start, FreePoses& free) {
  const std::size_t count = structure_.nodes.size(), middle = count / 2;
  for (const std::size_t node : std::set<std::size_t>{0, middle, count - 1})
    for (Index axis = 0; axis < 3; ++axis)
      for (const double sense : {1.0, -1.0})
        follow(start, free.size(), [&](double way) {
          const Vec3 at = structure_.nodes[node].position;
          return free.pulled(start, static_cast<int>(node), at + sense * way * Vec3::Unit(axis));
        });
}

FreeReach::Range FreeReach::of(const SceneElement& element) const {
  Structure moved = structure_;
  Range range{start_value(element, moved), 0, 0};
  if (!std::isfinite(range.now)) return range;
  for (const auto& way : ways_) {
    double last = 0;
    for (const VectorXd& pose : way) {
      for (std::size_t i = 0; i < moved.nodes.size(); ++i)
        moved.nodes[i].position = pose.segment<3>(3 * static_cast<Index>(i));
      const double apart = start_value(element, moved) - range.now;
      if (!(std::abs(apart) > std::abs(last)) || apart * last < 0) break;
      last = apart;
    }
    (last < 0 ? range.down : range.up) = std::max(last < 0 ? range.down : range.up, std::abs(last));
  }
  return range;
}

}  // namespace unfurl
