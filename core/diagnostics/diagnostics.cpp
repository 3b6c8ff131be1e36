// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/diagnostics/books.hpp"
#include "core/diagnostics/columns.hpp"
#include "core/diagnostics/diagnosis_ahead.hpp"
#include "core/diagnostics/drives.hpp"
#include "core/diagnostics/energy_flow.hpp"
#include "core/diagnostics/fold_angle.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/reactions.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/diagnostics/state_forces.hpp"
#include "core/forces/latch_spring.hpp"
#include "core/simulate/elastic_sharing.hpp"
#include "core/simulate/latch.hpp"

namespace unfurl {
namespace {

double max_norm(const VectorXd& v) {
  return v.size() ? v.lpNorm<Eigen::Infinity>() : 0.0;
}

// What a diagnostic may look at in one state.
struct Instant {
  const Simulation& run;
  std::size_t i;
  const State& state;
  const VectorXd &q, &v;           // node coordinates, velocities
  const VectorXd& phi;             // of all constraints [m]
  const VectorXd& velocity_phi;    // G v of all constraints [m/s]
  const VectorXd& axial_force;     // of the solved rods [N]
  const std::vector<char>& shown;  // per solved rod
  const VectorXd& acceleration;    // of the nodes; NaN where the equations have no solution [m/s^2]
  const System& equations;         // that the state belongs to, near its angles
  const FoldAngle& fold;
  const EnergyFlow& flow;
  double kinetic, potential;   // [J]
  double first_energy;         // kinetic + potential at t = 0 [J]
  double relative_constraint;  // the largest

