// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/run_digest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/diagnostics/good_part.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// Whether a summary looks for a column's largest or smallest value within steps.
bool looked_for(std::string_view name, bool largest) {
  for (const std::string_view known :
       {"axial_force_max_N", "axial_stress_max_Pa", "stress_ratio_max", "buckling_ratio_max",
        "latch_force_max_N", "latch_torque_max_N_m", "kinetic_energy_J"})
    if (name == known) return largest;
  if (name == "axial_force_min_N" || name == "axial_stress_min_Pa") return !largest;
  return name.ends_with(".torque_N_m") || name.ends_with(".force_N") || name.ends_with(".power_W") ||
         name.ends_with(".energy_J");
}

// Whether sign times values may go beyond the most that is known where they are looked at more closely: they
// come within their own spread of it.
bool may_top(std::span<const double> values, double sign, double most) {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;
  for (const double x : values) low = std::fmin(low, sign * x), high = std::fmax(high, sign * x);
  return high + (high - low) > most;
}

// Columns that count what happened since the start.
bool counts(std::string_view name) {
  for (const std::string_view known :
       {"work_J", "dissipated_J", "drive_work_J", "impact_loss_J", "energy_balance_J"})
    if (name == known) return true;
  return name.ends_with(".energy_J");
}

// The row of the largest sign * value; the first of equal ones. values.size() where there is none.
std::size_t row_of_largest(std::span<const double> values, double sign) {
  std::size_t best = values.size();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i]) && (best == values.size() || sign * values[i] > sign * values[best])) best = i;
  return best;
}

double fastest(const Trajectory& trajectory, std::size_t i) {
  const VectorXd v = trajectory.node_velocities(i);
  const Index in_space = space_coordinates(trajectory.structure());
  double most = 0;
  for (Index k = 0; k + 2 < in_space; k += 3) most = std::max(most, v.segment<3>(k).norm());
  return most;
}

double reach(const Trajectory& trajectory, std::size_t i) {
  return trajectory.node_positions(i).lpNorm<Eigen::Infinity>();
}

// Rows at which a rod bears most, of all rods and of those whose force is not unique.
void add_rods(const Structure& structure, const Diagnostics& d, std::set<std::size_t>& rows) {
  using Size = double (*)(const Rod&, double);
  static constexpr std::array<Size, 6> sizes{
      [](const Rod&, double f) { return std::abs(f); },
      [](const Rod&, double f) { return f; },
      [](const Rod&, double f) { return -f; },
      [](const Rod& rod, double f) { return std::abs(axial_stress(rod, f)); },
      [](const Rod& rod, double f) { return stress_ratio(rod, f); },
      [](const Rod& rod, double f) { return buckling_ratio(rod, f); }};
  for (const Size size : sizes)
    for (const bool open_only : {false, true}) {
      double most = -std::numeric_limits<double>::infinity();
      Index row = -1;
      for (Index i = 0; i < d.axial_force.rows(); ++i)
        for (Index r = 0; r < d.axial_force.cols(); ++r) {
          if (!d.shows(r) || (open_only && d.force_unique(i, r))) continue;
          const double x = size(structure.rods[static_cast<std::size_t>(r)], d.axial_force(i, r));
          if (x > most) most = x, row = i;
        }
      if (row >= 0) rows.insert(static_cast<std::size_t>(row));
    }
}

// In place of what was found of that column before.
void note(Diagnostics& d, FoundWithin found) {
  std::erase_if(d.found,
                [&](const FoundWithin& x) { return x.column == found.column && x.largest == found.largest; });
  d.found.push_back(std::move(found));
}

// What rods bear at a time within a step of a run or of what was left of it before.
VectorXd rod_forces(const Simulation& run, const Diagnostics& d, double t) {
  VectorXd forces = rod_forces_within_step(run, t);
  for (const FoundWithin& x : d.found)
    if (forces.size() == 0 && x.peak.t == t) forces = x.rod_forces;
  return forces;
}

// The lowest value before the largest rise, and where that ends.
void add_rise(const std::vector<double>& values, std::set<std::size_t>& rows) {
  std::size_t low = 0, from = 0, to = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < values[low]) low = i;
    if (values[i] - values[low] > values[to] - values[from]) from = low, to = i;
  }
  rows.insert({from, to});
}

