#include <algorithm>
#include <array>

#include "core/integrators/dvm.hpp"
#include "core/integrators/integrator.hpp"
#include "core/integrators/rk4.hpp"

namespace unfurl {

std::span<const Method> methods() {
  static const std::array rows{
      Method{"dvm", "discrete variational (Galerkin) method, constraints held to round-off", dvm_claims,
             make_dvm},
      Method{"rk4", "classical Runge-Kutta on the index-1 equations; constraints drift", rk4_claims,
             make_rk4},
  };
  return rows;
}

const Method* find_method(std::string_view name) {
  const auto rows = methods();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const Method& m) { return m.name == name; });
  return it == rows.end() ? nullptr : &*it;
}

}  // namespace unfurl
