// Force kinds. Like constraints they are evaluated in blocks, one virtual call for all forces of a kind.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/model/structure.hpp"

namespace unfurl {

class ForceBlock {
 public:
  virtual ~ForceBlock() = default;
  virtual bool constant() const = 0;  // does not depend on t, q or v: evaluated once per model
  // f += scale * F(t, q, v), in node coordinates [N].
  virtual void add(double t, const double* q, const double* v, double scale, double* f) const = 0;
};

struct ForceKind {
  std::string_view kind;
  std::string_view help;
  // The block of all forces of this kind; nullptr where the structure has none.
  std::unique_ptr<ForceBlock> (*make)(const Structure&, const SparseRows& node_mass);
};
std::span<const ForceKind> force_kinds();

}  // namespace unfurl
