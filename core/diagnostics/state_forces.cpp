// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/state_forces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/math/lagrange.hpp"

namespace unfurl {
namespace {

// Directions as weak as that, where the forces are not smooth, are looked into.
constexpr double weak = 3, rough = 1e-6, rough_at_end = 1e-4;
// Doubt, of the largest multiplier: what is not worth a thought, and what is not worth poses beside it.
constexpr double negligible = 1e-8, harmless = 1e-6;

// Weakness from which on rounding of a pose may count, and from which on it does, however smooth the forces.
constexpr double may_count = 300, counts_surely = 1e4;

const SolvedPoint nothing_known{};

bool within(const VectorXd& off, double share, const VectorXd& sizes) {
  return (off.array().abs() <= share * sizes.array()).all();
}

// Rows or coordinates of a part.
std::vector<Index> members(const IndependentParts& parts, Index part, Index count, bool rows) {
  std::vector<Index> out;
  for (Index k = 0; k < count; ++k)
    if ((rows ? parts.of_row(k) : parts.of(k)) == part) out.push_back(k);
  return out;
}

}  // namespace

const IndependentParts& StateForces::parts(std::size_t i) {
  if (std::exchange(parts_of_, &trajectory_.model(i)) != &trajectory_.model(i))
    parts_.emplace(trajectory_.model(i).system);
  return *parts_;
}

VectorXd StateForces::large_doubt(std::size_t i, const VectorXd& lambda) {
  if (doubt_.size() == 0) return {};
  const Eigen::ArrayXd most = most_doubt * parts(i).largest_beside(lambda).array();
  const VectorXd large = (doubt_.array() > most).select(doubt_, 0.0);
  return large.isZero(0) ? VectorXd() : large;
}

void StateForces::forget_beside(std::size_t i, const VectorXd& doubt, VectorXd& lambda,
                                VectorXd& node_acceleration) {
  const VectorXd doubted = parts(i).largest_of_rows(doubt);
  const VectorXd unknown = (doubted.array() > 0).select(std::numeric_limits<double>::quiet_NaN(), doubted);
  VectorXd moved(node_acceleration.size());
  trajectory_.model(i).system.expand_rate(parts(i).spread(unknown), moved);
  node_acceleration += moved;
  for (Index r = 0; r < lambda.size(); ++r) lambda[r] += unknown[parts(i).of_row(r)];
}

const SolvedPoint& StateForces::at(std::size_t i) {
  if (ahead_ && i < ahead_->size()) return (*ahead_)[i];
  if (trajectory_.report(i).singular_event) return nothing_known;
  if (kept_[i % kept].i != i) solve_from(i);
  return kept_[i % kept].point;
}

bool StateForces::near_singular(std::size_t i) {
  const SolvedPoint& here = at(i);
  return here.known ? here.weakness > weak : trajectory_.report(i).singular_event;
}

void StateForces::solve_from(std::size_t i) {
  if (model_ != &trajectory_.model(i)) {
    model_ = &trajectory_.model(i);
    if (!lanes_ || !lanes_->take_loads_of(model_->system)) lanes_.emplace(model_->system);
  }
  std::vector<const State*> states;
  for (std::size_t k = i; states.size() < SaddleLanes::lanes && k < trajectory_.size() &&
                          &trajectory_.model(k) == model_ && !trajectory_.report(k).singular_event;
       ++k)
    states.push_back(&trajectory_.state(k));
  lanes_->evaluate(states);
  for (std::size_t k = 0; k < states.size(); ++k) {
    Kept& to = kept_[(i + k) % kept];
    to = {i + k, {}};
    if (lanes_->ok(k)) to.point = {lanes_->acceleration(k), lanes_->lambda(k), true, lanes_->weakness(k)};
  }
}

VectorXd StateForces::multipliers(std::size_t i, VectorXd& node_acceleration) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const System& system = trajectory_.model(i).system;
  SolvedPoint here = at(i);
  doubt_.resize(0);
  const bool rough_here = here.known && here.weakness > weak && !smooth(i);
  if ((rough_here || (here.known && tells_nothing(i, here.weakness))) && !stays(i, here.lambda)) {
    seen_ = {i, here.lambda, {}};
    Close closer = look_closely(i, trajectory_.state(i));
    if (closer.doubt.size() > 0 && rough_here) {
      const VectorXd doubt = parts(i).largest_of_rows(closer.doubt),
                     size = parts(i).largest_of_rows(closer.point.lambda);
      Looks looks;
      for (Index part = 0; part < doubt.size(); ++part)
        if (doubt[part] > harmless * size[part]) interpolate(i, part, looks, closer);
      here = std::move(closer.point);
    }
    doubt_ = seen_.doubt = std::move(closer.doubt);
  }
  node_acceleration.resize(system.coordinates());
  system.expand_rate(here.known ? here.acceleration : VectorXd::Constant(system.solved_coordinates(), nan),
                     node_acceleration);
  if (trajectory_.report(i).singular_event) return trajectory_.state(i).lambda;
  return here.known ? std::move(here.lambda) : VectorXd::Constant(system.constraints(), nan);
}

