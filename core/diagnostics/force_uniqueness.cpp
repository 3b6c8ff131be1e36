// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/force_uniqueness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "core/diagnostics/drives.hpp"
#include "core/diagnostics/reactions.hpp"
#include "core/integrators/independent_parts.hpp"
#include "core/math/determined_rows.hpp"
#include "core/math/factors.hpp"
#include "core/math/largest.hpp"
#include "core/simulate/elastic_sharing.hpp"
#include "core/simulate/singular_poses.hpp"

namespace unfurl {
namespace {

// States of [first, last] that are looked at; of a model that is known, those that may be singular.
std::set<std::size_t> looked_at(const Simulation& run, std::size_t first, std::size_t last, bool known,
                                bool ends) {
  constexpr std::size_t parts = 4;
  const Trajectory& trajectory = run.trajectory;
  std::set<std::size_t> states;
  for (std::size_t k = 0; k <= parts && !known; ++k) states.insert(first + (last - first) * k / parts);
  if (ends) states.insert(last);
  for (const Event& event : run.events) {
    if (std::isnan(event.singular_value)) continue;
    if (known && (event.t < trajectory.time(first) || event.t > trajectory.time(last))) continue;
    std::size_t after = first;
    while (after < last && trajectory.time(after) < event.t) ++after;
    states.insert(after);
    if (after > first) states.insert(after - 1);
  }
  return states;
}

}  // namespace

ForceUniqueness::ForceUniqueness(const Simulation& run, const KnownUniqueness& before, bool goes_on)
    : known_(before) {
  const Trajectory& trajectory = run.trajectory;
  for (std::size_t first = 0, last = 0; first < trajectory.size(); first = last + 1) {
    const RestingRows resting(trajectory.model(first));
    const auto rests_at = [&](std::size_t i) {
      const bool leads = i + 1 < trajectory.size() && &trajectory.model(i + 1) == &trajectory.model(i);
      return resting.empty() ? std::vector<char>()
                             : resting.at(trajectory.state(i), leads ? &trajectory.state(i + 1) : nullptr,
                                          run.options.step);
    };
    const std::vector<char>& rests = rests_[first] = rests_at(first);
    last = first;
    while (last + 1 < trajectory.size() && &trajectory.model(last + 1) == &trajectory.model(first) &&
           rests_at(last + 1) == rests)
      ++last;
    if (first > 0 || known_.rests != rests) known_ = {{}, {}, rests};
    examine(run, resting, first, last, !goes_on || last + 1 < trajectory.size());
  }
}

void ForceUniqueness::examine(const Simulation& run, const RestingRows& resting, std::size_t first,
                              std::size_t last, bool ends) {
  const System& system = run.trajectory.model(first).system;
  const std::vector<int> cables = resting.cables(known_.rests);
  const auto kept = static_cast<std::size_t>(system.constraints()), rows = kept + cables.size();
  const auto any_of_both = [](std::vector<char>& usual, const std::vector<char>& determined) {
    for (std::size_t r = 0; r < usual.size(); ++r) usual[r] = static_cast<char>(usual[r] | determined[r]);
  };
  const auto determined_at = [&](std::size_t i, const VectorXd& compliance) {
    const VectorXd q = run.trajectory.node_positions(i);
    SparseRows G = system.jacobian_pattern();
    std::vector<double> scratch;
    system.jacobian(q, G, scratch);
    G = resting.behind(G, q, known_.rests);
    return determined_rows(G, RestingRows::behind(compliance, G.rows()));
  };
  const bool is_known = rows > 0 && known_.rigidly.size() == rows;
  if (!is_known) known_ = {std::vector<char>(rows, 0), std::vector<char>(rows, 0), known_.rests};
  std::map<std::size_t, std::vector<char>> seen;
  for (const std::size_t i : looked_at(run, first, last, is_known, ends)) seen[i] = determined_at(i, {});
  examined_ += seen.size();
  std::vector<char>& rigid = known_.rigidly;
  // A pose without rank determines nothing that others do not, but for the rounding of its coordinates.
  const auto votes = [&](std::size_t i) { return !run.trajectory.report(i).singular_event; };
  const bool any_votes = std::ranges::any_of(seen, [&](const auto& pose) { return votes(pose.first); });
  for (const auto& [i, determined] : seen)
    if (votes(i) || (!any_votes && !is_known)) any_of_both(rigid, determined);
  for (auto& [i, determined] : seen)
    if (determined != rigid && !run.trajectory.report(i).singular_event) singular_[i] = std::move(determined);
  rigidly_[first] =
      std::all_of(rigid.begin(), rigid.begin() + static_cast<std::ptrdiff_t>(kept), std::identity());
  const VectorXd compliance = row_compliance(run.trajectory.model(first));
  if (rigidly_[first] || compliance.size() == 0) {
    known_.usual = rigid;
  } else {
    for (const auto& [i, unused] : seen)
      if (votes(i) || (!any_votes && !is_known)) any_of_both(known_.usual, determined_at(i, compliance));
    open_where_rank_falls(run, seen);
  }
  usual_[first] = known_.usual;
  std::set<int>& open = open_cables_[first];
  for (std::size_t k = 0; k < cables.size(); ++k)
    if (known_.usual[kept + k] == 0 && cables[k] >= 0) open.insert(cables[k]);
}

// Where rods lie beside others nothing may be left that rigid rods determine, and a pose without rank has no
// fewer of that: its rank tells.
void ForceUniqueness::open_where_rank_falls(const Simulation& run,
                                            const std::map<std::size_t, std::vector<char>>& seen) {
  constexpr double lost = 1e-6;  // as determined_rows() has it
  const System& system = run.trajectory.model(seen.begin()->first).system;
  if (std::max(system.constraints(), system.solved_coordinates()) > max_singular_size) return;
  std::map<std::size_t, Index> ranks;
  Index usual = 0;
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  for (const auto& [i, unused] : seen) {
    system.jacobian(run.trajectory.node_positions(i), G, scratch);
    ranks[i] = rank_of(MatrixXd(G).rowwise().normalized(), lost);
    usual = std::max(usual, ranks[i]);
  }
  for (const auto& [i, rank] : ranks)
    if (rank < usual && !run.trajectory.report(i).singular_event) singular_.emplace(i, known_.rigidly);
}

bool ForceUniqueness::all_by_rigid_rods(std::size_t state) const {
  return std::prev(rigidly_.upper_bound(state))->second;
}

const std::vector<char>& ForceUniqueness::at(std::size_t state) const {
  const auto singular = singular_.find(state);
  return singular != singular_.end() ? singular->second : std::prev(usual_.upper_bound(state))->second;
}

std::vector<char> followed_forces(const Model& model, const State& state, const VectorXd& axial_force) {
  constexpr double small = 0.01;
  const std::vector<int>& giving = model.system.giving_rods();
  if (state.tension_error.size() != std::ssize(giving) || giving.empty()) return {};
  const std::vector<Rod>& rods = model.structure.rods;
  const double most = small * largest_magnitude(axial_force.data(), axial_force.size());
  std::vector<char> followed(rods.size(), 0);
  bool all = true;
  for (std::size_t k = 0; k < giving.size(); ++k) {
    const auto r = static_cast<std::size_t>(giving[k]);
    followed[r] = state.tension_error[static_cast<Index>(k)] / rods[r].multiplicity <= most ? 1 : 0;
    all = all && followed[r];
  }
  return all ? std::vector<char>() : followed;
}

namespace {

// Whether the force that is largest in this direction, of the rods that are shown, is unique; of none it is,
// beside one that is not known it is not.
double extreme_unique(const Diagnostics& d, const VectorXd& force, const std::vector<char>& unique,
                      double sign) {
  double most = -std::numeric_limits<double>::infinity();
  for (Index r = 0; r < force.size(); ++r)
    if (d.shows(r)) most = std::max(most, sign * force[r]);
  const double close = std::isinf(most) ? 0.0 : 1e-9 * std::abs(most);  // equal ones differ by round-off
  for (Index r = 0; r < force.size(); ++r)
    if (d.shows(r) && !(sign * force[r] < most - close) &&
        (std::isnan(force[r]) || !unique[static_cast<std::size_t>(r)]))
      return 0.0;
  return 1.0;
}

std::vector<double>* values_of(Diagnostics& d, std::string_view name) {
  for (Series& column : d.columns)
    if (column.name == name) return &column.values;
  return nullptr;
}

// Of each node coordinate the largest of what acts on it in these states: beside it, what rods give where all
// fall alike is rounding.
VectorXd acting_in(const Trajectory& trajectory, const DoubtfulStates& states) {
  VectorXd most = VectorXd::Zero(trajectory.model().system.coordinates());
  for (const auto& [i, unused] : states) {
    const System system = trajectory.model(i).system.at(trajectory.state(i));
    VectorXd f = VectorXd::Zero(system.coordinates());
    system.add_applied_force(trajectory.time(i), trajectory.node_positions(i), trajectory.node_velocities(i),
                             1.0, f);
    most = most.cwiseMax(f.cwiseAbs());
  }
  return most;
}

// Doubt that counts, of each row of a model, by what of a run its constraints join with it: the largest
// forces of rods, and what acts.
class LeastDoubt {
 public:
  LeastDoubt(const Trajectory& trajectory, const DoubtfulStates& doubtful, const Diagnostics& d)
      : trajectory_(trajectory), forces_(VectorXd::Zero(d.axial_force.cols())) {
    if (doubtful.empty()) return;
    acting_ = acting_in(trajectory, doubtful);
    for (Index i = 0; i < std::ssize(d.t); ++i)
      for (Index r = 0; r < forces_.size(); ++r)
        if (const double f = std::abs(d.axial_force(i, r)); f > forces_[r]) forces_[r] = f;
  }
  const VectorXd& of(const Model& model) {
    if (std::exchange(model_, &model) == &model) return least_;
    const System& system = model.system;
    const IndependentParts parts(system);
    VectorXd of_rows = VectorXd::Zero(system.constraints()), pulls = VectorXd::Zero(acting_.size());
    for (Index r = 0; r < forces_.size(); ++r) {
      const Rod& rod = trajectory_.structure().rods[static_cast<std::size_t>(r)];
      if (const int row = system.rod_rows()[static_cast<std::size_t>(r)]; row >= 0)
        of_rows[row] = forces_[r];
      else  // it gives: a force on its ends
        for (const int end : {rod.a, rod.b})
          for (Index k = 3 * end; k < 3 * end + 3; ++k) pulls[k] = std::max(pulls[k], forces_[r]);
    }
    const auto of_nodes = [&](const VectorXd& sizes) {
      VectorXd solved(system.solved_coordinates());
      system.reduce_sizes(sizes, solved);
      return parts.largest(solved.data());
    };
    const VectorXd of_parts =
        (1e-9 * parts.largest_of_rows(of_rows).cwiseMax(of_nodes(pulls))).cwiseMax(1e-12 * of_nodes(acting_));
    least_.resize(of_rows.size());
    for (Index r = 0; r < least_.size(); ++r) least_[r] = of_parts[parts.of_row(r)];
    return least_;
  }

