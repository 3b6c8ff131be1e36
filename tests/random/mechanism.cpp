// SPDX-License-Identifier: BSD-3-Clause
#include "tests/random/mechanism.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace unfurl::random {

// SplitMix64 (Steele, Lea & Flood 2014). Seeds in a row would give one stream, shifted: each is scrambled
// first.
Dice::Dice(std::uint64_t seed) : state_(seed) {
  state_ = next() ^ (seed << 32U);
}
std::uint64_t Dice::next() {
  std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31U);
}
double Dice::between(double low, double high) {
  return low + (high - low) * static_cast<double>(next() >> 11U) * 0x1p-53;
}
double Dice::log_between(double low, double high) {
  return std::exp(between(std::log(low), std::log(high)));
}
Vec3 Dice::box(double half) {
  const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
  return {x, y, z};
}
Vec3 Dice::direction() {
  while (true) {
    const Vec3 v = box(1);
    if (v.norm() > 0.2 && v.norm() < 1) return v.normalized();
  }
}

double Motion::value(double t) const {
  if (smooth) {
    const double u = std::clamp((t - start) / duration, 0.0, 1.0);
    return rise * std::pow(u, 3) * (10 - 15 * u + 6 * u * u);
  }
  const double s = std::max(t - start, 0.0);
  if (s >= ramp) return rate * (s - ramp / 2);
  return rate * (std::pow(s, 3) / (ramp * ramp) - std::pow(s, 4) / (2 * std::pow(ramp, 3)));
}
double Motion::first(double t) const {
  if (smooth) {
    const double u = std::clamp((t - start) / duration, 0.0, 1.0);
    return rise / duration * (30 * u * u - 60 * std::pow(u, 3) + 30 * std::pow(u, 4));
  }
  const double u = std::clamp((t - start) / ramp, 0.0, 1.0);
  return rate * (3 * u * u - 2 * std::pow(u, 3));
}
double Motion::second(double t) const {
  const double u = (t - start) / (smooth ? duration : ramp);
  if (u <= 0 || u >= 1) return 0;
  return smooth ? rise / (duration * duration) * (60 * u - 180 * u * u + 120 * std::pow(u, 3))
                : rate / ramp * (6 * u - 6 * u * u);
}
std::vector<double> Motion::knots() const {
  return {start, start + (smooth ? duration : ramp)};
}

namespace {

class Generator {
 public:
  Generator(std::uint64_t seed, unsigned features) : dice_(seed), features_(features) {}

  Mechanism make() {
    m_.end_time = 0.04 * (6 + dice_.below(10));
    m_.lumped = dice_.chance(0.2);
    if (dice_.chance(0.7)) m_.gravity = dice_.log_between(1, 20) * dice_.direction();
    free_ = dice_.chance(0.25);
    planar_ = dice_.chance(0.3);
    normal_ = dice_.direction();
    tree();
    if (dice_.chance(0.5)) loops();
    if (wanted(with_redundant) && dice_.chance(0.35)) rigid_cluster();
    if (planar_) plane_rows();
    forces();
    if (wanted(with_drives) && !free_ && dice_.chance(0.4)) drive();
    if ((wanted(with_stops) || wanted(with_rests)) && dice_.chance(0.5)) stop();
    return m_;
  }

 private:
  bool wanted(unsigned feature) const { return (features_ & feature) != 0; }
  int count() const { return static_cast<int>(m_.points.size()); }
  Vec3 in_plane(const Vec3& v) const { return planar_ ? Vec3(v - normal_.dot(v) * normal_) : v; }
  const Vec3& at(int i) const { return m_.points[static_cast<std::size_t>(i)].position; }
  bool joined(int a, int b) const {
    return std::any_of(m_.bars.begin(), m_.bars.end(), [&](const Bar& bar) {
      return (bar.a == a && bar.b == b) || (bar.a == b && bar.b == a);
    });
  }
  void join(int a, int b) { m_.bars.push_back({a, b, dice_.chance(0.2) ? 0.0 : dice_.log_between(0.3, 3)}); }

  int add_point(const Vec3& position, bool fixed) {
    m_.points.push_back({position, Vec3::Zero(), 0, fixed});
    if (fixed) return count() - 1;
    m_.points.back().velocity = in_plane(dice_.box(1.5));
    m_.points.back().mass = dice_.log_between(0.2, 3);
    return count() - 1;
  }

  // A point at arm's length of another, not near any.
  Vec3 near(const Vec3& from) {
    while (true) {
      const Vec3 x = from + in_plane(dice_.box(1.2));
      double least = 1e9;
      for (const Point& p : m_.points) least = std::min(least, (p.position - x).norm());
      if (least > 0.4) return x;
    }
  }

