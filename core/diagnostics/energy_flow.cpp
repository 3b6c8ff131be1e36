// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/energy_flow.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/diagnostics/quintic.hpp"
#include "core/forces/elastic_rods.hpp"
#include "core/integrators/row_noise.hpp"
#include "core/math/barycentric.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/push_responses.hpp"
#include "core/simulate/stops.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {

bool motors_or_warmed(const Structure& s) {
  return std::ranges::any_of(s.forces,
                             [](const Force& f) { return f.motor.stall > 0 || f.unstressed.moves(); }) ||
         std::ranges::any_of(s.rods, [](const Rod& r) { return r.gives && r.expansion != 0; });
}

namespace {
constexpr double stiff_at = 2;  // times 1 / h, from which c / m is
}

EnergyMeter::EnergyMeter(const Model& model)
    : system_(model.system),
      loads_(system_.has_power(false)),
      dampers_(system_.has_power(true)),
      drives_(system_.rheonomic()),
      tables_(model.structure),
      damped_rods_(model.system) {
  if (idle()) return;
  const System& system = model.system;
  by_tension_ =
      drives_ || system.by_tension() || (system.elastic_rods() && system.elastic_rods()->has_power());
  index1_ = std::make_unique<Index1>(system_);
  q_.resize(system.coordinates());
  v_.resize(system.coordinates());
  stiff_rate_.resize(system.coordinates());
  unused_.resize(system.solved_coordinates());
  lambda_.resize(system.constraints());
  target_rate_.resize(system.constraints());
}

SolvedPoint EnergyMeter::at_state(const State& state) {
  SolvedPoint p{VectorXd(state.z.size()), VectorXd(lambda_.size()), true};
  system_.follow(state);
  if (p.known = index1_->evaluate(state, p.acceleration, p.lambda); !p.known) p.acceleration.setZero();
  return p;
}

double EnergyMeter::taken(const State& state) {
  if (!dampers_) return 0.0;
  system_.follow(state);
  system_.expand(state.z, q_);
  return system_.taken(q_);
}

VectorXd EnergyMeter::rod_forces(const State& state) {
  if (state.tension.size() > 0) return state.tension;
  VectorXd force(std::ssize(system_.giving_rods()));
  system_.expand(state.z, q_);
  system_.expand_rate(state.w, v_);
  system_.giving_rod_forces(state.t, q_, v_, force);
  return force;
}

// c / m of the strongest damper, from above [1/s].
double EnergyMeter::damping_bound(const State& state) {
  system_.expand(state.z, q_);
  system_.expand_rate(state.w, v_);
  system_.force_derivatives(state.t, q_, v_, derivatives_);
  damping_ = derivatives_.by_w.sum();
  if (rods_apart_) damping_ -= damped_rods_.derivative(system_, q_);
  return rate_bound(damping_, system_.moving_mass());
}

double EnergyMeter::dampers_take(double t, const VectorXd& v, const double* tension) const {
  return -system_.power(true, t, q_, v, tension) - (rods_apart_ ? damped_rods_.power(t, q_, v) : 0.0);
}

double EnergyMeter::energy(const State& state) {
  system_.follow(state);
  system_.expand(state.z, q_);
  return system_.kinetic_energy(state.w) + system_.potential_energy(q_) - system_.load_work(q_);
}

// The motion a time after the state, or before it; what depends on time itself, as what warms, by another.
double EnergyMeter::damping_power(const State& state, const VectorXd& acceleration, double after,
                                  double later) {
  system_.expand(state.z + after * state.w, q_);
  system_.expand_rate(stiff_.cwiseProduct(state.w + after * acceleration), v_);
  return dampers_take(state.t + later, v_, state.tension.size() > 0 ? state.tension.data() : nullptr);
}

