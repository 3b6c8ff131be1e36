// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "app/command.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

// DIR/report.html, one file for a reviewer who has nothing else: film, figures with their captions, how the
// run ended, what it measured, which model and method, its warnings, the scene. Throws FileError.
void write_run_report(const std::filesystem::path& directory, const Scene& scene, const Simulation& run,
                      const Diagnostics& diagnostics, const Arguments& arguments);

}  // namespace unfurl