  const System& system() const { return equations; }
  const Deployment& deployment() const { return run.trajectory.structure().deployment; }
  double work() const { return system().load_work(q) + flow.load_work[i]; }
  // The largest sign * force of a rod that is shown; 0 of none, NaN where it is not known.
  double most_force(double sign) const {
    double most = -std::numeric_limits<double>::infinity();
    for (Index r = 0; r < axial_force.size(); ++r) {
      if (!shown[static_cast<std::size_t>(r)]) continue;
      const double value = sign * axial_force[r];
      if (std::isnan(value)) return value;
      most = std::max(most, value);
    }
    return std::isinf(most) ? 0.0 : most;
  }
  // The largest of sign * quantity; NaN where nothing is known of any rod, or of one that has a modulus.
  double most_of_rods(double sign, double (*quantity)(const Rod&, double)) const {
    double most = std::numeric_limits<double>::quiet_NaN();
    for (Index r = 0; r < axial_force.size(); ++r) {
      const Rod& rod = run.trajectory.structure().rods[static_cast<std::size_t>(r)];
      if (!rod.elastic() || !shown[static_cast<std::size_t>(r)]) continue;
      const double value = sign * quantity(rod, axial_force[r]);
      if (std::isnan(value)) return value;
      if (!(most >= value)) most = value;
    }
    return most;
  }
  double latch_load() const {
    return unfurl::latch_load(run.trajectory.model(i).structure, equations.moment(state.t), q, v);
  }
};

// What a scene must have for a column to mean something.
enum class Needs {
  nothing,
  fold,
  deployment,
  dampers,
  drives,
  impacts,
  moduli,
  strengths,
  latch_forces,
  latch_torques
};

struct Row {
  const char *name, *label, *unit;
  Needs needs;
  double (*value)(const Instant&);
};

constexpr double ulp = std::numeric_limits<double>::epsilon();

const std::array rows{
    Row{"kinetic_energy_J", "kinetic energy", "J", Needs::nothing,
        [](const Instant& s) { return s.kinetic; }},
    Row{"potential_energy_J", "potential energy", "J", Needs::nothing,
        [](const Instant& s) { return s.potential; }},
    Row{"work_J", "work of loads and motors, of elastic cables and rods that change their lengths", "J",
        Needs::nothing, [](const Instant& s) { return s.work(); }},
    Row{"dissipated_J", "energy taken by dampers and friction", "J", Needs::dampers,
        [](const Instant& s) { return s.flow.dissipated[s.i]; }},
    Row{"drive_work_J", "work of the drives and of rigid rods that warm", "J", Needs::drives,
        [](const Instant& s) { return s.flow.drive_work[s.i]; }},
    Row{"impact_loss_J", "energy lost in impacts", "J", Needs::impacts,
        [](const Instant& s) { return s.flow.impact_loss[s.i]; }},
    Row{"energy_balance_J", "energy balance", "J", Needs::nothing,
        [](const Instant& s) {
          return s.kinetic + s.potential - s.first_energy - s.work() + s.flow.dissipated[s.i] -
                 s.flow.drive_work[s.i] + s.flow.impact_loss[s.i];
        }},
    Row{"constraint_max_m", "constraint error", "m", Needs::nothing,
        [](const Instant& s) { return max_norm(s.phi); }},
    Row{"constraint_relative_max", "relative constraint error", "", Needs::nothing,
        [](const Instant& s) { return s.relative_constraint; }},
    Row{"constraint_round_off_max", "constraint error in units of round-off", "ulp", Needs::nothing,
        [](const Instant& s) { return s.relative_constraint / ulp; }},
    Row{"constraint_velocity_max_m_s", "velocity constraint error", "m/s", Needs::nothing,
        [](const Instant& s) { return max_norm(s.velocity_phi); }},
    Row{"fold_angle_rad", "fold angle", "rad", Needs::fold, [](const Instant& s) { return s.fold.angle(); }},
    Row{"fold_rate_rad_s", "fold rate", "rad/s", Needs::fold, [](const Instant& s) { return s.fold.rate(); }},
    Row{"deployed_fraction", "deployed fraction", "", Needs::deployment,
        [](const Instant& s) { return s.deployment().fraction(s.q, s.state.angles); }},
    Row{"axial_force_max_N", "largest axial force", "N", Needs::nothing,
        [](const Instant& s) { return s.most_force(1.0); }},
    Row{"axial_force_min_N", "smallest axial force", "N", Needs::nothing,
        [](const Instant& s) { return 0.0 - s.most_force(-1.0); }},
    Row{"step_s", "step", "s", Needs::nothing,
        [](const Instant& s) { return s.i == 0 ? 0.0 : s.state.t - s.run.trajectory.time(s.i - 1); }},
    Row{"newton_iterations", "Newton iterations", "", Needs::nothing,
        [](const Instant& s) { return static_cast<double>(s.run.trajectory.report(s.i).newton_iterations); }},
    Row{"axial_force_max_unique", "largest axial force is unique", "", Needs::nothing,
        [](const Instant&) { return 1.0; }},  // until mark_unique()
    Row{"axial_force_min_unique", "smallest axial force is unique", "", Needs::nothing,
        [](const Instant&) { return 1.0; }},
    Row{"axial_stress_max_Pa", "largest axial stress", "Pa", Needs::moduli,
        [](const Instant& s) { return s.most_of_rods(1.0, axial_stress); }},
    Row{"axial_stress_min_Pa", "smallest axial stress", "Pa", Needs::moduli,
        [](const Instant& s) { return -s.most_of_rods(-1.0, axial_stress); }},
    Row{"latch_force_max_N", "largest force of a latch", "N", Needs::latch_forces,
        [](const Instant& s) { return s.latch_load(); }},
    Row{"latch_torque_max_N_m", "largest torque of a latch", "N m", Needs::latch_torques,
        [](const Instant& s) { return s.latch_load(); }},
    Row{"stress_ratio_max", "largest share of a rod's strength", "", Needs::strengths,
        [](const Instant& s) { return s.most_of_rods(1.0, stress_ratio); }},
    Row{"buckling_ratio_max", "largest share of a rod's Euler load", "", Needs::moduli,
        [](const Instant& s) { return s.most_of_rods(1.0, buckling_ratio); }},
    // As scenes have it.
    Row{"fold_angle_deg", "fold angle", "deg", Needs::fold,
        [](const Instant& s) { return s.fold.angle() / radians_per_degree; }},
    Row{"fold_rate_deg_s", "fold rate", "deg/s", Needs::fold,
        [](const Instant& s) { return s.fold.rate() / radians_per_degree; }},
};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// -(across'/across) / (along'/along): the ratio of the strain increments of the motion that goes on, which at
// rest is the one that begins. At rest is what a step does not tell from the rounding of positions; where
// nothing begins either there is no ratio.
double poisson_ratio(const Instant& s) {
  const Structure& structure = s.run.trajectory.structure();
  const LinearForm& along = structure.lengths[static_cast<std::size_t>(structure.strain_along)].value;
  const LinearForm& across = structure.lengths[static_cast<std::size_t>(structure.strain_across)].value;
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  const double h = s.run.options.step;
  double stretch = along.rate(s.v) / along(s.q), widening = across.rate(s.v) / across(s.q);
  if (std::max(std::abs(stretch), std::abs(widening)) * h <= rounding) {
    stretch = along.rate(s.acceleration) / along(s.q), widening = across.rate(s.acceleration) / across(s.q);
    if (!(std::max(std::abs(stretch), std::abs(widening)) * h * h > rounding)) return nan;
  }
  constexpr double turning =
      1e-9;  // a length at its greatest, but for rounding: the ratio has no bound there
  return std::abs(stretch) <= turning * std::abs(widening) ? nan : -widening / stretch;
}

// The columns that only this structure has, at the end.
void add_own_columns(const Structure& structure, Diagnostics& out) {
  for (const ReportedLength& m : structure.lengths) out.columns.push_back({m.name, m.label, "m", {}});
  for (const ReportedSurface& m : structure.surfaces) out.columns.push_back({m.name, m.label, "m", {}});
  if (structure.strain_along >= 0) out.columns.push_back({"poisson_ratio", "Poisson's ratio", "", {}});
}

void add_own_values(const Structure& structure, const Instant& s, Series* column) {
  for (const ReportedLength& m : structure.lengths) (column++)->values.push_back(m.value(s.q));
  for (const ReportedSurface& m : structure.surfaces) (column++)->values.push_back(m.rms(s.q));
  if (structure.strain_along >= 0) column->values.push_back(poisson_ratio(s));
}

// Whether impacts may happen, not whether they do: stops, whatever they limit, and rigid latches.
bool can_strike(const Structure& structure, const SolverOptions& options) {
  return !structure.stops.empty() ||
         (options.at_deployed == "latch" && !structure.deployment.empty() && !latch_gives(structure));
}

bool latched_angle(const Deployment& deployment) {
  return deployment.latches.empty() && (!deployment.measured || is_angle(deployment.measure));
}

bool present(Needs needs, const Simulation& run) {
  const Model& model = run.trajectory.model();
  const auto latches = [&](double damping) {
    return run.options.at_deployed == "latch" &&
           std::any_of(model.structure.forces.begin(), model.structure.forces.end(),
                       [&](const Force& force) { return force.kind == "latch" && force.damping >= damping; });
  };
  switch (needs) {
    case Needs::nothing:
      return true;
    case Needs::fold:
      return model.structure.deployment.folds();
    case Needs::deployment:
      return !model.structure.deployment.empty();
    case Needs::dampers:
      return model.system.has_power(true) || latches(std::numeric_limits<double>::min());
    case Needs::drives:
      return model.system.rheonomic() ||
             std::any_of(model.structure.stops.begin(), model.structure.stops.end(),
                         [](const Stop& stop) { return stop.reeled; });
    case Needs::impacts:
      return can_strike(model.structure, run.options);
    case Needs::moduli:
      return any_elastic(model.structure);
    case Needs::strengths:
      return any_strength(model.structure);
    case Needs::latch_forces:
      return latches(0.0) && !latched_angle(model.structure.deployment);
    case Needs::latch_torques:
      return latches(0.0) && latched_angle(model.structure.deployment);
  }
  return true;
}

}  // namespace

const Series* Diagnostics::find(std::string_view name) const {
  for (const Series& s : columns)
    if (s.name == name) return &s;
  return nullptr;
}

const Series& Diagnostics::at(std::string_view name) const {
  if (const Series* s = find(name)) return *s;
  throw std::out_of_range("no diagnostic " + std::string(name));
}

std::vector<DiagnosticColumn> diagnostic_columns() {
  std::vector<DiagnosticColumn> columns;
  for (const Row& row : rows) columns.push_back({row.name, row.label});
  return columns;
}

std::vector<std::string_view> diagnostic_names() {
  std::vector<std::string_view> names;
  for (const Row& row : rows) names.emplace_back(row.name);
  return names;
}

namespace {
// The rows that were not looked at.
void leave_open(const Trajectory& trajectory, Diagnostics& out) {
  out.left_open = trajectory.size() - out.t.size();
  while (out.t.size() < trajectory.size()) out.t.push_back(trajectory.time(out.t.size()));
  for (Series& column : out.columns) column.values.resize(out.t.size(), nan);
  out.axial_force.bottomRows(static_cast<Index>(out.left_open)).setConstant(nan);
  out.force_unique.bottomRows(static_cast<Index>(out.left_open)).setConstant(false);
}

// Of works what there is in the structure is named alone.
std::string label_in(const Structure& s, const Row& row) {
  const std::string_view name = row.name;
  if (name == "work_J" && !motors_or_warmed(s)) return "work of the loads";
  const auto warms = [](const Rod& rod) { return !rod.gives && rod.expansion != 0; };
  if (name == "drive_work_J" && std::ranges::none_of(s.rods, warms)) return "work of the drives";
  return row.label;
}

enum class Look { energies, books, motion, states, all };

// The columns of a run, filled state by state.
class StateTable {
 public:
  // `uniqueness`: where it is known already; null: it is asked for only at the end.
  StateTable(const Simulation& run, Look look, const ForceUniqueness* uniqueness, const KnownAhead& ahead)
      : run_(run),
        look_(look),
        books_(look == Look::books || look == Look::energies),
        uniqueness_(uniqueness),
        used_(columns(run, books_, out_)),
        flow_(run.trajectory, look == Look::books || look == Look::all),
        known_flow_(ahead.flow),
        forces_(run.trajectory, ahead.forces),
        fold_(run.trajectory.structure().deployment) {
    if (!books_) drives_.emplace(run.trajectory.model(), out_.columns);
    if (!books_ && look != Look::motion) reactions_.emplace(run.trajectory.model(), out_.columns);
    first_own_ = out_.columns.size();
    if (!books_) add_own_columns(run.trajectory.structure(), out_);
    const auto rods = books_ ? Index{0} : static_cast<Index>(run.trajectory.structure().rods.size());
    make_room(static_cast<Index>(run.trajectory.size()), rods);
    out_.rod_unique.assign(static_cast<std::size_t>(rods), 1);
    if (!books_) out_.rod_shown = shown_rods(run.trajectory.structure());
    force_.resize(rods);
  }