  void tree() {
    add_point(dice_.box(0.5), !free_);
    for (int i = 1, n = 2 + dice_.below(5); i < n; ++i) {
      const int from = dice_.below(i);
      add_point(near(at(from)), false);
      join(from, i);
    }
  }

  // A second way to what is there: through a new joint, or a point of support.
  void loops() {
    const int a = dice_.below(count()), b = dice_.below(count());
    const int c = add_point(near(at(a)), false);
    join(a, c);
    if (!free_ && dice_.chance(0.5)) {
      const int d = add_point(near(at(c)), true);
      join(c, d);
    } else if (b != a && !joined(b, c)) {
      join(b, c);
    }
  }

  // Five points all joined: ten bars, of which nine are independent; in a plane four: six bars for five.
  void rigid_cluster() {
    std::vector<int> cluster = {dice_.below(count())};
    while (static_cast<int>(cluster.size()) < (planar_ ? 4 : 5)) {
      const int p = add_point(near(at(cluster[0])), false);
      for (const int other : cluster) join(other, p);
      cluster.push_back(p);
    }
  }

  void plane_rows() {
    for (int i = 0; i < count(); ++i)
      if (!m_.points[static_cast<std::size_t>(i)].fixed) m_.rows.push_back({"plane", {i}, {normal_}});
  }

  std::pair<int, int> two() {
    const int a = dice_.below(count());
    return {a, (a + 1 + dice_.below(count() - 1)) % count()};
  }
  double distance(int a, int b) const { return (at(a) - at(b)).norm(); }

  void forces() {
    for (int k = dice_.below(3); k > 0 && wanted(with_springs); --k) {
      const auto [a, b] = two();
      const bool cable = wanted(with_cables) && dice_.chance(0.4);
      // Not on the edge of slack: that would be decided by round-off.
      double share = dice_.between(0.6, 1.5);
      if (std::abs(share - 1) < 0.02) share = 0.9;
      m_.springs.push_back({a, b, dice_.log_between(5, 200),
                            dice_.chance(0.4) ? dice_.log_between(0.1, 3) : 0, share * distance(a, b),
                            cable});
    }
    if (wanted(with_springs) && m_.bars.size() > 1 && dice_.chance(0.3)) twist();
    for (int k = dice_.below(3); k > 0; --k)
      m_.loads.push_back({dice_.below(count()), dice_.box(15), {}, {}});
    for (int k = wanted(with_pulses) ? dice_.below(3) : 0; k > 0; --k) pulse();
    if (dice_.chance(0.2))
      m_.followers.push_back({dice_.below(static_cast<int>(m_.bars.size())), dice_.between(-10, 10)});
    if (dice_.chance(0.2)) m_.drags.push_back({dice_.below(count()), dice_.log_between(0.1, 3)});
  }

  void twist() {
    for (std::size_t i = 0; i < m_.bars.size(); ++i)
      for (std::size_t j = i + 1; j < m_.bars.size(); ++j) {
        const Bar &p = m_.bars[i], &q = m_.bars[j];
        const int hinge = p.a == q.a || p.a == q.b ? p.a : p.b == q.a || p.b == q.b ? p.b : -1;
        if (hinge < 0 || !dice_.chance(0.5)) continue;
        m_.twists.push_back({p.a == hinge ? p.b : p.a, hinge, q.a == hinge ? q.b : q.a,
                             dice_.log_between(1, 30), dice_.chance(0.4) ? dice_.log_between(0.05, 1) : 0,
                             dice_.between(0.5, 2.6)});
        if (!planar_ || !wanted(with_turns) || dice_.chance(0.4)) return;
        m_.twists.back().axis = normal_;
        m_.twists.back().free_angle = dice_.between(-5, 5);
        return;
      }
  }

  // Up and down within a time that may be far shorter than a step, or a table over the whole run.
  void pulse() {
    Load load{dice_.below(count()), dice_.direction(), {}, {}};
    const double end = m_.end_time;
    if (dice_.chance(0.5)) {
      const double width = dice_.log_between(1e-3, 0.1) * end, begin = dice_.between(0, end - 2 * width);
      const double impulse = dice_.between(0.2, 2);  // [N s]
      load.times = {begin, begin + 0.4 * width, begin + width};
      load.values = {0, 2 * impulse / width, 0};
    } else {
      for (double t = dice_.between(-0.1, 0.1); t < 1.2 * end; t += dice_.between(0.05, 0.3) * end) {
        load.times.push_back(t);
        load.values.push_back(dice_.between(-15, 15));
      }
    }
    if (load.times.size() > 1) m_.loads.push_back(load);
  }

