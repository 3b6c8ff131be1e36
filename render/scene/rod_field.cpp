// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/rod_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/diagnostics/force_round_off.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/length_error.hpp"
#include "core/diagnostics/line_forces.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/math/magnitudes.hpp"
#include "render/scene/color_map.hpp"

namespace unfurl {
namespace {

constexpr double round_off = 1e-17;

// The smallest of 1, 2, 5, 10, ... (any power of ten) that is not below x > 0.
double rounded_up(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= x * (1 - 1e-9)) return step * power;
  return 10 * power;
}

template <class Value>  // of the nodes' positions, their velocities, a rod and the time
MatrixXd over_run(const Trajectory& run, Value value) {
  const std::vector<Rod>& rods = run.structure().rods;
  MatrixXd out(static_cast<Index>(run.size()), static_cast<Index>(rods.size()));
  for (std::size_t i = 0; i < run.size(); ++i) {
    const VectorXd q = run.node_positions(i), v = run.node_velocities(i);
    for (std::size_t r = 0; r < rods.size(); ++r)
      out(static_cast<Index>(i), static_cast<Index>(r)) = value(q, v, rods[r], run.time(i));
  }
  return out;
}

// Of rods that are not shown, which help to hold a shape, nothing is known: no colour, no range.
void leave_hidden_out(const Structure& structure, MatrixXd& values) {
  const std::vector<char> shown = shown_rods(structure);
  for (std::size_t r = 0; r < shown.size(); ++r)
    if (!shown[r]) values.col(static_cast<Index>(r)).setConstant(std::numeric_limits<double>::quiet_NaN());
}

double middle_speed(const VectorXd&, const VectorXd& v, const Rod& rod, double) {
  return 0.5 * (v.segment<3>(3 * rod.a) + v.segment<3>(3 * rod.b)).norm();
}

// Rates that do not move a rod by more than rounding in all of the run are rounding.
bool stays(const Trajectory& run, const MatrixXd& speeds) {
  constexpr double rounding = 1e-12;  // of the longest rod
  double length = 0;
  for (const Rod& rod : run.structure().rods) length = std::max(length, rod.length);
  const double duration = run.end_time() - run.time(0);
  return duration > 0 && !(magnitudes(speeds).most * duration > rounding * length);
}

double size_of_length_error(const VectorXd& q, const VectorXd&, const Rod& rod, double t) {
  return std::abs(length_error(rod, q, t));
}

// The run's own range.
void choose_range(RodField& field, const MatrixXd& all) {
  const auto [most, usual] = magnitudes(all);
  // Of nothing but zeros, or of nothing at all, any range will do.
  const double high = most > std::numeric_limits<double>::min() * 1e20 ? rounded_up(usual) : 1.0;
  field.high =
      field.log ? std::max(std::pow(10.0, std::ceil(std::log10(std::max(most, 1e-16)))), 1e-15) : high;
  field.low = field.diverging ? -field.high : field.log ? 1e-4 * field.high : 0;
}

}  // namespace

double RodField::between(const MatrixXd& columns, double time, Index column) const {
  const auto after = std::upper_bound(t.begin(), t.end(), time);
  if (after == t.begin()) return columns(0, column);
  if (after == t.end()) return columns(columns.rows() - 1, column);
  const auto i = after - t.begin() - 1;
  const double u = (time - *(after - 1)) / (*after - *(after - 1)), a = columns(i, column),
               b = columns(i + 1, column);
  // Up to a state at which it is not known, and from there on, it is what is known next to it.
  if (u == 0 || !std::isfinite(b)) return a;
  return std::isfinite(a) ? (1 - u) * a + u * b : b;
}

double RodField::position(double value) const {
  if (!log) return std::clamp((value - low) / (high - low), 0.0, 1.0);
  return std::clamp(std::log(std::max(value, round_off) / low) / std::log(high / low), 0.0, 1.0);
}

Color RodField::color(double value) const {
  // Grey is 0 among colours around zero.
  if (!std::isfinite(value)) return diverging ? Color{0.07f, 0.07f, 0.07f, 1} : Color{0.5f, 0.5f, 0.5f, 1};
  if (!diverging) return sequential_color(position(value));
  // Grey at 0, or at the end that is nearest to it.
  if (low >= 0) return diverging_color(position(value));
  if (high <= 0) return diverging_color(position(value) - 1);
  return diverging_color(std::clamp(value < 0 ? -value / low : value / high, -1.0, 1.0));
}

RodField rod_field(const std::string& by, std::array<double, 2> range, const Simulation& run,
                   const Diagnostics& diagnostics) {
  RodField field;
  field.t = diagnostics.t;
  if (by == "axial_force") {
    field.label = "axial force (N), tension > 0";
    const Structure& structure = run.trajectory.structure();
    const std::size_t rods = structure.rod_copies.size(), open = rods - unique_rods(structure, diagnostics);
    if (open > 0) field.label += "; " + std::to_string(open) + " of " + std::to_string(rods) + " not unique";
    field.values = without_round_off(run, diagnostics, diagnostics.axial_force);
    field.diverging = true;
    LineForces others = line_forces(run, diagnostics);
    field.lines = std::move(others.lines), field.springs = std::move(others.springs);
  } else if (by == "stress" || by == "buckling") {
    const Structure& structure = run.trajectory.structure();
    const bool stress = by == "stress";
    field.label = stress ? "axial stress (MPa), tension > 0" : "compression / Euler load";
    if (!any_elastic(structure)) field.label += ": not known, no rod has a youngs_modulus";
    field.values =
        (stress ? 1e-6 : 1.0) *
        without_round_off(run, diagnostics,
                          over_rods(structure, diagnostics, stress ? axial_stress : buckling_ratio));
    field.diverging = stress;
  } else if (by == "speed") {
    field.label = "speed (m/s)";
    field.values = over_run(run.trajectory, middle_speed);
    if (stays(run.trajectory, field.values)) field.values.setZero();
  } else if (by == "constraint_error") {
    field.label = "error of length (m)";
    const std::vector<Rod>& rods = run.trajectory.structure().rods;
    if (std::ranges::all_of(rods, &Rod::gives)) field.label += ": none, all rods are elastic";
    field.unknown = "elastic, without one";
    field.values = over_run(run.trajectory, size_of_length_error);
    field.log = true;
  } else {
    throw std::invalid_argument("rod_field: no quantity '" + by + "'");
  }
  leave_hidden_out(run.trajectory.structure(), field.values);
  MatrixXd all(field.values.rows(), field.values.cols() + field.lines.cols() + field.springs.cols());
  if (field.lines.size() + field.springs.size() > 0)
    all << field.values, field.lines, field.springs;
  else
    all = field.values;
  field.known = all.array().isFinite().any();
  choose_range(field, all);
  if (range[0] < range[1] && (!field.log || range[0] > 0)) field.low = range[0], field.high = range[1];
  const double hair = 1e-9 * (field.high - field.low), low_hair = field.log ? 1e-9 * field.low : hair;
  for (Index i = 0; i < all.size(); ++i) {
    const double value = all.data()[i];
    field.below = field.below || value < field.low - low_hair;
    field.above = field.above || value > field.high + hair;
  }
  return field;
}

}  // namespace unfurl
