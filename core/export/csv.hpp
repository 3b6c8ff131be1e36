// SPDX-License-Identifier: BSD-3-Clause
// A run as tables of comma-separated values: shortest text that reads back as the same double, header names
// with units.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/export/atomic_file.hpp"

namespace unfurl {

// One row per accepted step: t_s, then every diagnostic. Throws FileError, as all of these.
void write_series_csv(const std::filesystem::path& path, const Diagnostics& diagnostics);

// t_s, then NAME.x_m NAME.y_m NAME.z_m NAME.vx_m_s NAME.vy_m_s NAME.vz_m_s for every node of the whole
// structure.
void write_trajectory_csv(const std::filesystem::path& path, const Trajectory& trajectory);

// t_s, then NAME.axial_force_N for every rod of the whole structure, tension positive, the mean over the
// rod's length; after all of them NAME.axial_force_unique for every rod in the same order: 1 where the rigid
// model determines that force, 0 where it is one choice of many. A column beside each force, since it may
// change from state to state (a latch closes, a pose is singular); behind them, so that forces keep their
// places.
void write_rod_forces_csv(const std::filesystem::path& path, const Trajectory& trajectory,
                          const Diagnostics& diagnostics);

// The same into files that get their names later.
struct RowsAhead {  // of trajectory.csv, of the run's first states
  std::size_t states = 0;
  std::vector<std::string> text = {};
};
void write_series_csv(PendingFile& file, const Diagnostics& diagnostics);
void write_trajectory_csv(PendingFile& file, const Trajectory& trajectory, const RowsAhead& ahead = {});
void write_rod_forces_csv(PendingFile& file, const Trajectory& trajectory, const Diagnostics& diagnostics);
// trajectory.csv of these states without its header.
std::string trajectory_rows(const Trajectory& trajectory);

// A cell: in quotes where it holds a comma, a quote or a line break (RFC 4180), where it would begin a
// comment, and where a reader would cut blanks off its ends.
std::string csv_cell(const std::string& text);

}  // namespace unfurl
