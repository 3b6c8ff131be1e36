// SPDX-License-Identifier: BSD-3-Clause
// Forces in a flat pose to which a drive leads, of what swings there fast.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
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

// The drive's torque in the flat pose by virtual work of all that it moves, and the rod's axial force.
Pair expected(const Motion& motion, const Payload& payload) {
  constexpr int steps = 20000;  // Runge-Kutta's of up to 3e-3 rad, off by 1e-11 or so
  const double end = motion.flat(), h = end / steps;
  Four y = payload.first();
  for (int i = 0; i < steps; ++i) {
    const Vec3 now = motion.angle(i * h), middle = motion.angle((i + 0.5) * h),
               then = motion.angle((i + 1) * h);
    const Four a = payload.slope(now, y), b = payload.slope(middle, y + h / 2 * a),
               c = payload.slope(middle, y + h / 2 * b), d = payload.slope(then, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  Vec3 a = motion.angle(end);
  a[0] = 0;
  double axial = 0;
  const Pair f = payload.on_leg(a, y, axial);
  const double back = payload.on_rod ? payload.stiffness * (y[0] + start) : 0;
  return {(2.0 / 3 + 1) * a[2] + (0.5 + 0.5 + 1) * weight - f[1] - back, axial};
}

// Two legs and a coupler of 1 m and 1 kg on pivots in one line, the first leg led.
std::string linkage(const Motion& motion, const Payload& payload) {
  return R"toml([structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = ["=cos(60*deg)", 0, "=sin(60*deg)"]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)"]},
  {name = "P", position = [1.2, 0, "=sin(60*deg)-0.15"], mass = 1.3}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1})toml" +
         std::string(payload.on_rod ? R"(, {nodes = ["B1", "P"], mass = 0}])" : "]") + R"(
[[structure.constraints]]
kind = "plane"
nodes = ["B*", "P"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
[[forces]]
)" +
         (payload.on_rod ? "kind = \"torsion_spring\"\nnodes = [\"A1\", \"B1\", \"P\"]\naxis = [0, -1, 0]\n"
                         : "kind = \"spring\"\nnodes = [\"B1\", \"P\"]\n") +
         "stiffness = " + number(payload.stiffness) +
         "\n[[constraints]]\nkind = \"angle\"\nname = \"m\"\nnodes = [\"X\", \"A0\", \"B0\"]\naxis = [0, -1, "
         "0]\n" +
         (motion.is_table ? "motion = \"table\"\ntimes = [0, 1]\nvalues = [60, 0]\n"
                          : "motion = \"smooth\"\nduration = 1\nto = " + number(motion.to) + "\n") +
         "[solver]\nend_time = 2\n";
}

}  // namespace

// The drive's torque and the payload's force are finite there, the legs' and the coupler's without bound. Six
// stages at up to a radian a step are off by 1e-8 or so; of that and of rounding in rates next to the pose,
// 1e-16 over what is left of the angle, forces of some hundreds of newtons have some 1e-6.
TEST_CASE("forces of what swings fast in a flat pose to which a drive leads are those of its own motion") {
  for (const Motion& motion : {Motion{false, 0}, Motion{true, 0}, Motion{false, -5}})
    for (const Payload& payload : {Payload{true, 40}, Payload{true, 300}, Payload{false, 4000}})
      for (const double step : {0.01, 0.007}) {
        const Simulation run =
            testing::run_scene(linkage(motion, payload), {"solver.step=" + number(step), "solver.stages=6"});
        CAPTURE(motion.is_table, motion.to, payload.on_rod, payload.stiffness, step, run.message);
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

}  // namespace led_forces_test
