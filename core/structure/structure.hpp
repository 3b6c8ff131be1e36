// SPDX-License-Identifier: BSD-3-Clause
// A structure as plain data: what is solved (nodes, rods, constraints, loads) and what is shown (copies of
// those).
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/math/types.hpp"
#include "core/structure/time_function.hpp"

namespace unfurl {

struct Node {
  std::string name;
  Vec3 position = Vec3::Zero();  // at t = 0 [m]
  Vec3 velocity = Vec3::Zero();  // at t = 0 [m/s]
  double mass = 0.0;             // lumped mass, added to the rods' share [kg]
  // A number of a drive (the turn of a rotor, the integral of a controller) that moves along x as a node
  // does: nowhere in space, so that it has no weight, no momentum, and is not shown.
  bool ghost = false;
};

// A uniform rod between two nodes; mass 0 makes it a pure distance constraint. Its motion is that of a rigid
// rod unless it gives; a modulus says how rods share forces that rigid ones leave open, and what they may
// carry.
struct Rod {
  std::string name;
  int a = 0, b = 0;   // node indices
  double mass = 0.0;  // [kg]
  // [m]; the distance of its nodes at t = 0 (fit_lengths.hpp sees to that), of one that gives without force
  double length = 0.0;
  std::string group;    // "chord", "post", "rod", ...: what colours and groups of rod forces go by
  double radius = 0.0;  // for drawing; 0: not known [m]
  double multiplicity =
      1.0;            // how many equal rods of the whole structure this one stands for (sector models)
  double area = 0.0;  // of the cross section; 0: not known [m^2]
  double youngs_modulus = std::numeric_limits<double>::infinity();  // infinite: rigid [Pa]
  double second_moment = 0.0;  // of the cross section, the smallest; 0: not known [m^4]
  double strength = std::numeric_limits<double>::infinity();  // axial stress that it may bear [Pa]
  // Its length follows its force (forces/elastic_rods.hpp): a rod of the motion that is elastic.
  bool gives = false;
  double damping_time = 0.0;  // of a rod that gives: N = (e + damping_time e') / compliance [s]
  double free_length = 0.0;   // in place of length: it starts stretched; 0: not given [m]
  double expansion = 0.0;     // relative change of length per kelvin [1/K]
  TimeFunction warming = {};  // above the temperature at which it has its length [K]
  // Of a rod that was cut to bend, one of so many equal parts (structures/segments.hpp).
  int parts = 1;
  std::string whole = {};  // that rod's name; empty: not cut

  // The change of its length over time, as a share of it, and the derivatives of that [1, 1/s, 1/s^2].
  double warmed(double t, int order = 0) const {
    return expansion == 0 ? 0.0 : expansion * warming.derivative(order, t);
  }
  // Of a rod that gives, without force [m].
  double rest_length(double t) const { return natural_length() * (1 + warmed(t)); }
  double rest_rate(double t) const { return natural_length() * warmed(t, 1); }  // its derivative [m/s]
  double natural_length() const { return free_length > 0 ? free_length : length; }
  // Between the pins at which it, or the rod that it is a part of, may turn, without force [m].
  double pinned_length() const { return parts * natural_length(); }
  bool elastic() const { return area > 0 && std::isfinite(youngs_modulus); }
  // Stretch per axial force, of all that it stands for together; 0: rigid [m/N].
  double compliance() const {
    return elastic() ? natural_length() / (youngs_modulus * area * multiplicity) : 0.0;
  }
};

// sum_i coefficient_i . x_{node_i} + offset: a linear measure of the configuration.
struct LinearForm {
  std::vector<int> nodes;
  std::vector<Vec3> coefficients;
  double offset = 0.0;

  bool empty() const { return nodes.empty(); }
  // q: all node coordinates [3 n].
  double operator()(const ConstVec& q) const;
  // The part without the offset; of velocities it is the rate.
  double rate(const ConstVec& v) const;
};

enum class MeasureKind { coordinate, length, angle, fold, dihedral, combination };

struct MeasureTerm;

// A scalar of the configuration; core/structure/measure.hpp says what each kind measures.
struct Measure {
  MeasureKind kind = MeasureKind::length;
  std::vector<int> nodes;  // coordinate: 1 or 2; length: 2; angle: 4 or 6; dihedral: 4; others: none
  Vec3 axis = Vec3::Zero();
  double reference =
      0.0;  // angles with a sign: at t = 0 they are counted on the branch within pi of it [rad]
  std::vector<MeasureTerm> terms;  // of a combination: no combinations
};

// One term of sum_i coefficient_i * measure_i.
struct MeasureTerm {
  double coefficient = 1.0;
  Measure measure = {};
};

// One constraint of a kind in the constraint table (constraints/constraint.hpp says how each kind reads the
// fields).
struct Constraint {
  std::string kind;           // "plane", "fixed", "relation", ...
  std::string name;           // for messages: "plane of B0"
  std::vector<int> nodes;     // node indices
  std::vector<Vec3> vectors;  // directions or coefficients
  double value = 0.0;         // offset or length [m]
  Measure measure = {};       // "measure": what is held or driven
  TimeFunction target = {};   // "measure": its value over time, in the measure's unit
  bool symmetry = false;      // says that a structure is flat or symmetric: no support
  bool of_stop = false;       // stands for a stop, cable or friction that holds, or a latch
  int side = -1;              // of the stops (simulate/stops.hpp), for which it stands; -1: for none
};

// An end stop: limits that a measure may touch but not pass (simulate/stops.hpp).
struct Stop {
  std::string name;  // for messages and events
  Measure measure;
  // In the measure's unit [m] or [rad]; infinite where there is no limit.
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  double restitution = 0.0;  // rebound speed over approach speed
  double rest_speed = 0.0;   // rebounds slower than this rest on the stop [m/s] or [rad/s]
  // A cable that is paid out or drawn in: the upper limit over time, in place of max.
  TimeFunction reel = {};
  bool reeled = false;
};

// A motor that turns or pulls a measure through a gear; forces/motor.hpp says by what law.
struct Motor {
  enum class Control { none, position, rate };
  // Which part of its law holds; any: the one that the state asks for.
  enum class Regime { asked, forward, backward, limit, reverse_limit, any };

