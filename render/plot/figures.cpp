// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures.hpp"

#include <algorithm>
#include <array>

#include "core/diagnostics/jacobian_spectrum.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/structure/shown_lines.hpp"
#include "core/system/self_stress.hpp"
#include "render/plot/figures/kinds.hpp"

namespace unfurl {
namespace {

bool always(const Simulation&, const Diagnostics&) {
  return true;
}
bool has_rods(const Simulation& run, const Diagnostics&) {
  return !run.trajectory.structure().rods.empty();
}
bool has_moduli(const Simulation& run, const Diagnostics&) {
  return any_elastic(run.trajectory.structure());
}
bool has_fold_angle(const Simulation&, const Diagnostics& d) {
  return d.find("fold_angle_rad") != nullptr;
}
bool has_members(const Simulation& run, const Diagnostics& d) {
  return has_rods(run, d) || !lines_between_nodes(run.trajectory.structure()).empty();
}
bool has_drives(const Simulation&, const Diagnostics& d) {
  return std::any_of(d.columns.begin(), d.columns.end(),
                     [](const Series& column) { return column.name.ends_with(".power_W"); });
}
bool has_deployment(const Simulation&, const Diagnostics& d) {
  return d.find("deployed_fraction") != nullptr;
}
bool has_poisson_ratio(const Simulation&, const Diagnostics& d) {
  return d.find("poisson_ratio") != nullptr;
}
bool has_spectrum(const Simulation& run, const Diagnostics&) {
  return spectrum_applies(run);
}

bool has_self_stress(const Simulation& run, const Diagnostics& d) {
  return std::count(d.rod_unique.begin(), d.rod_unique.end(), 0) > 0 &&
         run.trajectory.model().system.coordinates() <= max_listed_coordinates;
}

constexpr std::array kinds{
    FigureKind{"deployment", "fold angle and deployed fraction over time", has_deployment, deployment_figure},
    FigureKind{"constraint_error", "constraint error of positions, relative to rod length, and of velocities",
               always, constraint_error_figure},
    FigureKind{"energy",
               "kinetic and potential energy, work of loads and drives, losses, error of their balance",
               always, energy_figure},
    FigureKind{"rod_forces", "axial forces of the rods by group, tension positive; dashed where not unique",
               has_rods, rod_forces_figure},
    FigureKind{"rod_strength", "axial stress and share of Euler's buckling load, where rods have a modulus",
               has_moduli, rod_strength_figure},
    FigureKind{"drives", "torque, force and power of motors, winches and prescribed motions", has_drives,
               drives_figure},
    FigureKind{"poisson", "lengths along and across a stretch, Poisson's ratio", has_poisson_ratio,
               poisson_figure},
    FigureKind{"phase", "fold rate over fold angle", has_fold_angle, phase_figure},
    FigureKind{"steps", "how long the steps are and how many Newton iterations they take", always,
               steps_figure},
    FigureKind{"jacobian", "smallest singular values of the constraints' Jacobian over time", has_spectrum,
               jacobian_figure},
    FigureKind{"self_stress", "forces that balance themselves: what a rigid model leaves open",
               has_self_stress, self_stress_figure},
    FigureKind{"poses", "the configuration at six times", has_members, poses_figure},
};

}  // namespace

std::span<const FigureKind> figure_kinds() {
  return kinds;
}

const FigureKind* find_figure(std::string_view name) {
  for (const FigureKind& kind : kinds)
    if (kind.name == name) return &kind;
  return nullptr;
}

}  // namespace unfurl
