// SPDX-License-Identifier: BSD-3-Clause
#include "tests/random/judge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "tests/random/independent.hpp"
#include "tests/random/quantities.hpp"

namespace unfurl::random {

namespace {

std::string with_number(const std::string& what, double x) {
  char text[32];
  std::snprintf(text, sizeof text, ": %.3g", x);
  return what + text;
}

// The program's run: every state it kept.
struct ProgramRun {
  std::string error;  // empty: completed
  std::vector<Motion3> states;
  std::vector<std::string> warnings;

  const Motion3* at(double t) const {
    for (const Motion3& s : states)
      if (std::abs(s.t - t) < 1e-9) return &s;
    return nullptr;
  }
};

ProgramRun run_program(const Mechanism& m, int stages, double step) {
  ProgramRun out;
  try {
    const Scene scene = read_scene_text(scene_text(m, stages, step), "random.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    out.warnings = run.warnings;
    for (std::size_t i = 0; i < run.trajectory.size(); ++i)
      out.states.push_back(
          {run.trajectory.time(i), run.trajectory.node_positions(i), run.trajectory.node_velocities(i)});
    if (run.status != RunStatus::completed) out.error = "does not complete: " + run.message;
  } catch (const std::exception& e) {
    out.error = std::string("refused: ") + e.what();
  }
  return out;
}

double apart(const Motion3& a, const Motion3& b) {
  return std::max((a.q - b.q).lpNorm<Eigen::Infinity>(), (a.v - b.v).lpNorm<Eigen::Infinity>());
}

class Judge {
 public:
  Judge(const Mechanism& m, std::uint64_t seed) : m_(m), dice_(seed ^ 0xABCDu) {
    for (int k = 1; k <= 4; ++k) times_.push_back(m.end_time * k / 4);
  }

  Verdict verdict() {
    if (!reference()) return {Verdict::Kind::set_aside, why_};
    std::string error;
    for (const double step : {0.005, 0.00125, 0.0003125}) {  // what is too fast for one gets another
      step_ = step;
      fine_ = run_program(m_, 5, step);
      coarse_ = run_program(m_, 4, 2 * step);
      error = fine_.error.empty() ? coarse_.error : fine_.error;
      if (error.empty() && converges() && agrees()) break;
    }
    if (!error.empty()) return failure(error);
    if (!agrees() || !lengths_hold() || !energy_holds() || !momenta_hold() || !same_in_another_frame())
      return failure(why_);
    return {Verdict::Kind::agrees, step_ < 0.005 ? "with shorter steps" : "", error_};
  }

 private:
  Verdict failure(const std::string& why) const { return {Verdict::Kind::failed, why, error_}; }

  // The answer, and how much of an error at the start is left of it at each time: 1e-8 m/s is far above the
  // reference's own errors and far below what would leave the linear regime.
  bool reference() {
    constexpr double nudge = 1e-8;
    const IndependentRun run = solve_independently(m_, times_),
                         other = solve_independently(m_, times_, {1e-12, nudge});
    why_ = run.ok ? other.why : run.why;
    if (!run.ok || !other.ok) return false;
    if (run.switches != other.switches) return why_ = "switches that a nudge brings or takes", false;
    double growth = 1;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      growth = std::max(growth, apart(run.states[k], other.states[k]) / nudge);
      growth_.push_back(growth);
    }
    if (growth > 1e4) return why_ = "errors grow ten-thousandfold", false;
    reference_ = run.states;
    return true;
  }

  bool converges() const {
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const Motion3 *fine = fine_.at(times_[k]), *coarse = coarse_.at(times_[k]);
      if (!fine || !coarse || apart(*fine, *coarse) > 3e-4 * growth_[k]) return false;
    }
    return true;
  }

  // Orders 6 and 8, the step halved: the finer run's own error is less than an eighth of what lies between
  // the two, or so small that round-off (1e-13 of metres in some hundred steps) and the reference's (1e-12 a
  // step) count, grown as any error does.
  bool agrees() {
    error_ = 0;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const Motion3 *fine = fine_.at(times_[k]), *coarse = coarse_.at(times_[k]);
      if (!fine || !coarse) return why_ = "no state at a whole step", false;
      const double between = apart(*fine, *coarse), off = apart(*fine, reference_[k]);
      const double allowed = std::max(1.5e-9 * growth_[k], between / 8);
      error_ = std::max(error_, off / allowed);
      if (off > allowed) return why_ = with_number("not the independent solver's motion", off), false;
      if (between > 3e-4 * growth_[k]) return why_ = with_number("does not converge", between), false;
    }
    return true;
  }

