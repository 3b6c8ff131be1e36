// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/peak_by_states.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "core/diagnostics/state_forces.hpp"
#include "core/math/lagrange.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {
namespace {

constexpr std::size_t each_side = 3, all_points = 2 * each_side;

// The polynomial through points.
struct Points {
  std::array<double, all_points> t, x;

  double through(std::size_t begin, std::size_t end, double at) const {
    const auto time = [&](std::size_t k) { return t[begin + k]; };
    double sum = 0;
    for (std::size_t k = 0; k < end - begin; ++k)
      sum += lagrange_weight(k, end - begin, at, time) * x[begin + k];
    return sum;
  }
  double operator()(double at) const { return through(0, all_points, at); }
};

// False where there are not as many known states of one model on either side of a time.
bool take_states(const Trajectory& states, const std::vector<double>& x, double t, Points& out) {
  const std::size_t before = states.state_before(t);
  const auto take = [&](std::size_t k, int way) {
    const std::size_t first = way < 0 ? each_side : each_side - 1;
    for (std::size_t taken = 1; taken <= each_side; k = way < 0 ? k - 1 : k + 1) {
      if (k >= x.size() || &states.model(k) != &states.model(before)) return false;
      const std::size_t to = way < 0 ? first - taken : first + taken;
      const bool same = taken > 1 && states.time(k) == out.t[way < 0 ? to + 1 : to - 1];
      if (std::isnan(x[k]) || same) continue;
      out.t[to] = states.time(k), out.x[to] = x[k];
      ++taken;
    }
    return true;
  };
  return take(before, -1) && take(before + 1, +1) && out.t[each_side - 1] < out.t[each_side];
}

}  // namespace

PeakInMotion by_states(const Simulation& run, const std::vector<double>& x, const PeakInMotion& found) {
  constexpr double many = 10, round_off = 1e-12;  // times what the outer two states change; of the value
  constexpr double most_off = 0.01, well_known = 1e-3;  // beyond that the states have missed it
  constexpr int looks = 32;
  Points known;
  if (!take_states(run.trajectory, x, found.t, known)) return found;
  const double here = known(found.t),
               doubt = many * std::abs(here - known.through(1, all_points - 1, found.t));
  const double above = found.value - here;
  if (above <= doubt + round_off * std::abs(here) || above > most_off * std::abs(found.value) ||
      doubt > well_known * std::abs(here))
    return found;
  StateForces forces(run.trajectory);
  const std::size_t before = run.trajectory.state_before(found.t);
  if (!forces.near_singular(before) && !forces.near_singular(before + 1)) return found;
  double begin = known.t[1], end = known.t[all_points - 2];
  PeakInMotion top;
  for (int round = 0; round < 3; ++round) {
    const double apart = (end - begin) / looks;
    for (int k = 0; k <= looks; ++k) {
      const double t = begin + k * apart, value = known(t);
      if (!(value <= top.value)) top = {value, t};
    }
    begin = std::max(begin, top.t - apart), end = std::min(end, top.t + apart);
  }
  // They say that what was found is too much; a polynomial that goes beyond it swings.
  return top.value <= found.value ? top : found;
}

PeakInMotion beyond(const Diagnostics& diagnostics, std::string_view column, bool largest,
                    PeakInMotion seen) {
  const double sign = largest ? 1.0 : -1.0;
  for (const auto& [name, most, known, forces] : diagnostics.found) {
    if (name != column || most != largest) continue;
    const PeakInMotion rise = seen.bounded ? known : seen;
    if (!(sign * known.value <= sign * seen.value)) seen = known;
    if (!rise.bounded) seen.bounded = false, seen.rise_t = rise.rise_t;
  }
  return seen;
}

}  // namespace unfurl