// Up to so many known states before or behind, the nearest first. Nothing is smooth across an impact, a jump
// of what acts, a change of the model.
std::vector<std::size_t> StateForces::beside(std::size_t i, int way, std::size_t most) const {
  std::vector<std::size_t> out;
  for (std::size_t j = i; out.size() < most;) {
    if (way < 0 ? j == 0 : j + 1 == trajectory_.size()) break;
    const std::size_t next = way < 0 ? j - 1 : j + 1;
    if (&trajectory_.model(next) != &trajectory_.model(i) || trajectory_.report(next).singular_event ||
        trajectory_.time(next) == trajectory_.time(j))
      break;
    out.push_back(j = next);
  }
  return out;
}

// Where there are not two states on either side, by those that there are, as far as three or more tell; false
// where there are fewer.
bool StateForces::smooth(std::size_t i) {
  std::vector<std::size_t> states = beside(i, -1, 2), behind = beside(i, +1, 2);
  const bool inside = states.size() == 2 && behind.size() == 2;
  if (!inside) states = beside(i, -1, 4), behind = beside(i, +1, 4);
  states.insert(states.end(), behind.begin(), behind.end());
  if (states.size() < 3) return false;
  for (const std::size_t k : states)
    if (!at(k).known) return false;
  const VectorXd lambda = at(i).lambda;
  VectorXd off = lambda;
  const auto time = [&](std::size_t k) { return trajectory_.time(states[k]); };
  for (std::size_t k = 0; k < states.size(); ++k)
    off -= lagrange_weight(k, states.size(), trajectory_.time(i), time) * at(states[k]).lambda;
  return within(off, inside ? rough : rough_at_end, parts(i).largest_beside(lambda));
}

// Forces are smooth whatever rounding says of them where the pose rests, or what is weak of it does.
bool StateForces::tells_nothing(std::size_t i, double weakness) {
  if (!(weakness > may_count)) return false;
  const std::vector<std::size_t> before = beside(i, -1, 2), behind = beside(i, +1, 2);
  if (before.size() < 2) return false;
  if (rests(i, before) && rests(i, behind)) return true;
  const auto weak_too = [&](std::size_t k) {
    return at(k).weakness > counts_surely && std::isfinite(at(k).weakness);
  };
  return weak_too(i) && std::ranges::all_of(before, weak_too) && std::ranges::all_of(behind, weak_too);
}

// Whether the pose and its forces are those of the state before, which was looked at closely: then so is its
// doubt.
bool StateForces::stays(std::size_t i, const VectorXd& lambda) {
  const std::vector<std::size_t> before = beside(i, -1, 1);
  if (before.empty() || seen_.i != before.front() || !rests(i, before) ||
      !within(lambda - seen_.lambda, rough, parts(i).largest_beside(lambda)))
    return false;
  seen_.i = i;
  doubt_ = seen_.doubt;
  return true;
}