  bool lengths_hold() {
    for (const Motion3& s : fine_.states)
      for (const Bar& bar : m_.bars) {
        const auto end = [&](int i) { return Vec3(s.q.segment<3>(3 * i)); };
        const double l = (m_.points[static_cast<std::size_t>(bar.b)].position -
                          m_.points[static_cast<std::size_t>(bar.a)].position)
                             .norm();
        const double off = std::abs((end(bar.b) - end(bar.a)).norm() - l);
        if (off > 1e-11)
          return why_ = with_number("a rod's length", off), false;  // coordinates of some metres
      }
    return true;
  }

  bool energy_holds() {
    const bool damped =
        std::any_of(m_.springs.begin(), m_.springs.end(), [](auto& s) { return s.damping > 0; }) ||
        std::any_of(m_.twists.begin(), m_.twists.end(),
                    [](auto& t) { return t.damping > 0 || !t.axis.isZero(); });
    const bool varying =
        std::any_of(m_.loads.begin(), m_.loads.end(), [](auto& l) { return !l.times.empty(); });
    if (damped || varying || !m_.drives.empty() || !m_.followers.empty() || !m_.drags.empty() ||
        !m_.stops.empty())
      return true;
    const double off = energy_drift(fine_), coarse = energy_drift(coarse_);
    if (off <= std::max(1e-9, coarse / 4)) return true;
    return why_ = with_number("energy", off), false;
  }
  // Relative to the energy that moves.
  double energy_drift(const ProgramRun& run) const {
    const auto energy = [&](const Motion3& s) { return kinetic_energy(m_, s.v) + potential_energy(m_, s.q); };
    const double start = energy(run.states.front());
    double most = 0, drift = 0;
    for (const Motion3& s : run.states) {
      most = std::max(most, kinetic_energy(m_, s.v));
      drift = std::max(drift, std::abs(energy(s) - start));
    }
    return drift / (most + 1e-3);
  }

  // Where nothing outside holds it: P = P_0 + m g t + the impulses of the loads, to round-off in the sums; L
  // where no load has a moment either.
  bool momenta_hold() {
    const bool held = std::any_of(m_.points.begin(), m_.points.end(), [](auto& p) { return p.fixed; }) ||
                      std::any_of(m_.drives.begin(), m_.drives.end(), [](auto& d) { return !d.length; }) ||
                      std::any_of(m_.stops.begin(), m_.stops.end(), [](auto& s) { return !s.length; });
    if (held || !m_.rows.empty() || !m_.followers.empty() || !m_.drags.empty()) return true;
    double mass = 0, scale = 1;
    for (const Point& p : m_.points) mass += p.mass;
    for (const Bar& bar : m_.bars) mass += bar.mass;
    for (const Load& load : m_.loads)
      scale += load.force.norm() * (1 + std::abs(load_impulse(load, m_.end_time)));
    scale += mass * (1 + m_.gravity.norm());
    const Motion3& start = fine_.states.front();
    for (const Motion3& s : fine_.states) {
      Vec3 expected = momentum(m_, start.v) + mass * s.t * m_.gravity;
      for (const Load& load : m_.loads) expected += load_impulse(load, s.t) * load.force;
      const double off = (momentum(m_, s.v) - expected).norm();
      if (off > 1e-11 * scale) return why_ = with_number("momentum", off), false;
      if (!m_.loads.empty() || !m_.gravity.isZero()) continue;
      const double turn = (angular_momentum(m_, s.q, s.v) - angular_momentum(m_, start.q, start.v)).norm();
      if (turn > 1e-10 * scale) return why_ = with_number("angular momentum", turn), false;
    }
    return true;
  }