 private:
  const Trajectory& trajectory_;
  VectorXd forces_, acting_, least_;  // of rods, known ones; of node coordinates; of rows of the model
  const Model* model_ = nullptr;
};

// open[i], 1: waves or round-off change forces of state i.
void mark_rods(const Trajectory& trajectory, const ForceUniqueness& uniqueness,
               const DoubtfulStates& doubtful, Diagnostics& d, std::vector<char>& open) {
  std::vector<double>* const largest = values_of(d, "axial_force_max_unique");
  std::vector<double>* const smallest = values_of(d, "axial_force_min_unique");
  std::vector<char> unique(d.rod_unique.size(), 1);
  VectorXd force;
  LeastDoubt least(trajectory, doubtful, d);
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    const std::vector<char>& rows = uniqueness.at(i);
    const std::vector<int>& row_of = trajectory.model(i).system.rod_rows();
    const bool regular = uniqueness.regular(i);
    force = d.axial_force.row(static_cast<Index>(i));
    const std::vector<char> followed = followed_forces(trajectory.model(i), trajectory.state(i), force);
    const auto doubt = doubtful.find(i);
    Eigen::ArrayX<bool> in_doubt;
    if (doubt != doubtful.end()) in_doubt = doubt->second.array() > least.of(trajectory.model(i)).array();
    const bool doubted = in_doubt.any();
    open[i] = followed.empty() && !doubted ? 0 : 1;
    for (std::size_t r = 0; r < unique.size(); ++r) {
      unique[r] = row_of[r] < 0 ? char{1} : rows[static_cast<std::size_t>(row_of[r])];
      if (regular) d.rod_unique[r] = static_cast<char>(d.rod_unique[r] & unique[r]);
      if (!followed.empty()) unique[r] = static_cast<char>(unique[r] & followed[r]);
      if (doubted && row_of[r] >= 0 && in_doubt[row_of[r]]) unique[r] = 0;
      d.force_unique(static_cast<Index>(i), static_cast<Index>(r)) =
          unique[r] != 0 && !std::isnan(force[static_cast<Index>(r)]);
    }
    if (largest) (*largest)[i] = extreme_unique(d, force, unique, 1.0);
    if (smallest) (*smallest)[i] = extreme_unique(d, force, unique, -1.0);
  }
}

// Of each state, 1: waves of forces that the step does not resolve change what a drive gives there, by what
// its step's multipliers say otherwise.
std::vector<char> driven_by_waves(const Trajectory& trajectory, const DriveChannel& drive, Diagnostics& d) {
  constexpr double small = 0.01;
  std::vector<char> out(d.t.size(), 0);
  const std::vector<double>* const column =
      values_of(d, drive.name() + (drive.angle() ? ".torque_N_m" : ".force_N"));
  if (!column || !drive.by_row()) return out;
  double most = 0;
  for (const double effort : *column) most = std::max(most, std::abs(effort));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const State& state = trajectory.state(i);
    const Model& model = trajectory.model(i);
    const Index rods = std::ssize(model.system.giving_rods()), rows = state.lambda.size();
    if (rows == 0 || state.stage_tension.rows() != rods + rows) continue;
    const double by_step = drive.sample(model, model.system, state.t, {}, {}, state.lambda).effort;
    out[i] = std::abs(by_step - (*column)[i]) > small * most ? 1 : 0;
  }
  return out;
}

}  // namespace