// (P_0 + P_1) h / 2 + (P_0' - P_1') h^2 / 12, of order 4 where the power is smooth at the step; the second
// term bounded by the first where it is not. P' by central differences over a time in which hardly anything
// falls. Where c / m is too large for that, accelerations are the rounding of rates times c / m: there the
// power in the middle, by the cubic through coordinates and rates, says the same but for order 5 (and has the
// rounding of coordinates over h); the smaller one is taken, and none where they disagree in sign.
//
// A rate that is gone long before the step's end, with most of the power, or that has come about right behind
// its start, is not to be had from the ends, nor one that a method lets ring about what it is: it lost what
// the energies lost beyond the work of others, as in an impact, `lost`. What that is less than nothing, or
// more than these powers could take, is an error of the method, which the balance is to tell.
//
// Where the motion between the states has the same power, `between`, that is taken: what its interpolant is
// off where two motions are nearly one has a power of its own. All powers are those of what stiff dampers
// move.
double EnergyMeter::taken_by_stiff(const State& a, const State& b, double fastest, double between,
                                   double lost) {
  const double h = b.t - a.t, e = 1e-3 / fastest;
  // Of time itself into the step: at its ends something may begin.
  const auto rate = [&](const State& s, const VectorXd& acceleration, double inward) {
    return (damping_power(s, acceleration, e) - damping_power(s, acceleration, -e)) / (2 * e) +
           (damping_power(s, acceleration, 0, inward) - damping_power(s, acceleration, 0)) / inward;
  };
  constexpr double most = 10;  // times the power at the other end
  const double at_start = damping_power(a, before_.acceleration, 0),
               at_end = damping_power(b, after_.acceleration, 0);
  const bool gone = gone_ && (at_start > most * at_end || at_end > most * at_start);
  if (gone || rings_) {
    const double most_lost = std::max({h * most_power_, h * at_start, h * at_end, between, 0.0});
    return std::clamp(lost, 0.0, most_lost);
  }
  const double line = 0.5 * h * (at_start + at_end);
  double bend = h * h / 12 * (rate(a, before_.acceleration, e) - rate(b, after_.acceleration, -e));
  if (constexpr double too_large = 1e5; h * fastest > too_large) {
    const State middle{.t = a.t + 0.5 * h,
                       .z = 0.5 * (a.z + b.z) + h / 8 * (a.w - b.w),
                       .w = 1.5 / h * (b.z - a.z) - 0.25 * (a.w + b.w),
                       .lambda = {}};
    const double by_middle =
        2 * h / 3 * (damping_power(middle, after_.acceleration, 0) - 0.5 * (at_start + at_end));
    bend = bend * by_middle > 0 ? std::copysign(std::min(std::abs(bend), std::abs(by_middle)), bend) : 0.0;
  }
  const double by_states =
      bend > 0 ? line + std::min(bend, line) : line / (1 - bend / std::max(line, 1e-300));
  constexpr double least_share = 0.5, most_share = 1.01;
  return between >= least_share * by_states && between <= most_share * by_states ? between : by_states;
}

namespace {

// Of each coordinate one that stands for all that share its accelerations: by their masses, by rows; and by
// these dampers.
std::vector<Index> parts_of(const System& system, const SparseRows* dampers = nullptr) {
  std::vector<Index> to(static_cast<std::size_t>(system.solved_coordinates()));
  std::iota(to.begin(), to.end(), Index{0});
  const auto part = [&](Index i) {
    while (to[static_cast<std::size_t>(i)] != i) i = to[static_cast<std::size_t>(i)];
    return i;
  };
  const auto join = [&](const SparseRows& A) {
    for (int row = 0; row < A.outerSize(); ++row) {
      SparseRows::InnerIterator it(A, row);
      for (const Index first = it ? part(it.col()) : 0; it; ++it)
        to[static_cast<std::size_t>(part(it.col()))] = first;
    }
  };
  join(system.mass());
  join(system.jacobian_pattern());
  if (dampers) join(*dampers);
  for (Index& i : to) i = part(i);
  return to;
}

// At either end of a step, in the mean, and of what that is off the mean of the ends: squares.
struct Rates {
  double at_a = 0, at_b = 0, mean = 0, off = 0;
  // They are others behind the start, or before the end, than there: of the time between the mean alone
  // tells. A rate that falls as exp(-c t / m) has less than a sixth of the step for it.
  bool gone() const { return 9 * off > std::max({at_a, at_b, mean}); }
  // They change their sign from state to state.
  bool ring() const { return 2 * mean < std::min(at_a, at_b); }
};
// Of a part: its rates. Of what dampers join besides: those that they tell from what it does as a whole, by
// the powers that they would take of them.
struct PartRates {
  bool stiff = false;
  Rates all = {}, damped = {};
};

}  // namespace