// No doubt where it is negligible.
StateForces::Close StateForces::look_closely(std::size_t model_of, const State& state) {
  if (close_ != &trajectory_.model(model_of)) {
    close_ = &trajectory_.model(model_of);
    if (!system_ || !system_->take_loads_of(close_->system)) {
      one_.reset();
      system_ = std::make_unique<System>(close_->system);
      one_ = std::make_unique<Index1>(*system_, true);
    }
  }
  Close out;
  out.t = state.t;
  system_->follow(state);
  out.point.known = one_->evaluate_closely(state, out.point.acceleration, out.point.lambda, out.doubt);
  if (!out.point.known || out.doubt.size() == 0 ||
      within(out.doubt, negligible, parts(model_of).largest_beside(out.point.lambda)))
    out.doubt.resize(0);
  return out;
}

// What an event in a singular pose that follows state i says its forces tend to; not known where none does.
StateForces::Close StateForces::limit_behind(std::size_t i) const {
  Close out;
  if (i + 1 >= trajectory_.size() || &trajectory_.model(i + 1) != &trajectory_.model(i)) return out;
  const State& event = trajectory_.state(i + 1);
  out.t = event.t;
  out.point.known = trajectory_.report(i + 1).singular_event && event.t > trajectory_.time(i) &&
                    event.lambda.size() > 0 && event.lambda.allFinite();
  if (out.point.known) out.point.lambda = event.lambda;
  return out;
}

// Whether these states have the pose of state i, to rounding: they tell no more of it.
bool StateForces::rests(std::size_t i, const std::vector<std::size_t>& states) const {
  constexpr double rounding = 1e-13;
  const VectorXd& pose = trajectory_.state(i).z;
  return std::ranges::all_of(states, [&](std::size_t k) {
    return (pose - trajectory_.state(k).z).lpNorm<Eigen::Infinity>() <=
           rounding * pose.lpNorm<Eigen::Infinity>();
  });
}

// By the polynomial through three poses on either side, as near as they are in a thousandth of the doubt, or
// farther where that says more; its error is what the outer ones change. Not through a pole: there what is
// odd about the pose falls away from it, where the forces are smooth it grows. The last state before an event
// in a singular pose: through five poses before it and what the event says; where nothing follows it: through
// six poses before it. All that of one part of the structure: what is joined to nothing of it is known.
void StateForces::interpolate(std::size_t i, Index part, Looks& looks, Close& here) {
  // States on either side: short steps are many in the round-off, parts of a failed one before an end more.
  constexpr std::size_t far = reach, far_from_end = 64;
  const std::vector<std::size_t> behind = beside(i, +1, far);
  const Close limit = behind.empty() ? limit_behind(i) : Close{};
  const bool ends = limit.point.known, one_way = behind.empty(), at_end = one_way && !ends;
  const std::vector<std::size_t> before = beside(i, -1, one_way ? far_from_end : far);
  if (before.empty() || (at_end && before.size() <= far)) return;  // single states are no run's end
  if (rests(i, before) && rests(i, behind)) return;
  const double t = trajectory_.time(i);
  const auto closely = [&](double at) -> const Close& {
    const auto [found, first] = looks.try_emplace(at);
    if (first) found->second = look_closely(i, trajectory_.state_at(at));
    return found->second;
  };
  const auto both = [&](std::size_t first, std::size_t last) {
    return one_way ? t - trajectory_.time(first)
                   : std::min(t - trajectory_.time(first), trajectory_.time(last) - t);
  };
  const double most = both(before.back(), one_way ? 0 : behind.back());
  const std::vector<Index> rows = members(parts(i), part, here.doubt.size(), true),
                           columns = members(parts(i), part, here.point.acceleration.size(), false);
  const auto largest = [&rows](const VectorXd& x) { return x(rows).lpNorm<Eigen::Infinity>(); };
  const double own = largest(here.doubt);
  constexpr double told = 0.1;  // less, and the poses may be too far apart for what happens between them
  constexpr double many = 10;   // times as much: all of these poses have round-off
  const auto tells_more = [&](const Close& pose) {
    return pose.point.known && (pose.doubt.size() == 0 || 1000 * largest(pose.doubt) < own);
  };
  // The farther, the less of the round-off: the first of ever doubled distances that tells more.
  const double nearest = both(before.front(), one_way ? 0 : behind.front()) / 1024;
  int first = 0, levels = 0;
  while (std::ldexp(nearest, levels) <= 0.5 * most) ++levels;
  for (int end = levels; first < end;) {
    const int middle = (first + end) / 2;
    if (tells_more(closely(t - std::ldexp(nearest, middle))))
      end = middle;
    else
      first = middle + 1;
  }
  std::vector<Close> near;
  const auto look = [&](double apart) {
    for (const double side : {-apart, one_way ? -1.25 * apart : apart}) {
      near.push_back(closely(t + side));
      if (!tells_more(near.back())) return false;
    }
    return true;
  };
  const auto time = [&](std::size_t k) { return near[k].t; };
  const auto through = [&](std::size_t points, VectorXd SolvedPoint::*what) {
    VectorXd out = VectorXd::Zero((here.point.*what).size());
    for (std::size_t k = 0; k < points; ++k)
      out += lagrange_weight(k, points, t, time) * (near[k].point.*what);
    return out;
  };
  const auto odd = [&](std::size_t k) { return largest(near[k].point.lambda - near[k + 1].point.lambda); };
  double least = told * own;
  for (int level = first; level < levels; ++level) {
    const double apart = std::ldexp(nearest, level);
    near.clear();
    if (!look(apart)) continue;
    if (!look(1.5 * apart) || !look(2 * apart) || (!one_way && odd(0) > 0.75 * odd(4) + 0.01 * own)) return;
    const VectorXd acceleration = through(near.size(), &SolvedPoint::acceleration);
    if (ends) near.insert(near.begin(), limit), near.pop_back();
    const VectorXd lambda = through(near.size(), &SolvedPoint::lambda);
    const VectorXd doubt = many * (lambda - through(near.size() - 2, &SolvedPoint::lambda)).cwiseAbs();
    if (!(largest(doubt) < least)) {
      if (!at_end || least < told * own) return;
      continue;
    }
    least = largest(doubt);
    here.point.acceleration(columns) = acceleration(columns);
    here.point.lambda(rows) = lambda(rows);
    here.doubt(rows) = doubt(rows);
    if (least <= negligible * largest(lambda)) return;
  }
}

