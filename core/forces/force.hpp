// Force kinds. Like constraints they are evaluated in blocks, one virtual call for all forces of a kind.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/model/param_spec.hpp"
#include "core/model/structure.hpp"

namespace unfurl {

// dF/dq or dF/dv as entries of a sparse matrix.
using ForceDerivative = std::vector<Eigen::Triplet<double>>;

// The three numbers of a node in node coordinates.
inline Eigen::Map<const Vec3> node_vector(const double* x, int node) {
  return Eigen::Map<const Vec3>(x + 3 * static_cast<Index>(node));
}

class ForceBlock {
 public:
  virtual ~ForceBlock() = default;
  virtual bool constant() const = 0;  // does not depend on t, q or v: evaluated once per model
  // f += scale * F(t, q, v), in node coordinates [N].
  virtual void add(double t, const double* q, const double* v, double scale, double* f) const = 0;

  // The energy that the conservative part of F has stored [J]: F = -dV/dq + the rest.
  virtual double potential(const double*) const { return 0.0; }
  // The power of the rest [W]: F . v + dV/dt. Loads put energy in, dampers (dissipative() is true) take it.
  virtual bool has_power() const { return false; }
  virtual bool dissipative() const { return false; }
  virtual double power(double, const double*, const double*) const { return 0.0; }
  // dF/dq and dF/dv, for Newton matrices; what is left out costs iterations, not accuracy.
  virtual void derivatives(double, const double*, const double*, ForceDerivative&, ForceDerivative&) const {}
};

// Which members of a structure an entry of a kind names.
enum class Members {
  none,       // its table has a form of its own
  each_node,  // nodes: names or globs, one force each
  node_list,  // nodes = [A, B, ...]: all of them in one
  two_nodes,  // nodes = [A, B]
  rod,        // rod: one name; its direction follows the rod
  angle       // rods = [R, S], nodes = [A, HINGE, B], or fold_angle = true
};

struct ForceKind {
  std::string_view kind;
  std::string_view help;
  // The block of all forces of this kind; nullptr where the structure has none.
  std::unique_ptr<ForceBlock> (*make)(const Structure&, const SparseRows& node_mass);
  Members members = Members::none;
  const std::vector<ParamSpec>& (*params)() = nullptr;  // keys of [[forces]]; nullptr: not listed there
};
std::span<const ForceKind> force_kinds();

}  // namespace unfurl
