// SPDX-License-Identifier: BSD-3-Clause
// Forces in a flat pose to which a drive leads, of what swings there fast.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/path/path_run.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace led_forces_test {

namespace {

using testing::number;
using Pair = Eigen::Vector2d;
using Four = Eigen::Vector4d;

constexpr double start = 60 * radians_per_degree, weight = 9.81, mass = 1.3, length = 0.15;

// A motion of the first leg in 1 s by a quintic or a cubic, to an angle [deg].
struct Motion {
  bool is_table;
  double to;

  Vec3 angle(double u) const {
    const double way = to * radians_per_degree - start;
    if (is_table) return {start + way * u * u * (3 - 2 * u), way * 6 * u * (1 - u), way * (6 - 12 * u)};
    return {start + way * u * u * u * (10 - 15 * u + 6 * u * u), way * 30 * u * u * (1 - u) * (1 - u),
            way * 60 * u * (1 - u) * (1 - 2 * u)};
  }
  double flat() const {
    double low = 0, high = 1;
    for (int i = 0; to < 0 && i < 60; ++i) (angle((low + high) / 2)[0] > 0 ? low : high) = (low + high) / 2;
    return high;
  }
};

// Of a payload of the second leg's end, which moves on a circle: on a rod that a torsion spring holds to the
// leg, or on a spring alone.
struct Payload {
  bool on_rod;
  double stiffness;

  // Place, rate and acceleration of the leg's end.
  static std::array<Pair, 3> base(const Vec3& a) {
    const Pair out(std::cos(a[0]), std::sin(a[0])), up(-out[1], out[0]);
    return {out, a[1] * up, a[2] * up - a[1] * a[1] * out};
  }
  // The rod's angle from below, or where the payload is; and rates.
  Four first() const { return on_rod ? Four(0, 0, 0, 0) : Four(0.5, std::sin(start) - length, 0, 0); }
  Pair pull(const Four& y, const Pair& at) const {
    const Pair d = at - y.head<2>();
    return stiffness * (1 - length / d.norm()) * d;
  }
  Four slope(const Vec3& a, const Four& y) const {
    const auto [at, rate, shaken] = base(a);
    if (on_rod) {
      const double turning = shaken[0] * std::cos(y[0]) + (shaken[1] + weight) * std::sin(y[0]),
                   back = stiffness * (y[0] - (a[0] - start));
      return {y[2], 0, -turning / length - back / (mass * length * length), 0};
    }
    const Pair f = pull(y, at) / mass;
    return {y[2], y[3], f[0], f[1] - weight};
  }
  // What pulls the leg's end, and the rod's axial force.
  Pair on_leg(const Vec3& a, const Four& y, double& axial) const {
    const auto [at, rate, shaken] = base(a);
    if (!on_rod) return -pull(y, at);
    const Pair out(std::sin(y[0]), -std::cos(y[0])), aside(-out[1], out[0]);
    const Pair f = mass * (shaken + length * (slope(a, y)[2] * aside - y[2] * y[2] * out) + Pair(0, weight));
    axial = -f.dot(out);
    return -f;
  }
};

// Runge-Kutta's way there; tells the motion after each step.
template <class Tell>
void swing(const Motion& motion, const Payload& payload, int steps, const Tell& tell) {
  const double h = motion.flat() / steps;
  Four y = payload.first();
  for (int i = 0; i < steps; ++i) {
    const Vec3 now = motion.angle(i * h), middle = motion.angle((i + 0.5) * h),
               then = motion.angle((i + 1) * h);
    const Four a = payload.slope(now, y), b = payload.slope(middle, y + h / 2 * a),
               c = payload.slope(middle, y + h / 2 * b), d = payload.slope(then, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
    tell(then, y);
  }
}

// The drive's torque in the flat pose by virtual work of all that it moves, and the rod's axial force.
Pair expected(const Motion& motion, const Payload& payload) {
  Vec3 a;
  Four y;
  swing(motion, payload, 20000, [&](const Vec3& angle, const Four& there) { a = angle, y = there; });
  double axial = 0;
  const Pair f = payload.on_leg(a, y, axial);
  const double back = payload.on_rod ? payload.stiffness * (y[0] + start) : 0;
  return {(2.0 / 3 + 1) * a[2] + (0.5 + 0.5 + 1) * weight - f[1] - back, axial};
}

// The least and the largest pull of a spring within its last period.
Pair last_wave(const Motion& motion, const Payload& payload) {
  constexpr int steps = 30000;  // of 0.24 rad at most, which lose 4 % of a wave
  const auto period = static_cast<int>(2 * pi / std::sqrt(payload.stiffness / mass) * steps / motion.flat());
  Pair out(1e9, -1e9);
  int i = 0;
  swing(motion, payload, steps, [&](const Vec3& a, const Four& y) {
    if (++i < steps - period) return;
    const Pair to = y.head<2>() - Payload::base(a)[0];
    const double force = payload.stiffness * (to.norm() - length);
    out = {std::min(out[0], force), std::max(out[1], force)};
  });
  return out;
}

// Two legs and a coupler of 1 m and 1 kg on pivots in one line, the first leg led.
std::string linkage(const Motion& motion, const std::string& rod, const std::string& force) {
  return R"toml([structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = ["=cos(60*deg)", 0, "=sin(60*deg)"]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)"]},
  {name = "P", position = [1.2, 0, "=sin(60*deg)-0.15"], mass = 1.3}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1})toml" +
         rod + R"(]