// A deployed pose in which forces have no bound: a warning names them (accuracy_warnings()).
bool without_forces(const Trajectory& run, std::size_t i) {
  return run.report(i).singular_event && !run.state(i).lambda.allFinite();
}

}  // namespace

RunDigest::RunDigest(std::shared_ptr<const Model> model, const SolverOptions& options)
    : model_(std::move(model)), options_(options), kept_(empty()), good_(empty()), all_(empty()) {}

Digest RunDigest::empty() const {
  return {Simulation{.trajectory = Trajectory(model_, options_), .options = options_}, {}};
}

// Energies and turns go on from the state before the first new one, which the window before had, too.
void RunDigest::count_on(Diagnostics& d, std::size_t first) {
  for (std::size_t c = 0; first > 0 && c < d.columns.size(); ++c) {
    Series& column = d.columns[c];
    double off = ends_.at(c) - column.values[first - 1];
    if (column.name == "fold_angle_rad")
      off = 2 * pi * std::round(off / (2 * pi));
    else if (column.name == "fold_angle_deg")
      off = 360 * std::round(off / 360);
    else if (!counts(column.name))
      continue;
    for (double& x : column.values) x += off;
  }
}

void RunDigest::add_events(const Simulation& window, double until) {
  for (const Event& event : window.events) {
    const bool known = std::any_of(singular_.begin(), singular_.end(), [&](const Event& other) {
      return std::abs(other.t - event.t) <= 0.5 * options_.step;
    });
    if (event.kind == "singular_pose" && !known && event.t <= until) singular_.push_back(event);
  }
}

Diagnostics RunDigest::add(Simulation& window, std::size_t first, std::size_t last,
                           const std::function<bool()>& cancelled) {
  record_singular_poses(window, cancelled);
  add_events(window, window.trajectory.end_time());
  Diagnostics d = diagnose_window(window, last < window.trajectory.size(), known_, cancelled);
  count_on(d, first);
  ends_.clear();
  for (const Series& column : d.columns) ends_.push_back(column.values[last - 1]);
  all_ = with_rows(kept_, window, d, first, last);
  const GoodPart part = good_part(all_.run, all_.diagnostics);
  const std::size_t before = kept_.run.trajectory.size(), size = all_.run.trajectory.size();
  const bool good = part.states == size - all_.diagnostics.left_open;  // of what was judged
  trusted_ = (good ? size : std::max(part.states, before)) - before;
  if (first > 0 && trusted_ > 0 && !cut() &&
      looked([&] { return look_at_seam(window, d, first, first + std::min<std::size_t>(trusted_, 2)); }))
    all_ = with_rows(kept_, window, d, first, last);
  if (good) {
    doubt_.clear();
  } else if (part.states > before || doubt_.empty()) {
    good_ = all_;
    keep_states(std::max<std::size_t>(part.states, 1), good_.run, good_.diagnostics);
    good_.diagnostics.left_open = 0;
    if (!looked([&] { return note_rise(good_), good_ = thinned(good_), true; }))
      good_.diagnostics.left_open = 1;
    doubt_ = part.text(all_.diagnostics);
  }
  return d;
}

// What `look` finds; where it is ended (LooksUntil) what tops the last states is left open.
bool RunDigest::looked(const std::function<bool()>& look) {
  try {
    return look();
  } catch (const LookedEnough&) {
    all_.diagnostics.left_open = std::max<std::size_t>(all_.diagnostics.left_open, 1);
    return false;
  }
}