  void add(std::size_t i) {
    if (static_cast<Index>(i) >= out_.axial_force.rows())
      make_room(2 * static_cast<Index>(run_.trajectory.size()), out_.axial_force.cols());
    const State& state = run_.trajectory.state(i);
    if (model_ != &run_.trajectory.model(i)) enter(i);
    system_->follow(state);
    const VectorXd q = run_.trajectory.node_positions(i), v = run_.trajectory.node_velocities(i);
    if (i > 0 && !known_flow_) flow_.step_to(i, books_ ? nullptr : &forces_);
    system_->all_constraint_values(state.t, q, phi_);
    system_->all_constraint_rates(state.t, q, v, velocity_phi_, scratch_);
    VectorXd lambda;
    if (!books_) lambda = find_forces(i, q, v);
    const double kinetic = system_->kinetic_energy(state.w), potential = system_->potential_energy(q);
    if (i == 0) first_energy_ = kinetic + potential;
    fold_.go_to(state.t, q, v);
    const Instant instant{run_,
                          i,
                          state,
                          q,
                          v,
                          phi_,
                          velocity_phi_,
                          force_,
                          out_.rod_shown,
                          acceleration_,
                          *system_,
                          fold_,
                          known_flow_ ? *known_flow_ : flow_.so_far(),
                          kinetic,
                          potential,
                          first_energy_,
                          max_norm(phi_.cwiseQuotient(lengths_))};
    out_.t.push_back(state.t);
    for (std::size_t c = 0; c < used_.size(); ++c) out_.columns[c].values.push_back(used_[c]->value(instant));
    if (books_) return;
    add_own_values(run_.trajectory.structure(), instant, out_.columns.data() + first_own_);
    drives_->append(*model_, *system_, state.t, q, v, lambda,
                    [&](std::size_t d) { return instant.flow.of_drives[d][i]; });
    if (reactions_) reactions_->append(*model_, *system_, state, q, v, acceleration_, lambda);
  }

