// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/deployed_event.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/simulate/initial_state.hpp"

namespace unfurl {
namespace {

// States are solved at fold angles between `farthest_sample` and a twelfth of it [rad]. Below 2.5e-3
// round-off in the hinges, 1e-16/fold, begins to show; at nine points below 3e-2 the extrapolation error of a
// six-unit ring is of the order (0.01)^9. The fold rate varies on the scale sin(pi/n) of the fold angle: the
// farthest is halved until the rate changes by less than `even` over its outer half.
constexpr double span = 12, even = 0.1, smallest_farthest = 1e-4;
constexpr int points = 9;
// What the structure carries may move on a shorter scale than it unfolds: nets that strike, rods that swing.
// Where the rates that all samples give and those of one degree less differ by more than this share of the
// fastest, the samples lie too far apart, and are taken nearer by. (Rings stay below it at their own error.)
constexpr double smooth_enough = 1e-4;
// The same of axial forces of elastic rods, a share of the largest: waves change them sooner than rates.
constexpr double smooth_force = 1e-2;
// Before that, in rings of many units, theta theta' is nearly constant and a step of the run may be too long
// for the last of its way. A step is short enough where the trapezoidal rule of its end rates gives its
// change of the sine to this share: (r - 1)^2 / 4 r for rates of the ratio r, 1.1 here, which leaves 1e-9 s
// at four stages.
constexpr double short_enough = 2.3e-3;
// Released at rest from the sine s_0, time goes like sqrt(1 - s / s_0): samples keep well away from that.
constexpr double from_start = 0.25;
// Where the run last switched, or time had an edge, nearer by, the motion is followed back from there, to a
// little farther out than the samples. What makes it begin there may change its rates sooner than it does on
// the way of a run: 140 rad/s^2 at 4.5 rad/s leave 2e-11 s at twice as uneven a rate, and a stay of 200
// rad/s, which goes back past its largest rate, 5e-9 s where rates of samples are as rough as usual.
constexpr double from_switch = 0.95, farther = 1.05, even_behind_switch = 0.05, smooth_behind_switch = 1e-8;
constexpr int most_stations = 200;
constexpr double near_dead_centre = 0.95;  // sine of the fold angle
// Shares of a constraint's length: errors of the extrapolated pose above the first are taken away, by motions
// of up to the second times as much.
constexpr double extrapolated = 1e-13, fitting = 100;
// Lengths tried of a step that is to end near a sine: starts next to the pose need short ones.
constexpr int most_lengths = 40;

using Sample = NearDeployed;

VectorXd at_zero(const std::vector<Sample>& samples, const VectorXd& shares, VectorXd State::*part) {
  VectorXd sum = VectorXd::Zero((samples.front().state.*part).size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    sum += shares[static_cast<Index>(i)] * (samples[i].state.*part);
  return sum;
}

class Locator {
 public:
  Locator(const Trajectory& trajectory, const Model& model, Integrator& integrator, double h,
          std::size_t first, bool touched = false)
      : trajectory_(trajectory),
        system_(model.system),
        integrator_(integrator),
        h_(h),
        first_(first),
        followed_(model.system),
        index1_(followed_, true) {
    if (touched) sense_ = find_sense();
  }

  std::optional<State> locate() {
    if (!find_samples()) return std::nullopt;
    return extrapolate();
  }

  // The nearest state that steps set out from farther off than samples lie.
  State far_off() {
    resolved_ = trajectory_.size() - 1;
    if (sine(trajectory_.state(first_)) < farther * farthest_sample) go_back(farther * farthest_sample);
    return last_before(farthest_sample);
  }

  // At a time before the pose, next to it.
  std::optional<State> locate_before(double t) {
    if (!find_samples()) return std::nullopt;
    for (Sample& sample : samples_) sample.sine = t - sample.state.t;
    if (std::ranges::any_of(samples_, [](const Sample& s) { return !(s.sine > 0); })) return std::nullopt;
    const VectorXd shares = shares_at_zero(samples_, static_cast<int>(samples_.size()) - 1);
    State out = samples_.back().state;
    out.t = t;
    out.z = at_zero(samples_, shares, &State::z);
    out.w = at_zero(samples_, shares, &State::w);
    tension_at_zero(system(), samples_, out);
    if (!out.z.allFinite()) return std::nullopt;
    fit(out);
    samples_ = {};
    keep(0, std::move(out));
    if (samples_.empty()) return std::nullopt;
    samples_.back().state.t = t;
    return samples_.back().state;
  }

 private:
  bool find_samples() {
    find_resolved();
    const double start = sine(trajectory_.state(0)), room = sine(trajectory_.state(first_));
    double far = std::min(farthest_sample, from_start * start);
    const bool back = first_ > 0 && from_switch * room < far;
    if (back) go_back(farther * far);
    // The samples that say most of the pose.
    double least = std::numeric_limits<double>::infinity();
    for (far = reach(far, back ? even_behind_switch : even);; far *= 0.25) {
      sample(far);
      const double rough = roughness();
      if (rough < 0.1 * least || best_.empty()) {
        best_ = samples_;
        least = rough;
      }
      if (!(least > (back ? smooth_behind_switch : smooth_enough)) || far < 4 * smallest_farthest) break;
    }
    samples_ = std::move(best_);
    return samples_.size() >= 3;
  }

  // Stations of the motion that leads to the first state, until so far out.
  void go_back(double out) {
    State from = trajectory_.state(first_);
    for (int i = 0; i < most_stations && sine(from) < out; ++i) {
      const double rate = sine_rate(from), step = std::min(h_, (out - sine(from)) / -rate);
      if (!(rate < 0) || !add_station(from, -step, sine(from), std::numeric_limits<double>::infinity()))
        break;
      from = stations_.back().state;
    }
    std::ranges::reverse(stations_);
  }

  void sample(double far) {
    samples_.clear();
    const double near = far / span;
    for (int i = 0; i < points; ++i) {
      const double u = 0.5 - 0.5 * std::cos(pi * (i + 0.5) / points);
      solve_to(far + u * (near - far));
    }
  }

  // How far the rates of the deployed pose depend on the highest degree, as a share of the fastest.
  double roughness() {
    if (samples_.size() < 3) return std::numeric_limits<double>::infinity();
    const int most = static_cast<int>(samples_.size()) - 1;
    const VectorXd w = at_zero(samples_, shares_at_zero(samples_, most), &State::w),
                   lower = at_zero(samples_, shares_at_zero(samples_, most - 1), &State::w);
    const double of_rates = (w - lower).lpNorm<Eigen::Infinity>() / w.lpNorm<Eigen::Infinity>();
    if (system().giving_rods().empty()) return of_rates;
    const MatrixXd tension = tensions(system(), samples_);
    const double of_forces = (tension * (shares_at_zero(samples_, most) - shares_at_zero(samples_, most - 1)))
                                 .lpNorm<Eigen::Infinity>() /
                             tension.lpNorm<Eigen::Infinity>();
    return std::max(of_rates, smooth_enough / smooth_force * of_forces);
  }

  double reach(double far, double most_uneven) {
    for (; far > smallest_farthest; far *= 0.5) {
      samples_.clear();
      solve_to(far);
      solve_to(0.5 * far);
      if (samples_.size() < 2) continue;
      const double outer = sine_rate(samples_[0].state), inner = sine_rate(samples_[1].state);
      if (std::abs(outer - inner) < most_uneven * std::abs(inner)) break;
    }
    samples_.clear();
    return far;
  }

  // What remains, or what goes through zero with it where that is touched.
  double sine(const State& s) {
    const double left = remaining(s);
    if (sense_ == Sense::passes) return left;
    const double sine = sense_ == Sense::squared ? std::sqrt(std::max(left, 0.0)) : left;
    return remaining_rate(s) > 0 ? -sine : sine;
  }
  double sine_rate(const State& s) {
    const double rate = remaining_rate(s);
    if (sense_ == Sense::passes) return rate;
    return -std::abs(rate) / (sense_ == Sense::squared ? 2 * std::sqrt(std::max(remaining(s), 0.0)) : 1.0);
  }
  double remaining(const State& s) {
    q_.resize(system().coordinates());
    system().expand(s.z, q_);
    return trajectory_.structure().deployment.remaining(q_, s.angles);
  }
  double remaining_rate(const State& s) {
    q_.resize(system().coordinates());
    v_.resize(q_.size());
    system().expand(s.z, q_);
    system().expand_rate(s.w, v_);
    return trajectory_.structure().deployment.remaining_rate(q_, v_);
  }

  // An angle without an axis has a kink where its sides lie in line; a length has its largest value there,
  // and its rate falls to 3/4 in a quarter of the time.
  enum class Sense { passes, turns, squared };
  Sense find_sense() {
    const State& last = trajectory_.state(trajectory_.size() - 1);
    State next = last;
    const double rate = remaining_rate(last);
    integrator_.restart();
    if (!integrator_.step(next, 0.5 * remaining(last) / -rate).ok()) return Sense::squared;
    return remaining_rate(next) < 0.875 * rate ? Sense::turns : Sense::squared;
  }
  const System& system() const { return system_; }

  // How far the change of the sine from one state to the next differs from h (r_0 + r_1) / 2, as a share.
  double unevenness(const State& a, const State& b) {
    const double change = sine(b) - sine(a);
    return std::abs(0.5 * (b.t - a.t) * (sine_rate(a) + sine_rate(b)) / change - 1);
  }

  // The last state of the run behind a step that was short enough; where none was, behind the best one. Not
  // as far back as a dead centre: there a motion grows by the same share in every step, however short its
  // way.
  void find_resolved() {
    resolved_ = trajectory_.size() - 1;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = resolved_; i > first_ && sine(trajectory_.state(i - 1)) < near_dead_centre; --i) {
      const double now = unevenness(trajectory_.state(i - 1), trajectory_.state(i));
      if (now < best) resolved_ = i;
      best = std::min(best, now);
      if (best <= short_enough) return;
    }
  }

  State last_before(double target) {
    for (auto s = stations_.rbegin(); s != stations_.rend(); ++s)
      if (s->sine > 1.0001 * target) return s->state;
    std::size_t i = resolved_;
    while (i > first_ && sine(trajectory_.state(i)) < 1.0001 * target) --i;
    return trajectory_.state(i);
  }

  // From the last state before `target`, in one step that is short enough or with stations on the way.
  void solve_to(double target) {
    for (int i = 0; i < most_stations; ++i) {
      const State from = last_before(target);
      if (step_to(from, target, short_enough)) return;
      const double rate = sine_rate(from), half = 0.5 * (sine(from) - target);
      if (!add_station(from, std::min(h_, rate < 0 ? half / -rate : h_), 1.0001 * target, sine(from))) break;
    }
    step_to(last_before(target), target, std::numeric_limits<double>::infinity());
  }

  // One step, its length found by the secant method; any sine within 2 % of the target will do: targets lie
  // at least 5 % apart, and no two samples may coincide.
  bool step_to(const State& from, double target, double most_uneven) {
    const double s0 = sine(from), rate0 = sine_rate(from);
    double lo = 0, f_lo = s0 - target;
    double step = std::min(1.2 * h_, rate0 < 0 ? f_lo / -rate0 : h_);
    for (int it = 0; it < most_lengths; ++it) {
      State to = from;
      integrator_.restart();
      if (!integrator_.step(to, step).ok()) {
        step = 0.5 * (lo + step);
        continue;
      }
      const double f = sine(to) - target;
      if (std::abs(f) < 0.02 * target) {
        if (unevenness(from, to) > most_uneven) return false;
        keep(f + target, std::move(to));
        return true;
      }
      const double slope = (f - f_lo) / (step - lo);
      if (f > 0) {
        if (unevenness(from, to) > most_uneven) return false;
        lo = step;
        f_lo = f;
      }
      const double next = step - f / slope, share = next / step;
      step = share < 0.2 ? 0.2 * step : share > 2.0 ? 2.0 * step : next;  // backwards, too
    }
    return false;
  }

  // A state that a step of this length or a shorter one leads to, between two sines.
  bool add_station(const State& from, double step, double low, double high) {
    for (int it = 0; it < 12; ++it, step *= 0.6) {
      State to = from;
      integrator_.restart();
      if (!integrator_.step(to, step).ok()) continue;
      const double at = sine(to);
      if (!(at > low && at < high) || unevenness(from, to) > short_enough) continue;
      stations_.push_back({at, std::move(to)});
      return true;
    }
    return false;
  }

  // Multipliers of least norm from the equations: those of a step's end are not as accurate as its
  // coordinates.
  void keep(double at, State state) {
    VectorXd acceleration(state.w.size());
    followed_.follow(state);
    if (index1_.evaluate(state, acceleration, state.lambda)) samples_.push_back({at, std::move(state)});
  }

  // Everything as a function of the sine, at zero.
  std::optional<State> extrapolate() {
    const int most = static_cast<int>(samples_.size()) - 1;
    const VectorXd shares = shares_at_zero(samples_, most);  // interpolation
    State out = samples_.front().state;
    out.t = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      out.t += shares[static_cast<Index>(i)] * samples_[i].state.t;
    out.z = at_zero(samples_, shares, &State::z);
    out.w = at_zero(samples_, shares, &State::w);
    tension_at_zero(system(), samples_, out);
    if (!std::isfinite(out.t) || !out.z.allFinite()) return std::nullopt;
    fit(out);
    followed_.follow(samples_.front().state);
    followed_.count_on(out);
    out.lambda = multipliers_at_deployed(index1_, samples_, out);
    return out;
  }

  // Where what is carried shakes the structure, the extrapolation leaves something of the constraints, which
  // takes a motion of about that size away.
  void fit(State& state) {
    if (!(error(state) > extrapolated)) return;
    State fitted = state;
    project(system(), fitted);
    if (error(fitted) < error(state) && (fitted.z - state.z).lpNorm<Eigen::Infinity>() <
                                            fitting * system().constraint_lengths().maxCoeff() * error(state))
      state = std::move(fitted);
  }
  double error(const State& state) {  // the largest of a constraint, as a share of its length
    if (system().constraints() == 0) return 0.0;
    VectorXd phi(system().constraints());
    q_.resize(system().coordinates());
    const System near = system().at(state);
    near.expand(state.z, q_);
    near.constraint(state.t, q_, phi);
    return phi.cwiseQuotient(system().constraint_lengths()).lpNorm<Eigen::Infinity>();
  }

  const Trajectory& trajectory_;
  const System& system_;
  Integrator& integrator_;
  double h_;
  std::size_t first_;
  System followed_;
  Index1 index1_;
  std::vector<Sample> samples_, best_;
  std::vector<Sample> stations_;  // solved on the way, by falling sine
  std::size_t resolved_ = 0;      // the last state of the run to start from
  Sense sense_ = Sense::passes;
  VectorXd q_, v_;
};

}  // namespace

std::optional<State> locate_deployed(const Trajectory& trajectory, const Model& model, Integrator& integrator,
                                     double h, std::size_t first, bool touched) {
  return Locator(trajectory, model, integrator, h, first, touched).locate();
}
State far_off_deployed(const Trajectory& trajectory, const Model& model, Integrator& integrator, double h,
                       std::size_t first) {
  return Locator(trajectory, model, integrator, h, first).far_off();
}
std::optional<State> locate_before_deployed(const Trajectory& trajectory, const Model& model,
                                            Integrator& integrator, double h, std::size_t first, double t) {
  return Locator(trajectory, model, integrator, h, first).locate_before(t);
}

}  // namespace unfurl
