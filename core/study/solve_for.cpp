// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/solve_for.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"

namespace unfurl {
namespace {

constexpr double last_digits = 1e-12;  // of a target: a measure that comes so near and no nearer meets it

class Search {
 public:
  Search(const Objective& f, double target, const SolveOptions& options, const StudyHooks& hooks)
      : f_(f), target_(target), o_(options), hooks_(hooks) {}

  Solved run() {
    if (o_.low < o_.high)
      bracket_given();
    else
      bracket_around();
    refine();
    refuse_jump();
    // The best may lie beside a bracket that closed to the last digits.
    return {best_.x, best_.value, std::min({a_.x, b_.x, best_.x}), std::max({a_.x, b_.x, best_.x}),
            std::move(seen_)};
  }

 private:
  Evaluation at(double x) {
    if (hooks_.stopped()) throw Cancelled();
    if (static_cast<int>(seen_.size()) >= o_.most)
      give_up("no answer after " + std::to_string(o_.most) + " runs");
    const double begin = now();
    const Evaluation e{x, f_(x)};
    took_ = now() - begin;
    if (seen_.empty()) first_took_ = took_;
    seen_.push_back(e);
    if (!std::isnan(e.value) && (seen_.size() == 1 || off(e) < off(best_) || std::isnan(best_.value)))
      best_ = e;
    return e;
  }
  double off(const Evaluation& e) const { return std::abs(e.value - target_); }
  double now() const { return o_.clock ? o_.clock() : thread_cpu_seconds(); }
  bool valid(const Evaluation& e) const { return !std::isnan(e.value); }
  bool exact(const Evaluation& e) const { return e.value == target_; }
  // To rounding of the target; zero is met by what is nothing beside the first value, or the next one to it
  // (of a rate of 0 an energy of some 1e-60 J is left): no closer, as values may rise with any power.
  bool meets(const Evaluation& e) const {
    const double first =
        seen_.empty() || !std::isfinite(seen_.front().value) ? 0 : std::abs(seen_.front().value);
    return exact(e) || off(e) <= (target_ == 0 ? 1e-30 * first : 4e-16 * std::abs(target_));
  }
  // To where the measure is not there; in units of what one begins with, whatever its unit.
  double closest(double x) const {
    const double begun = o_.start != 0 ? o_.start : std::max(std::abs(o_.low), std::abs(o_.high));
    return 1e-9 * std::max(std::abs(x), 1e-3 * (begun != 0 && std::isfinite(begun) ? std::abs(begun) : 1.0));
  }
  bool opposite(const Evaluation& a, const Evaluation& b) const {
    return valid(a) && valid(b) && (a.value < target_) != (b.value < target_);
  }

  [[noreturn]] void give_up(const std::string& why) const {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo, x0 = lo, x1 = -lo;
    for (const Evaluation& e : seen_)
      if (valid(e)) {
        lo = std::min(lo, e.value), hi = std::max(hi, e.value);
        x0 = std::min(x0, e.x), x1 = std::max(x1, e.x);
      }
    if (lo > hi) throw NotFound(why + "; no parameter that was tried gave a run with this measure");
    throw NotFound(why + "; for parameters from " + short_number(x0, 9) + " to " + short_number(x1, 9) +
                   " the measure runs from " + short_number(lo, 9) + " to " + short_number(hi, 9));
  }

  [[noreturn]] void give_up_at(const Evaluation& e, const std::string& why) const {
    const std::string reason = o_.why_none ? o_.why_none(e.x) : "";
    give_up(why + (reason.empty() ? "" : ": " + reason));
  }

  void bracket_given() {
    a_ = at(o_.low);
    b_ = at(o_.high);
    for (const Evaluation& end : {a_, b_}) {
      if (!valid(end))
        give_up_at(end, "the measure is not there at an end of --between, " + short_number(end.x, 9));
      if (meets(end)) return void(a_ = b_ = end);
    }
    if (opposite(a_, b_)) return;
    if (off(best_) <= last_digits * std::abs(target_)) return void(a_ = b_ = best_);
    give_up("the target does not lie between the ends of --between");
  }

