// SPDX-License-Identifier: BSD-3-Clause
// A run that goes on from a flat pose in which its drives have come to rest.
#include <algorithm>

#include "core/constraints/linear_rows.hpp"
#include "core/simulate/stepper_loop.hpp"

namespace unfurl {

// Drives hold a pose that has lost rank, which the constraints alone do where nothing acts across its rods.
void Stepper::Loop::hold_deployed() {
  q_.resize(system().coordinates());
  system().expand(now().z, q_);
  held_.places.resize(3 * std::ssize(held_.nodes));
  for (std::size_t i = 0; i < held_.nodes.size(); ++i)
    held_.places.segment<3>(3 * static_cast<Index>(i)) = q_.segment<3>(3 * held_.nodes[i]);
  if (!now().lambda.allFinite()) hold_nodes();
}
void Stepper::Loop::hold_nodes() {
  holds_ = true;
  base_ = model_with_held(*base_, held_, run_.options.eliminate_linear);
}
void Stepper::Loop::enter_held() {
  set_model(sides_.any_active() ? sides_.model(*base_) : base_, in_base(now()), true);
}

// What a step moves of what is held is rounding, and nothing is left of it. True where that is too much, or
// the step cannot be solved: then nodes are held.
bool Stepper::Loop::gives_way(Probe& to) {
  constexpr double rounding = 1e-6;  // of the structure, in a step
  if (holds_ || held_.places.size() == 0) return false;
  const auto give_way = [this] { return hold_nodes(), enter_held(), true; };
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
  archive(holds_);
  if (archive.reading() && holds_) base_ = model_with_held(*base_, held_, run_.options.eliminate_linear);
}

}  // namespace unfurl