// Where a stiff damper moves coordinates, accelerations are what rounding and the method leave of rates times
// c / m, there and in what hangs together with them. The rest tells their motion to order 4: the quintic is
// the cubic then.
EnergyMeter::Ends EnergyMeter::trusted_ends(const State& a, const State& b) {
  Ends ends{{.t = a.t, .z = a.z, .w = a.w, .lambda = {}},
            {.t = b.t, .z = b.z, .w = b.w, .lambda = {}},
            before_.acceleration,
            after_.acceleration};
  const double h = b.t - a.t;
  const SparseRows& by_w = damping_;
  if (parts_.empty()) parts_ = parts_of(system_), damped_ = parts_of(system_, &by_w);
  std::vector<PartRates> rates(parts_.size());
  gone_ = rings_ = false;
  most_power_ = 0;
  stiff_.setZero(a.w.size());
  const auto of = [&](const std::vector<Index>& parts, Index i) -> PartRates& {
    return rates[static_cast<std::size_t>(parts[static_cast<std::size_t>(i)])];
  };
  const auto square = [](double x) { return x * x; };
  const auto power = [&](const VectorXd& w) { return VectorXd(-w.cwiseProduct(by_w * w)); };
  const VectorXd m = system_.moving_mass(), bounds = rate_bounds(by_w, m), mean = (b.z - a.z) / h;
  const VectorXd of_a = power(a.w), of_b = power(b.w), of_mean = power(mean),
                 of_off = power(mean - 0.5 * (a.w + b.w));
  constexpr double of_energy = 1e-9;
  const double rounding = of_energy * std::max(system_.kinetic_energy(a.w), system_.kinetic_energy(b.w));
  for (Index i = 0; i < mean.size(); ++i) {
    if (std::isinf(m[i])) continue;
    PartRates& part = of(parts_, i);
    Rates& damped = of(damped_, i).damped;
    part.stiff |= h * bounds[i] > stiff_at;
    if (h * bounds[i] > stiff_at) stiff_[damped_[static_cast<std::size_t>(i)]] = 1;
    damped.at_a += of_a[i], damped.at_b += of_b[i], damped.mean += of_mean[i], damped.off += of_off[i];
    part.all.at_a += square(a.w[i]), part.all.at_b += square(b.w[i]), part.all.mean += square(mean[i]);
    part.all.off += square(mean[i] - 0.5 * (a.w[i] + b.w[i]));
  }
  for (Index i = 0; i < mean.size(); ++i) {
    const PartRates& part = of(parts_, i);
    if (!part.stiff) continue;
    const Rates& damped = of(damped_, i).damped;
    gone_ = gone_ || part.all.gone() || (damped.gone() && h * damped.off > rounding);
    rings_ = rings_ || (damped.ring() && h * std::min(damped.at_a, damped.at_b) > rounding);
    if (part.all.gone()) ends.a.w[i] = ends.b.w[i] = mean[i];
    const double at_a = ends.a.w[i], at_b = ends.b.w[i];
    ends.by_a[i] = (6 * mean[i] - 4 * at_a - 2 * at_b) / h;
    ends.by_b[i] = (2 * at_a + 4 * at_b - 6 * mean[i]) / h;
  }
  for (Index i = 0; i < mean.size(); ++i) {
    const Rates& damped = rates[static_cast<std::size_t>(i)].damped;  // of those that it stands for
    most_power_ += std::max({damped.at_a, damped.at_b, damped.mean, damped.off});
    stiff_[i] = stiff_[damped_[static_cast<std::size_t>(i)]];
  }
  return ends;
}

namespace {

// Accelerations of the cubic through coordinates and rates.
std::pair<VectorXd, VectorXd> cubic_ends(const State& a, const State& b) {
  const double h = b.t - a.t;
  const VectorXd mean = (b.z - a.z) / h;
  return {(6 * mean - 4 * a.w - 2 * b.w) / h, (2 * a.w + 4 * b.w - 6 * mean) / h};
}

}  // namespace

// What rods pull with that a step has found at its own points.
VectorXd EnergyMeter::between_stages(const State& b, double u) const {
  return b.stage_tension * Barycentric(own_.nodes).values(u);
}