  // Outwards to both sides in turn. An invalid x is a wall that is approached by halving.
  void bracket_around() {
    const Evaluation start = at(o_.start);
    if (!valid(start)) give_up_at(start, "the scene as it stands has no such measure");
    a_ = b_ = start;
    if (meets(start)) return;
    const double first = o_.start != 0 ? 0.02 * std::abs(o_.start) : 0.02;
    Side up{start, start, start, first}, down{start, start, start, -first};
    for (bool looked = false; up.open || down.open;) {
      if (advance(up) || advance(down)) return;
      const bool both = up.first.x != start.x && down.first.x != start.x;
      if (both && !std::exchange(looked, true) && in_dip(down.first, start, up.first)) return;
    }
    if (off(best_) <= last_digits * std::abs(target_)) return void(a_ = b_ = best_);  // beside a wall, too
    give_up("the target is not reached on either side of " + short_number(o_.start, 9) +
            (valid(turns_) ? "; it comes as near as " + short_number(turns_.value, 9) + " at " +
                                 short_number(turns_.x, 9) + " and turns back there"
                           : "") +
            (too_long_.empty()
                 ? ""
                 : "; at " + too_long_ + " a run takes too long to look further (--between does)"));
  }

  struct Side {
    Evaluation first, before, last;  // of the start, too, until there are more
    double stride, took = 0;
    bool open = true, walled = false;
  };

  bool advance(Side& side) {
    if (!side.open) return false;
    const Evaluation next = at(side.last.x + side.stride);
    const bool met = meets(next) || opposite(side.last, next);  // of a plateau from above, too
    side.took += took_;
    if (side.took > o_.patience_s && took_ > o_.patience_of_first * first_took_ && !met) {
      too_long_ = short_number(next.x, 9);
      side.open = false;
      return false;
    }
    if (!valid(next)) {
      side.walled = true;
      side.stride /= 2;
      side.open = std::abs(side.stride) > closest(side.last.x);
      return false;
    }
    if (met) {
      b_ = next, a_ = exact(next) || opposite(side.last, next) ? side.last : next;
      return true;
    }
    if (side.before.x != side.last.x && in_dip(side.before, side.last, next)) return true;
    if (side.before.x == side.last.x) side.first = next;
    side.before = std::exchange(side.last, next);
    side.stride *= side.walled ? 0.5 : 2;
    const double far = std::abs(side.last.x - o_.start), unit = std::max(std::abs(o_.start), 1.0);
    side.open = std::abs(side.stride) > closest(side.last.x) && far < 1e9 * unit;
    return false;
  }

  // Values of one side of the target of which that in the middle is nearest: others between them may lie on
  // the other side, or on it. A golden section, until what is left of the dip could not reach there: it falls
  // by its height once more at most where its parts are equal and it is convex, here by twice that.
  bool in_dip(Evaluation before, Evaluation middle, Evaluation behind) {
    constexpr int most_rounds = 60;  // to 3e-13 of the width
    const double nothing = 0;        // where many measures have their least
    if (off(before) < off(middle) || off(behind) < off(middle)) return false;
    const Touch touch = touch_of(before, middle, behind);
    bool reaches = true;
    for (int round = 0; round < most_rounds; ++round) {
      const double height = std::max(off(before), off(behind)) - off(middle);
      const double left = middle.x - before.x, right = behind.x - middle.x;
      const double ratio = std::max(left / right, right / left);
      reaches = off(middle) < 2 * ratio * height;
      if (!reaches) break;
      constexpr double golden = 0.3819660112501051;
      double x = middle.x + golden * (std::abs(left) < std::abs(right) ? right : -left);
      if (round == 0 && (before.x < nothing) != (behind.x < nothing) && middle.x != nothing) x = nothing;
      const bool is_behind = (x - middle.x) * right > 0;
      if (x == middle.x || x == before.x || x == behind.x) break;
      const Evaluation e = at(x);
      if (!valid(e)) break;
      if (meets(e) || opposite(middle, e)) {
        b_ = e, a_ = exact(e) || opposite(middle, e) ? (is_behind ? middle : before) : e;
        return true;
      }
      if (off(e) < off(middle))
        (is_behind ? before : behind) = std::exchange(middle, e);
      else
        (is_behind ? behind : before) = e;
      if (!valid(turns_) || off(middle) < off(turns_)) turns_ = middle;
    }
    if (!(off(middle) <= (reaches ? touch.by_width : touch.by_rounding))) return false;
    a_ = b_ = middle;
    return true;
  }

