// SPDX-License-Identifier: BSD-3-Clause
// What poses next to the deployed one say of it.
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/math/coupled_columns.hpp"
#include "core/math/factors.hpp"
#include "core/simulate/deployed_event.hpp"

namespace unfurl {

// Each sample is weighted with sine^4: an error d of a rod's length turns it by d / (l sine), and what the
// hinges' velocities and accelerations take from that is d / sine^4 in the forces.
VectorXd shares_at_zero(const std::vector<NearDeployed>& samples, int degree) {
  const Index count = static_cast<Index>(samples.size());
  MatrixXd powers(count, degree + 1);
  VectorXd weight(count);
  for (Index i = 0; i < count; ++i) {
    const double x = samples[static_cast<std::size_t>(i)].sine / samples.front().sine;
    weight[i] = std::pow(x, 4);
    for (Index j = 0; j <= degree; ++j) powers(i, j) = weight[i] * std::pow(x, static_cast<double>(j));
  }
  // The first row of the pseudo-inverse.
  return weight.cwiseProduct(least_squares(powers.transpose(), VectorXd::Unit(degree + 1, 0)));
}

MatrixXd tensions(const System& system, const std::vector<NearDeployed>& samples) {
  MatrixXd out(std::ssize(system.giving_rods()), std::ssize(samples));
  VectorXd q(system.coordinates()), v(q.size());
  for (Index i = 0; i < out.cols(); ++i) {
    const State& state = samples[static_cast<std::size_t>(i)].state;
    VectorXd tension = state.tension;
    if (tension.size() == 0) {
      system.expand(state.z, q);
      system.expand_rate(state.w, v);
      tension.resize(out.rows());
      system.giving_rod_forces(state.t, q, v, tension);
    }
    out.col(i) = tension;
  }
  return out;
}

void tension_at_zero(const System& system, const std::vector<NearDeployed>& samples, State& out) {
  out.tension.resize(0), out.tension_error.resize(0);
  if (system.giving_rods().empty()) return;
  const MatrixXd tension = tensions(system, samples);
  std::vector<VectorXd> fits;
  fits.reserve(samples.size());
  for (int degree = 0; degree < static_cast<int>(samples.size()); ++degree)
    fits.push_back(tension * shares_at_zero(samples, degree));
  std::size_t best = fits.size() - 1;
  const auto change = [&](std::size_t degree) { return (fits[degree] - fits[degree - 1]).norm(); };
  for (std::size_t degree = best; degree >= 2; --degree)
    if (change(degree) < change(best)) best = degree;
  out.tension = fits[best];
  out.tension_error = VectorXd::Zero(out.tension.size());
  for (std::size_t degree = best - 1; degree < fits.size(); ++degree)
    out.tension_error = out.tension_error.cwiseMax((fits[degree] - fits[best]).cwiseAbs());
  VectorXd of_samples = VectorXd::Zero(out.tension.size());
  for (const NearDeployed& sample : samples)
    if (sample.state.tension_error.size() > 0) of_samples = of_samples.cwiseMax(sample.state.tension_error);
  out.tension_error += of_samples;
}

namespace {

// A share of the multipliers that poses next to the deployed one must agree to.
constexpr double most_open = 1e-5;

// Nothing, and the values at zero of the polynomials through some values of the samples, by degrees.
std::vector<VectorXd> fits_of(const std::vector<NearDeployed>& samples, const std::vector<VectorXd>& values) {
  const VectorXd none = VectorXd::Zero(values.front().size());
  std::vector<VectorXd> fits{none};
  for (int degree = 0; degree < static_cast<int>(samples.size()); ++degree) {
    const VectorXd shares = shares_at_zero(samples, degree);
    VectorXd sum = none;
    for (std::size_t i = 0; i < samples.size(); ++i) sum += shares[static_cast<Index>(i)] * values[i];
    fits.push_back(std::move(sum));
  }
  return fits;
}

// Of sine^power times the multipliers.
std::vector<VectorXd> multiplier_fits(const std::vector<NearDeployed>& samples, int power) {
  std::vector<VectorXd> values;
  values.reserve(samples.size());
  for (const NearDeployed& sample : samples)
    values.push_back(std::pow(sample.sine, power) * sample.state.lambda);
  return fits_of(samples, values);
}

// The fit that changes least from the one of a degree less, by less than `most`; 0: none does.
std::size_t settled_fit(const std::vector<VectorXd>& fits, double most) {
  double least = most;
  std::size_t best = 0;
  for (std::size_t i = 2; i < fits.size(); ++i) {
    const double change = (fits[i] - fits[i - 1]).norm();
    if (!(change < least)) continue;
    least = change;
    best = i;
  }
  return best;
}

// c where multipliers grow like c / sine^order towards the pose, as where rods in line bear a load across
// them; empty where they do not: there c is a small share of what sine^order times lambda is next to the
// pose.
VectorXd pole(const std::vector<NearDeployed>& samples, int order) {
  constexpr double not_small = 1e-2, known = 1e-2, settled = 0.1, single = 0.3;
  const std::vector<VectorXd> fits = multiplier_fits(samples, order);
  const double beside = std::pow(std::abs(samples.back().sine), order) * samples.back().state.lambda.norm();
  const std::size_t best = settled_fit(fits, known * beside);
  if (best == 0 || !(fits[best].norm() > not_small * beside)) return {};
  // Round-off of the samples, which is of that size in rings of hundreds of units, agrees with nothing.
  const VectorXd change = fits[best] - fits[best - 1];
  if (!(change.norm() < settled * fits[best].norm())) return {};
  // Nor is one multiplier's pole what it depends on the degree.
  return (change.array().abs() < single * fits[best].array().abs()).select(fits[best], 0.0);
}

// What acts just before the deployed pose, where that is not what acts in it: on hinges without an axis whose
// rods are in line there, all of them or those that rounding has put so, and hardly turn. Empty where it is.
VectorXd other_force_before(Index1& index1, const std::vector<NearDeployed>& samples, const State& at) {
  constexpr double other = 1e-7, known = 0.1;  // shares of what acts, and of the difference
  std::vector<VectorXd> values;
  values.reserve(samples.size());
  for (const NearDeployed& sample : samples) values.push_back(index1.applied_force(sample.state));
  const std::vector<VectorXd> fits = fits_of(samples, values);
  const std::size_t best = settled_fit(fits, std::numeric_limits<double>::infinity());
  const VectorXd& here = index1.applied_force(at);
  const double off = (fits[best] - here).norm();
  if (!(off > other * here.norm()) || !((fits[best] - fits[best - 1]).norm() < known * off)) return {};
  return fits[best];
}

using Known = Eigen::ArrayX<bool>;

VectorXd known_of(const VectorXd& lambda, const Known& known) {
  return known.select(lambda.array(), std::numeric_limits<double>::quiet_NaN());
}

// What those that are bounded settle to best, with nothing of the others beside them.
VectorXd best_known(std::vector<NearDeployed>& samples, const Known& bounded) {
  constexpr double most_off = 1e-3;  // of what they are next to the pose
  double size = 0;
  for (NearDeployed& sample : samples) {
    sample.state.lambda = bounded.select(sample.state.lambda, 0.0);
    size = std::max(size, sample.state.lambda.lpNorm<Eigen::Infinity>());
  }
  const std::vector<VectorXd> fits = multiplier_fits(samples, 0);
  const std::size_t best = settled_fit(fits, std::numeric_limits<double>::infinity());
  const auto change = (fits[best] - fits[best - 1]).array().abs();
  return known_of(fits[best], bounded && change <= most_off * size);
}

// Do they grow towards the pose, and that far from it, where round-off is no matter?
bool grow(const std::vector<NearDeployed>& samples) {
  constexpr double much = 1.5;
  const auto size = [&](std::size_t i) { return samples[i].state.lambda.norm(); };
  return size(samples.size() / 2) > much * size(0);
}

// Constraints that share no coordinate, be it through others, say nothing of each other's forces.
std::vector<std::vector<Index>> rows_by_sets(const System& system) {
  const SparseRows jacobian = system.jacobian_pattern();
  CoupledColumns columns(jacobian.cols());
  columns.join_rows_of(jacobian);
  columns.join_rows_of(system.mass());
  std::map<Index, std::vector<Index>> sets;
  for (int r = 0; r < jacobian.outerSize(); ++r) {
    const SparseRows::InnerIterator it(jacobian, r);
    sets[it ? columns.set_of(it.col()) : -1].push_back(r);
  }
  std::vector<std::vector<Index>> out;
  for (auto& set : sets) out.push_back(std::move(set.second));
  return out;
}

// Of rows that are joined: from their samples, and `fits` of theirs that the equations have corrected.
VectorXd joined_multipliers(std::vector<NearDeployed> samples, const std::vector<VectorXd>& fits, int poles) {
  constexpr double something_else = 1e-3, grows = 1e-4, wild = 10;
  Known bounded = Known::Constant(samples.front().state.lambda.size(), true);
  for (int order = poles; order > 0; --order) {
    const VectorXd c = pole(samples, order);
    if (c.size() == 0) continue;
    bounded = bounded && c.array().abs() <= grows * c.lpNorm<Eigen::Infinity>();
    for (NearDeployed& sample : samples) sample.state.lambda -= c / std::pow(sample.sine, order);
  }
  if (!bounded.all()) return best_known(samples, bounded);
  const std::vector<VectorXd> own = multiplier_fits(samples, 0);
  const std::size_t nearest = settled_fit(own, std::numeric_limits<double>::infinity());
  const double open = (own[nearest] - own[nearest - 1]).norm();
  if (open > something_else * own[nearest].norm() && grow(samples)) return known_of(own[nearest], !bounded);
  const std::size_t by_itself = settled_fit(own, most_open * own.back().norm());
  const std::size_t best = settled_fit(fits, most_open * fits[0].norm());
  // Where the pose is so near to losing more of its rank that the equations say anything, they are left out.
  double next_to = 0;
  for (const NearDeployed& sample : samples) next_to = std::max(next_to, sample.state.lambda.norm());
  if (!((fits[best] - own[nearest]).norm() <= wild * next_to)) return own[nearest];
  const bool differ =
      by_itself > 0 && (fits[best] - own[by_itself]).norm() > something_else * own[by_itself].norm();
  return differ ? own[by_itself] : fits[best];
}

}  // namespace

// By the equations of the pose, with what acts just before it. Where nothing settles of what grows, nothing
// is known. Beyond that, where fits that settle by themselves say something else than those that the
// equations have corrected, they are right. Where multipliers grow without bound, the equations of the pose
// lack what is left of them times a Jacobian that vanishes. All of that by what is joined: a large force
// elsewhere is no measure of it.
VectorXd multipliers_at_deployed(Index1& index1, std::vector<NearDeployed> samples, const State& at,
                                 int poles) {
  std::vector<VectorXd> fits = multiplier_fits(samples, 0);
  index1.correct(at, fits, other_force_before(index1, samples, at));
  VectorXd out(samples.front().state.lambda.size());
  for (const std::vector<Index>& rows : rows_by_sets(index1.system())) {
    std::vector<NearDeployed> theirs;
    for (const NearDeployed& sample : samples) {
      theirs.push_back({sample.sine, {}});
      theirs.back().state.lambda = sample.state.lambda(rows);
    }
    std::vector<VectorXd> their_fits;
    for (const VectorXd& fit : fits) their_fits.push_back(fit(rows));
    out(rows) = joined_multipliers(std::move(theirs), their_fits, poles);
  }
  return out;
}

}  // namespace unfurl
