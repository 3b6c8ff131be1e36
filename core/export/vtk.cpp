// SPDX-License-Identifier: BSD-3-Clause
// A VTK unstructured grid (VTU, XML, version 1.0) per state and a PVD file that gives each its time. Arrays
// are inline base64 behind a 64-bit byte count: full precision, little endian as the machine is.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/text/base64.hpp"
#include "core/text/xml_text.hpp"

namespace unfurl {
namespace {

static_assert(std::endian::native == std::endian::little);

std::string number(double x) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr};
}

template <class T>
std::string data_array(const char* type, const std::string& name, int components, std::span<const T> values) {
  const std::uint64_t size = values.size_bytes();
  const auto* head = reinterpret_cast<const std::byte*>(&size);
  std::vector<std::byte> bytes(head, head + sizeof size);
  const auto body = std::as_bytes(values);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"binary\">" + base64(bytes) + "</DataArray>\n";
}

std::string reals(const std::string& name, int components, const VectorXd& values) {
  return data_array<double>("Float64", name, components,
                            {values.data(), static_cast<std::size_t>(values.size())});
}

// Names as rows of bytes in UTF-8, as many as the longest has, with zeros behind: VTK's own arrays of strings
// are unknown to other readers of these files.
std::string name_array(const std::string& array, const std::vector<std::string>& names) {
  std::size_t width = 1;
  for (const std::string& name : names) width = std::max(width, name.size());
  std::vector<std::uint8_t> bytes(width * names.size(), 0);
  for (std::size_t i = 0; i < names.size(); ++i)
    std::copy(names[i].begin(), names[i].end(), bytes.begin() + static_cast<std::ptrdiff_t>(i * width));
  return data_array<std::uint8_t>("UInt8", array, static_cast<int>(width), bytes);
}

// Rods as VTK_LINE cells; their group by number, in the order in which groups first appear.
struct Cells {
  std::vector<std::int64_t> connectivity, offsets, group;
  std::vector<std::uint8_t> types;
  VectorXd radius;                    // of rods; 0: not known [m]
  std::string node_names, rod_names;  // arrays, of rods with the names of their groups

  explicit Cells(const Structure& structure) : radius(static_cast<Index>(structure.rod_copies.size())) {
    std::vector<std::string> groups, nodes, rods, group_of;
    for (const NodeCopy& node : structure.node_copies) nodes.push_back(node.name);
    for (const RodCopy& rod : structure.rod_copies) {
      connectivity.insert(connectivity.end(), {rod.a, rod.b});
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      types.push_back(3);
      const std::string& name = structure.rods[static_cast<std::size_t>(rod.source)].group;
      const auto index = std::find(groups.begin(), groups.end(), name) - groups.begin();
      if (index == std::ssize(groups)) groups.push_back(name);
      group.push_back(index);
      radius[std::ssize(rods)] = structure.rods[static_cast<std::size_t>(rod.source)].radius;
      rods.push_back(rod.name);
      group_of.push_back(name);
    }
    node_names = name_array("name", nodes);
    rod_names = name_array("name", rods) + name_array("group_name", group_of);
  }
};

std::string grid(const ExportJob& job, const Cells& cells, std::size_t i) {
  const Trajectory& trajectory = job.run.trajectory;
  const auto& structure = trajectory.structure();
  const auto rods = static_cast<Index>(structure.rod_copies.size());
  VectorXd force(rods);
  std::vector<std::uint8_t> unique;
  for (Index r = 0; r < rods; ++r) {
    const int source = structure.rod_copies[static_cast<std::size_t>(r)].source;
    force[r] = job.diagnostics.axial_force(static_cast<Index>(i), source);
    unique.push_back(job.diagnostics.force_unique(static_cast<Index>(i), source) ? 1 : 0);
  }
  const VectorXd time = VectorXd::Constant(1, trajectory.time(i));
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n"
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" +
      number(time[0]) + "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"" +
      std::to_string(structure.node_copies.size()) + "\" NumberOfCells=\"" + std::to_string(rods) + "\">\n";
  text += "<PointData Vectors=\"velocity_m_s\">\n" + reals("velocity_m_s", 3, trajectory.velocities(i)) +
          cells.node_names + "</PointData>\n";
  text += "<CellData Scalars=\"axial_force_N\">\n" + reals("axial_force_N", 1, force) +
          data_array<std::uint8_t>("UInt8", "axial_force_unique", 1, unique) +
          data_array<std::int64_t>("Int64", "group", 1, cells.group) + reals("radius_m", 1, cells.radius) +
          cells.rod_names + "</CellData>\n";
  text += "<Points>\n" + reals("Points", 3, trajectory.positions(i)) + "</Points>\n<Cells>\n" +
          data_array<std::int64_t>("Int64", "connectivity", 1, cells.connectivity) +
          data_array<std::int64_t>("Int64", "offsets", 1, cells.offsets) +
          data_array<std::uint8_t>("UInt8", "types", 1, cells.types);
  return text + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

void export_vtk(const ExportJob& job) {
  const auto folder = export_folder(job, "vtk");
  const Trajectory& trajectory = job.run.trajectory;
  const Cells cells(trajectory.structure());
  std::string collection =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  const auto name_of = [&](std::size_t i) {
    char suffix[32];
    std::snprintf(suffix, sizeof suffix, "_%06zu.vtu", i);
    return std::string(job.name) + suffix;
  };
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    job.next();
    const std::string name = name_of(i);
    write_file_atomically(folder / name, grid(job, cells, i), Flush::later);
    collection += "<DataSet timestep=\"" + number(trajectory.time(i)) + "\" part=\"0\" file=\"" +
                  xml_text(name) + "\"/>\n";
  }
  flush_files(folder);
  write_file_atomically(folder / (std::string(job.name) + ".pvd"),
                        collection + "</Collection>\n</VTKFile>\n");
  // Of a longer run that was here before; what cannot be removed stays.
  std::error_code error;
  for (std::size_t i = trajectory.size(); std::filesystem::remove(folder / name_of(i), error);) ++i;
}

}  // namespace unfurl