[[structure.constraints]]
kind = "plane"
nodes = ["B*", "P"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
)" + force +
         "\n[[constraints]]\nkind = \"angle\"\nname = \"m\"\nnodes = [\"X\", \"A0\", \"B0\"]\naxis = [0, -1, "
         "0]\n" +
         (motion.is_table ? "motion = \"table\"\ntimes = [0, 1]\nvalues = [60, 0]\n"
                          : "motion = \"smooth\"\nduration = 1\nto = " + number(motion.to) + "\n") +
         "[solver]\nend_time = 2\n";
}

std::string linkage(const Motion& motion, const Payload& payload) {
  const std::string stiffness = "stiffness = " + number(payload.stiffness);
  return payload.on_rod
             ? linkage(motion, ", {nodes = [\"B1\", \"P\"], mass = 0}",
                       "[[forces]]\nkind = \"torsion_spring\"\nnodes = [\"A1\", \"B1\", \"P\"]\n"
                       "axis = [0, -1, 0]\n" +
                           stiffness)
             : linkage(motion, "", "[[forces]]\nkind = \"spring\"\nnodes = [\"B1\", \"P\"]\n" + stiffness);
}

}  // namespace

// The drive's torque and the payload's force are finite there, the legs' and the coupler's without bound. Six
// stages at up to a radian a step are off by 1e-8 or so; of that and of rounding in rates next to the pose,
// 1e-16 over what is left of the angle, forces of some hundreds of newtons have some 1e-6.
TEST_CASE("forces of what swings fast in a flat pose to which a drive leads are those of its own motion") {
  for (const Motion& motion : {Motion{false, 0}, Motion{true, 0}, Motion{false, -5}})
    for (const Payload& payload : {Payload{true, 300}, Payload{false, 4000}}) {
      const Simulation run =
          testing::run_scene(linkage(motion, payload), {"solver.step=0.01", "solver.stages=6"});
      CAPTURE(motion.is_table, motion.to, payload.on_rod, payload.stiffness, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      const Pair truth = expected(motion, payload);
      const Diagnostics d = diagnose(run);
      CHECK(d.at("m.torque_N_m").values.back() == Approx(truth[0]).epsilon(0).margin(1e-3));
      CHECK(d.at("m.torque_unique").values.back() == 1);
      const Index end = d.axial_force.rows() - 1;
      if (payload.on_rod) {
        CHECK(d.axial_force(end, 3) == Approx(truth[1]).epsilon(0).margin(1e-3));
        CHECK(d.force_unique(end, 3));
      }
      for (Index r = 0; r < 3; ++r) CHECK(std::isnan(d.axial_force(end, r)));
    }
}

// The same payload on an elastic rod, which shakes it at 1100 Hz: what pulls at the leg's end goes to and fro
// between two values in a period, and steps that do not follow that say one within, or that they do not know.
TEST_CASE("an elastic rod that a drive lays flat with what it hangs from has no force of its waves unsaid") {
  for (const Motion& motion : {Motion{false, 0}, Motion{false, -5}})
    for (const double modulus : {5e10, 2.5e11}) {
      if (motion.to < 0 && modulus > 1e11) continue;
      const Payload payload{false, modulus * 1e-4 / length};
      const Pair wave = last_wave(motion, payload);
      for (const auto& [step, stages] : {std::pair{0.002, 4}, {0.0043, 5}}) {
        const std::string rod =
            R"(, {nodes = ["B1", "P"], elastic = true, mass = 0, area = 1e-4, youngs_modulus = )";
        const Simulation run =
            testing::run_scene(linkage(motion, rod + number(modulus) + "}", ""),
                               {"solver.step=" + number(step), "solver.stages=" + std::to_string(stages)});
        CAPTURE(motion.is_table, motion.to, modulus, step, run.message, wave[0], wave[1]);
        REQUIRE(run.status == RunStatus::deployed);
        const Diagnostics d = diagnose(run);
        const Index end = d.axial_force.rows() - 1;
        const double force = d.axial_force(end, 3), off = 0.02 * wave[1];  // as above
        CAPTURE(force);
        if (d.force_unique(end, 3)) CHECK((force > wave[0] - off && force < wave[1] + off));
        for (Index r = 0; r < 3; ++r) CHECK(std::isnan(d.axial_force(end, r)));
      }
    }
}

namespace {

// The same legs on a sled of 4.1 kg that a spring holds, with a double pendulum; or one leg as heavy
// as both with the coupler's mass at its end, which moves alike and has no pose that loses rank.
std::string on_sled(bool both, double hanging) {
  const std::string first =
      both ? R"toml(, {name = "B0", position = ["=cos(60*deg)", 0, "=sin(60*deg)"]})toml" : "";
  const std::string legs =
      both
          ? R"({nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1})"
          : R"({nodes = ["A1", "B1"], mass = 2})";
  return R"toml([structure]
kind = "custom"
nodes = [{name = "W", position = [-3, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], mass = 2},
  {name = "A1", position = [0.7, 0, 0], mass = 1}, {name = "X", position = [2, 0, 0], mass = 1},
  {name = "B1", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)"], mass = )toml" +
         std::string(both ? "0" : "1") + R"toml(}, {name = "P", position = [1.2, 0, "=sin(60*deg)-)toml" +
         number(hanging) + R"toml("], mass = 1.3}, {name = "Q", position = [1.5, 0, "=sin(60*deg)-)toml" +
         number(hanging) + R"toml("], mass = 0.7})toml" + first + "]\nrods = [" + legs +
         R"(, {nodes = ["A0", "A1"], mass = 0.05}, {nodes = ["A1", "X"], mass = 0.05}, {nodes = ["B1", "P"], mass = 0}, {nodes = ["P", "Q"], mass = 0}]
constraints = [{kind = "line", nodes = ["A*", "X"], direction = [1, 0, 0]}, {kind = "plane", nodes = ["B*", "P", "Q"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
)" + (both ? "[deployment]\nmeasure = \"angle X A0 B0 about 0 -1 0\"\ndeployed = 0\n" : "") +
         R"([[forces]]
kind = "spring"
nodes = ["W", "A0"]
stiffness = 500
free_length = 3.02
)"
         "\n[[constraints]]\nkind = \"angle\"\nname = \"m\"\naxis = [0, -1, 0]\nmotion = "
         "\"smooth\"\nduration "
         "= 1\nto = 0\n" +
         (both ? R"(nodes = ["X", "A0", "B0"])" : R"(nodes = ["X", "A1", "B1"])") +
         "\n[solver]\nstep = 0.005\nstages = 6\n";
}

}  // namespace

