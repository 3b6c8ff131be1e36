// SPDX-License-Identifier: BSD-3-Clause
// Force kinds. Like constraints they are evaluated in blocks, one virtual call for all forces of a kind.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/structure/moment.hpp"
#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// dF/dq or dF/dv as entries of a sparse matrix.
struct ForceDerivative : std::vector<Eigen::Triplet<double>> {
  bool keeps_places = false;  // what is slack adds zeros, so that entries are at the same places again
};

// The three numbers of a node in node coordinates.
inline Eigen::Map<const Vec3> node_vector(const double* x, int node) {
  return Eigen::Map<const Vec3>(x + 3 * static_cast<Index>(node));
}

class ForceBlock {
 public:
  virtual ~ForceBlock() = default;
  virtual bool constant() const = 0;  // does not depend on t, q or v: evaluated once per model
  // f += scale * F(t, q, v), in node coordinates [N].
  virtual void add(const Moment& at, const double* q, const double* v, double scale, double* f) const = 0;

  // The energy that the conservative part of F has stored [J]: F = -dV/dq + the rest.
  virtual double potential(const Moment&, const double*) const { return 0.0; }
  // The power of the rest [W]: F . v + dV/dt. Loads put energy in, dampers (dissipative() is true) take it.
  virtual bool has_power() const { return false; }
  virtual bool dissipative() const { return false; }
  virtual double power(const Moment&, const double*, const double*) const { return 0.0; }
  // The part of it that dampers take; the rest is put in.
  virtual double dissipation(const Moment& at, const double* q, const double* v) const {
    return dissipative() ? power(at, q, v) : 0.0;
  }
  virtual bool dissipates() const { return has_power() && dissipative(); }
  virtual bool supplies() const { return has_power() && !dissipative(); }
  // Where that power is the rate of a function of the pose, which a difference tells better than a
  // quadrature: what has been taken [J], dtaken/dt = -power. All of it (takes_by_pose() is true), or what
  // dissipation() leaves out.
  virtual bool takes_by_pose() const { return false; }
  virtual double taken(const Moment&, const double*) const { return 0.0; }
  // Of rods that give: methods may take these forces as unknowns instead (ElasticRods).
  virtual bool of_giving_rods() const { return false; }
  // Whether F depends on the axial forces of rods that give beyond their own pull, and dF/dN then: entries by
  // coordinate and rod.
  virtual bool by_tension() const { return false; }
  virtual void tension_derivatives(const Moment&, const double*, const double*, ForceDerivative&) const {}
  // dF/dq and dF/dv, for Newton matrices; what is left out costs iterations, not accuracy. Where the moment
  // has axial forces, at these.
  virtual void derivatives(const Moment&, const double*, const double*, ForceDerivative&,
                           ForceDerivative&) const {}
};

// Which members of a structure an entry of a kind names.
enum class Members {
  none,         // its table has a form of its own
  each_node,    // nodes: names or globs, one force each
  node_list,    // nodes = [A, B, ...]: all of them in one
  two_nodes,    // nodes = [A, B]
  three_nodes,  // nodes = [A, B, C]
  rods,         // rods: names or globs of rods or of their groups; what the entry says becomes theirs
  path,         // nodes = [A, B, ...]: in order; some may come again
  terms,        // terms = ["2.5 length A B", ...]
  rod,          // rod: one name; its direction follows the rod
  angle,        // rods = [R, S], nodes = [A, HINGE, B], or fold_angle = true
  measure       // an angle as above; nodes = [A, B]: their distance; with a direction: a coordinate
};

struct ForceKind {
  // The block of all forces of a kind; nullptr where the structure has none.
  using Make = std::unique_ptr<ForceBlock> (*)(const Structure&, const SparseRows& node_mass);
  // The values of an entry of [[forces]] into a force that has its name, nodes and measure already; `rest` is
  // the measure's value at t = 0. Throws StructureError with the parameter that cannot be so.
  using Fill = void (*)(const ParamSet& values, Force& force);

  // Of what a table of its own says (loads, gravity), and of an entry of [[forces]].
  ForceKind(std::string_view kind_, std::string_view help_, Make make_)
      : kind(kind_), help(help_), make(make_) {}
  ForceKind(std::string_view kind_, std::string_view help_, Make make_, Members members_,
            const std::vector<ParamSpec>& (*params_)(), Fill fill_)
      : kind(kind_), help(help_), make(make_), members(members_), params(params_), fill(fill_) {}

  std::string_view kind;
  std::string_view help;
  Make make;
  Members members = Members::none;
  const std::vector<ParamSpec>& (*params)() = nullptr;
  Fill fill = nullptr;
};
std::span<const ForceKind> force_kinds();

}  // namespace unfurl
