// SPDX-License-Identifier: BSD-3-Clause
// MATLAB's MAT-file, level 5, uncompressed (MathWorks, "MAT-File Format", version 7 manual, chapter 1): what
// MATLAB and Octave `load` without a toolbox. Arrays stand in column-major order.
#include <cstdint>

#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/text/utf8.hpp"
#include "core/text/version.hpp"

namespace unfurl {
namespace {

// Types of data elements and classes of arrays.
constexpr std::uint32_t mi_int8 = 1, mi_uint8 = 2, mi_uint16 = 4, mi_int32 = 5, mi_uint32 = 6, mi_double = 9,
                        mi_matrix = 14;
constexpr std::uint32_t mx_cell = 1, mx_char = 4, mx_double = 6, mx_uint8 = 9, logical_flag = 0x0200;

class MatFile {
 public:
  MatFile() {
    text_ = "MATLAB 5.0 MAT-file, written by Unfurl " + version();
    text_.resize(124, ' ');
    text_ += {'\x00', '\x01', 'I', 'M'};  // version 0x0100, little endian
  }

  // `values` in column-major order of `shape`.
  void numbers(const std::string& name, const std::vector<std::size_t>& shape,
               const std::vector<double>& values) {
    add(array(name, mx_double, shape, element(mi_double, bytes_of(values))));
  }

  void flags(const std::string& name, const std::vector<std::size_t>& shape,
             const std::vector<std::uint8_t>& values) {
    add(array(name, mx_uint8 | logical_flag, shape, element(mi_uint8, bytes_of(values))));
  }

  // A column of cells with a row of characters each, which MATLAB has in UTF-16.
  void names(const std::string& name, const std::vector<std::string>& texts) {
    std::string cells;
    for (const std::string& text : texts) {
      const std::u16string units = utf16(text);
      const std::vector<std::uint16_t> characters(units.begin(), units.end());
      cells +=
          element(mi_matrix, array("", mx_char, {1, units.size()}, element(mi_uint16, bytes_of(characters))));
    }
    add(array(name, mx_cell, {texts.size(), 1}, cells));
  }

  const std::string& text() const { return text_; }

 private:
  template <class T>
  static std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }

  // Tag, data, padding to eight bytes.
  static std::string element(std::uint32_t type, const std::string& data) {
    if (data.size() > 0xFFFFFFF0U) throw Error("a MAT-file of level 5 holds arrays up to 4 GB; use npy");
    std::string out = bytes_of<std::uint32_t>({type, static_cast<std::uint32_t>(data.size())}) + data;
    out.resize((out.size() + 7) / 8 * 8, '\0');
    return out;
  }

  static std::string array(const std::string& name, std::uint32_t flags,
                           const std::vector<std::size_t>& shape, const std::string& data) {
    const std::vector<std::int32_t> sizes(shape.begin(), shape.end());
    return element(mi_uint32, bytes_of<std::uint32_t>({flags, 0})) + element(mi_int32, bytes_of(sizes)) +
           element(mi_int8, name) + data;
  }

  void add(const std::string& data) { text_ += element(mi_matrix, data); }

  std::string text_;
};

}  // namespace

void export_mat(const ExportJob& job) {
  const Trajectory& trajectory = job.run.trajectory;
  const Structure& structure = trajectory.structure();
  const std::size_t steps = trajectory.size(), nodes = structure.node_copies.size(),
                    rods = structure.rod_copies.size();
  std::vector<double> time(steps), position(3 * nodes * steps), velocity(3 * nodes * steps),
      force(rods * steps), ends;
  std::vector<std::uint8_t> unique(rods * steps);
  for (std::size_t i = 0; i < steps; ++i) {
    job.next();
    time[i] = trajectory.time(i);
    const VectorXd x = trajectory.positions(i), v = trajectory.velocities(i);
    for (std::size_t k = 0; k < 3 * nodes; ++k) {  // [steps, nodes, 3]
      const std::size_t at = i + steps * (k / 3 + nodes * (k % 3));
      position[at] = x[static_cast<Index>(k)];
      velocity[at] = v[static_cast<Index>(k)];
    }
    for (std::size_t r = 0; r < rods; ++r) {
      const int source = structure.rod_copies[r].source;
      force[i + steps * r] = job.diagnostics.axial_force(static_cast<Index>(i), source);
      unique[i + steps * r] = job.diagnostics.force_unique(static_cast<Index>(i), source) ? 1 : 0;
    }
  }
  std::vector<std::string> node_names, rod_names, column_names;
  for (const NodeCopy& node : structure.node_copies) node_names.push_back(node.name);
  for (const RodCopy& rod : structure.rod_copies) {
    rod_names.push_back(rod.name);
    ends.push_back(rod.a + 1);  // MATLAB counts from 1
  }
  for (const RodCopy& rod : structure.rod_copies) ends.push_back(rod.b + 1);
  std::vector<double> series;
  for (const Series& column : job.diagnostics.columns) {
    column_names.push_back(column.name);
    series.insert(series.end(), column.values.begin(), column.values.end());
  }
  MatFile file;
  file.numbers("t_s", {steps, 1}, time);
  file.numbers("positions_m", {steps, nodes, 3}, position);
  file.numbers("velocities_m_s", {steps, nodes, 3}, velocity);
  file.numbers("axial_forces_N", {steps, rods}, force);
  file.flags("axial_forces_unique", {steps, rods}, unique);
  file.numbers("rod_nodes", {rods, 2}, ends);
  file.numbers("series", {steps, column_names.size()}, series);
  file.names("series_names", column_names);
  file.names("node_names", node_names);
  file.names("rod_names", rod_names);
  job.next();
  write_file_atomically(job.directory / "run.mat", file.text());
}

}  // namespace unfurl
