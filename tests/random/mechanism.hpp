// SPDX-License-Identifier: BSD-3-Clause
// A mechanism drawn from a seed: plain data of its own, which is written as a scene for the program and read
// as it is by the independent solver.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace unfurl::random {

using Vec3 = Eigen::Vector3d;
using Vector = Eigen::VectorXd;

struct Point {
  Vec3 position, velocity = Vec3::Zero();  // [m], [m/s]
  double mass = 0;                         // [kg]
  bool fixed = false;
};
struct Bar {
  int a, b;
  double mass;  // [kg]
};
// sum of coefficients . x = const.
struct LinearRow {
  std::string kind;  // "plane", "relation"
  std::vector<int> nodes;
  std::vector<Vec3> coefficients;
};
// A value that moves from what it is at t = 0: by `rise` smoothly (10 u^3 - 15 u^4 + 6 u^5), or at a rate
// that is reached within a ramp.
struct Motion {
  bool smooth = true;
  double start = 0, duration = 1, rise = 0;  // [s], [s], [m]
  double rate = 0, ramp = 0;                 // [m/s], [s]

  double value(double t) const;  // what is added to the value at t = 0
  double first(double t) const;
  double second(double t) const;
  std::vector<double> knots() const;  // where a third derivative or less jumps
};
struct Drive {
  bool length = true;  // of two nodes; false: coordinate of nodes[0] along `direction`
  std::vector<int> nodes;
  Vec3 direction = Vec3::Zero();
  Motion motion;
};
struct Spring {
  int a, b;
  double stiffness, damping, free_length;
  bool cable = false;
};
// Torque on the angle from hinge-a to hinge-b: in [0, pi], or with an axis (normal to all motion) followed
// through any number of turns.
struct Twist {
  int a, hinge, b;
  double stiffness, damping, free_angle;  // [N m/rad], [N m s/rad], [rad]
  Vec3 axis = Vec3::Zero();
};
struct Load {
  int node;
  Vec3 force;                         // [N]
  std::vector<double> times, values;  // factor, straight between the points, held beyond; empty: constant
};
struct Follower {
  int bar;
  double force;  // on node b, from a to b [N]
};
struct Drag {
  int node;
  double damping;  // [N s/m]
};
struct Stop {
  bool length = true;
  std::vector<int> nodes;
  Vec3 direction = Vec3::Zero();
  bool lower = true;  // the measure stays above the limit; false: below
  double limit = 0, restitution = 0.5;
};

struct Mechanism {
  std::vector<Point> points;
  std::vector<Bar> bars;
  std::vector<LinearRow> rows;
  std::vector<Drive> drives;
  std::vector<Spring> springs;
  std::vector<Twist> twists;
  std::vector<Load> loads;
  std::vector<Follower> followers;
  std::vector<Drag> drags;
  std::vector<Stop> stops;
  Vec3 gravity = Vec3::Zero();
  bool lumped = false;
  double end_time = 0.5;  // [s]
};

// What a drawn mechanism may have; each bit may be left out of a search.
enum Feature : unsigned {
  with_drives = 1,
  with_springs = 2,
  with_cables = 4,
  with_stops = 8,
  with_pulses = 16,
  with_redundant = 32,
  with_rests = 64,
  with_turns = 128,
  all_features = 255
};

Mechanism draw(std::uint64_t seed, unsigned features = all_features);
std::string scene_text(const Mechanism& mechanism, int stages, double step);

// The same mechanism turned about the origin, or with nodes and bars in another order (order[new] = old).
Mechanism turned(const Mechanism& mechanism, const Eigen::Matrix3d& turn);
Mechanism renumbered(const Mechanism& mechanism, const std::vector<int>& order);

// Numbers that are the same on every machine: the standard's distributions are not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed);
  std::uint64_t next();
  double between(double low, double high);
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  bool chance(double p) { return between(0, 1) < p; }
  double log_between(double low, double high);
  Vec3 box(double half);
  Vec3 direction();

 private:
  std::uint64_t state_;
};

}  // namespace unfurl::random
