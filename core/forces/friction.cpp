// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/friction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/constraints/linear_rows.hpp"
#include "core/forces/pin_loads.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {
namespace {

class DryFriction final : public ForceBlock {
 public:
  DryFriction(const Structure& structure, const SparseRows& node_mass) {
    const std::vector<int> followed = followed_angles(structure).of_force;
    for (std::size_t i = 0; i < structure.forces.size(); ++i) {
      const Force& f = structure.forces[i];
      if (f.kind != "friction") continue;
      any_ = true;
      if (f.slip == 0) continue;
      slipping_.push_back(
          {MeasureFunction(f.measure, structure.deployment), f.slip * f.kinetic, followed[i],
           f.slip * PinLoads::arm(f), i, f.slip,
           f.measure.kind == MeasureKind::angle && !counts_turns(f.measure) ? f.measure : Measure(),
           f.measure.kind == MeasureKind::length ? passing * reference_length(structure) : 0.0});
      if (!(PinLoads::arm(f) > 0)) continue;
      if (!loads_) loads_ = std::make_unique<PinLoads>(structure, node_mass);
      if (const int giving = loads_->giving_rod(i); giving >= 0)
        by_rods_.push_back({slipping_.size() - 1, giving,
                            structure.rods[static_cast<std::size_t>(PinLoads::rod_of(structure, f))]});
    }
  }
  bool any() const { return any_; }
  bool constant() const override { return false; }
  bool has_power() const override { return true; }
  bool dissipative() const override { return true; }
  bool takes_by_pose() const override { return !loads_; }

  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override {
    const PinLoads::Loads loads = loads_at(at, q, v);
    VectorXd g;
    for (const Slipping& s : slipping_) {
      const double tau = goes_on(s, at, q, v, g) * force(s, loads);
      const auto& stencil = s.measure.stencil();
      for (std::size_t i = 0; i < stencil.size(); ++i)
        f[stencil[i]] -= scale * tau * g[static_cast<Index>(i)];
    }
  }
  double power(const Moment& at, const double* q, const double* v) const override {
    const PinLoads::Loads loads = loads_at(at, q, v);
    VectorXd g;
    double sum = 0;
    for (const Slipping& s : slipping_) {
      const double sense = goes_on(s, at, q, v, g);
      sum -= sense * force(s, loads) * s.measure.rate(g.data(), v);
    }
    return sum;
  }
  double taken(const Moment& at, const double* q) const override {
    double sum = 0;
    if (takes_by_pose())
      for (const Slipping& s : slipping_) sum += s.force * s.measure.value(q, near(s, at));
    return sum;
  }
  bool by_tension() const override { return !by_rods_.empty(); }
  void tension_derivatives(const Moment& at, const double* q, const double* v,
                           ForceDerivative& by_n) const override {
    if (!by_tension()) return;
    const PinLoads::Loads loads = loads_at(at, q, v);
    VectorXd g;
    for (const ByRod& b : by_rods_) {
      const Slipping& s = slipping_[b.slipping];
      gradient(s, at, q, g);
      for (Index i = 0; i < g.size(); ++i)
        by_n.emplace_back(s.measure.stencil()[static_cast<std::size_t>(i)], b.giving,
                          -s.arm * loads.by_tension[s.index] * g[i]);
    }
  }
  // Of the pins' loads that by the length of a rod that gives alone, N = (e + damping_time e') / C: what is
  // left out is mu r over the size of the rods as much.
  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    const PinLoads::Loads loads = loads_at(at, q, v);
    if (!at.tension) add_by_lengths(at, q, v, by_q, by_v);
    VectorXd g;
    for (const Slipping& s : slipping_) {
      const double tau = goes_on(s, at, q, v, g) * force(s, loads);
      s.measure.add_hessian(q, -tau, by_q);
    }
  }

