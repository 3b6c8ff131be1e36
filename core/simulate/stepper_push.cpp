// SPDX-License-Identifier: BSD-3-Clause
// What one-sided holds do when something has crossed, and forces that are set between steps.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/math/factors.hpp"
#include "core/simulate/pushed_model.hpp"
#include "core/simulate/stepper_loop.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// Stops that are touched from the start, none of which is approached then.
bool Stepper::Loop::rests_from_start() {
  bool any = false;
  for (std::size_t i = 0; i < sides_.stops().size(); ++i) {
    if (!sides_.touches(i, system(), now())) continue;
    any = true;
    if (sides_.stops().gap_rate(i, system(), now()) < -sides_.zero_rate(i)) return false;
  }
  return any;
}

// Modes at the start of a run: of that impacts are events, and what rests on a stop. What cannot be ends it
// there.
void Stepper::Loop::find_first_modes() try {
  sides_.find_laws(system(), now());
  sides_.touch(system(), now());
  ModeChange change{.state = now()};  // the base is the model at the start
  if (sides_.any_friction() || rests_from_start()) change = modes_after(now());
  if (!change.failure.empty()) return ended_ = true, void(fail(change.failure));
  record(change);
  for (const std::size_t i : change.turned)
    if (sides_.is_stop(i) && !change.strikes(i))
      std::ranges::copy(sides_.events(i, start_), std::back_inserter(run_.events));
  const bool struck = !change.impacts.empty();  // the state before it stays
  if (sides_.any_active())
    set_model(sides_.model(*base_), change.state, struck);
  else if (struck)
    append_after_impulse(hand_over(*base_, change.state, model()).state);
} catch (const CannotFactorise& error) {
  ended_ = true, fail(error.what());
}

// Of several that are set at one time all act at once: what gives way is found anew from where the first of
// them found it, and what was gone through on the way is none of the motion. Where no modes are found the
// next step says so, if the forces are still these.
void Stepper::Loop::set_force(int node, const Vec3& force) try {
  const auto pushed = pushed_model(*base_, run_.trajectory.structure().loads.size(), node, force);
  if (ended_ || !pushed) return;
  if (!pushed_) {
    const bool first_of_all = run_.trajectory.size() == 1 && new_ == 0;  // it goes
    Archive sides;
    sides_.archive(sides);
    pushed_ = Pushed{in_base(now()),
                     sides.bytes(),
                     run_.trajectory.size() - (first_of_all ? 1 : 0),
                     run_.events.size(),
                     run_.warnings.size(),
                     crowd_time_,
                     crowd_};
  }
  base_ = pushed;
  auto told = std::exchange(on_step, {});
  enter_pushed();
  while (watched() && crowd_ < stepping::most_switches) {
    const std::vector<std::size_t> over = passed();
    if (over.empty()) break;
    if (act(over)) continue;
    run_.status = RunStatus::completed;
    run_.message.clear();
    enter_pushed();
    break;
  }
  on_step = std::move(told);
  State last = now();
  while (run_.trajectory.size() > pushed_->states) run_.trajectory.pop_back();
  run_.trajectory.change_model(present_);
  append(std::move(last), StepReport{});
} catch (const CannotFactorise& error) {
  ended_ = true, fail(error.what());
}

// The present time with the forces as they are, and what holds as the first of them found it.
void Stepper::Loop::enter_pushed() {
  Archive sides(pushed_->sides);
  sides_.archive(sides);
  run_.events.resize(pushed_->events);
  run_.warnings.resize(pushed_->warnings);
  crowd_time_ = pushed_->crowd_time;
  crowd_ = pushed_->crowd;
  in_step_ = 0;
  if (sides_.any_active())
    set_model(sides_.model(*base_), pushed_->from, true);
  else
    enter(base_, pushed_->from, true);
}

bool Stepper::Loop::act(const std::vector<std::size_t>& which, const VectorXd& left) {
  if (now().t - crowd_time_ > stepping::one_time * run_.options.step) crowd_time_ = now().t, crowd_ = 0;
  const long most = stepping::most_switches + 2 * static_cast<long>(sides_.size());
  // Rebounds that lose nothing come to an end, if late.
  const bool lossless = std::ranges::all_of(
      which, [&](std::size_t i) { return sides_.is_stop(i) && sides_.stops()[i].restitution == 1; });
  constexpr long lossless_share = 20;
  const long counts = lossless ? 1 : lossless_share, room = lossless_share * stepping::most_in_step * most;
  in_step_ += counts;
  const bool crowded = ++crowd_ == most || (in_step_ >= room && in_step_ - counts < room);
  if (crowded) return hold_what_touches();
  if (crowd_ > 2 * most || in_step_ > room + lossless_share * most) return stop_watching();
  ModeChange change = modes_after(in_base(now()), which, left);
  // What drives or pushes may begin with nothing: a moment later it is seen what must give way to it.
  if (change.failure.empty() && !change.changed && change.impacts.empty())
    change = modes_after(in_base(now()), which, left, stepping::moment * run_.options.step);
  return apply(change);
}

}  // namespace unfurl
