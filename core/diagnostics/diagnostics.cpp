#include "core/diagnostics/diagnostics.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/integrators/index1.hpp"

namespace unfurl {
namespace {

// What a diagnostic may look at in one state.
struct Instant {
  const Simulation& run;
  std::size_t i;
  const State& state;
  const VectorXd &q, &v;          // node coordinates, velocities
  const VectorXd &phi, &lengths;  // of all constraints [m]
  const VectorXd& velocity_phi;   // G v of all constraints [m/s]
  const VectorXd& axial_force;    // of the solved rods [N]
  const VectorXd& acceleration;   // of the nodes; NaN where the equations have no solution [m/s^2]
  double first_energy;            // kinetic + potential at t = 0 [J]

  const System& system() const { return run.trajectory.model().system; }
  const Deployment& deployment() const { return run.trajectory.structure().deployment; }
  double kinetic() const { return system().kinetic_energy(state.w); }
  double relative_constraint() const {
    return phi.size() ? phi.cwiseQuotient(lengths).lpNorm<Eigen::Infinity>() : 0.0;
  }
};

double max_norm(const VectorXd& v) {
  return v.size() ? v.lpNorm<Eigen::Infinity>() : 0.0;
}

struct Row {
  const char *name, *label, *unit;
  bool needs_fold;
  double (*value)(const Instant&);
};

constexpr double ulp = std::numeric_limits<double>::epsilon();

const std::array rows{
    Row{"kinetic_energy_J", "kinetic energy", "J", false, [](const Instant& s) { return s.kinetic(); }},
    Row{"potential_energy_J", "potential energy", "J", false,
        [](const Instant& s) { return s.system().potential_energy(s.q); }},
    Row{"work_J", "work of the loads", "J", false,
        [](const Instant& s) { return s.system().load_work(s.q); }},
    Row{"energy_balance_J", "energy balance", "J", false,
        [](const Instant& s) {
          return s.kinetic() + s.system().potential_energy(s.q) - s.first_energy - s.system().load_work(s.q);
        }},
    Row{"constraint_max_m", "constraint error", "m", false, [](const Instant& s) { return max_norm(s.phi); }},
    Row{"constraint_relative_max", "relative constraint error", "", false,
        [](const Instant& s) { return s.relative_constraint(); }},
    Row{"constraint_round_off_max", "constraint error in units of round-off", "ulp", false,
        [](const Instant& s) { return s.relative_constraint() / ulp; }},
    Row{"constraint_velocity_max_m_s", "velocity constraint error", "m/s", false,
        [](const Instant& s) { return max_norm(s.velocity_phi); }},
    Row{"fold_angle_rad", "fold angle", "rad", true,
        [](const Instant& s) { return s.deployment().fold_angle(s.q); }},
    Row{"fold_rate_rad_s", "fold rate", "rad/s", true,
        [](const Instant& s) { return s.deployment().fold_rate(s.q, s.v); }},
    Row{"deployed_fraction", "deployed fraction", "", true,
        [](const Instant& s) { return s.deployment().fraction(s.q); }},
    Row{"axial_force_max_N", "largest axial force", "N", false,
        [](const Instant& s) { return s.axial_force.size() ? s.axial_force.maxCoeff() : 0.0; }},
    Row{"axial_force_min_N", "smallest axial force", "N", false,
        [](const Instant& s) { return s.axial_force.size() ? s.axial_force.minCoeff() : 0.0; }},
    Row{"step_s", "step", "s", false,
        [](const Instant& s) { return s.i == 0 ? 0.0 : s.state.t - s.run.trajectory.time(s.i - 1); }},
    Row{"newton_iterations", "Newton iterations", "", false,
        [](const Instant& s) { return static_cast<double>(s.run.trajectory.report(s.i).newton_iterations); }},
};

// -(across'/across) / (along'/along): the ratio of the strain increments of the motion that goes on, which at
// rest is the one that begins.
double poisson_ratio(const Instant& s) {
  const Structure& structure = s.run.trajectory.structure();
  const LinearForm& along = structure.lengths[static_cast<std::size_t>(structure.strain_along)].value;
  const LinearForm& across = structure.lengths[static_cast<std::size_t>(structure.strain_across)].value;
  const VectorXd& motion = s.v.isZero(0.0) ? s.acceleration : s.v;
  const double stretch = along.rate(motion) / along(s.q);
  return stretch == 0.0 ? std::numeric_limits<double>::quiet_NaN()
                        : -(across.rate(motion) / across(s.q)) / stretch;
}

// The columns that only this structure has, at the end.
void add_own_columns(const Structure& structure, Diagnostics& out) {
  for (const ReportedLength& m : structure.lengths) out.columns.push_back({m.name, m.label, "m", {}});
  if (structure.strain_along >= 0) out.columns.push_back({"poisson_ratio", "Poisson's ratio", "", {}});
}

void add_own_values(const Structure& structure, const Instant& s, Series* column) {
  for (const ReportedLength& m : structure.lengths) (column++)->values.push_back(m.value(s.q));
  if (structure.strain_along >= 0) column->values.push_back(poisson_ratio(s));
}

// Axial forces from the index-1 equations at the state: least-norm where rods are redundant, per rod of the
// whole. At an event in a singular pose they are the extrapolated ones that the state holds.
void axial_forces(Index1& index1, const Model& model, const State& state, bool singular_event,
                  VectorXd& force, VectorXd& node_acceleration) {
  VectorXd acceleration(model.system.solved_coordinates()), lambda = state.lambda;
  acceleration.setConstant(std::numeric_limits<double>::quiet_NaN());
  const bool ok = singular_event || index1.evaluate(state.t, state.z, state.w, acceleration, lambda);
  model.system.expand_rate(acceleration, node_acceleration);
  for (Index r = 0; r < force.size(); ++r) {
    const auto ur = static_cast<std::size_t>(r);
    force[r] = ok ? lambda[model.system.rod_rows()[ur]] / model.structure.rods[ur].multiplicity
                  : std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

const Series* Diagnostics::find(std::string_view name) const {
  for (const Series& s : columns)
    if (s.name == name) return &s;
  return nullptr;
}

const Series& Diagnostics::at(std::string_view name) const {
  const Series* s = find(name);
  if (!s) throw std::out_of_range("no diagnostic " + std::string(name));
  return *s;
}

std::vector<std::string_view> diagnostic_names() {
  std::vector<std::string_view> names;
  for (const Row& row : rows) names.emplace_back(row.name);
  return names;
}

Diagnostics diagnose(const Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  const Model& model = trajectory.model();
  Diagnostics out;
  std::vector<const Row*> used;
  for (const Row& row : rows) {
    if (row.needs_fold && trajectory.structure().deployment.empty()) continue;
    used.push_back(&row);
    out.columns.push_back({row.name, row.label, row.unit, {}});
  }
  add_own_columns(trajectory.structure(), out);
  const auto rods = static_cast<Index>(model.structure.rods.size());
  out.axial_force.resize(static_cast<Index>(trajectory.size()), rods);
  const VectorXd lengths = model.system.all_lengths();
  VectorXd phi(model.system.all_constraints()), force(rods), velocity_phi,
      acceleration(model.system.coordinates());
  Index1 index1(model.system, true);
  double first_energy = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const State& state = trajectory.state(i);
    const VectorXd q = trajectory.node_positions(i), v = trajectory.node_velocities(i);
    model.system.all_constraint_values(q, phi);
    velocity_phi = model.system.all_jacobian(q) * v;
    axial_forces(index1, model, state, trajectory.report(i).singular_event, force, acceleration);
    out.axial_force.row(static_cast<Index>(i)) = force.transpose();
    if (i == 0) first_energy = model.system.kinetic_energy(state.w) + model.system.potential_energy(q);
    const Instant instant{run, i, state, q, v, phi, lengths, velocity_phi, force, acceleration, first_energy};
    out.t.push_back(state.t);
    for (std::size_t c = 0; c < used.size(); ++c) out.columns[c].values.push_back(used[c]->value(instant));
    add_own_values(trajectory.structure(), instant, out.columns.data() + used.size());
  }
  return out;
}

}  // namespace unfurl
