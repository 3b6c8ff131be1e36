// SPDX-License-Identifier: BSD-3-Clause
// Formats that a run can be exported to, beside the files that every run writes: `--export NAME`.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// What a writer is given.
struct ExportJob {
  const Simulation& run;
  const Diagnostics& diagnostics;
  std::filesystem::path directory;   // exists; the format's own file or folder is made inside
  std::string_view name;             // of the scene: what single files are called
  double frame_interval = 1.0 / 30;  // between key frames of animations, in seconds of motion
  double speed = 1.0;                // seconds of motion per second of animation
  std::string_view title = {}, scene = {}, command = {};  // what made the run, for pages that say it
};

struct ExportFormat {
  std::string_view name;
  std::string_view help;
  std::string_view result;          // what appears in the directory: "vtk" (a folder), "animation.glb"
  void (*write)(const ExportJob&);  // every file whole or not at all; throws FileError
};
std::span<const ExportFormat> export_formats();
const ExportFormat* find_export_format(std::string_view name);  // nullptr: there is none

// The job's directory / folder, made where it is missing; throws FileError.
std::filesystem::path export_folder(const ExportJob& job, std::string_view folder);

void export_vtk(const ExportJob& job);   // core/export/vtk.cpp
void export_gltf(const ExportJob& job);  // core/export/gltf.cpp
void export_csv(const ExportJob& job);   // core/export/csv.cpp
void export_npy(const ExportJob& job);   // core/export/npy.cpp
void export_mat(const ExportJob& job);   // core/export/mat.cpp
void export_html(const ExportJob& job);  // core/export/html.cpp

}  // namespace unfurl
