// SPDX-License-Identifier: BSD-3-Clause
// Formats that a run can be exported to, beside the files that every run writes: `--export NAME`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// Of a group of rods in pictures: linear colour, red negative where the group keeps its own; 0..1.
struct ExportedMaterial {
  std::string group;
  double red = -1, green = 0, blue = 0, metal = 0.35, roughness = 0.32;
};

// What is spanned between nodes at a moment; seen from both sides.
struct ExportedSurface {
  std::string name;
  std::vector<float> positions, normals;  // three a vertex [m]
  std::vector<std::uint32_t> triangles;
  double red = 0, green = 0, blue = 0, opacity = 1, metal = 0, roughness = 0.5;  // linear colour
};

// What pictures show and a run does not know.
struct ExportedLooks {
  bool loads = true;  // arrows
  std::vector<ExportedMaterial> materials;
  // At a pose, the places of all copied nodes: as many surfaces with as many vertices at each.
  std::function<std::vector<ExportedSurface>(const VectorXd& pose)> surfaces;
};

// What a writer is given.
struct ExportJob {
  const Simulation& run;
  const Diagnostics& diagnostics;
  std::filesystem::path directory;   // exists; the format's own file or folder is made inside
  std::string_view name;             // of the scene: what single files are called
  double frame_interval = 1.0 / 30;  // between key frames of animations, in seconds of motion
  double speed = 1.0;                // seconds of motion per second of animation
  std::string_view title = {}, scene = {}, command = {};  // what made the run, for pages that say it
  const ExportedLooks* looks = nullptr;                   // null: rods have their groups' colours
  // Warnings of the run about how its scene is written, with a place in a file: not for pages, which have the
  // scene with all of its keys in them.
  std::span<const std::string> about_text = {};
  std::vector<std::string>* said = nullptr;  // takes what a format could not show
  std::function<void()> between = {};        // called between pieces of the work; what it throws ends it

  void next() const {
    if (between) between();
  }
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

// What pages say against a run.
std::vector<std::string> lasting_warnings(const Simulation& run, const Diagnostics& diagnostics,
                                          std::span<const std::string> about_text);

void export_vtk(const ExportJob& job);   // core/export/vtk.cpp
void export_gltf(const ExportJob& job);  // core/export/gltf.cpp
void export_csv(const ExportJob& job);   // core/export/csv.cpp
void export_npy(const ExportJob& job);   // core/export/npy.cpp
void export_mat(const ExportJob& job);   // core/export/mat.cpp
void export_html(const ExportJob& job);  // core/export/html.cpp

}  // namespace unfurl