  Motion motion() {
    Motion motion;
    motion.smooth = dice_.chance(0.5);
    motion.start = dice_.chance(0.3) ? 0 : dice_.between(0, 0.5) * m_.end_time;
    motion.duration = dice_.between(0.3, 0.9) * m_.end_time;
    motion.rise = dice_.between(-0.15, 0.15);
    motion.rate = dice_.between(-0.3, 0.3);
    motion.ramp = dice_.between(0.05, 0.4) * m_.end_time;
    return motion;
  }

  void drive() {
    const auto [a, b] = two();
    const bool both_fixed =
        m_.points[static_cast<std::size_t>(a)].fixed && m_.points[static_cast<std::size_t>(b)].fixed;
    if (dice_.chance(0.5) && !joined(a, b) && !both_fixed)
      m_.drives.push_back({true, {a, b}, Vec3::Zero(), motion()});
    else if (!m_.points[static_cast<std::size_t>(a)].fixed)
      m_.drives.push_back({false, {a}, in_plane(dice_.direction()).normalized(), motion()});
  }

  void stop() {
    const auto [a, b] = two();
    Stop s;
    s.length = dice_.chance(0.5);
    if (s.length && joined(a, b)) return;
    s.nodes = s.length ? std::vector<int>{a, b} : std::vector<int>{a};
    s.direction = s.length ? Vec3(Vec3::Zero()) : Vec3(in_plane(dice_.direction()).normalized());
    const double now = s.length ? distance(a, b) : s.direction.dot(at(a));
    s.lower = dice_.chance(0.5);
    s.limit = now + (s.lower ? -1 : 1) * dice_.between(0.02, 0.3) * (s.length ? now : 1.0);
    s.restitution = wanted(with_rests) && dice_.chance(0.3) ? 0.0 : dice_.between(0.3, 1);
    m_.stops.push_back(s);
  }

  Dice dice_;
  unsigned features_;
  bool free_ = false, planar_ = false;
  Vec3 normal_ = Vec3::Zero();
  Mechanism m_;
};

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  const std::string s = text;
  return s.find_first_of(".e") == std::string::npos ? s + ".0" : s;
}
std::string list(const std::vector<double>& xs) {
  std::string s;
  for (const double x : xs) s += (s.empty() ? "" : ", ") + number(x);
  return "[" + s + "]";
}
std::string list(const Vec3& x) {
  return list(std::vector<double>{x[0], x[1], x[2]});
}
std::string names(const std::vector<int>& nodes) {
  std::string s;
  for (const int i : nodes) s += (s.empty() ? "\"n" : ", \"n") + std::to_string(i) + "\"";
  return "[" + s + "]";
}

std::string constraint_text(const Mechanism& m) {
  std::string s;
  for (const LinearRow& row : m.rows) {
    s += "[[structure.constraints]]\nkind = \"" + row.kind + "\"\nnodes = " + names(row.nodes) + "\n";
    if (row.kind == "plane") s += "normal = " + list(row.coefficients[0]) + "\n";
  }
  int count = 0;
  for (const Drive& d : m.drives) {
    s += "[[constraints]]\nname = \"drive" + std::to_string(count++) + "\"\nkind = \"";
    s += (d.length ? "length" : "coordinate") + std::string("\"\nnodes = ") + names(d.nodes) + "\n";
    if (!d.length) s += "direction = " + list(d.direction) + "\n";
    const Vec3 &a = m.points[static_cast<std::size_t>(d.nodes[0])].position,
               &b = m.points[static_cast<std::size_t>(d.nodes.back())].position;
    const double begin = d.length ? (b - a).norm() : d.direction.dot(a);
    s += "start = " + number(d.motion.start) + "\n";
    if (d.motion.smooth)
      s += "motion = \"smooth\"\nto = " + number(begin + d.motion.rise) +
           "\nduration = " + number(d.motion.duration) + "\n";
    else
      s += "motion = \"rate\"\nrate = " + number(d.motion.rate) + "\nramp = " + number(d.motion.ramp) + "\n";
  }
  for (const Stop& stop : m.stops) {
    s += "[[constraints]]\nname = \"stop" + std::to_string(count++) + "\"\nkind = \"";
    s += (stop.length ? "length_stop" : "coordinate_stop") + std::string("\"\nnodes = ") + names(stop.nodes) +
         "\n";
    if (!stop.length) s += "direction = " + list(stop.direction) + "\n";
    s += (stop.lower ? "min = " : "max = ") + number(stop.limit) +
         "\nrestitution = " + number(stop.restitution) + "\n";
  }
  return s;
}

