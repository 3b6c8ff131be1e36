// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/formats.hpp"

#include <algorithm>
#include <array>

#include "core/diagnostics/accuracy.hpp"
#include "core/export/atomic_file.hpp"

namespace unfurl {

std::span<const ExportFormat> export_formats() {
  static const std::array rows{
      ExportFormat{"vtk", "ParaView: vtk/SCENE.pvd and a VTU per step, with rod forces and node velocities",
                   "vtk", export_vtk},
      ExportFormat{"gltf", "Blender and web viewers: animation.glb, glTF 2.0 with moving rods and joints",
                   "animation.glb", export_gltf},
      ExportFormat{"csv", "long tables, one row per step and member: csv/nodes.csv, csv/rods.csv", "csv",
                   export_csv},
      ExportFormat{"npy", "NumPy arrays: npy/positions_m.npy [steps, nodes, 3] and others", "npy",
                   export_npy},
      ExportFormat{"mat", "MATLAB and Octave: run.mat (level 5), the same arrays and the series", "run.mat",
                   export_mat},
      ExportFormat{"html",
                   "a page to share: viewer.html, the structure turns in any browser, without a network",
                   "viewer.html", export_html},
  };
  return rows;
}

const ExportFormat* find_export_format(std::string_view name) {
  const auto rows = export_formats();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.name == name; });
  return it == rows.end() ? nullptr : &*it;
}

std::filesystem::path export_folder(const ExportJob& job, std::string_view folder) {
  const std::filesystem::path path = job.directory / folder;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw FileError(path, error.value());
  return path;
}

std::vector<std::string> lasting_warnings(const Simulation& run, const Diagnostics& diagnostics,
                                          std::span<const std::string> about_text) {
  std::vector<std::string> warnings = run.warnings;
  std::erase_if(warnings, [&](const std::string& warning) {
    return std::ranges::find(about_text, warning) != about_text.end();
  });
  for (std::string& warning : accuracy_warnings(run, diagnostics)) warnings.push_back(std::move(warning));
  return warnings;
}

}  // namespace unfurl
