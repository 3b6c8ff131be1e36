// SPDX-License-Identifier: BSD-3-Clause
// How far a motion can be judged, and how it is told between its states.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/study/reference_motion.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace judged_span_test {

namespace {

std::shared_ptr<const Model> two_points() {
  return model_of(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0.3, 0, 0], mass = 2}, {name = 'B', "
      "position = [0, 1, 0], mass = 1}]\n");
}

// Node A along x, node B along z.
State state_of(const Model& model, double t, double x, double vx, double z, double vz) {
  VectorXd q = VectorXd::Zero(6), v = q;
  q << x, 0, 0, 0, 1, z;
  v << vx, 0, 0, 0, 0, vz;
  State s;
  s.t = t;
  s.z = model.system.reduce(q);
  s.w = model.system.reduce_rate(v);
  return s;
}

Simulation run_with(const std::vector<Event>& events, double end) {
  const auto model = two_points();
  SolverOptions options;
  options.end_time = end;
  Simulation run{.trajectory = Trajectory(model, options), .options = options};
  run.trajectory.append(state_of(*model, 0.25, 0, 0, 0, 0), {});
  run.events = events;
  return run;
}

Event event(const char* name, double t, const char* kind) {
  return {.name = name, .t = t, .kind = kind};
}

// Coefficients of powers of t.
struct Polynomial {
  std::vector<double> c;
  double operator()(double t) const {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * t + c[i];
    return sum;
  }
  double rate(double t) const {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 1;) sum = sum * t + static_cast<double>(i) * c[i];
    return sum;
  }
};

ReferenceMotion motion_of(const std::vector<double>& times, const Polynomial& x, const Polynomial& z) {
  const auto model = two_points();
  Trajectory trajectory(model, SolverOptions{});
  for (const double t : times) trajectory.append(state_of(*model, t, x(t), x.rate(t), z(t), z.rate(t)), {});
  return ReferenceMotion(trajectory);
}

}  // namespace

TEST_CASE("what a smooth motion ends before is the first that bends or breaks it in time") {
  const auto span = [](const std::vector<Event>& events) { return judged_span(run_with(events, 4.0)); };
  CHECK(span({}).end == 4.0);
  CHECK(span({}).before.empty());
  for (const char* kind :
       {"contact", "free", "slip", "stick", "reversal", "taut", "slack", "saturated", "unsaturated"}) {
    INFO(kind);
    // Of two the first, of what comes at the end or later none.
    const JudgedSpan first =
        span({event("other", 0.5, "edge"), event("it", 1.6, kind), event("later", 1.8, "contact")});
    CHECK(first.end == 0.995 * 1.6);
    CHECK(first.before == "the first time that it");
    CHECK(span({event("it", 4.0, kind)}).end == 4.0);
    CHECK(span({event("it", 4.5, kind)}).end == 4.0);
    // At the start (0.25 s here) a law that bends is known as it is, what breaks is not.
    const bool bends = kind == std::string("taut") || kind == std::string("slack") ||
                       std::string(kind).ends_with("saturated");
    const JudgedSpan at_start = span({event("it", 0.25, kind), event("next", 2.0, "slip")});
    CHECK(at_start.end == 0.995 * (bends ? 2.0 : 0.25));
    CHECK(at_start.before == (bends ? "the first time that next" : "the first time that it"));
  }
  const JudgedSpan stop =
      span({event("meets stop floor", 1.1, "impact"), event("deployed", 1.2, "deployed")});
  CHECK(stop.end == 0.995 * 1.1);
  CHECK(stop.before == "the first end stop");
  const JudgedSpan pose =
      span({event("deployed", 1.2, "deployed"), event("meets stop floor", 1.3, "impact")});
  CHECK(pose.end == 0.995 * 1.2);
  CHECK(pose.before == "the deployed pose");
  CHECK(span({event("stopped", 1.1, "other"), event("latched", 1.2, "latch")}).end == 4.0);
}