std::string force_text(const Mechanism& m) {
  std::string s;
  for (const Spring& f : m.springs) {
    s += "[[forces]]\nkind = \"spring\"\nnodes = " + names({f.a, f.b}) +
         "\nstiffness = " + number(f.stiffness) + "\nfree_length = " + number(f.free_length) + "\n";
    if (f.damping > 0) s += "damping = " + number(f.damping) + "\n";
    if (f.cable) s += "tension_only = true\n";
  }
  for (const Twist& f : m.twists) {
    s += "[[forces]]\nkind = \"torsion_spring\"\nnodes = " + names({f.a, f.hinge, f.b}) +
         "\nstiffness = " + number(f.stiffness) + "\nfree_angle = " + number(f.free_angle * 180 / M_PI) +
         "\n";
    if (f.damping > 0) s += "damping = " + number(f.damping) + "\n";
    if (!f.axis.isZero()) s += "axis = " + list(f.axis) + "\n";
  }
  for (const Load& f : m.loads) {
    s += f.times.empty() ? "[[loads]]\n" : "[[forces]]\nkind = \"load_over_time\"\n";
    s += "nodes = " + names({f.node}) + "\nforce = " + list(f.force) + "\n";
    if (!f.times.empty()) s += "times = " + list(f.times) + "\nvalues = " + list(f.values) + "\n";
  }
  for (const Follower& f : m.followers)
    s += "[[forces]]\nkind = \"follower\"\nrod = \"r" + std::to_string(f.bar) +
         "\"\nforce = " + number(f.force) + "\n";
  for (const Drag& f : m.drags)
    s +=
        "[[forces]]\nkind = \"drag\"\nnodes = " + names({f.node}) + "\ndamping = " + number(f.damping) + "\n";
  return s;
}

}  // namespace

Mechanism draw(std::uint64_t seed, unsigned features) {
  return Generator(seed, features).make();
}

std::string scene_text(const Mechanism& m, int stages, double step) {
  std::string s = "[structure]\nkind = \"custom\"\n";
  if (m.lumped) s += "mass = \"lumped\"\n";
  for (std::size_t i = 0; i < m.points.size(); ++i) {
    const Point& p = m.points[i];
    s += "[[structure.nodes]]\nname = \"n" + std::to_string(i) + "\"\nposition = " + list(p.position) + "\n";
    if (p.fixed)
      s += "fixed = true\n";
    else
      s += "velocity = " + list(p.velocity) + "\nmass = " + number(p.mass) + "\n";
  }
  for (std::size_t i = 0; i < m.bars.size(); ++i)
    s += "[[structure.rods]]\nname = \"r" + std::to_string(i) +
         "\"\nnodes = " + names({m.bars[i].a, m.bars[i].b}) + "\nmass = " + number(m.bars[i].mass) + "\n";
  s += constraint_text(m) + force_text(m);
  s += "[gravity]\nacceleration = " + list(m.gravity) + "\n";
  s += "[solver]\nmethod = \"dvm\"\nstages = " + std::to_string(stages) + "\nstep = " + number(step) +
       "\nend_time = " + number(m.end_time) + "\n";
  return s;
}

Mechanism turned(const Mechanism& mechanism, const Eigen::Matrix3d& turn) {
  Mechanism m = mechanism;
  const auto rotate = [&](Vec3& v) { v = (turn * v).eval(); };
  for (Point& p : m.points) rotate(p.position), rotate(p.velocity);
  for (LinearRow& row : m.rows)
    for (Vec3& c : row.coefficients) rotate(c);
  for (Drive& d : m.drives) rotate(d.direction);
  for (Load& load : m.loads) rotate(load.force);
  for (Twist& t : m.twists) rotate(t.axis);
  for (Stop& s : m.stops) rotate(s.direction);
  rotate(m.gravity);
  return m;
}

Mechanism renumbered(const Mechanism& mechanism, const std::vector<int>& order) {
  Mechanism m = mechanism;
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    m.points[i] = mechanism.points[static_cast<std::size_t>(order[i])];
  }
  const auto move = [&](int& node) { node = place[static_cast<std::size_t>(node)]; };
  for (Bar& bar : m.bars) move(bar.a), move(bar.b);
  std::reverse(m.bars.begin(), m.bars.end());
  for (Follower& f : m.followers) f.bar = static_cast<int>(m.bars.size()) - 1 - f.bar;
  for (LinearRow& row : m.rows)
    for (int& node : row.nodes) move(node);
  for (Drive& d : m.drives)
    for (int& node : d.nodes) move(node);
  for (Spring& s : m.springs) move(s.a), move(s.b);
  for (Twist& t : m.twists) move(t.a), move(t.hinge), move(t.b);
  for (Load& load : m.loads) move(load.node);
  for (Drag& d : m.drags) move(d.node);
  for (Stop& s : m.stops)
    for (int& node : s.nodes) move(node);
  return m;
}

}  // namespace unfurl::random