// What the payload shakes is all of it there, so that forces may not be known; what is told is right, to what
// fits may be off by unsaid, or a step of 1e-7 s before the end.
TEST_CASE("forces of a sled on which a drive lays legs flat are right or not known") {
  for (const double hanging : {0.3, 0.7}) {
    const Simulation run = testing::run_scene(on_sled(true, hanging), {"solver.end_time=2"}),
                     other = testing::run_scene(on_sled(false, hanging), {"solver.end_time=0.9999999"});
    CAPTURE(hanging, run.message, other.message);
    REQUIRE(run.status == RunStatus::deployed);
    const Diagnostics d = diagnose(run), truth = diagnose(other);
    const Index end = d.axial_force.rows() - 1;
    for (Index r = 0; r < 3; ++r) CHECK(std::isnan(d.axial_force(end, r)));
    const double off = 1e-3 * truth.axial_force.bottomRows(1).cwiseAbs().maxCoeff();
    if (d.force_unique(end, 5))
      CHECK(d.axial_force(end, 5) == Approx(truth.axial_force.bottomRows(1)(0, 3)).epsilon(0).margin(off));
    if (d.at("m.torque_unique").values.back() == 1)
      CHECK(d.at("m.torque_N_m").values.back() ==
            Approx(truth.at("m.torque_N_m").values.back()).epsilon(0).margin(off));
  }
}

// Inertia alone makes them grow like the angle's second rate over the angle, one over the square of the time
// that is left. The drive's torque is bounded: nothing, where that rate ends at nothing, for weight and load
// have a stationary potential there; else the same by both models, to what fits leave of some newton metres.
TEST_CASE(
    "forces of a mast that a drive lays flat on its path are without bound as those of the full model") {
  for (const std::string motion : {"motion = \"smooth\"\nto = 0\nduration = 0.8",
                                   "motion = \"table\"\ntimes = [0, 0.8]\nvalues = [60, 0]"}) {
    const std::string scene = R"([structure]
kind = "scissor_mast"
cells = 3
fold_angle = 60
deployed_angle = 0
tip_force = 20
[gravity]
acceleration = [0, 0, -3]
[[constraints]]
kind = "angle"
name = "m"
fold_angle = true
)" + motion + "\n[solver]\nend_time = 2\nstep = 0.002\n";
    std::vector<double> torque;
    const Scene read = read_scene_text(scene, "s.toml", {});
    for (const bool path : {true, false}) {
      const auto model = build_model(read);
      const Simulation run = path ? simulate_on_path(model, read.solver) : simulate(model, read.solver);
      CAPTURE(motion, path, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      const Diagnostics d = diagnose(run);
      CHECK(d.axial_force.bottomRows(1).array().isNaN().all());
      torque.push_back(d.at("m.torque_N_m").values.back());
    }
    CAPTURE(motion);
    CHECK(torque[0] == Approx(torque[1]).epsilon(0).margin(1e-3));
    if (motion.find("smooth") != std::string::npos) CHECK(std::abs(torque[0]) < 1e-3);
  }
}

}  // namespace led_forces_test
