// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/accuracy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "core/diagnostics/books.hpp"
#include "core/diagnostics/driven_tables.hpp"
#include "core/diagnostics/good_part.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/state_forces.hpp"
#include "core/integrators/integrator.hpp"
#include "core/integrators/stage_equations.hpp"
#include "core/math/largest.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structures/hoop_joints.hpp"

namespace unfurl {
namespace {

// Shares of the energy turned over and of a rod's length beyond which a motion is wrong to the eye.
constexpr double energy_share = 1e-3, length_share = 1e-3;

// Of a chord rod's length: it enters the time of deployment squared, as some 1e-7 s.
constexpr double uneven_share = 1e-3;

// The energies of a run but for their balance; the first is the kinetic energy.
std::vector<const Series*> energies(const Diagnostics& d) {
  std::vector<const Series*> found{&d.at("kinetic_energy_J")};
  for (const Series& column : d.columns)
    if (column.unit == "J" && column.name != "energy_balance_J" && column.name != "kinetic_energy_J")
      found.push_back(&column);
  return found;
}

void add_state(const std::vector<const Series*>& energies, std::size_t i, EnergyTurnedOver& turned) {
  std::vector<double> others;
  for (std::size_t k = 1; k < energies.size(); ++k) others.push_back(energies[k]->values[i]);
  turned.add(energies[0]->values[i], others);
}

bool finite(const Simulation& run, const Diagnostics& d, std::size_t i) {
  const State& state = run.trajectory.state(i);
  for (const Series& column : d.columns)
    if ((column.unit == "J" || column.name.starts_with("constraint_")) && !std::isfinite(column.values[i]))
      return false;
  return state.z.allFinite() && state.w.allFinite();
}

bool damps(const Simulation& run) {
  const Method* method = find_method(run.options.method);
  return method && method->claims(run.options).damps;
}

// By how much an energy balance is off, given state by state.
class BalanceError {
 public:
  explicit BalanceError(bool may_fall) : may_fall_(may_fall) {}
  void add(double balance) {
    lowest_ = std::min(lowest_, balance);
    off_ = larger(off_, may_fall_ ? balance - lowest_ : std::abs(balance));
  }
  double value() const { return off_; }