// Sixteen conditions, of eight states on either side, are those of a polynomial of degree 15.
TEST_CASE("between its states a reference is the polynomial of degree 15 through eight of them") {
  std::mt19937 dice(5);
  std::uniform_real_distribution<double> any(-1, 1);
  Polynomial x, z;
  for (int i = 0; i < 16; ++i) x.c.push_back(any(dice)), z.c.push_back(any(dice));
  std::vector<double> times;
  for (int i = 0; i < 21; ++i) times.push_back(-0.9 + 0.09 * i + 0.02 * any(dice));
  const ReferenceMotion motion = motion_of(times, x, z);
  CHECK(motion.end() == times.back());
  CHECK(motion.bytes() == 2 * 8 * 21 * 6);
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    for (const double u : {0.0, 0.31, 0.5, 0.87}) {
      const double t = (1 - u) * times[i] + u * times[i + 1];
      const VectorXd q = motion.positions(t);
      // Squares of Lagrange's basis at eight uneven points, some 10 at the ends, of terms of size 10.
      CHECK(std::abs(q[0] - x(t)) < 1e-11);
      CHECK(std::abs(q[5] - z(t)) < 1e-11);
      CHECK(q[4] == Approx(1).epsilon(1e-11));
    }
  // Nothing is known beyond the ends.
  CHECK(motion.positions(times.front() - 1)[0] == Approx(x(times.front())).epsilon(1e-12));
  CHECK(motion.positions(times.back() + 1)[5] == Approx(z(times.back())).epsilon(1e-12));
  // One of a higher degree is told by those around it: worse far from the middle of eight.
  Polynomial high{std::vector<double>(17, 0.0)};
  high.c[16] = 1;
  const ReferenceMotion rough = motion_of(times, high, z);
  for (const std::size_t i : {5u, 9u, 14u}) {
    const double t = 0.6 * times[i] + 0.4 * times[i + 1];
    double error = 1;  // t^16 less its interpolant: the product of the squares of all distances
    for (std::size_t k = i - 3; k <= i + 4; ++k) error *= (t - times[k]) * (t - times[k]);
    CHECK(high(t) - rough.positions(t)[0] == Approx(error).epsilon(1e-3).margin(1e-15));
  }
  times.resize(15);
  CHECK_THROWS_WITH(motion_of(times, x, z), "too few states to interpolate");
}

TEST_CASE("a reference is as uncertain as a coarser one is far away, at its states and between that one's") {
  const Polynomial still{{0.2}}, x{{0.1, 0.7, -0.4}};
  // They differ by 0.003 t (2 - t) (t - 0.6)^2 along x, which is largest between: of both sets of times.
  const auto apart = [](double t) { return std::abs(0.003 * t * (2 - t) * (t - 0.6) * (t - 0.6)); };
  Polynomial other = x;  // 0.003 (0.72 t - 2.76 t^2 + 3.2 t^3 - t^4)
  other.c = {0.1, 0.7 + 0.00216, -0.4 - 0.00828, 0.0096, -0.003};
  std::vector<double> fine, coarse;
  for (int i = 0; i <= 40; ++i) fine.push_back(0.05 * i);
  for (int i = 0; i <= 16; ++i) coarse.push_back(0.125 * i);
  for (const bool fine_ones : {true, false}) {
    const std::vector<double>&own = fine_ones ? fine : coarse, &theirs = fine_ones ? coarse : fine;
    double most = 0;
    for (const double t : own) most = std::max(most, apart(t));
    for (std::size_t i = 1; i < theirs.size(); ++i)
      most = std::max(most, apart(0.5 * (theirs[i - 1] + theirs[i])));
    ReferenceMotion motion = motion_of(own, x, still);
    CHECK(std::isinf(motion.uncertainty()));
    CHECK(motion.compare(motion_of(theirs, other, still)) == Approx(most).epsilon(1e-9));
    CHECK(motion.uncertainty() == Approx(most).epsilon(1e-9));
    const double before = motion.uncertainty();
    motion.widen(0.5 * before);
    CHECK(motion.uncertainty() == before);
    motion.widen(3 * before);
    CHECK(motion.uncertainty() == 3 * before);
    ReferenceMotion unknown = motion_of(own, x, still);
    unknown.widen(0.125);
    CHECK(unknown.uncertainty() == 0.125);
  }
}

}  // namespace judged_span_test