// Between the last state before the window and its first new one the motion may go beyond all that the digest
// has. That is then noted. False: it does not.
bool RunDigest::look_at_seam(const Simulation& window, const Diagnostics& d, std::size_t first,
                             std::size_t end) {
  const std::size_t begin = first - std::min<std::size_t>(first, 2);
  const Simulation seam{.trajectory = window.trajectory.part(begin, end, options_), .options = options_};
  const RememberedExtremes once;
  bool found = false;
  for (std::size_t c = 0; c < d.columns.size(); ++c) {
    Diagnostics rows;
    rows.columns.push_back(d.columns[c]);
    std::vector<double>& x = rows.columns.back().values;
    x.erase(x.begin() + static_cast<std::ptrdiff_t>(end), x.end());
    x.erase(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(begin));
    for (const double sign : {1.0, -1.0}) {
      if (!looked_for(d.columns[c].name, sign > 0)) continue;
      const std::string& name = d.columns[c].name;
      const std::vector<double>& all = all_.diagnostics.columns[c].values;
      const std::size_t row = row_of_largest(all, sign);
      if (row == all.size()) continue;
      const double most = beyond(all_.diagnostics, name, sign > 0, {all[row]}).value;
      if (!may_top(x, sign, sign * most)) continue;
      const PeakInMotion top = extreme_of_column(seam, rows, name, sign > 0);
      if (!(sign * top.value > sign * most)) continue;
      note(kept_.diagnostics, {name, sign > 0, top, rod_forces(seam, rows, top.t)});
      found = true;
    }
  }
  const auto [speed, quickest] = largest_of_states(all_.run.trajectory, fastest);
  const double top = find_measure("peak_speed").value(seam, d);
  if (!(top > beyond(all_.diagnostics, "peak_speed", true, {speed}).value)) return found;
  note(kept_.diagnostics, {"peak_speed", true, {top, seam.trajectory.time(0)}});
  return true;
}

Digest RunDigest::with_rows(const Digest& before, const Simulation& window, const Diagnostics& d,
                            std::size_t first, std::size_t last) const {
  Digest out = before;
  Simulation& run = out.run;
  run.status = window.status;
  run.message = window.message;
  run.warnings = window.warnings;
  run.steps = window.steps;
  run.newton_iterations = window.newton_iterations;
  run.factorisations = window.factorisations;
  run.cpu_s = window.cpu_s;
  const Model* model = &run.trajectory.last_model();
  for (std::size_t i = first; i < last; ++i) {
    if (const Model* now = &window.trajectory.model(i); now != model) {
      model = now;
      run.trajectory.change_model(std::shared_ptr<const Model>(std::shared_ptr<const Model>(), now));
    }
    run.trajectory.append(window.trajectory.state(i), window.trajectory.report(i));
    if (const VectorXd* u = window.trajectory.stretch(i))
      run.trajectory.add_stretch(run.trajectory.size() - 1, *u);
  }
  Diagnostics& rows = out.diagnostics;
  const auto count = static_cast<Index>(last - first), old = static_cast<Index>(rows.t.size());
  if (rows.columns.empty()) {
    rows.columns = d.columns;
    for (Series& column : rows.columns) column.values.clear();
    rows.rod_unique = d.rod_unique, rows.rod_shown = d.rod_shown;
    rows.axial_force.resize(0, d.axial_force.cols());
    rows.force_unique.resize(0, d.force_unique.cols());
  }
  const auto from = static_cast<std::ptrdiff_t>(first), to = static_cast<std::ptrdiff_t>(last);
  rows.t.insert(rows.t.end(), d.t.begin() + from, d.t.begin() + to);
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    std::vector<double>& values = rows.columns[c].values;
    values.insert(values.end(), d.columns.at(c).values.begin() + from, d.columns[c].values.begin() + to);
  }
  rows.axial_force.conservativeResize(old + count, Eigen::NoChange);
  rows.force_unique.conservativeResize(old + count, Eigen::NoChange);
  rows.axial_force.bottomRows(count) = d.axial_force.middleRows(static_cast<Index>(first), count);
  rows.force_unique.bottomRows(count) = d.force_unique.middleRows(static_cast<Index>(first), count);
  rows.left_open += last - std::clamp(d.t.size() - d.left_open, first, last);
  for (std::size_t r = 0; r < rows.rod_unique.size(); ++r)
    rows.rod_unique[r] = static_cast<char>(rows.rod_unique[r] & d.rod_unique[r]);
  run.events = window.events;
  std::erase_if(run.events, [](const Event& event) { return event.kind == "singular_pose"; });
  run.events.insert(run.events.end(), singular_.begin(), singular_.end());
  std::stable_sort(run.events.begin(), run.events.end(),
                   [](const Event& a, const Event& b) { return a.t < b.t; });
  return out;
}