// What the equations say is round-off over a small number next to a singular pose, as a flat ring of many
// units is, and what of forces that jump at an end may be of its other side. Where a quartic through all the
// rest tells grossly another end, that one is taken; where both ends are as far off what rates tell, the
// cubic.
void EnergyMeter::smooth_ends(const State& a, const State& b) {
  constexpr double gross = 0.25;  // of the largest; a smooth motion is off by order 3 in the step
  const auto [by_rates_a, by_rates_b] = cubic_ends(a, b);
  const VectorXd off_a = before_.acceleration - by_rates_a, off_b = after_.acceleration - by_rates_b;
  // Coordinates may be lengths, angles, or what a controller sums up, with which nothing moves.
  const VectorXd m = system_.moving_mass();
  const auto size = [&m](const VectorXd& x) {
    return m.array().isInf().select(0.0, m.array() * x.array().square()).sum();
  };
  const double largest = std::max(size(by_rates_a), size(by_rates_b));
  by_a_ = before_.acceleration;
  by_b_ = after_.acceleration;
  if (before_.known && after_.known && size(off_b - off_a) <= gross * gross * largest) return;
  const double far_a = before_.known ? size(off_a) : INFINITY, far_b = after_.known ? size(off_b) : INFINITY;
  const VectorXd none = VectorXd::Zero(off_a.size());
  const VectorXd& both = std::min(far_a, far_b) > largest ? none : far_a < far_b ? off_a : off_b;
  by_a_ = by_rates_a + both;
  by_b_ = by_rates_b + both;
}

void EnergyMeter::add(const State& a, const State& b, SolvedPoint at_b, bool singular_at_b,
                      bool singular_at_a) {
  if (idle()) return;
  before_ = fresh_ && last_ == a.t ? std::move(after_) : at_state(a);
  after_ = at_b.known ? std::move(at_b) : at_state(b);
  fresh_ = true, last_ = b.t, before_.known &= !singular_at_a, after_.known &= !singular_at_b;
  const double h = b.t - a.t;
  const Index told = b.stage_tension.cols();
  if (told > 0 && told != own_.nodes.size()) own_ = gauss_legendre(static_cast<int>(told));
  rods_apart_ = dampers_ && told > 0 && b.tension.size() > 0;
  const Index points = by_tension_ ? told : 0, giving = std::ssize(system_.giving_rods());
  const bool by_step = drives_ && told > 0 && b.stage_tension.rows() == giving + lambda_.size();
  const double by_friction = taken(b) - taken(a);
  system_.follow(a);
  const double by_rods = rods_apart_ ? damped_rods_.taken(system_, a, b, own_) : 0.0;
  dissipated += by_friction + by_rods;
  const double fastest = dampers_ ? damping_bound(a) : 0.0;
  const bool stiff = h * fastest > stiff_at;
  const bool smooth = tables_.only_sines();  // at all times: what a step has found at its own points tells it
  const std::vector<double> points_inside =
      drives_ && !(smooth && by_step) ? tables_.points_within(a.t, b.t) : std::vector<double>();
  const bool split = !points_inside.empty();
  const Ends trusted = stiff ? trusted_ends(a, b) : Ends{};
  // Accelerations of single points of a table, or of waves of rods, tell no motion of a step.
  if ((split && !smooth) || by_step)
    std::tie(by_a_, by_b_) = cubic_ends(a, b);
  else if (!stiff)
    smooth_ends(a, b);
  const Quintic motion =
      stiff ? Quintic{trusted.a, trusted.b, trusted.by_a, trusted.by_b, h} : Quintic{a, b, by_a_, by_b_, h};
  static const Quadrature gauss = gauss_legendre(3), lobatto = gauss_lobatto(4);
  const Quadrature parts = split ? gauss_between(points_inside, a.t, b.t) : Quadrature();
  const double others = load_work + drive_work;
  // Both rules are of order 6; where all that is asked is the multipliers, the ends have them already.
  const bool by_ends = points == 0 && !split && !loads_ && !dampers_ && before_.known && after_.known;
  const Quadrature& rule = split ? parts : points > 0 ? own_ : by_ends ? lobatto : gauss;
  // Warming works against the forces of rods; of stiffly damped ones the states tell these, not the line.
  const bool by_line = stiff && loads_ && points == 0 && system_.elastic_rods();
  const VectorXd pull = by_line ? rod_forces(a) : VectorXd(), change = by_line ? rod_forces(b) - pull : pull;
  // Both ends in one singular pose: only they are known, and what grows without bound does no work there.
  const bool in_pose = singular_at_a && singular_at_b && a.lambda.size() == b.lambda.size();
  const auto bounded = [](const VectorXd& x) { return VectorXd(x.array().isFinite().select(x, 0.0)); };
  VectorXd tension, line;
  double taken_between = 0, by_stiff = 0;
  for (Index i = 0; i < rule.nodes.size(); ++i) {
    const double u = rule.nodes[i], t = a.t + u * h, weight = h * rule.weights[i];
    const bool at_end = by_ends && (i == 0 || i + 1 == rule.nodes.size());
    VectorXd z = motion.value(u);
    VectorXd w = motion.rate(u);
    if (points > 0) tension = split ? between_stages(b, u) : VectorXd(b.stage_tension.col(i));
    if (by_step) lambda_ = tension.tail(lambda_.size()), tension.conservativeResize(giving);
    if (at_end) lambda_ = i == 0 ? before_.lambda : after_.lambda;
    if (in_pose) lambda_ = (1 - u) * bounded(a.lambda) + u * bounded(b.lambda);
    if (split && smooth) index1_->move_onto(t, z, tension);
    const bool known = drives_ && (at_end || by_step || in_pose ||
                                   (split ? index1_->evaluate_on(t, z, w, unused_, lambda_, tension)
                                          : index1_->evaluate(t, z, w, unused_, lambda_, tension)));
    system_.expand(z, q_);
    system_.expand_rate(w, v_);
    const double* const pulls = points > 0 ? tension.data() : nullptr;
    if (by_line) line = pull + u * change;
    if (loads_) load_work += weight * system_.power(false, t, q_, v_, by_line ? line.data() : pulls);
    if (dampers_) taken_between += weight * dampers_take(t, v_, pulls);
    if (stiff) {
      system_.expand_rate(stiff_.cwiseProduct(w), stiff_rate_);
      by_stiff += weight * dampers_take(t, stiff_rate_, pulls);
    }
    if (at_point && (known || !drives_)) at_point(weight, t, q_, v_, lambda_);
    if (!known) continue;
    system_.target_rate(t, target_rate_);
    drive_work -= weight * lambda_.dot(target_rate_);
  }
  if (stiff) {
    const double of_others = taken_between - by_stiff, lost = energy(a) - energy(b) + load_work + drive_work -
                                                              others - by_friction - by_rods - of_others;
    dissipated += of_others + taken_by_stiff(a, b, fastest, by_stiff, lost);
  } else {
    dissipated += taken_between;
  }
}