  void fill(const std::function<bool()>& cancelled) {
    while (out_.t.size() < run_.trajectory.size() && !(cancelled && cancelled())) add(out_.t.size());
    make_room(static_cast<Index>(run_.trajectory.size()), out_.axial_force.cols());
  }
  // The states of which those that follow have no say.
  void fill_first(const std::function<bool()>& enough) {
    while (out_.t.size() + StateForces::reach < run_.trajectory.size() && !(enough && enough()))
      add(out_.t.size());
  }

  Diagnostics finish(const ForceUniqueness* uniqueness) {
    if (uniqueness) mark_unique(run_.trajectory, *uniqueness, doubtful_, out_);
    if (!uniqueness && look_ == Look::all) leave_unique_open(out_);
    leave_open(run_.trajectory, out_);
    for (Series& column : out_.columns)
      if (column.unit == "J")
        for (double& energy : column.values) energy *= run_.trajectory.structure().sectors;
    return std::move(out_);
  }

 private:
  void make_room(Index states, Index rods) {
    const Index before = out_.force_unique.rows();
    out_.axial_force.conservativeResize(states, rods);
    out_.force_unique.conservativeResize(states, rods);
    if (states > before) out_.force_unique.bottomRows(states - before).setConstant(false);  // it is copied
  }