 private:
  bool may_fall_;
  double lowest_ = 0, off_ = 0;
};

// By more than a millionth of the structure and than rounding of its coordinates could look like, or of the
// way that forces make in a step, which they do not where something holds.
bool moves(const Simulation& run) {
  constexpr double noise = 16 * std::numeric_limits<double>::epsilon();
  const Trajectory& trajectory = run.trajectory;
  const Index in_space = space_coordinates(trajectory.structure());
  const VectorXd start = trajectory.node_positions(0).head(in_space);
  if (start.size() == 0) return false;
  const Eigen::Map<const Eigen::Matrix3Xd> nodes(start.data(), 3, start.size() / 3);
  const double extent = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).maxCoeff();
  const System& system = trajectory.model().system;
  VectorXd force = VectorXd::Zero(system.coordinates());
  system.add_applied_force(trajectory.time(0), trajectory.node_positions(0), trajectory.node_velocities(0),
                           1.0, force);
  const VectorXd mass = system.node_mass().diagonal();
  double reach = start.lpNorm<Eigen::Infinity>();
  for (Index k = 0; k < in_space; ++k)
    if (mass[k] > 0)
      reach = std::max(reach, std::abs(force[k]) / mass[k] * run.options.step * run.options.step);
  const double least = std::max(1e-6 * extent, noise * reach);
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    if ((trajectory.node_positions(i).head(in_space) - start).lpNorm<Eigen::Infinity>() > least) return true;
  return false;
}

// Where tables prescribe motions faster than steps follow: what to do about a balance.
std::string words_of_tables(const Simulation& run) {
  const std::string words = DrivenTables(run.trajectory.structure()).words(run.options.step);
  return words.empty() ? words : "; " + words;
}

double deployed_at(const Simulation& run) {
  for (const Event& event : run.events)
    if (event.name == "deployed") return event.t;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

GoodPart good_part(const Simulation& run, const Diagnostics& d) {
  const std::size_t judged = d.t.size() - d.left_open;
  const Series &balance = d.at("energy_balance_J"), &stretch = d.at("constraint_relative_max");
  const auto columns = energies(d);
  std::vector<double> round_off_error, stopped;  // asked for where they could make a difference
  const auto within = [&](double off, double energy, std::size_t i) {
    if (off <= trusted_share * energy) return true;
    if (round_off_error.empty())
      round_off_error = energy_round_off(run), stopped = energy_of_stopped_waves(run);
    return off <= trusted_share * energy + round_off_error[i] + std::min(stopped[i], energy);
  };
  EnergyTurnedOver turned;
  GoodPart part;
  std::ostringstream why;
  why.precision(3);
  BalanceError error(damps(run));
  double even_until = deployed_at(run);
  const Model* model = nullptr;  // forces of a controller are loads of the states that bear them
  for (std::size_t i = 0; i < judged; ++i) {
    if (const Model* now = &run.trajectory.model(i); std::exchange(model, now) != now)
      even_until = driven_evenly(now->structure) ? even_until : -1;
    if (!finite(run, d, i)) {
      if (part.states == i) why << "the state is not finite any more";
      break;
    }
    if (!(stretch.values[i] <= trusted_share)) {
      if (part.states == i)
        why << "constraints are violated by " << 100 * stretch.values[i] << " % of a rod's length";
      break;
    }
    if (d.t[i] <= even_until &&
        unevenness(run.trajectory.structure(), run.trajectory.node_positions(i)) > uneven_share) {
      if (part.states == i)
        why << "the ring, whose units are driven alike, opens unevenly: round-off has grown to "
            << 100 * uneven_share
            << " % of a rod's length and decides when it deploys; structure.model = \"full\" or \"sector\" "
               "keeps it "
               "even, structure.perturbed_unit says what disturbs it";
      break;
    }
    error.add(balance.values[i]);
    add_state(columns, i, turned);
    const double energy = turned.value(), off = error.value();
    if (within(off, energy, i)) {
      part.states = i + 1;
      why.str("");
    } else if (part.states == i) {
      why << "the energy balance is off by " << off << " J, "
          << (energy > 0 ? 100 * off / energy : std::numeric_limits<double>::infinity())
          << " % of the energy turned over" << words_of_tables(run);
    }
  }
  part.why = why.str();
  part.states = std::max<std::size_t>(part.states, std::min<std::size_t>(judged, 1));
  return part;
}

namespace {

std::string percent_of(double part, double whole) {
  std::ostringstream text;
  text.precision(3);
  if (part <= whole)
    text << 100 * part / whole << " %";
  else
    text << "more than all";
  return text.str();
}

}  // namespace

void EnergyTurnedOver::add(double kinetic, std::span<const double> others) {
  kinetic_ = larger(kinetic_, kinetic);
  if (low_.empty()) low_.assign(others.begin(), others.end()), high_ = low_;
  for (std::size_t k = 0; k < others.size(); ++k) {
    low_[k] = -larger(-low_[k], -others[k]);
    high_[k] = larger(high_[k], others[k]);
  }
}

double EnergyTurnedOver::value() const {
  double most = kinetic_;
  for (std::size_t k = 0; k < low_.size(); ++k) most = larger(most, high_[k] - low_[k]);
  return most;
}

double energy_turned_over(const Diagnostics& d) {
  const auto columns = energies(d);
  EnergyTurnedOver turned;
  for (std::size_t i = 0; i < d.t.size() - d.left_open; ++i) add_state(columns, i, turned);
  return turned.value();
}

Diagnostics judge(Simulation& run, const std::function<bool()>& cancelled, const KnownAhead& ahead) {
  Diagnostics d = diagnose(run, cancelled, ahead);
  const std::size_t judged = d.t.size() - d.left_open;
  GoodPart part = good_part(run, d);
  if (part.states == judged) return d;
  fail_for(part.text(d), run);
  d.left_open = 0;
  keep_states(part.states, run, d);
  return d;
}

namespace {

// Of a deployed pose whose multipliers are not finite; empty where all are bounded.
std::string without_bound(const Trajectory& run) {
  for (std::size_t i = 0; i < run.size(); ++i) {
    const State& state = run.state(i);
    if (!run.report(i).singular_event || state.lambda.allFinite()) continue;
    const std::vector<Rod>& rods = run.model(i).structure.rods;
    const std::vector<int>& row_of = run.model(i).system.rod_rows();
    std::string first;
    std::size_t count = 0;
    for (std::size_t r = 0; r < rods.size(); ++r)
      if (row_of[r] >= 0 && !std::isfinite(state.lambda[row_of[r]]) && ++count == 1) first = rods[r].name;
    std::ostringstream text;
    text
        << "forces" << (count > 0 ? " of rod " + first : std::string())
        << (count > 1 ? " and " + std::to_string(count - 1) + " more" : std::string())
        << " grow without bound towards the " << (run.structure().deployment.empty() ? "" : "deployed ")
        << "pose at t = " << state.t
        << " s, as rods in line need them to bear a load across: that state has none, and peaks are those of "
           "states beside it; end with an angle_stop before that pose, or let rods give "
           "(structure.rod_model)";
    return text.str();
  }
  return {};
}

// Of states that rest so near to a singular pose that nothing but rounding says their forces.
std::string words_of_undetermined(const Trajectory& run, const Diagnostics& d) {
  const auto [first, last] = undetermined_states(run, d);
  if (first == last) return {};
  std::ostringstream text;
  text.precision(6);
  text << "from t = " << d.t[first] << " s to " << d.t[last]
       << " s the pose is so near to a singular one that rounding says its forces, which may grow without "
          "bound towards it: rod forces, torques and reactions are not unique there; rest before that pose, "
          "or let rods give (structure.rod_model)";
  return text.str();
}

}  // namespace

Rise rise_on_the_way(const Simulation& run, const Diagnostics& d) {
  if (std::ranges::none_of(run.events, [](const Event& e) { return e.kind == "singular_pose"; })) return {};
  const RememberedExtremes once;
  const PeakInMotion most = extreme_of_column(run, d, "axial_force_max_N", true),
                     least = extreme_of_column(run, d, "axial_force_min_N", false);
  if (most.bounded && least.bounded) return {};
  PeakForce peak = peak_rod_force(run, d, most.bounded ? Pull::compression : Pull::tension);
  // The largest force may be another one, far from the pose.
  const auto at = static_cast<double>(run.trajectory.state_before(peak.t));
  if (std::ranges::none_of(run.events, [&](const Event& e) {
        return e.kind == "singular_pose" &&
               std::abs(static_cast<double>(run.trajectory.state_before(e.t)) - at) <= 1;
      })) {
    peak.rod = -1, peak.force_N = 0, peak.t = (most.bounded ? least : most).rise_t;
    const VectorXd forces = (most.bounded ? -1 : 1) * rod_forces_within_step(run, peak.t);
    for (Index r = 0; r < forces.size(); ++r)
      if (d.shows(r) && forces[r] > peak.force_N) peak.rod = r, peak.force_N = forces[r];
  }
  if (peak.rod < 0) return {};
  std::ostringstream text;
  text.precision(6);
  text << "the force of rod " << run.trajectory.structure().rods[static_cast<std::size_t>(peak.rod)].name
       << " grows without bound towards a singular pose beside t = " << peak.t
       << " s, which is passed on the way: its peak there, and what follows from it, is that of the nearest "
          "pose that was looked at, and larger with shorter steps";
  return {text.str(), peak.t, std::abs(peak.force_N)};
}

std::size_t first_unstretched(const Simulation& run, const Diagnostics& d) {
  const Trajectory& trajectory = run.trajectory;
  const std::vector<Rod>& rods = trajectory.structure().rods;
  const auto bears = [&](std::size_t i) {
    for (std::size_t r = 0; r < rods.size(); ++r)
      if (std::isfinite(rods[r].youngs_modulus) && rods[r].area > 0 &&
          std::abs(d.axial_force(static_cast<Index>(i), static_cast<Index>(r))) > 0)
        return true;
    return false;
  };
  for (std::size_t i = 0; i < d.t.size(); ++i)
    if (const VectorXd* u = trajectory.stretch(i); u && u->isZero(0) && bears(i)) return i;
  return d.t.size();
}

double turning_rate(const Trajectory& trajectory, std::size_t i) {
  const VectorXd v = trajectory.node_velocities(i);
  double most = 0;
  for (const Rod& rod : trajectory.structure().rods)
    most = std::max(most, (v.segment<3>(3 * rod.b) - v.segment<3>(3 * rod.a)).norm() / rod.length);
  return most;
}

double stretch_share(const Trajectory& trajectory, std::size_t i) {
  const VectorXd* u = trajectory.stretch(i);
  if (!u || u->size() == 0) return 0;
  const VectorXd q = trajectory.node_positions(i);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Rod& rod : trajectory.structure().rods)
    for (const int node : {rod.a, rod.b}) {
      low = low.cwiseMin(q.segment<3>(3 * node));
      high = high.cwiseMax(q.segment<3>(3 * node));
    }
  return u->lpNorm<Eigen::Infinity>() / (high - low).maxCoeff();
}

std::pair<double, std::size_t> largest_of_states(const Trajectory& trajectory, StateSize size) {
  std::pair<double, std::size_t> most{0, 0};
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    if (const double x = size(trajectory, i); x > most.first) most = {x, i};
  return most;
}

namespace {

// What quasi-static rods give is of first order: what it turns of the structure changes no force. By the
// elastica a cantilever's tip is told too far by 1 % at a tenth of its length, 10 % at a third, 66 % at one.
std::string words_of_large_stretch(const Trajectory& trajectory) {
  constexpr double large = 0.1;
  const auto [most, i] = largest_of_states(trajectory, stretch_share);
  if (!(most > large)) return "";
  std::ostringstream text;
  text << "quasi-static rods move nodes by up to " << trajectory.stretch(i)->lpNorm<Eigen::Infinity>()
       << " m (t = " << trajectory.time(i) << " s), " << percent_of(most, 1)
       << " of the structure's size: that is of first order, and no small displacement; "
          "structure.rod_model = \"elastic\" finds it";
  return text.str();
}

// The turn of a rod within a step [rad] from which on a method is a hundredth of its length off, or more,
// with every revolution; of a rod that turns freely.
double followed_turn(const SolverOptions& options) {
  if (options.method == "generalized_alpha") return 0.1;
  if (options.method != "dvm") return 0.5;
  if (options.constraints_at == "ends") return 0.1;
  constexpr std::array by_stages{0.1, 0.9, 2.0, 2.5, 3.0, 4.5, 5.5};  // of two and more
  return by_stages[static_cast<std::size_t>(std::clamp(options.stages, 2, 8) - 2)];
}

// The energy does not see such an error: a rod that turns freely keeps it at any step.
std::string words_of_turns(const Simulation& run) {
  const SolverOptions& options = run.options;
  if (options.adaptive || options.tolerance > 0 || run.solved_as.name == "path") return "";
  const auto [most, i] = largest_of_states(run.trajectory, turning_rate);
  const double followed = followed_turn(options);
  if (!(most * options.step > followed)) return "";
  std::ostringstream text;
  text.precision(3);
  text << "rods turn by up to " << most * options.step << " rad within a step of " << options.step
       << " s (t = " << run.trajectory.time(i)
       << " s), which the steps do not follow, however well the energy is kept: take solver.step <= "
       << followed / most
       << (options.method != "dvm"            ? ""
           : options.constraints_at == "ends" ? ", or solver.constraints_at = \"nodes\""
                                              : ", or more solver.stages")
       << ", or solver.adaptive = true";
  return text.str();
}

std::string words_of_interruption(const Diagnostics& d) {
  if (d.left_open >= d.t.size())
    return "interrupted before the run was judged: series, rod forces and measures are empty";
  if (d.left_open == 0) return "interrupted before it was known which forces are unique";
  std::ostringstream text;
  text << "interrupted: the run was judged up to t = " << d.t[d.t.size() - d.left_open - 1]
       << " s only: what follows may be nan in series and rod forces, and measures of the whole run are";
  return text.str();
}

double seconds_behind(const std::string& words, const std::string& text) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? std::nan("") : std::strtod(text.c_str() + at + words.size(), nullptr);
}

// Of a cable that swings unresolved, once: the swing of what it holds tells more than that the step does not
// resolve the motion towards it, and where it is the fastest swing on springs at the start, that was told.
void leave_out_repeated_swings(std::vector<std::string>& warnings) {
  constexpr double same = 0.05;  // period: of the cable alone, and of all that swings with it
  const std::string holds = " holds swings on it in ";
  double at_start = std::nan("");
  for (const std::string& w : warnings)
    if (w.find("fastest swing on springs, ") != w.npos)
      at_start = seconds_behind("fastest swing on springs, ", w);
  const std::vector<std::string> told = warnings;
  for (const std::string& swing : told) {
    const std::size_t end = swing.find(holds);
    if (end == swing.npos || !swing.starts_with("what ")) continue;
    const std::string towards = " does not resolve the motion towards " + swing.substr(5, end - 5) + ",";
    const bool known = std::abs(seconds_behind(holds, swing) - at_start) <= same * at_start;
    std::erase_if(warnings,
                  [&](const std::string& w) { return w.find(towards) != w.npos || (known && w == swing); });
  }
}

}  // namespace