namespace {

// What the work of the constant loads since the start jumps by where these become others: their work before
// that stays what it was.
double other_loads(const System& from, const System& to, const VectorXd& z) {
  if (&from == &to) return 0.0;
  VectorXd q(to.coordinates());
  to.expand(z, q);
  return to.load_work(q) - from.load_work(q);
}

}  // namespace

RunEnergyFlow::RunEnergyFlow(const Trajectory& run, bool booked)
    : trajectory_(run),
      booked_(booked),
      drives_(drive_channels(run.model())),
      flow_{{0.0}, {0.0}, {0.0}, {0.0}, std::vector(drives_.size(), std::vector{0.0})} {}

void RunEnergyFlow::meter_of(const Model& model) {
  if (model_ == &model) return;
  model_ = &model;
  meter_ = std::make_unique<EnergyMeter>(model);
  meter_->at_point = [this](double weight, double t, const VectorXd& q, const VectorXd& v,
                            const VectorXd& lambda) {
    for (std::size_t d = 0; d < drives_.size(); ++d)
      flow_.of_drives[d].back() +=
          weight * drives_[d].sample(*model_, meter_->system(), t, q, v, lambda).power;
  };
}

// What drives put in by the impulse between two states of one time, P g' of each, g' half of its rates before
// and after; what else the kinetic energy gained or lost is lost. False where nothing is driven, and where
// the model's rows do not hold after it, as a winch's that a latch stops, or are, with the stops that are met
// there, not all that acted.
bool RunEnergyFlow::explain_impulse(const Model& rows, const State& a, const State& b, double gain) {
  constexpr double near = 1e3;       // times what counts as touching
  constexpr double held = 1e-4;      // of the fastest: drift of a method
  constexpr double rounding = 1e-8;  // of what the rate of a stop may be
  const Stops stops(rows.structure);
  bool reeled = false;
  for (std::size_t i = 0; i < stops.size(); ++i) reeled = reeled || stops[i].reeled;
  if (!rows.system.rheonomic() && !reeled) return false;
  const System system = rows.system.at(a);
  VectorXd q(system.coordinates()), v(q.size()), broken(system.all_constraints());
  std::vector<double> scratch;
  system.expand(b.z, q);
  system.expand_rate(b.w, v);
  system.all_constraint_rates(b.t, q, v, broken, scratch);
  const double fastest = std::max(a.w.lpNorm<Eigen::Infinity>(), b.w.lpNorm<Eigen::Infinity>());
  if (broken.size() > 0 && broken.lpNorm<Eigen::Infinity>() > held * fastest) return false;
  PushResponses responses(system, a);
  if (!responses.ok()) return false;
  std::vector<std::size_t> met;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (stops.gap(i, system, a) > near * stops.touching(stops[i].function)) continue;
    responses.add(stops[i].function, stops[i].sign, stops[i].near(a));
    const Index row = responses.size() - 1;
    const double limit_before = stops[i].sign * stops[i].rate(a.t),
                 limit_after = stops[i].sign * stops[i].rate(b.t);
    // What was not approached and is left then has given nothing, as a cable that goes slack.
    const double small = rounding * std::max(responses.at_most(row, a.w) + std::abs(limit_before),
                                             responses.at_most(row, b.w) + std::abs(limit_after));
    if (responses.rates(a.w)[row] >= limit_before - small && responses.rates(b.w)[row] > limit_after + small)
      responses.leave_last();
    else
      met.push_back(i);
  }
  VectorXd lambda, rate(system.constraints());
  double unexplained = 0;
  const VectorXd P = responses.impulses_of(b.w - a.w, lambda, unexplained);
  if (!(unexplained <= 1e-6)) return false;
  double all = 0;
  for (const double t : {a.t, b.t}) {
    const auto of_reel = [&](int side) {
      double sum = 0;
      for (std::size_t k = 0; k < met.size(); ++k)
        if (side < 0 || met[k] == static_cast<std::size_t>(side))
          sum += P[static_cast<Index>(k)] * stops[met[k]].sign * stops[met[k]].rate(t);
      return sum;
    };
    system.target_rate(t, rate);
    all += 0.5 * (of_reel(-1) - lambda.dot(rate));
    for (std::size_t d = 0; d < drives_.size(); ++d)
      flow_.of_drives[d].back() += 0.5 * drives_[d].work(rows, t, lambda, of_reel);
  }
  flow_.drive_work.back() += all;
  flow_.impact_loss.back() += all - gain;
  return true;
}