  // Turned, and with nodes and rods in another order: the same motion but for round-off, grown.
  bool same_in_another_frame() {
    const Vec3 axis = dice_.direction();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(dice_.between(0.3, 2.8), axis).toRotationMatrix();
    std::vector<int> order(m_.points.size());
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size() - 1; i > 0; --i)
      std::swap(order[i], order[static_cast<std::size_t>(dice_.below(static_cast<int>(i) + 1))]);
    const ProgramRun other = run_program(renumbered(turned(m_, turn), order), 4, 2 * step_);
    if (!other.error.empty()) return why_ = "turned and renumbered, it " + other.error, false;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const Motion3 *here = coarse_.at(times_[k]), *there = other.at(times_[k]);
      if (!there) return why_ = "turned and renumbered, it has no state at a whole step", false;
      double off = 0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const auto a = 3 * static_cast<Eigen::Index>(i), b = 3 * static_cast<Eigen::Index>(order[i]);
        off = std::max(off, (there->q.segment<3>(a) - turn * here->q.segment<3>(b)).norm());
        off = std::max(off, (there->v.segment<3>(a) - turn * here->v.segment<3>(b)).norm());
      }
      if (off > 1e-9 * growth_[k])
        return why_ = with_number("turned and renumbered, it moves otherwise", off), false;
    }
    return true;
  }

  const Mechanism& m_;
  Dice dice_;
  std::vector<double> times_, growth_;
  std::vector<Motion3> reference_;
  ProgramRun fine_, coarse_;
  std::string why_;
  double error_ = 0, step_ = 0;  // step_: of the finer run [s]
};

// Mechanisms with one thing less.
std::vector<Mechanism> simpler(const Mechanism& m) {
  std::vector<Mechanism> out;
  const auto without = [&](auto member) {
    for (std::size_t i = 0; i < (m.*member).size(); ++i) {
      out.push_back(m);
      auto& list = out.back().*member;
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
    }
  };
  without(&Mechanism::loads);
  without(&Mechanism::drives);
  without(&Mechanism::stops);
  without(&Mechanism::springs);
  without(&Mechanism::twists);
  without(&Mechanism::drags);
  without(&Mechanism::followers);
  if (m.followers.empty()) without(&Mechanism::bars);
  if (!m.gravity.isZero()) out.push_back(m), out.back().gravity.setZero();
  if (m.lumped) out.push_back(m), out.back().lumped = false;
  const int last = static_cast<int>(m.points.size()) - 1;
  const auto used = [&](int i) {
    const auto has = [&](const auto& nodes) {
      return std::find(nodes.begin(), nodes.end(), i) != nodes.end();
    };
    return std::any_of(m.bars.begin(), m.bars.end(), [&](auto& b) { return b.a == i || b.b == i; }) ||
           std::any_of(m.springs.begin(), m.springs.end(), [&](auto& s) { return s.a == i || s.b == i; }) ||
           std::any_of(m.twists.begin(), m.twists.end(),
                       [&](auto& t) { return t.a == i || t.b == i || t.hinge == i; }) ||
           std::any_of(m.loads.begin(), m.loads.end(), [&](auto& l) { return l.node == i; }) ||
           std::any_of(m.drags.begin(), m.drags.end(), [&](auto& d) { return d.node == i; }) ||
           std::any_of(m.drives.begin(), m.drives.end(), [&](auto& d) { return has(d.nodes); }) ||
           std::any_of(m.stops.begin(), m.stops.end(), [&](auto& s) { return has(s.nodes); });
  };
  for (int i = 0; i <= last && last > 0; ++i) {
    if (used(i)) continue;
    std::vector<int> order;  // it goes to the end, and away
    for (int j = 0; j <= last; ++j)
      if (j != i) order.push_back(j);
    order.push_back(i);
    Mechanism less = renumbered(m, order);
    less.points.pop_back();
    std::erase_if(less.rows, [&](const LinearRow& row) { return row.nodes[0] == last; });
    out.push_back(std::move(less));
  }
  return out;
}

std::string first_words(const std::string& why) {
  return why.substr(0, why.find(':'));
}

}  // namespace

Verdict judge(const Mechanism& mechanism, std::uint64_t seed) {
  return Judge(mechanism, seed).verdict();
}

Mechanism shrunk(Mechanism mechanism, std::uint64_t seed, const Verdict& verdict) {
  for (bool less = true; less;) {
    less = false;
    for (Mechanism& m : simpler(mechanism)) {
      const Verdict now = judge(m, seed);
      if (!now.failed() || first_words(now.why) != first_words(verdict.why)) continue;
      mechanism = std::move(m);
      less = true;
      break;
    }
  }
  return mechanism;
}

}  // namespace unfurl::random