  // How near to the target a dip touches it that was looked at to its last digits, or until rounding hid it.
  // Next to its least the measure differs by c |x - x_0| or c |x - x_0|^2: by 1e-12 of the dip's height that
  // is 1e-12 or 1e-6 of its width. Rounding: the last four digits of the target, the last of the values.
  struct Touch {
    double by_width, by_rounding;
  };
  Touch touch_of(const Evaluation& before, const Evaluation& middle, const Evaluation& behind) const {
    double height = 0, size = 0;
    for (const Evaluation& e : {before, middle, behind})
      if (std::isfinite(e.value)) {
        height = std::max(height, off(e) - off(middle));
        size = std::max(size, std::abs(e.value));
      }
    const double slope = height / std::abs(behind.x - before.x);
    return {1e-12 * height + 1e-15 * slope * std::abs(middle.x),
            std::max(last_digits * std::abs(target_), 1e-15 * size)};
  }

  // Where between the ends the measure is not there: from both towards that by halving, until the root is on
  // one side.
  void leave(const Evaluation& hole) {
    double edges[] = {hole.x, hole.x};
    for (bool open = true; open;) {
      open = false;
      for (const bool second : {false, true}) {
        Evaluation& end = second ? b_ : a_;
        double& edge = edges[second ? 1 : 0];
        if (std::abs(edge - end.x) <= closest(end.x)) continue;
        open = true;
        const Evaluation e = at(0.5 * (end.x + edge));
        if (exact(e)) return void(a_ = b_ = e);
        if (opposite(end, e)) return void((second ? a_ : b_) = e);
        if (valid(e))
          end = e;
        else
          edge = e.x;
      }
    }
    give_up_at(hole, "the measure is not there for a parameter of " + short_number(hole.x, 9));
  }

  void refine() {
    int side = 0;  // which end stayed last time (Illinois)
    bool tried_nothing = false;
    double fa = a_.value - target_, fb = b_.value - target_;
    while (a_.x != b_.x && !exact(best_)) {
      const double width = std::abs(b_.x - a_.x);
      if (width <= o_.x_tolerance * std::max(std::abs(a_.x), std::abs(b_.x))) return;
      double x = (a_.x * fb - b_.x * fa) / (fb - fa);
      if (!std::isfinite(x) || (x - a_.x) * (x - b_.x) >= 0 || ++slow_ % 4 == 0) x = 0.5 * (a_.x + b_.x);
      // An answer of nothing: no width is small beside it.
      const bool nothing = a_.x * b_.x < 0 && !std::exchange(tried_nothing, true);
      if (nothing) x = 0;
      const Evaluation e = at(x);
      if (nothing && !valid(e)) continue;
      // Beside what is not endless of the ends; of those one may be.
      const double scale = std::max(std::isinf(fa) ? 0 : std::abs(fa), std::isinf(fb) ? 0 : std::abs(fb));
      if (constexpr double rounding = 1e-15; nothing && off(e) <= rounding * scale) {
        a_ = b_ = best_ = e;
        return;
      }
      if (!valid(e)) {
        leave(e);
        fa = a_.value - target_, fb = b_.value - target_;
        side = 0;
        continue;
      }
      const double fe = e.value - target_;
      if ((fe < 0) == (fa < 0)) {
        a_ = e, fa = fe;
        if (side == 1) fb /= 2;
        side = 1;
      } else {
        b_ = e, fb = fe;
        if (side == -1) fa /= 2;
        side = -1;
      }
    }
  }

  // A bracket that closed on a jump holds no root. What is small is so beside the target, or where that is
  // zero beside what else was met.
  void refuse_jump() const {
    const double jump = std::abs(b_.value - a_.value);
    double scale = std::abs(target_);
    for (const Evaluation& e : seen_)
      if (target_ == 0 && std::isfinite(e.value)) scale = std::max(scale, std::abs(e.value));
    if (off(best_) <= 1e-6 * scale || jump < 1e-4 * scale) return;
    throw NotFound("the measure jumps over the target at " + short_number(b_.x, 9) + ", from " +
                   short_number(a_.value, 9) + " to " + short_number(b_.value, 9) +
                   (std::isinf(jump) ? "; a later solver.end_time may help" : ""));
  }

  const Objective& f_;
  double target_;
  const SolveOptions& o_;
  const StudyHooks& hooks_;
  Evaluation a_, b_, best_;
  Evaluation turns_{0,
                    std::numeric_limits<double>::quiet_NaN()};  // the nearest of a dip that was looked into
  std::vector<Evaluation> seen_;
  int slow_ = 0;
  double took_ = 0, first_took_ = 0;  // [s]
  std::string too_long_;
};

}  // namespace

Solved solve_for(const Objective& f, double target, const SolveOptions& options, const StudyHooks& hooks) {
  return Search(f, target, options, hooks).run();
}

}  // namespace unfurl
