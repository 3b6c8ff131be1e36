// SPDX-License-Identifier: BSD-3-Clause
// What drives and guides a structure, as bodies: pulleys under cables, stages of telescopes, actuators,
// motors.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/structure/shown_lines.hpp"
#include "render/scene/hardware.hpp"

namespace unfurl {
namespace {

Vec3f single(const Vec3& v) {
  return v.cast<float>();
}

// Through what angle two rods turn against each other in a motion [rad].
double swing_of(const std::array<int, 3>& nodes, const std::vector<std::vector<Vec3>>& poses) {
  double least = 4, most = 0;
  for (const std::vector<Vec3>& at : poses) {
    const auto place = [&](int k) {
      return at[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])];
    };
    const Vec3 a = place(0) - place(1), b = place(2) - place(1);
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    least = std::min(least, angle), most = std::max(most, angle);
  }
  return most - least;
}

}  // namespace

int Hardware::copy(int node) const {
  return copy_of_[static_cast<std::size_t>(node)];
}

// Cables run over the nodes between their ends, telescopes have stages, length drives two; none where only a
// part of the structure is solved.
void Hardware::find_drives(const Poses& poses) {
  const auto whole = std::ranges::count_if(structure_.nodes, [](const Node& n) { return !n.ghost; });
  solved_whole_ = static_cast<std::size_t>(whole) == structure_.node_copies.size();
  if (!solved_whole_) return;
  for (std::vector<int> stages : telescopes(structure_)) {
    for (int& node : stages) node = copy(node);
    telescopes_.push_back(std::move(stages));
  }
  if (!detailed_) return;
  const auto run_over = [&](const Measure& path) {
    const auto spans = stretches(path);
    for (std::size_t k = 0; k + 1 < spans.size(); ++k) {
      const auto [a, b] = spans[k];
      const auto [c, d] = spans[k + 1];  // whichever way round each of them is
      if (b == c || b == d) pulleys_.push_back({copy(a), copy(b), copy(b == c ? d : c)});
      if (a == c || a == d) pulleys_.push_back({copy(b), copy(a), copy(a == c ? d : c)});
    }
  };
  for (const Force& force : structure_.forces) {
    if (force.kind == "cable" && !(force.smoothing > 0)) run_over(force.measure);
    if (force.kind == "motor") add_drive(force.measure, poses);
  }
  for (const Stop& stop : structure_.stops)
    if (stop.reeled) run_over(stop.measure);
  for (const Constraint& c : structure_.constraints)
    if (c.kind == "measure") add_drive(c.measure, poses);
}

// An angle is driven by a motor at its hinge.
void Hardware::add_drive(const Measure& measure, const Poses& poses) {
  const bool one = measure.kind == MeasureKind::combination && measure.terms.size() == 1;
  if (one) return add_drive(measure.terms.front().measure, poses);
  const std::vector<int>& n = measure.nodes;
  if (measure.kind == MeasureKind::angle && n[0] == n[2]) {
    motors_.push_back({{copy(n[1]), copy(n[0]), copy(n[3])}, measure.axis});
    if (measure.axis.isZero())
      for (const RodEnd& end : joints_->ends(copy(n[0])))
        if (far_end(end) == copy(n[1])) {
          motors_.back().end = end;
          motors_.back().side = outer_side(motors_.back(), poses);
        }
  }
  if (measure.kind == MeasureKind::fold) add_fold_drive(poses);
}

// A fold angle is all units' own: its motors sit at the hinges that turn most.
void Hardware::add_fold_drive(const Poses& poses) {
  constexpr double as_far = 0.9, least = 0.02;  // of the widest; [rad]
  std::vector<Motored> hinges;
  std::vector<double> swings;
  for (std::size_t n = 0; n < structure_.node_copies.size(); ++n) {
    const std::vector<RodEnd>& ends = joints_->ends(static_cast<int>(n));
    double widest = least;
    Motored hinge{{-1, static_cast<int>(n), -1}, Vec3::Zero()};
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        const int a = far_end(ends[i]), b = far_end(ends[j]);
        const double swing = swing_of({a, static_cast<int>(n), b}, poses);
        if (swing > widest) widest = swing, hinge.nodes = {a, static_cast<int>(n), b}, hinge.end = ends[i];
      }
    if (hinge.end.rod < 0) continue;
    hinges.push_back(hinge);
    swings.push_back(widest);
  }
  if (hinges.empty()) return;
  const double most = *std::ranges::max_element(swings);
  for (std::size_t k = 0; k < hinges.size(); ++k) {
    if (swings[k] < as_far * most) continue;
    hinges[k].side = outer_side(hinges[k], poses);
    motors_.push_back(hinges[k]);
  }
}

int Hardware::far_end(const RodEnd& end) const {
  const RodCopy& rod = structure_.rod_copies[static_cast<std::size_t>(end.rod)];
  return end.end == 0 ? rod.b : rod.a;
}

double Hardware::thickest() const {
  double most = 0;
  for (std::size_t i = 0; i < cables_.size(); ++i) most = std::max(most, cables_[i] ? 0.0 : radius(i));
  return most > 0 ? most : looks_.bare_radius;
}

