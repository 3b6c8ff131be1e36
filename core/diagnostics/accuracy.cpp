#include "core/diagnostics/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/integrators/stage_equations.hpp"

namespace unfurl {
namespace {

// Shares of the energy turned over and of a rod's length beyond which a motion is wrong to the eye.
constexpr double energy_share = 1e-3, length_share = 1e-3;

double largest(const Series& series) {
  double m = 0;
  for (const double x : series.values) m = std::max(m, std::abs(x));
  return m;
}

double range(const Series& series) {
  const auto [low, high] = std::minmax_element(series.values.begin(), series.values.end());
  return series.values.empty() ? 0.0 : *high - *low;
}

}  // namespace

std::vector<std::string> accuracy_warnings(const Diagnostics& d) {
  if (d.left_open > 0) {
    std::ostringstream text;
    text << "the run was judged up to t = " << d.t[d.t.size() - std::min(d.left_open + 1, d.t.size())]
         << " s only: what follows is empty in series and rod forces";
    return {text.str()};
  }
  std::vector<std::string> warnings;
  const double off = largest(d.at("energy_balance_J"));
  const double turned =
      std::max({largest(d.at("kinetic_energy_J")), range(d.at("potential_energy_J")), range(d.at("work_J"))});
  std::ostringstream text;
  text.precision(3);
  if (off > energy_share * turned) {
    text << "the energy balance is off by " << off << " J, " << 100 * off / turned
         << " % of the energy turned over: take a smaller solver.step or more solver.stages";
    warnings.push_back(text.str());
  }
  const double stretch = largest(d.at("constraint_relative_max"));
  if (stretch > length_share) {
    text.str("");
    text << "constraints are violated by " << 100 * stretch
         << " % of a rod's length: take a smaller solver.step, or method dvm, which holds them";
    warnings.push_back(text.str());
  }
  return warnings;
}

double constraint_tolerance(const Simulation& run) {
  const VectorXd& lengths = run.trajectory.model().system.constraint_lengths();
  if (run.options.method != "dvm" || lengths.size() == 0 || run.trajectory.empty()) return 0.0;
  const double reach = run.trajectory.node_positions(run.trajectory.size() - 1).lpNorm<Eigen::Infinity>();
  const double length = lengths.minCoeff();
  return constraint_level_wanted * constraint_noise(length, reach) / length;
}

}  // namespace unfurl