void mark_unique(const Trajectory& trajectory, const ForceUniqueness& uniqueness,
                 const DoubtfulStates& doubtful, Diagnostics& d) {
  std::size_t most = 0;  // rows of any model
  for (std::size_t i = 0; i < d.t.size(); ++i) most = std::max(most, uniqueness.at(i).size());
  const std::vector<char> none(most, 0);
  std::vector<char> open(d.t.size(), 0);
  mark_rods(trajectory, uniqueness, doubtful, d, open);
  mark_reactions(trajectory, uniqueness, open, d);
  for (const DriveChannel& drive : drive_channels(trajectory.model())) {
    const bool angle = drive.angle();
    std::vector<double>* const column =
        values_of(d, drive.name() + (angle ? ".torque_unique" : ".force_unique"));
    if (!column) continue;
    const std::vector<double>* const effort =
        values_of(d, drive.name() + (angle ? ".torque_N_m" : ".force_N"));
    for (std::size_t i = 0; const char waves : driven_by_waves(trajectory, drive, d)) {
      const bool unique = drive.unique(trajectory.model(i), open[i] ? none : uniqueness.at(i)) &&
                          uniqueness.unique_without_row(i, drive.cable());
      const bool known = !effort || !trajectory.report(i).singular_event || !std::isnan((*effort)[i]);
      (*column)[i++] = unique && known && !waves ? 1.0 : 0.0;
    }
  }
}