  double stall = 0.0;          // torque or force at rest, of the motor [N m] or [N]
  double no_load_speed = 0.0;  // of the motor, where its torque is zero [rad/s] or [m/s]
  double gear_ratio = 1.0;     // speed of the motor over that of the measure
  double limit = std::numeric_limits<double>::infinity();  // most that the motor gives, by its current
  Control control = Control::none;                         // none: full voltage
  double proportional = 0.0, integral = 0.0, derivative = 0.0;
  TimeFunction command = {};  // what a controller follows, in the measure's unit or, of a rate, per second
  int integrator = -1;        // the ghost that sums up a controller's error; -1: none
  Regime regime = Regime::any;
};

// One force of a kind in the force table (forces/force.hpp).
struct Force {
  std::string kind;               // "spring", "follower", ...
  std::string name;               // for messages and columns
  std::vector<int> nodes;         // node indices
  Measure measure = {};           // spring, torsion_spring: what it acts on
  double stiffness = 0.0;         // [N/m] or [N m/rad]
  double damping = 0.0;           // [N s/m] or [N m s/rad]
  double rest = 0.0;              // value of the measure without a force [m] or [rad]
  bool one_sided = false;         // pulls only: a cable
  bool slack = false;             // one that does not pull now, whatever its length is
  double smoothing = 0.0;         // of what pulls only: half of the width over which it begins to [m]
  double axial_stiffness = 0.0;   // of a cable, E A [N]; its stiffness is that over its unstressed length
  TimeFunction unstressed = {};   // of a cable: that length over time [m]
  Motor motor = {};               // of a motor
  Vec3 direction = Vec3::Zero();  // of a load over time
  TimeFunction size = {};         // of a load [N]; of a temperature [K]
  double expansion = 0.0;         // of a temperature [1/K]
  LinearForm form = {};           // of a latch: what it pulls to zero
  // friction: what it gives while it slips, and at most while it sticks [N] or [N m]; the sense in which it
  // slips, 0: it does not
  double kinetic = 0.0, holding = 0.0;
  int slip = 0;
  // offload: length of the rope, infinite where its trolley follows [m]; where the trolley stays, NaN: above
  // the node's start [m]
  double rope = 0.0;
  Vec3 trolley = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

// A constant force on a node.
struct Load {
  int node = 0;
  Vec3 force = Vec3::Zero();  // [N]
  bool shown = true;          // drawn as an arrow
};

// How far the structure has unfolded. The fold angle atan2(fold_sine, fold_cosine) falls from its initial to
// its deployed value; or some measure goes from its stowed to its deployed value. A structure that has
// neither: no deployed event, no fold angle.
struct Deployment {
  LinearForm fold_sine;              // [-]
  LinearForm fold_cosine;            // [-]
  double initial_fold_angle = 0.0;   // [rad]
  double deployed_fold_angle = 0.0;  // [rad]

  // Zero when deployed; what latches hold. Empty: fold_sine is held. Where several parts can move on their
  // own in the deployed pose, each needs one.
  std::vector<LinearForm> latches = {};
  // The same of parts that may be uneven in the deployed pose, where one latch holds them all; what is zero
  // there [m].
  std::vector<LinearForm> parts = {};

  // In place of a fold angle. Its angles with a sign count their turns (FollowedAngles, measure.hpp).
  bool measured = false;
  Measure measure = {};
  double stowed = 0.0, deployed = 0.0;  // [m] or [rad]