// Whether a look within the steps of the last window may find more of a column than what is known.
bool RunDigest::worth_a_look(const Digest& all, const Series& column, double sign) const {
  const std::vector<double>& t = all.diagnostics.t;
  const std::size_t known = std::min(kept_.diagnostics.t.size(), t.size());
  const std::span<const double> x(column.values);
  const std::size_t row = row_of_largest(x.first(known), sign);
  return row == known ||
         may_top(x.subspan(known), sign,
                 sign * beyond(kept_.diagnostics, column.name, sign > 0, {x[row]}).value) ||
         std::ranges::any_of(
             all.run.events,
             [&](const Event& event) { return event.kind == "singular_pose" && event.t >= t[known - 1]; }) ||
         !rod_humps(all.run.trajectory, all.diagnostics, column.name, sign).empty();
}

// In the coordinates of the model at the start; nothing is looked for around these states any more.
Digest RunDigest::thinned(const Digest& all) const {
  const Trajectory& trajectory = all.run.trajectory;
  const Diagnostics& d = all.diagnostics;
  const std::size_t judged = d.t.size() - d.left_open;
  std::set<std::size_t> rows{0, std::max<std::size_t>(judged, 1) - 1, d.t.size() - 1};
  Digest out = empty();
  out.diagnostics.found = d.found;
  for (const Series& column : d.columns)
    for (const bool largest : {true, false}) {
      const std::size_t row = row_of_largest(column.values, largest ? 1.0 : -1.0);
      if (row == column.values.size()) continue;
      rows.insert(row);
      if (!looked_for(column.name, largest) || !worth_a_look(all, column, largest ? 1.0 : -1.0)) continue;
      const PeakInMotion top = extreme_of_column(all.run, d, column.name, largest);
      if (std::isfinite(top.value) && (top.value != column.values[row] || !top.bounded))
        note(out.diagnostics, {column.name, largest, top, rod_forces(all.run, d, top.t)});
    }
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    if (without_forces(trajectory, i)) rows.insert(i);
  if (const std::size_t first = first_unstretched(all.run, d); first < d.t.size()) rows.insert(first);
  add_rods(trajectory.structure(), d, rows);
  add_rise(d.at("energy_balance_J").values, rows);
  // Of what the books of later windows may be off by: the largest so far.
  const std::vector<double> stopped = energy_of_stopped_waves(all.run);
  rows.insert(static_cast<std::size_t>(std::ranges::max_element(stopped) - stopped.begin()));
  for (const StateSize size : {turning_rate, stretch_share, reach})
    rows.insert(largest_of_states(trajectory, size).second);
  const auto [speed, quickest] = largest_of_states(trajectory, fastest);
  rows.insert(quickest);
  if (const double top = find_measure("peak_speed").value(all.run, d); top > speed)
    note(out.diagnostics, {"peak_speed", true, {top, trajectory.time(quickest)}});
  for (const FoundWithin& x : out.diagnostics.found) {
    const std::size_t before = trajectory.state_before(x.peak.t);
    rows.insert({before, std::min(before + 1, d.t.size() - 1)});
  }
  out.run.events = all.run.events;
  out.diagnostics.left_open = static_cast<std::size_t>(std::distance(rows.lower_bound(judged), rows.end()));
  out.diagnostics.columns = d.columns;
  for (Series& column : out.diagnostics.columns) column.values.clear();
  out.diagnostics.rod_unique = d.rod_unique, out.diagnostics.rod_shown = d.rod_shown;
  out.diagnostics.axial_force.resize(static_cast<Index>(rows.size()), d.axial_force.cols());
  out.diagnostics.force_unique.resize(static_cast<Index>(rows.size()), d.force_unique.cols());
  for (Index to = 0; const std::size_t i : rows) {
    State state = in_coordinates(trajectory.model(i).system, trajectory.state(i), model_->system);
    const bool same_rows = trajectory.model(i).system.rod_rows() == model_->system.rod_rows();
    if (!without_forces(trajectory, i) || !same_rows) state.lambda.resize(0);
    if (trajectory.model(i).system.giving_rods() != model_->system.giving_rods()) state.tension.resize(0);
    state.tension_error.resize(0);
    state.stage_tension.resize(0, 0);
    out.run.trajectory.append(std::move(state), StepReport{.singular_event = true});
    if (const VectorXd* u = trajectory.stretch(i))
      out.run.trajectory.add_stretch(out.run.trajectory.size() - 1, *u);
    out.diagnostics.t.push_back(d.t[i]);
    for (std::size_t c = 0; c < d.columns.size(); ++c)
      out.diagnostics.columns[c].values.push_back(d.columns[c].values[i]);
    out.diagnostics.axial_force.row(to) = d.axial_force.row(static_cast<Index>(i));
    out.diagnostics.force_unique.row(to) = d.force_unique.row(static_cast<Index>(i));
    ++to;
  }
  return out;
}