void axial_forces(const Model& model, const State& state, const VectorXd& q, const VectorXd& v,
                  const VectorXd& lambda, VectorXd& force) {
  const std::vector<int>& giving = model.system.giving_rods();
  VectorXd tension = state.tension;
  if (tension.size() != static_cast<Index>(giving.size())) {
    tension.resize(static_cast<Index>(giving.size()));
    model.system.giving_rod_forces(state.t, q, v, tension);
  }
  for (std::size_t k = 0; k < giving.size(); ++k) force[giving[k]] = tension[static_cast<Index>(k)];
  for (Index r = 0; r < force.size(); ++r) {
    const auto ur = static_cast<std::size_t>(r);
    const Rod& rod = model.structure.rods[ur];
    if (!rod.gives) force[r] = lambda[model.system.rod_rows()[ur]] * (1 + rod.warmed(state.t));
    force[r] /= rod.multiplicity;
  }
}

std::pair<std::size_t, std::size_t> undetermined_states(const Trajectory& trajectory, const Diagnostics& d) {
  constexpr std::size_t fewest = 5;  // fewer are passed on the way
  const auto open = [&](std::size_t i) {
    for (std::size_t r = 0; r < d.rod_unique.size(); ++r)
      if (d.rod_unique[r] && !d.force_unique(static_cast<Index>(i), static_cast<Index>(r))) return true;
    return false;
  };
  StateForces forces(trajectory);
  VectorXd acceleration;
  const std::size_t states = std::min(d.t.size() - d.left_open, trajectory.size());
  for (std::size_t first = 0, end = 0; first < states; first = std::max(end, first + 1)) {
    for (end = first; end < states && open(end);) ++end;
    if (end - first < fewest) continue;
    const VectorXd lambda = forces.multipliers((first + end) / 2, acceleration);
    if (forces.large_doubt((first + end) / 2, lambda).size() > 0) return {first, end - 1};
  }
  return {0, 0};
}

}  // namespace unfurl
