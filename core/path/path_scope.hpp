// SPDX-License-Identifier: BSD-3-Clause
// What the path can describe of a model.
#pragma once

#include "core/path/path.hpp"
#include "core/simulate/one_sided.hpp"

namespace unfurl {

// The row that prescribes a motion; nullptr where none does. Throws PathRefused where there are several.
const Constraint* driven_row(const Structure& structure);
// The second derivative of what it prescribes, along poses z of these derivatives.
double driven_second_rate(const Structure& structure, const System& system, const VectorXd& z,
                          const VectorXd& rate, const VectorXd& second_rate);

// The equations of a model without the row that drives it; that of the model where nothing does. Throws
// PathRefused where the path cannot describe the model: more or fewer ways to move than one, what it does not
// know (path_forces.hpp), motions prescribed in a way that it cannot take.
std::shared_ptr<const System> path_system(const std::shared_ptr<const Model>& model);
std::shared_ptr<const Path> trace_path(const std::shared_ptr<const Model>& model);

// Throws PathRefused unless an impulse of that stop takes the whole motion of the state: else the pose has
// other ways to move, which it sets going.
void refuse_other_ways(const OneSided& sides, std::size_t stop, const System& system, const State& here);
// Modes of friction beside others, or of several, are found by the time loop alone.
void refuse_friction(const OneSided& sides, const Structure& structure, const SolverOptions& options);

}  // namespace unfurl