  bool empty() const { return fold_sine.empty() && !measured; }
  bool folds() const { return !fold_sine.empty(); }              // has a fold angle
  double fold_angle(const ConstVec& q) const;                    // [rad]
  double fold_rate(const ConstVec& q, const ConstVec& v) const;  // [rad/s]
  // (cos fold - cos initial) / (cos deployed - cos initial), or that of the measure's values: 0 folded, 1
  // deployed. `angles`: those of a measure near which its own are taken, as State::angles begin; none: the
  // pose is taken to be within half a turn of the middle of both values.
  double fraction(const ConstVec& q, const VectorXd& angles = {}) const;
  // sin(fold - deployed), or 1 - fraction of a measure, of which the deployed event is the zero, and its rate
  // [1/s]; the sine is linear. Beyond a right angle the sine falls again, and is zero in the pose opposite
  // to the deployed one: there it is sign (2 - |sine|), which goes on to +-2 at half a turn.
  double remaining(const ConstVec& q, const VectorXd& angles = {}) const;
  double remaining_rate(const ConstVec& q, const ConstVec& v) const;
  bool is_passed(double left_before, double left_after) const;  // is_fold_passed(), of a measure always
  // What of remaining() counts as nothing: a fixed share, and far from the origin what rounding coordinates
  // as large as those of this pose leaves of it.
  double rounded(const ConstVec& q) const;
  // The measure's angles that count turns: those at t = 0, and in a pose from those of one that is less than
  // half a turn away.
  VectorXd first_angles() const;
  void count_on(const ConstVec& q, VectorXd& angles) const;
};

// What remains of a fold, by sine and cosine of the angle to the deployed pose (Deployment::remaining()).
double remaining_of_fold(double sine, double cosine);
// Whether between two poses, of which the first has something left and the second nothing, the deployed one
// lies, and not that opposite to it: on the shorter way.
bool is_fold_passed(double left_before, double left_after);

// A length of the whole that is reported where a structure has it: `name` with its unit is a column of the
// series.
struct ReportedLength {
  std::string name;   // "column_pitch_m"
  std::string label;  // "column pitch"
  LinearForm value;   // [m]
};

// Nodes that are to lie on a paraboloid of revolution about z, z = (x^2 + y^2) / (4 focal_length) + c: the
// root mean square of what their heights are off that with the best c is a column of the series.
struct ReportedSurface {
  std::string name;   // "surface_rms_m"
  std::string label;  // "surface error"
  std::vector<int> nodes;
  double focal_length = 0.0;  // [m]

  double rms(const ConstVec& q) const;  // [m]
};

// A straight line that is shown between two NodeCopies and is no rod: a span of a cable, a member of a net.
struct ShownLine {
  int a = 0, b = 0;
  std::string group;  // "cable", "net"
};

// A node of the whole structure: map * (position of the solved node `source`) + offset.
struct NodeCopy {
  std::string name;
  int source = 0;
  Mat3 map = Mat3::Identity();
  Vec3 offset = Vec3::Zero();
};

// A rod of the whole structure between two NodeCopies; `source` is the solved rod that carries its force.
struct RodCopy {
  std::string name;
  int a = 0, b = 0;
  int source = 0;
};

// A load of the whole structure, for arrows.
struct LoadCopy {
  int node = 0;  // index of a NodeCopy
  Vec3 force = Vec3::Zero();
};

struct Structure {
  std::string kind;  // the family's name
  // What is solved.
  std::vector<Node> nodes;
  std::vector<Rod> rods;
  std::vector<Constraint> constraints;
  std::vector<Stop> stops;
  std::vector<Load> loads;
  std::vector<Force> forces;
  Vec3 gravity = Vec3::Zero();  // acceleration [m/s^2]
  bool lumped_mass = false;     // true: half of a rod's mass at each node instead of the consistent matrix
  // The motion is that of rigid rods; what rods with a modulus give is added to what is shown of it
  // (simulate/stretched.hpp).
  bool quasi_static = false;
  Deployment deployment;
  std::vector<ReportedLength> lengths;
  // Indices of the lengths along and across a stretch; their strain increments give Poisson's ratio,
  // -(across'/across) / (along'/along). -1: the structure has none.
  int strain_along = -1, strain_across = -1;
  // What is shown and exported: the whole structure (equal to the solved one unless a sector model replicates
  // it).
  std::vector<NodeCopy> node_copies;
  std::vector<RodCopy> rod_copies;
  std::vector<LoadCopy> load_copies;
  std::vector<ShownLine> lines = {};
  std::vector<ReportedSurface> surfaces = {};
  std::vector<std::string> notes = {};          // what was changed of the given: warnings for whoever runs it
  std::vector<std::string> notes_on_path = {};  // and for whoever runs it along its path
  double sectors = 1.0;  // how many times what is solved makes the whole: energies are reported of the whole
};

// Per solved rod: whether it is shown; helpers that only hold a shape are not.
std::vector<char> shown_rods(const Structure& structure);
// Fill the copies with the solved nodes, rods and loads themselves.
void show_as_solved(Structure& structure);
// Fill the lines with the spans of all cables.
void show_cables(Structure& structure);

// Coordinates or velocities of the whole structure [3 N] from those of the solved nodes [3 n]; velocities
// take no offset.
VectorXd whole_positions(const Structure& structure, const ConstVec& q);
VectorXd whole_velocities(const Structure& structure, const ConstVec& v);

// Rod `rod` as it was given, where it is a part of one that was cut to bend: its place among those that were
// given, and the whole of it, from the first node of its first part to the last one of its last.
struct GivenRod {
  std::size_t place = 0;
  Rod rod;
};
GivenRod given_rod(const Structure& structure, std::size_t rod);

}  // namespace unfurl
