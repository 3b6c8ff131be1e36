// SPDX-License-Identifier: BSD-3-Clause
// A run as tables of comma-separated values: shortest text that reads back as the same double, header names
// with units.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/checksum.hpp"

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

// What trajectory.csv begins with, its header and rows of a run's first states, piece by piece.
class RowsAhead {
 public:
  void add(const Trajectory& piece);  // the states that follow
  void cut(std::size_t states);       // no more than so many are left

  struct Piece {
    std::string text;
    std::size_t states;  // of this and all before
    Checksum sum;        // of the file up to its end
  };
  const std::vector<Piece>& pieces() const { return pieces_; }
  std::size_t states() const { return pieces_.empty() ? 0 : pieces_.back().states; }

 private:
  std::vector<Piece> pieces_;
};

// The same into files that get their names later, and are on their way to the disk.
void write_series_csv(PendingFile& file, const Diagnostics& diagnostics);
void write_trajectory_csv(PendingFile& file, const Trajectory& trajectory, const RowsAhead& ahead = {});
void write_rod_forces_csv(PendingFile& file, const Trajectory& trajectory, const Diagnostics& diagnostics);

// A cell: in quotes where it holds a comma, a quote or a line break (RFC 4180), where it would begin a
// comment, and where a reader would cut blanks off its ends.
std::string csv_cell(const std::string& text);

}  // namespace unfurl
