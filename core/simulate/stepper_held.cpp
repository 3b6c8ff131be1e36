// SPDX-License-Identifier: BSD-3-Clause
// A run that goes on from a flat pose in which its drives have come to rest.
#include <algorithm>
#include <iterator>
#include <utility>

#include "core/constraints/linear_rows.hpp"
#include "core/simulate/stepper_loop.hpp"

namespace unfurl {

// Drives hold a pose that has lost rank, which the constraints alone do where nothing acts across its rods.
void Stepper::Loop::hold_deployed() {
  q_.resize(system().coordinates());
  system().expand(now().z, q_);
  std::ranges::copy(std::exchange(resting_, {}), std::back_inserter(held_.nodes));
  Index at = held_.places.size();
  held_.places.conservativeResize(3 * std::ssize(held_.nodes));
  for (; at < held_.places.size(); at += 3)
    held_.places.segment<3>(at) = q_.segment<3>(3 * held_.nodes[static_cast<std::size_t>(at) / 3]);
  if (!now().lambda.allFinite()) hold_nodes(held_.nodes.size());
}
void Stepper::Loop::hold_nodes(std::size_t end) {
  const std::size_t first = std::exchange(held_.by_base, end);
  if (first < end) base_ = model_with_held(*base_, held_, first, end, run_.options.eliminate_linear);
}
void Stepper::Loop::enter_held() {
  set_model(sides_.any_active() ? sides_.model(*base_) : base_, in_base(now()), true);
}

// What a step moves of what is held is rounding, and nothing is left of it. True where that is too much, or
// the step cannot be solved: then nodes are held.
bool Stepper::Loop::gives_way(Probe& to) {
  constexpr double rounding = 1e-6;  // of the structure, in a step
  if (held_.by_base == held_.nodes.size()) return false;
  const auto give_way = [this] { return hold_nodes(held_.nodes.size()), enter_held(), true; };
  if (!to.report.ok()) return give_way();
  VectorXd q(system().coordinates()), v(q.size());
  system().expand(to.state.z, q);
  system().expand_rate(to.state.w, v);
  double moved = 0;
  for (std::size_t i = 0; i < held_.nodes.size(); ++i) {
    auto place = q.segment<3>(3 * held_.nodes[i]), rate = v.segment<3>(3 * held_.nodes[i]);
    const Vec3 held = held_.places.segment<3>(3 * static_cast<Index>(i));
    moved = std::max({moved, (place - held).norm(), run_.options.step * rate.norm()});
    place = held;
    rate.setZero();
  }
  if (!(moved <= rounding * reference_length(base_->structure))) return give_way();
  to.state.z = system().reduce(q);
  to.state.w = system().reduce_rate(v);
  return false;
}

void Stepper::Loop::archive_held(Archive& archive) {
  std::size_t n = held_.nodes.size();
  archive(n);
  held_.nodes.resize(n);
  for (int& node : held_.nodes) archive(node);
  archive(held_.places);
  for (std::size_t* x : {&held_.by_base, &held_.latched}) archive(*x);
}

}  // namespace unfurl
