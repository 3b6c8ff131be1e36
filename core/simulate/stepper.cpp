// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/stepper.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/constraints/linear_rows.hpp"
#include "core/integrators/integrator.hpp"
#include "core/math/factors.hpp"
#include "core/math/lagrange.hpp"
#include "core/simulate/across_pose.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/run_words.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/simulate/stepper_loop.hpp"

namespace unfurl {

StepControl& Stepper::Loop::control() {
  if (controlled_ != &system()) {  // the first step, or the model has changed
    controlled_ = &system();
    control_.emplace(run_.trajectory.structure(), *controlled_, run_.options);
    if (const double h = std::exchange(last_step_, 0.0); h > 0) control_->continue_from(h);
  }
  return *control_;
}

// A step that led to a swing, be it from rest, and was too long for it did not follow it.
void Stepper::Loop::note_swing() {
  const auto& [omega, of_rates] = control_->swing();
  const std::size_t n = run_.trajectory.size();
  const double led_here = n > 1 ? now().t - run_.trajectory.time(n - 2) : 0.0;
  if (swing_ < 0 || led_here * of_rates > 2 * pi * swing_share_of(run_.options))
    swing_ = -1;
  else
    swing_ = std::max(swing_, omega);
}

// What is left of a step in which rates or forces have jumped, by what they are behind that.
void Stepper::Loop::plan_anew() {
  const double h = control().anew(now());
  if (!(now().t + 1.001 * h < target_)) return;
  control_->continue_from(h);
  target_ = now().t + h, edge_ = false;
}

// A longer step, as far as time has no edge, where this one begins or ends too close to a singular pose.
// The grid goes on after that.
bool Stepper::Loop::step_over(Probe& to, double& h) {
  for (const double length : {1.41, 1.73, 1.19, 2.24, 1.09, 2.77, 1.57, 3.37}) {
    if (now().t + length * h > std::min(until_, grid_.next_edge(now().t))) continue;
    Probe longer{.at = length * h, .state = now()};
    integrator_->restart();
    longer.report = take_step(*integrator_, longer.state, length * h);
    if (!longer.report.ok()) continue;
    part_end_ += (length - 1) * h;
    to = std::move(longer), h *= length;
    return true;
  }
  return false;
}

namespace {

// Of the forces of six states, does one not follow from the other five, as what grows without bound does not?
bool is_unbounded(const std::array<VectorXd, 6>& lambda, std::size_t nearest, const auto& place) {
  constexpr double smooth = 0.1, nothing = 1e-3;
  VectorXd told = VectorXd::Zero(lambda[0].size()), most = told;
  for (std::size_t k = 0; k < lambda.size(); ++k) {
    most = most.cwiseMax(lambda[k].cwiseAbs());
    if (k == nearest) continue;
    const auto others = [&](std::size_t other) { return place(other < nearest ? other : other + 1); };
    told += lagrange_weight(k < nearest ? k : k - 1, lambda.size() - 1, place(nearest), others) * lambda[k];
  }
  const double largest = most.size() > 0 ? most.maxCoeff() : 0.0;
  for (Index r = 0; r < most.size(); ++r)
    if (most[r] > nothing * largest && std::abs(told[r] - lambda[nearest][r]) > smooth * most[r]) return true;
  return false;
}

// Which coordinates rows join to one that they leave free in a pose and hold in another.
std::vector<bool> joined_to_weak(const System& system, const VectorXd& z, const VectorXd& other) {
  constexpr double lost = 1e-5, own = 0.5, some = 1e-3;
  SparseRows G = system.jacobian_pattern();
  const auto free = [&](const VectorXd& at) {
    VectorXd q(system.coordinates());
    std::vector<double> scratch;
    system.expand(at, q);
    system.jacobian(q, G, scratch);
    return column_complement(MatrixXd(G).rowwise().normalized().transpose(), lost);
  };
  const MatrixXd here = free(z), there = free(other);
  const MatrixXd weak = column_space(here - there * (there.transpose() * here), own);
  std::vector<bool> joined(static_cast<std::size_t>(z.size()));
  for (Index i = 0; i < z.size(); ++i)
    joined[static_cast<std::size_t>(i)] = weak.cols() > 0 && weak.row(i).cwiseAbs().maxCoeff() > some;
  for (bool more = true; more;) {
    more = false;
    for (Index r = 0; r < G.rows(); ++r) {
      bool any = false, all = true;
      for (SparseRows::InnerIterator it(G, r); it; ++it) {
        const bool is = joined[static_cast<std::size_t>(it.col())];
        any = any || is, all = all && is;
      }
      if (!any || all) continue;
      more = true;
      for (SparseRows::InnerIterator it(G, r); it; ++it) joined[static_cast<std::size_t>(it.col())] = true;
    }
  }
  return joined;
}

}  // namespace

// A step that ends in a singular pose, as where its grid brings one: what rows join to its weak directions is
// taken from the polynomial through the states of shorter and longer ones, which rounding leaves their
// digits; of shorter ones alone where time has an edge. The next step begins there as a run does. Where
// forces grow without bound towards the pose none can: it stays a weak end.
void Stepper::Loop::settle_in_pose(Probe& to, double h) {
  constexpr std::size_t states = 6;
  constexpr double apart = 0.004;  // of the structure's size, at most, and of a step:
  constexpr double share_apart = 0.3;
  constexpr double least = 1e-4;  // of the structure's size: what does not move is where it is
  to.report.weak_end = false;
  const double way = fastest_way(to) / reference_length(base_->structure),
               share = std::min(share_apart, apart / way), edge = grid_.next_edge(now().t);
  if (!(way > least) || std::max(system().constraints(), system().solved_coordinates()) > max_singular_size)
    return;
  const auto integrator = fresh_integrator();
  State out, beside;
  std::array<VectorXd, states> lambda;
  const auto gather = [&](const auto& length) {
    out = to.state;
    for (VectorXd* x : {&out.z, &out.w, &out.lambda}) x->setZero();
    for (std::size_t k = 0; k < states; ++k) {
      State state = now();
      integrator->restart();
      const StepReport report = integrator->step(state, length(k) * h);
      if (!report.ok() || report.weak_end || state.lambda.size() != out.lambda.size()) return false;
      const double weight = lagrange_weight(k, states, 1.0, length);
      out.z += weight * state.z;
      out.w += weight * state.w;
      out.lambda += weight * state.lambda;
      lambda[k] = state.lambda;
      if (k == 0) beside = std::move(state);
    }
    return true;
  };
  to.report.weak_end = true;
  bool barred = false;
  for (const double other : {1.0, 0.83, 0.91, 0.71, 0.59}) {  // some may end where no step can
    barred = edge < grid_.end() && now().t + (1 + 3 * other * share) * h > edge;
    const double d = other * (barred ? std::min(share, 0.5 * share_apart) : share);
    const auto length = [&](std::size_t k) {
      return 1 + d * (static_cast<double>(k) - (barred ? 6 : k < states / 2 ? 3 : 2));
    };
    if (!gather(length)) continue;
    to.report.weak_end = is_unbounded(lambda, barred ? states - 1 : states / 2 - 1, length);
    break;
  }
  if (to.report.weak_end) return;
  const std::vector<bool> joined = joined_to_weak(system(), out.z, beside.z);
  State settled = to.state;
  for (Index i = 0; i < out.z.size(); ++i)
    if (joined[static_cast<std::size_t>(i)]) settled.z[i] = out.z[i], settled.w[i] = out.w[i];
  settled.lambda = std::move(out.lambda);
  if (system().followed_angles() > 0) system().at(now()).count_on(settled);
  const auto step = [&](State& state, double length) { return integrator->step(state, length); };
  State next = settled;
  integrator->restart();
  if (!step(next, h).ok() &&
      !step_in_parts(*integrator, next, h, step).ok()) {  // as where a load begins there
    to.report.weak_end = true;
    return;
  }
  to.state = std::move(settled);
  integrator_->restart();
}

// The first crossing up to `to`, in a step of size h.
std::optional<Crossing> Stepper::Loop::find_crossing(Probe& to, double h) {
  sides_.measure(model(), to.state, true, to);
  begin_.at = 0;
  std::optional<AcrossPose> across;
  double unsolved = std::numeric_limits<double>::infinity();
  const auto step = [this](State& state, double length) {
    if (!probing_) probing_ = fresh_integrator();
    probing_->restart();
    return take_step(*probing_, state, length);
  };
  const Solve solve = [&](double length, Probe& probe) {
    probe.at = length;
    probe.state = led_way_ ? led_way_(now().t + length) : now();
    probe.report = led_way_ ? StepReport{} : step(probe.state, length);
    if (!probe.report.ok() && deployment_.empty()) {  // too long for what swings faster, as a whole
      probe.state = now();
      if (at_its_end(model().structure, system().at(now()), now(), length).empty())
        probe.report = step_in_parts(*probing_, probe.state, length, step);
      if (!probe.report.ok()) unsolved = std::min(unsolved, length);
    } else if (!probe.report.ok()) {
      if (!across) {
        const double longest = 1.5 * std::max(h, to.at);  // beyond the run's end, and an edge of time
        const std::shared_ptr<const Model> smooth = smooth_model(run_.trajectory.time(smooth_since()));
        const auto integrator = fresh_integrator(*find_method(run_.options.method), smooth->system);
        const State from = far_off(*smooth, *integrator, h);
        constexpr int count = 32;
        std::vector<double> lengths;
        for (int k = 1; k <= count; ++k) lengths.push_back((now().t - from.t + longest) * k / count);
        across.emplace(from, lengths, [&](State& state, double part) {
          integrator->restart();
          return integrator->step(state, part).ok();
        });
      }
      if (across->at(system(), now().t + length, probe.state))
        probe.report = {};
      else
        unsolved = std::min(unsolved, length);
    }
    if (probe.report.ok()) sides_.measure(model(), probe.state, true, probe);
    return probe.report.ok();
  };
  auto crossing = first_crossing(begin_, to, between(to, to.at < h), solve);
  if (!crossing) return crossing;
  if (crossing->probe.at >= unsolved - 1e-6 * h) crossing->later = to.at - crossing->probe.at;
  const double of_time = jump_width * now().t / to.at;
  crossing->left = (stepping::located + of_time) * begin_.forces.cwiseMax(to.forces);
  return crossing;
}

// A drive's velocity jumps: what it drives is taken along by an impulse of the constraints.
bool Stepper::Loop::jump(double t) {
  // What the method's rates drift from what is held is no leaving and no impact.
  State before = sides_.any_active() ? hand_over(model(), now(), model()).state : now();
  drift(system(), before, t - before.t);
  before.t = t;
  if (sides_.empty()) return append_after_impulse(hand_over(model(), before, model()).state), true;
  sides_.touch(system(), before);
  ModeChange change = modes_after(hand_over(model(), before, *base_).state);
  if (change.failure.empty() && !change.changed && change.impacts.empty())
    return append_after_impulse(hand_over(*base_, change.state, model()).state), true;
  return apply(change);
}

bool Stepper::Loop::go_to(Crossing crossing) {
  const double t = now().t + crossing.probe.at;
  if (crossing.later > 0)
    run_.warnings.push_back(
        "at t = " + seconds(t) +
        ": a stop, a cable or friction changes next to a singular pose, where no step can be solved; it does "
        "so later by less than " +
        seconds(crossing.later));
  if (t > now().t) {
    crossing.probe.state.t = t;
    if (!stays_in_pose(crossing.probe) && !led_way_ && ends_in_pose(crossing.probe))
      end_in_pose(crossing.probe, crossing.probe.at);
    crossing.probe.state.t = t;
    go_led_way(t);
    come_nearer(crossing.probe.state);
    go_on(std::move(crossing.probe.state), crossing.probe.report);
    integrator_->restart();
  }
  have_begin_ = false;
  return act(crossing.which, crossing.left);
}

// Margins inside a step, as hints: on the cubic through the coordinates and rates of both ends, as long as
// the step's own polynomial says the same; else on that, in more parts, with the forces of what is held in
// all of them, which cost a factorisation each. A method without a polynomial does not follow within a step
// what its ends' cubic does not. `cut_off`: it ends in a singular pose, where rates say little.
MatrixXd Stepper::Loop::between(const Probe& to, bool cut_off) {
  const auto count = static_cast<Index>(sides_.size());
  MatrixXd margins(count, stepping::parts - 1);
  VectorXd fastest = VectorXd::Zero(count);
  Probe p;
  const auto take = [&](Index column, bool forces) {
    sides_.measure(model(), p.state, forces, p);
    margins.col(column) = p.margins;
    for (Index i = 0; i < count; ++i) fastest[i] = std::max(fastest[i], std::abs(p.rates[i]));
  };
  // From so little of the way on margins are compared: they may change by less, of what moves together.
  constexpr double may_differ = 1e-4;
  const double way = fastest_way(to);
  bool own = true, differs = false;
  VectorXd z, w;
  for (int k = 1; k < stepping::parts; ++k) {
    const double share = static_cast<double>(k) / stepping::parts, t = now().t + to.at * share;
    p.state = led_way_ ? led_way_(t) : on_cubic(now(), to.state, t);
    if (own && !led_way_ && (k == 2 || k == 5)) {
      own = integrator_->inside(now(), to.at, share, z, w);
      differs = differs || (own && (z - p.state.z).lpNorm<Eigen::Infinity>() > may_differ * way);
    }
    take(k - 1, 2 * k == stepping::parts);
  }
  if (!own && !led_way_) {
    const VectorXd even = 0.5 * to.at * (begin_.rates + to.rates);
    if (!cut_off) warn_of_long_step(to, to.margins - begin_.margins - even, fastest);
  } else if (differs && leaves_cubic(to, margins)) {
    margins.resize(count, stepping::fine_parts - 1);
    for (int k = 1; k < stepping::fine_parts; ++k) {
      inside(to, static_cast<double>(k) / stepping::fine_parts, p.state);
      take(k - 1, true);
    }
    inside(to, 1, p.state);
    sides_.measure(model(), p.state, false, p);
    warn_of_long_step(to, to.at * (p.rates - to.rates), fastest);
  }
  return margins;
}

// At a share of the step, by its own polynomial; false where there is none.
bool Stepper::Loop::inside(const Probe& to, double share, State& state) {
  state = on_cubic(now(), to.state, now().t + to.at * share);
  return integrator_->inside(now(), to.at, share, state.z, state.w);
}

// Is the step's own polynomial there off the cubic of its ends by a part of the way?
bool Stepper::Loop::off_cubic(const Probe& to, double share, State& state) {
  if (!inside(to, share, state)) return false;
  const VectorXd off = state.z - on_cubic(now(), to.state, state.t).z;
  return off.lpNorm<Eigen::Infinity>() > stepping::cubic_share * fastest_way(to);
}

// Or of what a stop's or cable's margin changes? At two of the parts: their difference may be zero at one of
// them.
bool Stepper::Loop::leaves_cubic(const Probe& to, const MatrixXd& margins) {
  constexpr double rounding = 1e4;
  Probe p;
  for (const int k : {2, 5}) {
    if (off_cubic(to, static_cast<double>(k) / stepping::parts, p.state)) return true;
    sides_.measure(model(), p.state, false, p);
    for (Index i = 0; i < static_cast<Index>(sides_.first_friction()); ++i) {
      double least = std::min(begin_.margins[i], to.margins[i]),
             most = std::max(begin_.margins[i], to.margins[i]);
      for (Index j = 0; j < margins.cols(); ++j) {
        least = std::min(least, margins(i, j));
        most = std::max(most, margins(i, j));
      }
      if (std::abs(p.margins[i] - margins(i, k - 1)) >
          std::max(stepping::cubic_share * (most - least), rounding))
        return true;
    }
  }
  return false;
}

// Of each stop and cable once, where it is within reach of a motion that turns round within the step faster
// than that follows. `off`: by what the step contradicts itself; `fastest`: the margins' rates.
void Stepper::Loop::warn_of_long_step(const Probe& to, const VectorXd& off, const VectorXd& fastest) {
  // A quarter comes of a force that begins with the step and grows with the square of time.
  constexpr double part_of_way = 0.3, rounding = 1e4;
  if (run_.options.adaptive || sides_.any_leaving()) return;
  for (std::size_t k = 0; k < sides_.first_friction(); ++k) {
    const auto i = static_cast<Index>(k);
    const double way = to.at * std::max({fastest[i], std::abs(begin_.rates[i]), std::abs(to.rates[i])});
    if (!(std::abs(off[i]) > std::max(part_of_way * way, rounding))) continue;
    if (std::min(begin_.margins[i], to.margins[i]) > way) continue;
    const std::string told = " does not resolve the motion towards " +
                             (sides_.is_stop(k) ? "stop " + sides_.stops()[k].name : sides_.cable(k).name);
    if (std::ranges::any_of(run_.warnings, [&](const auto& w) { return w.find(told) != w.npos; })) continue;
    run_.warnings.push_back(
        "at t = " + seconds(now().t) + ": the step of " + seconds(to.at) + told +
        ", which may act within a step and be missed; solver.step = " + seconds(0.25 * to.at));
  }
}

// Of each once.
void Stepper::Loop::warn_of_cable(std::size_t i, const State& state) {
  const std::string begin = "what " + sides_.cable(i).name + " holds ";
  if (std::ranges::any_of(run_.warnings, [&](const std::string& w) { return w.starts_with(begin); })) return;
  std::string told = cable_step_warning(sides_, i, base_->system.at(state), state, run_.options);
  if (!told.empty()) run_.warnings.push_back(std::move(told));
}

bool Stepper::Loop::stop_watching() {
  unwatched_until_ = target_;
  warn_once(": stops, cables or friction switch without end; what they do in this step is not located");
  if (sides_.relax_laws()) set_model(sides_.model(*base_), in_base(now()), true);
  return true;
}

Stepper::Stepper(std::shared_ptr<const Model> model, const SolverOptions& options)
    : Stepper(model, options, initial_state(model->structure, model->system).state) {}

Stepper::Stepper(std::shared_ptr<const Model> model, const SolverOptions& options, State start)
    : run_{.trajectory = Trajectory(model, options), .options = with_steps_inside(options)} {
  if (!find_method(options.method)) throw std::invalid_argument("no method is called " + options.method);
  run_.trajectory.append(std::move(start), StepReport{});
  loop_ = std::make_unique<Loop>(run_, std::move(model), time());
  loop_->begin_run();
}

Stepper::Stepper(std::shared_ptr<const Model> model, const SolverOptions& options, Archive& archived)
    : run_{.trajectory = Trajectory(model, options), .options = with_steps_inside(options)} {
  double start = 0;
  archived(start);
  loop_ = std::make_unique<Loop>(run_, std::move(model), start);
  loop_->archive(archived);
}

Stepper::~Stepper() = default;

bool Stepper::step() {
  return loop_->step();
}
bool Stepper::advance_to(double t, const std::function<bool()>& cancelled) {
  return loop_->advance_to(t, cancelled);
}
void Stepper::set_force(int node, const Vec3& force) {
  loop_->set_force(node, force);
}
Stepper::Window Stepper::take_window(std::size_t around) {
  return loop_->take_window(around);
}
std::size_t Stepper::first_new() const {
  return loop_->first_new();
}
void Stepper::archive(Archive& archive) {
  double start = loop_->start();
  archive(start);
  loop_->archive(archive);
}
double Stepper::swing() const {
  return loop_->swing();
}
void Stepper::stop() {
  loop_->end();
  run_.status = RunStatus::stopped;
  run_.message = "stopped by the user at t = " + seconds(time());
}
void Stepper::on_step(std::function<void(const State&, const StepReport&)> callback) {
  loop_->on_step = std::move(callback);
}

}  // namespace unfurl