void RunEnergyFlow::step_to(std::size_t i, StateForces* forces) {
  for (auto* list : {&flow_.load_work, &flow_.dissipated, &flow_.drive_work, &flow_.impact_loss})
    list->push_back(list->back());
  for (auto& energy : flow_.of_drives) energy.push_back(energy.back());
  if (!booked_) return;
  const State &a = trajectory_.state(i - 1), &b = trajectory_.state(i);
  const Model &by = trajectory_.model(i - 1), &model = trajectory_.model(i);
  if (same_instant(a.t, b.t)) {  // an impulse; where time goes on a little, of a drive
    const System& before = by.system;
    const double gain = model.system.kinetic_energy(b.w) - before.kinetic_energy(a.w);
    const bool strikes = !by.structure.stops.empty() || !by.structure.deployment.empty();
    if (!explain_impulse(by, a, in_coordinates(model.system, b, before), gain) &&
        !explain_impulse(model, in_coordinates(before, a, model.system), b, gain)) {
      if (b.t > a.t)
        flow_.drive_work.back() += gain;
      else if (strikes)  // else an error, which the balance is to tell
        flow_.impact_loss.back() -= gain;
    }
    flow_.load_work.back() -= other_loads(before, model.system, b.z);
    if (meter_) meter_->jump();
    return;
  }
  meter_of(model);
  const double load_work = meter_->load_work, dissipated = meter_->dissipated,
               drive_work = meter_->drive_work;
  meter_->add(a, b, forces && !meter_->idle() ? forces->at(i) : SolvedPoint{},
              trajectory_.report(i).singular_event, trajectory_.report(i - 1).singular_event);
  flow_.load_work.back() += meter_->load_work - load_work;
  flow_.dissipated.back() += meter_->dissipated - dissipated;
  flow_.drive_work.back() += meter_->drive_work - drive_work;
}

}  // namespace unfurl