  static std::vector<const Row*> columns(const Simulation& run, bool books, Diagnostics& out) {
    std::vector<const Row*> used;
    for (const Row& row : rows) {
      const bool book =
          row.unit == std::string_view("J") || std::string_view(row.name).starts_with("constraint_");
      if (!present(row.needs, run) || (books && !book)) continue;
      used.push_back(&row);
      out.columns.push_back({row.name, label_in(run.trajectory.structure(), row), row.unit, {}});
    }
    return used;
  }

  // State i is the first of its model.
  void enter(std::size_t i) {
    model_ = &run_.trajectory.model(i);
    system_ = std::make_unique<System>(model_->system);
    if (!books_) sharing_.emplace(*model_, !uniqueness_ || uniqueness_->all_by_rigid_rods(i));
    lengths_ = model_->system.all_lengths();
    phi_.resize(lengths_.size());
    velocity_phi_.resize(lengths_.size());
  }

  // Of rods; returns the multipliers. A state that is looked at by itself, between those of a run, has none
  // where its round-off says what they are.
  VectorXd find_forces(std::size_t i, const VectorXd& q, const VectorXd& v) {
    const State& state = run_.trajectory.state(i);
    VectorXd lambda = forces_.multipliers(i, acceleration_);
    VectorXd doubt = forces_.large_doubt(i, lambda);
    sharing_->share(state.t, q, run_.trajectory.report(i).singular_event, lambda);
    if (doubt.size() > 0) {
      if (look_ != Look::all) forces_.forget_beside(i, doubt, lambda, acceleration_);
      doubtful_[i] = std::move(doubt);
    }
    axial_forces(*model_, state, q, v, lambda, force_);
    if (force_.size() > 0) out_.axial_force.row(static_cast<Index>(i)) = force_.transpose();
    return lambda;
  }

