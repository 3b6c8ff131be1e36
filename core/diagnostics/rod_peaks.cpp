// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/rod_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "core/diagnostics/peak_samples.hpp"

namespace unfurl {

namespace {

// The shown rod that bears most at a time within a step; -1: there is none, or that is no time within one.
struct Bearer {
  Index rod = -1;
  double force_N = 0.0;
  bool unique = false;
};

Bearer bearer(const Simulation& run, const Diagnostics& d, double t,
              const std::function<double(Index rod, double force)>& size) {
  Bearer found;
  if (d.t.size() != run.trajectory.size()) return found;
  VectorXd forces = rod_forces_within_step(run, t);
  for (const FoundWithin& found_before : d.found)
    if (forces.size() == 0 && found_before.peak.t == t) forces = found_before.rod_forces;
  for (Index r = 0; r < forces.size(); ++r)
    if (d.shows(r) && !std::isnan(size(r, forces[r])) &&
        (found.rod < 0 || size(r, forces[r]) > size(found.rod, found.force_N)))
      found = {r, forces[r], false};
  if (found.rod < 0) return found;
  const Index after = std::upper_bound(d.t.begin(), d.t.end(), t) - d.t.begin();
  found.unique = d.force_unique(after - 1, found.rod) && d.force_unique(after, found.rod);
  return found;
}

PeakInMotion larger_magnitude(const PeakInMotion& a, const PeakInMotion& b) {
  return std::isnan(a.value) || std::abs(b.value) > std::abs(a.value) ? b : a;
}

// Whether a time within a step is next to the time of a state, which holds the largest value of them all:
// where the forces within the step are not known, next to a singular pose, its rod is the one.
bool is_beside(const Trajectory& run, double t, double of_state) {
  const std::size_t i = run.state_before(t);
  return i + 1 < run.size() && run.time(i) < t && run.time(i > 0 ? i - 1 : 0) <= of_state &&
         of_state <= run.time(std::min(i + 2, run.size() - 1));
}

// What all rods have of a column that is the largest (sign 1) or least (-1) of theirs, with that sign [states
// x rods]; nothing of other columns.
MatrixXd borne_by_rods(const Structure& structure, const Diagnostics& d, std::string_view column,
                       double sign) {
  if (column == (sign < 0 ? "axial_force_min_N" : "axial_force_max_N")) return sign * d.axial_force;
  if (column == (sign < 0 ? "axial_stress_min_Pa" : "axial_stress_max_Pa"))
    return sign * over_rods(structure, d, axial_stress);
  if (sign > 0 && column == "stress_ratio_max") return over_rods(structure, d, stress_ratio);
  if (sign > 0 && column == "buckling_ratio_max") return over_rods(structure, d, buckling_ratio);
  return {};
}

}  // namespace

PeakForce peak_rod_force(const Simulation& run, const Diagnostics& d, Pull pull) {
  PeakForce peak = peak_rod_force(d, pull);
  PeakInMotion top;
  if (pull != Pull::compression) top = extreme_of_column(run, d, "axial_force_max_N", true);
  if (pull != Pull::tension)
    top = larger_magnitude(top, extreme_of_column(run, d, "axial_force_min_N", false));
  const Bearer there = bearer(run, d, top.t, [pull](Index, double force) {
    return pull == Pull::either ? std::abs(force) : pull == Pull::tension ? force : -force;
  });
  if (there.rod >= 0)
    peak = {there.force_N, there.rod, top.t, peak.unique && there.unique};
  else if (is_beside(run.trajectory, top.t, peak.t))
    peak.force_N = top.value, peak.t = top.t;
  peak.unique = peak.unique && top.bounded;
  return peak;
}

std::vector<std::size_t> rod_humps(const Trajectory& run, const Diagnostics& d, std::string_view column,
                                   double sign) {
  constexpr std::size_t most = 3;
  constexpr double round_off = 1e-9;
  const MatrixXd values = borne_by_rods(run.structure(), d, column, sign);
  const Index states = values.rows();
  double best = -std::numeric_limits<double>::infinity();
  for (Index r = 0; r < values.cols(); ++r)
    for (Index i = 0; d.shows(r) && i < states; ++i) best = std::max(best, values(i, r));
  std::vector<std::pair<double, std::size_t>> found;
  const auto leads = [&](std::size_t i) {
    return &run.model(i) == &run.model(i + 1) && run.time(i) < run.time(i + 1) &&
           !run.report(i + 1).singular_event;
  };
  for (Index r = 0; r < values.cols(); ++r)
    for (Index i = 1; d.shows(r) && i + 1 < states; ++i) {
      const double x = values(i, r), before = values(i - 1, r), behind = values(i + 1, r);
      const auto k = static_cast<std::size_t>(i);
      if (!(x >= before && x >= behind) || !leads(k - 1) || !leads(k)) continue;
      const double reach = vertex({run.time(k - 1), run.time(k), run.time(k + 1)}, {before, x, behind}).value;
      if (reach - x > round_off * std::abs(x) && 2 * reach - x > best) found.push_back({reach, k});
    }
  std::ranges::stable_sort(found, std::greater(), [](const auto& hump) { return hump.first; });
  std::vector<std::size_t> out;
  for (const auto& [reach, k] : found)
    if (out.size() < most && std::ranges::find(out, k) == out.end()) out.push_back(k);
  return out;
}

WorstRod worst_rod(const Simulation& run, const Diagnostics& d,
                   double (*quantity)(const Rod&, double force)) {
  const Structure& structure = run.trajectory.structure();
  WorstRod worst = worst_rod(structure, d, quantity);
  const PeakInMotion top =
      quantity == axial_stress
          ? larger_magnitude(extreme_of_column(run, d, "axial_stress_max_Pa", true),
                             extreme_of_column(run, d, "axial_stress_min_Pa", false))
          : extreme_of_column(run, d, quantity == stress_ratio ? "stress_ratio_max" : "buckling_ratio_max",
                              true);
  const auto of = [&](Index r, double force) {
    return quantity(structure.rods[static_cast<std::size_t>(r)], force);
  };
  const Bearer there = bearer(run, d, top.t, [&](Index r, double force) { return std::abs(of(r, force)); });
  if (there.rod >= 0)
    worst = {of(there.rod, there.force_N), there.rod, top.t, there.unique && !d.axial_force.hasNaN()};
  else if (is_beside(run.trajectory, top.t, worst.t))
    worst.value = top.value, worst.t = top.t;
  worst.unique = worst.unique && top.bounded;
  return worst;
}

}  // namespace unfurl
