// SPDX-License-Identifier: BSD-3-Clause
// NumPy's .npy format, version 1.0: magic, header (a Python dictionary padded to 64 bytes), raw array in C
// order.
#include <cstdint>

#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"

namespace unfurl {
namespace {

template <class T>
void write_array(const std::filesystem::path& path, const char* type, const std::vector<std::size_t>& shape,
                 const std::vector<T>& values) {
  std::string header = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (";
  for (const std::size_t n : shape) header += std::to_string(n) + ", ";
  header += "), }";
  constexpr std::size_t prefix = 10;
  header.append(63 - (prefix + header.size()) % 64, ' ').append(1, '\n');
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(header.size() & 255U);
  file += static_cast<char>(header.size() >> 8U);
  file += header;
  file.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  write_file_atomically(path, file);
}

}  // namespace

void export_npy(const ExportJob& job) {
  const auto folder = export_folder(job, "npy");
  const Trajectory& trajectory = job.run.trajectory;
  const Structure& structure = trajectory.structure();
  const std::size_t steps = trajectory.size(), nodes = structure.node_copies.size(),
                    rods = structure.rod_copies.size();
  std::vector<double> time, position, velocity, force;
  std::vector<std::int64_t> ends;
  std::vector<std::uint8_t> unique;  // numpy's bool
  for (const RodCopy& rod : structure.rod_copies) ends.insert(ends.end(), {rod.a, rod.b});
  for (std::size_t i = 0; i < steps; ++i) {
    job.next();
    time.push_back(trajectory.time(i));
    const VectorXd x = trajectory.positions(i), v = trajectory.velocities(i);
    position.insert(position.end(), x.begin(), x.end());
    velocity.insert(velocity.end(), v.begin(), v.end());
    for (const RodCopy& rod : structure.rod_copies) {
      force.push_back(job.diagnostics.axial_force(static_cast<Index>(i), rod.source));
      unique.push_back(job.diagnostics.force_unique(static_cast<Index>(i), rod.source) ? 1 : 0);
    }
  }
  job.next();
  write_array(folder / "t_s.npy", "<f8", {steps}, time);
  write_array(folder / "positions_m.npy", "<f8", {steps, nodes, 3}, position);
  write_array(folder / "velocities_m_s.npy", "<f8", {steps, nodes, 3}, velocity);
  write_array(folder / "axial_forces_N.npy", "<f8", {steps, rods}, force);
  write_array(folder / "axial_forces_unique.npy", "|b1", {steps, rods}, unique);
  write_array(folder / "rod_nodes.npy", "<i8", {rods, 2}, ends);
}

}  // namespace unfurl