void leave_unique_open(Diagnostics& d) {
  d.force_unique.setConstant(false);
  std::fill(d.rod_unique.begin(), d.rod_unique.end(), char{0});
  for (Series& column : d.columns)
    if (column.name.ends_with("_unique"))
      std::fill(column.values.begin(), column.values.end(), std::numeric_limits<double>::quiet_NaN());
}

PeakForce peak_rod_force(const Diagnostics& d, Pull pull) {
  constexpr double equal = 1e-9;  // of the peak: what multipliers of redundant rows carry of round-off
  const auto size = [pull](double force) {
    return pull == Pull::either ? std::abs(force) : pull == Pull::tension ? force : -force;
  };
  const MatrixXd& force = d.axial_force;
  PeakForce peak;
  for (Index i = 0; i < force.rows(); ++i)
    for (Index r = 0; r < force.cols(); ++r)
      if (d.shows(r) && !std::isnan(force(i, r)) && (peak.rod < 0 || size(force(i, r)) > size(peak.force_N)))
        peak = {force(i, r), r, d.t[static_cast<std::size_t>(i)], true};
  const double most = size(peak.force_N);
  for (Index r = 0; r < force.cols(); ++r)  // what nobody knows may be larger
    for (Index i = 0; d.shows(r) && i < force.rows(); ++i)
      if (!(size(force(i, r)) < most - equal * std::abs(most)) && !d.force_unique(i, r)) peak.unique = false;
  return peak;
}

std::size_t unique_rods(const Structure& structure, const Diagnostics& d) {
  return static_cast<std::size_t>(std::count_if(
      structure.rod_copies.begin(), structure.rod_copies.end(),
      [&](const RodCopy& copy) { return d.rod_unique[static_cast<std::size_t>(copy.source)] != 0; }));
}

}  // namespace unfurl