 private:
  static constexpr double passing = 1e-7;  // of the structure's length
  struct Slipping {
    MeasureFunction measure;
    double force;  // slip tau_k [N] or [N m]
    int followed;  // index among the angles that count turns; -1: not one of them
    double arm;    // slip mu r [m]
    std::size_t index;
    int slip;
    Measure measure_of;  // of an angle without a sign
    double beside_zero;  // of a distance [m]; 0: it is none
  };
  // Whose pin's load is that of a rod which gives.
  struct ByRod {
    std::size_t slipping;
    int giving;  // among these rods
    Rod rod;
  };
  PinLoads::Loads loads_at(const Moment& at, const double* q, const double* v) const {
    return loads_ ? loads_->evaluate(at, q, v) : PinLoads::Loads();
  }
  static double force(const Slipping& s, const PinLoads::Loads& loads) {
    return s.arm == 0.0 ? s.force : s.force + s.arm * loads.size[s.index];
  }
  void add_by_lengths(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                      ForceDerivative& by_v) const {
    ForceDerivative by_n;
    tension_derivatives(at, q, v, by_n);
    for (const auto& entry : by_n) {
      const Rod& rod = std::find_if(by_rods_.begin(), by_rods_.end(), [&](const ByRod& b) {
                         return b.giving == entry.col();
                       })->rod;
      const Vec3 n =
          entry.value() / rod.compliance() * (node_vector(q, rod.b) - node_vector(q, rod.a)).normalized();
      for (const auto& [node, end] : {std::pair{rod.a, -1}, {rod.b, 1}})
        for (int k = 0; k < 3; ++k) {
          by_q.emplace_back(entry.row(), 3 * node + k, end * n[k]);
          if (rod.damping_time > 0)
            by_v.emplace_back(entry.row(), 3 * node + k, end * rod.damping_time * n[k]);
        }
    }
  }
  static double near(const Slipping& s, const Moment& at) {
    return at.near(s.followed, s.measure.reference());
  }
  static double gradient(const Slipping& s, const Moment& at, const double* q, VectorXd& g) {
    g.resize(static_cast<Index>(s.measure.stencil().size()));
    return s.measure.value_and_gradient(q, g.data(), near(s, at));
  }
  // Where rods come into line, the gradient of an angle without a sign ends, and behind that, where stages of
  // a step may lie, the angle turns back; but the motion goes on and friction against it. g is then by the
  // angle about the axis n of d(d_1 x d_2)/dt, about which it turns there. Returns slip times the sense of
  // that.
  static double goes_on(const Slipping& s, const Moment& at, const double* q, const double* v, VectorXd& g) {
    constexpr double a_little = 0.01, in_line = 1e-6;  // [rad]; the motion seldom turns round so near
    const double angle = gradient(s, at, q, g), beside = std::min(angle, pi - angle);
    if (s.beside_zero > 0)  // nodes that pass each other
      return angle <= s.beside_zero && s.slip * s.measure.rate(g.data(), v) < 0 ? -1.0 : 1.0;
    if (s.measure_of.nodes.empty() || !(beside < a_little)) return 1.0;
    if (beside > in_line && s.slip * s.measure.rate(g.data(), v) >= 0) return 1.0;
    const std::vector<int>& n = s.measure_of.nodes;
    const Vec3 d1 = node_vector(q, n[1]) - node_vector(q, n[0]),
               v1 = node_vector(v, n[1]) - node_vector(v, n[0]);
    const Vec3 d2 = node_vector(q, n[3]) - node_vector(q, n[2]),
               v2 = node_vector(v, n[3]) - node_vector(v, n[2]);
    Measure about = s.measure_of;
    about.axis = (v1.cross(d2) + d1.cross(v2)).normalized();
    if (about.axis.isZero(0.0)) return 1.0;
    const MeasureFunction signed_angle(about, {});
    signed_angle.value_and_gradient(q, g.data());
    return signed_angle.rate(g.data(), v) * s.slip < 0 ? -1.0 : 1.0;
  }

  std::vector<Slipping> slipping_;
  std::vector<ByRod> by_rods_;
  std::unique_ptr<PinLoads> loads_;  // where some torque depends on them
  bool any_ = false;
};

}  // namespace

std::unique_ptr<ForceBlock> friction_block(const Structure& structure, const SparseRows& node_mass) {
  auto block = std::make_unique<DryFriction>(structure, node_mass);
  if (!block->any()) return nullptr;
  return block;
}

const std::vector<ParamSpec>& friction_params() {
  constexpr double endless = std::numeric_limits<double>::infinity(),
                   as_kinetic = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<ParamSpec> params = [] {
    return std::vector<ParamSpec>{
        required(real_param("kinetic", "", 0.0, 0.0, endless,
                            "while it slips: N m on an angle, N on a length or a coordinate")),
        real_param("static", "", as_kinetic, 0.0, endless,
                   "up to which it sticks, at least kinetic; by default kinetic"),
        real_param("pin_friction", "", 0.0, 0.0, endless,
                   "of a hinge: besides, Coulomb's mu times pin_radius times the force of the pin"),
        only_given("pin_friction", real_param("pin_radius", "m", 0.0, 0.0, endless, "of the hinge's pin")),
        vector_param("axis", "", {0, 0, 0},
                     "of the hinge: the angle then has a sign and counts any number of turns"),
        vector_param("direction", "", {0, 0, 0},
                     "with one or two nodes: friction on their coordinate along it, or its difference")};
  }();
  return params;
}

void fill_friction(const ParamSet& values, Force& force) {
  const double mu = values.real("pin_friction"), radius = values.real("pin_radius");
  if (mu > 0 && !(radius > 0))
    throw StructureError("pin_radius",
                         "is missing: the torque is pin_friction times it times the pin's force");
  force.size.offset = mu * radius;  // a length, constant: the arm of the pin's force
  force.kinetic = values.real("kinetic");
  const double most = values.real("static");
  force.holding = std::isnan(most) ? force.kinetic : most;
  if (force.holding < force.kinetic)
    throw StructureError("static", "must be at least kinetic: what sticks would hold less than what slips");
}

}  // namespace unfurl