// A wheel on whose rim the cable bends, inside the bend, between two flanges.
void Hardware::add_pulley(const Triple& nodes, const std::vector<Vec3>& at, DrawList& list) const {
  const auto place = [&](int n) { return at[static_cast<std::size_t>(n)]; };
  const Vec3 middle = place(nodes[1]), back = (place(nodes[0]) - middle).normalized(),
             on = (place(nodes[2]) - middle).normalized(), inside = back + on, across = back.cross(on);
  const double r = std::max(3.2 * thickest(), 1.2 * looks_.joint_radius[static_cast<std::size_t>(nodes[1])]);
  if (across.norm() < 1e-3) return;  // it goes straight on
  const Vec3 axis = across.normalized(), center = middle + r * inside.normalized();
  const auto wheel = [&](double from, double to, double wide, const Color& color) {
    list.sleeves.push_back({single(center + from * r * axis), single(center + to * r * axis),
                            static_cast<float>(wide * r), color, Finish::metal});
  };
  wheel(-0.30, 0.30, 0.92, look_.joint);
  for (const double side : {-0.42, 0.30}) wheel(side, side + 0.12, 1.22, look_.fitting);
  wheel(-0.62, 0.62, 0.34, look_.joint);
}

// Tubes that are the thinner the farther out they are, each with a collar where the next one leaves it; plain
// ones where joints are plain.
void Hardware::add_telescope(const std::vector<int>& nodes, const std::vector<Vec3>& at,
                             DrawList& list) const {
  const auto place = [&](std::size_t k) { return at[static_cast<std::size_t>(nodes[k])]; };
  std::vector<Vec3> ends;
  for (std::size_t k = 0; k < nodes.size(); ++k) ends.push_back(place(k));
  if (ends.size() == 2) ends.insert(ends.begin() + 1, 0.55 * ends[0] + 0.45 * ends[1]);
  const auto stages = static_cast<double>(ends.size() - 1);
  const Finish finish = detailed_ ? Finish::anodised : Finish::paint;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const Vec3 along = ends[k + 1] - ends[k];
    const double length = along.norm(), r = thickest() * (1.75 - 0.95 * static_cast<double>(k) / stages);
    if (length <= 0) continue;
    list.tubes.push_back(
        {single(ends[k]), single(ends[k + 1]), static_cast<float>(r), look_.fitting, finish});
    if (!detailed_) continue;
    const bool last = k + 2 == ends.size();
    const Vec3 collar = std::min(2.2 * r, 0.4 * length) / length * along;
    list.sleeves.push_back({single(ends[k + 1] - collar), single(ends[k + 1]),
                            static_cast<float>((last ? 1.35 : 1.22) * r), look_.joint, Finish::metal});
  }
}

// To which side of its rod's axis a motor is farther from the middle of all: in the pose that tells it best.
double Hardware::outer_side(const Motored& motor, const Poses& poses) const {
  double best = 0.05, side = 0;  // [-], of the way to the hinge
  for (std::size_t k = 0; k < poses.size(); ++k) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : poses[k]) middle += x / static_cast<double>(poses[k].size());
    const Vec3 out = poses[k][static_cast<std::size_t>(motor.nodes[1])] - middle;
    const double along = out.dot(joints_->axis(motor.end, joints_->times()[k]));
    if (std::abs(along) > best * out.norm()) best = std::abs(along) / out.norm(), side = along < 0 ? -1 : 1;
  }
  return side;
}

// Around what a motor turns at a time, a unit vector towards the side where it sits. Zero: not known, folded
// flat.
Vec3 Hardware::motor_axis(const Motored& motor, double t, const std::vector<Vec3>& at) const {
  const auto place = [&](int n) { return at[static_cast<std::size_t>(n)]; };
  if (motor.side != 0)
    if (const Vec3 axis = joints_->axis(motor.end, t); !axis.isZero()) return motor.side * axis;
  Vec3 axis = upright_ * motor.axis;
  if (axis.isZero()) {
    const Vec3 hinge = place(motor.nodes[1]), a = place(motor.nodes[0]) - hinge,
               b = place(motor.nodes[2]) - hinge;
    axis = a.cross(b);
    if (axis.norm() < 1e-4 * a.norm() * b.norm()) return Vec3::Zero();
  }
  const Vec3 viewer(0.47, -0.88, 0);  // as pictures begin: of both sides the one that is seen
  return (axis.dot(viewer) < 0 ? -1.0 : 1.0) * axis.normalized();
}

// A housing with its flange on the axis of the hinge, beside the lugs.
void Hardware::add_motor(const Motored& motor, double t, const std::vector<Vec3>& at, DrawList& list) const {
  const Vec3 hinge = at[static_cast<std::size_t>(motor.nodes[1])], axis = motor_axis(motor, t, at);
  if (axis.isZero()) return;
  const double r = thickest();
  const auto part = [&](double from, double to, double wide, const Color& color, Finish finish) {
    list.sleeves.push_back({single(hinge + from * r * axis), single(hinge + to * r * axis),
                            static_cast<float>(wide * r), color, finish});
  };
  part(1.3, 1.9, 2.1, look_.fitting, Finish::metal);
  part(1.9, 5.4, 1.75, {0.16f, 0.17f, 0.19f, 1}, Finish::anodised);
  part(5.4, 5.9, 1.2, look_.fitting, Finish::metal);
}

void Hardware::add_drives(double t, const std::vector<Vec3>& at, DrawList& list) const {
  for (const Triple& pulley : pulleys_) add_pulley(pulley, at, list);
  for (const std::vector<int>& telescope : telescopes_) add_telescope(telescope, at, list);
  for (const Motored& motor : motors_) add_motor(motor, t, at, list);
}

}  // namespace unfurl