  const Simulation& run_;
  Look look_;
  bool books_;
  const ForceUniqueness* uniqueness_;
  DoubtfulStates doubtful_;
  Diagnostics out_;
  std::vector<const Row*> used_;
  std::optional<DriveColumns> drives_;
  std::optional<ReactionColumns> reactions_;
  std::size_t first_own_ = 0;  // column of what the structure has of its own
  RunEnergyFlow flow_;
  const EnergyFlow* known_flow_;
  StateForces forces_;
  FoldAngle fold_;
  std::optional<ElasticSharing> sharing_;
  const Model* model_ = nullptr;
  std::unique_ptr<System> system_;  // of that model, as the angles have turned so far
  VectorXd lengths_, phi_, velocity_phi_, force_, acceleration_;
  std::vector<double> scratch_;
  double first_energy_ = 0;
};

Diagnostics diagnosed(const Simulation& run, Look look, const ForceUniqueness* uniqueness,
                      const std::function<bool()>& cancelled = {}) {
  StateTable table(run, look, uniqueness, {});
  table.fill(cancelled);
  return table.finish(uniqueness);
}

}  // namespace

DiagnosisAhead::DiagnosisAhead(const Simulation& run, const KnownAhead& known) {
  if (!any_elastic(run.trajectory.structure()))
    table_ = std::make_shared<StateTable>(run, Look::all, nullptr, known);
}

void DiagnosisAhead::judge(const std::function<bool()>& enough) {
  if (table_) static_cast<StateTable*>(table_.get())->fill_first(enough);
}

// Where moduli share the load, what is unique comes first.
Diagnostics diagnose(const Simulation& run, const std::function<bool()>& cancelled, const KnownAhead& ahead) {
  std::optional<ForceUniqueness> uniqueness;
  const auto find_uniqueness = [&] {
    if (cancelled && cancelled()) return;
    if (ahead.name_poses) ahead.name_poses();
    uniqueness.emplace(run);
  };
  if (any_elastic(run.trajectory.structure())) find_uniqueness();
  std::optional<StateTable> own;
  const bool begun = ahead.judged && ahead.judged->table_;
  StateTable& table = begun ? *static_cast<StateTable*>(ahead.judged->table_.get())
                            : own.emplace(run, Look::all, uniqueness ? &*uniqueness : nullptr, ahead);
  table.fill(cancelled);
  if (!uniqueness) find_uniqueness();
  return table.finish(uniqueness ? &*uniqueness : nullptr);
}

Diagnostics diagnose_window(const Simulation& window, bool goes_on, KnownUniqueness& known,
                            const std::function<bool()>& cancelled) {
  std::optional<ForceUniqueness> uniqueness;
  if (!cancelled || !cancelled()) known = uniqueness.emplace(window, known, goes_on).known();
  return diagnosed(window, Look::all, uniqueness ? &*uniqueness : nullptr, cancelled);
}

Diagnostics diagnose_books(const Simulation& run) {
  return diagnosed(run, Look::books, nullptr);
}

Diagnostics diagnose_energies(const Simulation& run) {
  return diagnosed(run, Look::energies, nullptr);
}

Diagnostics diagnose_states(const Simulation& run, bool reactions) {
  std::optional<ForceUniqueness> uniqueness;
  if (any_elastic(run.trajectory.structure())) uniqueness.emplace(run);
  return diagnosed(run, reactions ? Look::states : Look::motion, uniqueness ? &*uniqueness : nullptr);
}

}  // namespace unfurl
