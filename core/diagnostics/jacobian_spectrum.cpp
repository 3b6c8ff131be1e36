// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/jacobian_spectrum.hpp"

#include <algorithm>

#include "core/math/singular_values.hpp"
#include "core/system/mobility.hpp"

namespace unfurl {
namespace {

// Rows have length 1, so that the largest singular value is between 1 and the root of their number; round-off
// in the decomposition is some 1e-16 times that.
constexpr double round_off = 1e-12;

// Which states: of all that are there, as many as the work allows.
std::vector<std::size_t> chosen_states(const Simulation& run) {
  const System& system = run.trajectory.model().system;
  const auto rows = static_cast<double>(std::max<Index>(system.all_constraints(), 1)),
             columns = static_cast<double>(std::max<Index>(system.coordinates(), 1));
  constexpr double work = 2e8;  // rows x columns x the smaller of the two; about a second
  const auto affordable =
      static_cast<std::size_t>(std::clamp(work / (rows * columns * std::min(rows, columns)), 20.0, 400.0));
  const std::size_t size = run.trajectory.size(), count = std::min(affordable, size);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(count > 1 ? k * (size - 1) / (count - 1) : 0);
  return out;
}

}  // namespace

bool spectrum_applies(const Simulation& run) {
  const System& system = run.trajectory.model().system;
  return system.all_constraints() > 0 && system.all_constraints() <= max_spectrum_size &&
         system.coordinates() <= max_spectrum_size;
}

JacobianSpectrum jacobian_spectrum(const Simulation& run, int count) {
  const System& system = run.trajectory.model().system;
  JacobianSpectrum out;
  out.constraints = system.all_constraints();
  out.coordinates = system.coordinates();
  std::vector<VectorXd> bidiagonals;  // of the states: four of their values are wanted
  std::vector<Index> ranks;
  for (const std::size_t i : chosen_states(run)) {
    const MatrixXd G(unit_rows(system, run.trajectory.node_positions(i)));
    if (!G.allFinite()) continue;
    bidiagonals.push_back(bidiagonal_of(G));
    const Index first[] = {0};
    out.t.push_back(run.trajectory.time(i));
    out.largest.push_back(singular_values_at(bidiagonals.back(), first)[0]);
    const double least = round_off * out.largest.back();
    ranks.push_back(least > 0 ? singular_values_above(bidiagonals.back(), least) : 0);
    out.rank = std::max(out.rank, ranks.back());
  }
  out.smallest.resize(static_cast<std::size_t>(std::min<Index>(count, out.rank)));
  std::vector<Index> which;
  for (std::size_t k = 0; k < out.smallest.size(); ++k) which.push_back(out.rank - 1 - static_cast<Index>(k));
  for (std::size_t i = 0; i < bidiagonals.size(); ++i) {
    const VectorXd values = singular_values_at(bidiagonals[i], which);
    for (std::size_t k = 0; k < which.size(); ++k)
      out.smallest[k].push_back(which[k] < ranks[i] ? values[static_cast<Index>(k)] : 0.0);
  }
  return out;
}

}  // namespace unfurl