std::string mistrust(const Simulation& run, const Diagnostics& d) {
  return good_part(run, d).text(d);
}

std::vector<std::string> warnings_of(const Simulation& run, const Diagnostics& d) {
  std::vector<std::string> all = run.warnings;
  leave_out_repeated_swings(all);
  if (!d.t.empty()) std::ranges::move(accuracy_warnings(run, d), std::back_inserter(all));
  return all;
}

std::vector<std::string> accuracy_warnings(const Simulation& run, const Diagnostics& d) {
  if (!d.whole()) return {words_of_interruption(d)};
  std::vector<std::string> warnings;
  const bool dvm = run.options.method == "dvm";
  const bool undamped = run.options.method == "generalized_alpha" && run.options.rho_inf > 0.95 &&
                        run.trajectory.model().system.constraints() > 0;
  const double off = largest_magnitude(d.at("energy_balance_J").values), turned = energy_turned_over(d);
  std::ostringstream text;
  text.precision(3);
  const bool within = off <= energy_share * turned;
  const double round_off = within ? 0.0 : energy_round_off(run).back(),
               stopped = within ? 0.0 : std::min(energy_of_stopped_waves(run).back(), turned);
  if (!(off <= energy_share * turned + round_off + stopped)) {
    BalanceError rise(damps(run));
    for (const double balance : d.at("energy_balance_J").values) rise.add(balance);
    if (rise.value() < 0.5 * off)
      text << "what the steps do not resolve has lost " << off << " J, " << percent_of(off, turned)
           << " of the energy turned over, as solver.rho_inf means it to: a smaller solver.step loses less";
    else
      text << "the energy balance is off by " << off << " J, " << percent_of(off, turned)
           << " of the energy turned over: take "
           << (undamped ? "solver.rho_inf <= 0.95, as nearer to 1 the forces of rods swing up at any step"
                        : "a smaller solver.step")
           << (dvm ? " or more solver.stages" : "") << words_of_tables(run);
    warnings.push_back(text.str());
  } else if (off > energy_share * turned && moves(run)) {
    text << "the energy balance is off by " << off << " J, " << percent_of(off, turned)
         << " of the energy turned over, which "
         << (off > energy_share * turned + round_off
                 ? "waves of stiff rods can have had that the steps stop"
                 : "rounding alone can do here: forces or coordinates are too large beside this motion for "
                   "the balance to check it");
    warnings.push_back(text.str());
  }
  const double stretch = largest_magnitude(d.at("constraint_relative_max").values);
  if (!(stretch <= length_share)) {
    text.str("");
    text << "constraints are violated by " << 100 * stretch
         << " % of a rod's length: take a smaller solver.step"
         << (dvm ? "" : ", or method dvm, which holds them");
    warnings.push_back(text.str());
  }
  if (warnings.empty())  // else it is the same cause, and the same cure
    if (std::string text_of_turns = words_of_turns(run); !text_of_turns.empty())
      warnings.push_back(std::move(text_of_turns));
  if (std::string text_of_forces = without_bound(run.trajectory); !text_of_forces.empty())
    warnings.push_back(std::move(text_of_forces));
  if (std::string text_of_rest = words_of_undetermined(run.trajectory, d); !text_of_rest.empty())
    warnings.push_back(std::move(text_of_rest));
  if (Rise rise = rise_on_the_way(run, d); !rise.text.empty()) warnings.push_back(std::move(rise.text));
  if (const std::size_t first = first_unstretched(run, d); first < d.t.size()) {
    text.str("");
    text << "near t = " << d.t[first]
         << " s, as where rods lie in line, the quasi-static rods would have to be moved farther than their "
            "lengths allow: such states are shown without what the rods give, and those beside them are no "
            "small displacements; structure.rod_model = \"elastic\" finds them";
    warnings.push_back(text.str());
  } else if (std::string text_of_stretch = words_of_large_stretch(run.trajectory); !text_of_stretch.empty()) {
    warnings.push_back(std::move(text_of_stretch));
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
