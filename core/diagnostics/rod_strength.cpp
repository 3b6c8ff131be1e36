// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/rod_strength.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double euler_load(const Rod& rod) {
  if (!rod.elastic() || !(rod.second_moment > 0)) return std::numeric_limits<double>::infinity();
  return pi * pi * rod.youngs_modulus * rod.second_moment / (rod.pinned_length() * rod.pinned_length());
}

double axial_stress(const Rod& rod, double force) {
  return rod.elastic() ? force / rod.area : unknown;
}

double stress_ratio(const Rod& rod, double force) {
  return std::abs(axial_stress(rod, force)) / rod.strength;
}

double buckling_ratio(const Rod& rod, double force) {
  if (!rod.elastic() || std::isnan(force)) return unknown;
  return std::max(0.0, -force) / euler_load(rod);
}

MatrixXd over_rods(const Structure& structure, const Diagnostics& diagnostics,
                   double (*quantity)(const Rod&, double force)) {
  MatrixXd out = diagnostics.axial_force;
  for (Index r = 0; r < out.cols(); ++r)
    for (Index i = 0; i < out.rows(); ++i)
      out(i, r) = quantity(structure.rods[static_cast<std::size_t>(r)], out(i, r));
  return out;
}

WorstRod worst_rod(const Structure& structure, const Diagnostics& diagnostics,
                   double (*quantity)(const Rod&, double force)) {
  const MatrixXd values = over_rods(structure, diagnostics, quantity);
  WorstRod worst;
  for (Index i = 0; i < values.rows(); ++i)
    for (Index r = 0; r < values.cols(); ++r)
      if (diagnostics.shows(r) && !std::isnan(values(i, r)) &&
          (worst.rod < 0 || std::abs(values(i, r)) > std::abs(worst.value)))
        worst = {values(i, r), r, diagnostics.t[static_cast<std::size_t>(i)], diagnostics.force_unique(i, r)};
  if (diagnostics.axial_force.hasNaN()) worst.unique = false;  // what nobody knows may be larger
  return worst;
}

double margin_of(double ratio) {
  return 1 / ratio - 1;
}

bool any_elastic(const Structure& structure) {
  return std::any_of(structure.rods.begin(), structure.rods.end(),
                     [](const Rod& rod) { return rod.elastic(); });
}

bool any_strength(const Structure& structure) {
  return std::any_of(structure.rods.begin(), structure.rods.end(),
                     [](const Rod& rod) { return rod.elastic() && std::isfinite(rod.strength); });
}

}  // namespace unfurl