Digest RunDigest::whole(const Simulation& last_window) const {
  Digest out = all_;
  if (!doubt_.empty()) {
    if (trusted_ > 0) {
      keep_states(kept_.run.trajectory.size() + trusted_, out.run, out.diagnostics);
      out.diagnostics.left_open = 0;
    } else {
      const Digest end = std::move(out);
      out = good_;
      out.run.steps = end.run.steps;
      out.run.newton_iterations = end.run.newton_iterations;
      out.run.cpu_s = end.run.cpu_s;
      out.run.warnings = end.run.warnings;
    }
    out.run.status = last_window.status;
    out.run.message = last_window.message;
    fail_for(doubt_, out.run);
  }
  const auto rise = std::find_if(rises_.rbegin(), rises_.rend(),
                                 [&](const Rise& r) { return r.t <= out.run.trajectory.end_time(); });
  if (rise != rises_.rend() && rise_on_the_way(out.run, out.diagnostics).text.empty())
    out.run.warnings.push_back(rise->text);
  return out;
}

void RunDigest::note_rise(const Digest& rows) {
  Rise rise = rise_on_the_way(rows.run, rows.diagnostics);
  if (!rise.text.empty() && (rises_.empty() || rise.force_N > rises_.back().force_N))
    rises_.push_back(std::move(rise));
}

void RunDigest::settle() {
  const RememberedExtremes once;
  Digest thin = empty();
  if (!looked([&] { return note_rise(all_), thin = thinned(all_), true; })) thin = thinned(all_);
  kept_ = std::move(thin);
  all_ = empty();
}

void RunDigest::archive(Archive& archive) {
  archive_digest(archive, kept_);
  archive_digest(archive, good_);
  archive(doubt_);
  archive(ends_);
  archive(known_);
  archive_events(archive, singular_);
  std::size_t rises = rises_.size();
  archive(rises);
  if (rises > archive.bytes().size()) throw ArchiveError("ends too early");
  rises_.resize(rises);
  for (Rise& rise : rises_) {
    archive(rise.text);
    archive(rise.t);
    archive(rise.force_N);
  }
}

void RunDigest::archive_digest(Archive& archive, Digest& digest) const {
  Diagnostics& d = digest.diagnostics;
  if (archive.reading()) digest = empty();
  std::size_t states = digest.run.trajectory.size(), columns = d.columns.size();
  archive(states);
  for (std::size_t i = 0; i < states; ++i) {
    State state;
    if (!archive.reading()) state = digest.run.trajectory.state(i);
    archive(state.t);
    for (VectorXd* x : {&state.z, &state.w, &state.lambda, &state.tension, &state.angles}) archive(*x);
    VectorXd u;
    if (const VectorXd* shown = archive.reading() ? nullptr : digest.run.trajectory.stretch(i)) u = *shown;
    archive(u);
    if (!archive.reading()) continue;
    digest.run.trajectory.append(std::move(state), StepReport{.singular_event = true});
    if (u.size() > 0) digest.run.trajectory.add_stretch(i, std::move(u));
  }
  archive(d.t);
  archive(columns);
  if (columns > archive.bytes().size()) throw ArchiveError("ends too early");
  d.columns.resize(columns);
  for (Series& column : d.columns) {
    for (std::string* x : {&column.name, &column.label, &column.unit}) archive(*x);
    archive(column.values);
  }
  archive(d.axial_force);
  archive(d.force_unique);
  archive(d.rod_unique);
  std::size_t found = d.found.size();
  archive(found);
  if (found > archive.bytes().size()) throw ArchiveError("ends too early");
  d.found.resize(found);
  for (FoundWithin& x : d.found) {
    archive(x.column);
    archive(x.largest);
    for (double* number : {&x.peak.value, &x.peak.t, &x.peak.rise_t}) archive(*number);
    archive(x.peak.bounded);
    archive(x.rod_forces);
  }
  d.rod_shown = shown_rods(model_->structure);
  archive_events(archive, digest.run.events);
}

}  // namespace unfurl
