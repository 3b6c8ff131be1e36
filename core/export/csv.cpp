// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/csv.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/export/run_tables.hpp"

namespace unfurl {

namespace csv_tables {

// Writes row by row, so that a long run needs no second copy of itself in memory.
class CsvRows {
 public:
  // Into a file that is open, a copy of which is kept open here. `sum`: gets that of all rows.
  CsvRows(const std::filesystem::path& path, int file, Checksum* sum = nullptr)
      : path_(path), file_(::fdopen(::dup(file), "wb")), sum_(sum) {
    if (!file_) throw FileError(path_, errno);
    std::setvbuf(file_, nullptr, _IOFBF, std::size_t{1} << 16U);
  }
  // Behind a text.
  CsvRows(std::string& text, Checksum* sum) : text_(&text), sum_(sum) {}
  ~CsvRows() {
    if (file_) std::fclose(file_);
  }
  CsvRows(const CsvRows&) = delete;
  CsvRows& operator=(const CsvRows&) = delete;

  void cell(const std::string& text) { append(csv_cell(text)); }

  void cell(double x) {
    begin_cell();
    char* to = row_.data() + used_;
    *to = '-';  // but for a zero, which has no sign worth printing
    if (x < 0) ++to;
    const Known& known = known_text(std::abs(x));
    std::memcpy(to, known.text, sizeof known.text);  // the next cell covers what is too much of it
    used_ = static_cast<std::size_t>(to - row_.data()) + known.size;
  }
  void flag(bool yes) {
    begin_cell();
    row_[used_++] = yes ? '1' : '0';
  }

  void end_row() {
    row_[used_++] = '\n';  // room for it is always left
    if (sum_) sum_->add(std::string_view(row_.data(), used_));
    if (text_)
      text_->append(row_, 0, used_);
    else if (std::fwrite(row_.data(), 1, used_, file_) != used_)
      throw FileError(path_, errno);
    used_ = 0;
  }

  void begin(const RowsAhead& ahead) {
    for (const RowsAhead::Piece& piece : ahead.pieces()) {
      const std::string& text = piece.text;
      if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) throw FileError(path_, errno);
      *sum_ = piece.sum;
    }
  }

  void close() {
    if (std::fclose(std::exchange(file_, nullptr)) != 0) throw FileError(path_, errno);
  }
  void flush() {
    if (std::fflush(file_) != 0) throw FileError(path_, errno);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  // Structures repeat themselves: a symmetric one writes the same number, or its negative, many times in a
  // row, and finding the shortest text of one costs twenty times as much as finding it again.
  static constexpr std::size_t longest_number = 31;
  struct Known {
    std::uint64_t bits = 0;
    unsigned char size = 1;
    char text[longest_number] = {'0'};
  };
  const Known& known_text(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    Known& known = known_[(bits * 0x9e3779b97f4a7c15ULL) >> 55U];
    if (known.bits != bits) {
      const char* const end = std::to_chars(known.text, known.text + longest_number, x).ptr;
      known.bits = bits;
      known.size = static_cast<unsigned char>(end - known.text);
    }
    return known;
  }

  // Behind a comma, with room for a number.
  void begin_cell() {
    if (row_.size() - used_ < 64) row_.resize(2 * row_.size() + 64);
    if (used_ > 0) row_[used_++] = ',';
  }
  void append(std::string_view text) {
    begin_cell();
    if (row_.size() - used_ < text.size() + 64) row_.resize(2 * row_.size() + text.size() + 64);
    used_ += text.copy(row_.data() + used_, text.size());
  }

  std::filesystem::path path_;
  std::FILE* file_ = nullptr;
  std::string* text_ = nullptr;
  Checksum* sum_ = nullptr;
  std::vector<Known> known_ = std::vector<Known>(512);
  std::string row_ = std::string(4096, ' ');
  std::size_t used_ = 0;  // of it
};

class CsvFile {
 public:
  explicit CsvFile(const std::filesystem::path& path) : pending_(path), rows_(path, pending_.file()) {}
  CsvRows& rows() { return rows_; }
  void commit() {
    rows_.close();
    pending_.commit();
  }

 private:
  PendingFile pending_;
  CsvRows rows_;
};

}  // namespace csv_tables

using csv_tables::CsvFile, csv_tables::CsvRows;

std::string csv_cell(const std::string& text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  const bool plain = text.find_first_of(",\"\r\n") == std::string::npos;
  if (text.empty() || (plain && text.front() != '#' && !blank(text.front()) && !blank(text.back())))
    return text;
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

namespace {

void series_header(CsvRows& file, const Diagnostics& diagnostics) {
  file.cell("t_s");
  for (const auto& column : diagnostics.columns) file.cell(column.name);
  file.end_row();
}

void series_row(CsvRows& file, const Diagnostics& diagnostics, std::size_t i) {
  file.cell(diagnostics.t[i]);
  for (const auto& column : diagnostics.columns) file.cell(column.values[i]);
  file.end_row();
}

void trajectory_header(CsvRows& file, const Structure& structure) {
  file.cell("t_s");
  for (const auto& node : structure.node_copies)
    for (const char* suffix : {".x_m", ".y_m", ".z_m", ".vx_m_s", ".vy_m_s", ".vz_m_s"})
      file.cell(node.name + suffix);
  file.end_row();
}

void trajectory_row(CsvRows& file, const Trajectory& trajectory, std::size_t i) {
  const VectorXd x = trajectory.positions(i), v = trajectory.velocities(i);
  file.cell(trajectory.time(i));
  for (Index node = 0; node < x.size() / 3; ++node) {
    for (Index k = 0; k < 3; ++k) file.cell(x[3 * node + k]);
    for (Index k = 0; k < 3; ++k) file.cell(v[3 * node + k]);
  }
  file.end_row();
}

void rod_forces_header(CsvRows& file, const Structure& structure) {
  file.cell("t_s");
  for (const auto& rod : structure.rod_copies) file.cell(rod.name + ".axial_force_N");
  for (const auto& rod : structure.rod_copies) file.cell(rod.name + ".axial_force_unique");
  file.end_row();
}

void rod_forces_row(CsvRows& file, const Structure& structure, const Diagnostics& diagnostics,
                    std::size_t i) {
  const auto state = static_cast<Index>(i);
  file.cell(diagnostics.t[i]);
  for (const auto& rod : structure.rod_copies) file.cell(diagnostics.axial_force(state, rod.source));
  for (const auto& rod : structure.rod_copies) file.flag(diagnostics.force_unique(state, rod.source));
  file.end_row();
}

}  // namespace

void write_series_csv(PendingFile& file, const Diagnostics& diagnostics) {
  Checksum sum;
  CsvRows rows(file.target(), file.file(), &sum);
  series_header(rows, diagnostics);
  for (std::size_t i = 0; i < diagnostics.t.size(); ++i) series_row(rows, diagnostics, i);
  rows.close();
  file.send(&sum);
}

void RowsAhead::add(const Trajectory& piece) {
  Piece next{{}, states() + piece.size(), pieces_.empty() ? Checksum() : pieces_.back().sum};
  CsvRows rows(next.text, &next.sum);
  constexpr std::size_t cell = 20;  // characters, or a few more
  next.text.reserve(cell * piece.size() * (1 + 6 * piece.structure().node_copies.size()));
  if (pieces_.empty()) trajectory_header(rows, piece.structure());
  for (std::size_t i = 0; i < piece.size(); ++i) trajectory_row(rows, piece, i);
  pieces_.push_back(std::move(next));
}

void RowsAhead::cut(std::size_t states) {
  while (!pieces_.empty() && pieces_.back().states > states) pieces_.pop_back();
}

void write_trajectory_csv(PendingFile& file, const Trajectory& trajectory, const RowsAhead& ahead) {
  Checksum sum;
  CsvRows rows(file.target(), file.file(), &sum);
  rows.begin(ahead);
  if (ahead.states() == 0) trajectory_header(rows, trajectory.structure());
  for (std::size_t i = ahead.states(); i < trajectory.size(); ++i) trajectory_row(rows, trajectory, i);
  rows.close();
  file.send(&sum);
}

void write_rod_forces_csv(PendingFile& file, const Trajectory& trajectory, const Diagnostics& diagnostics) {
  Checksum sum;
  CsvRows rows(file.target(), file.file(), &sum);
  rod_forces_header(rows, trajectory.structure());
  for (std::size_t i = 0; i < diagnostics.t.size(); ++i)
    rod_forces_row(rows, trajectory.structure(), diagnostics, i);
  rows.close();
  file.send(&sum);
}

void write_series_csv(const std::filesystem::path& path, const Diagnostics& diagnostics) {
  PendingFile file(path);
  write_series_csv(file, diagnostics);
  file.commit();
}

void write_trajectory_csv(const std::filesystem::path& path, const Trajectory& trajectory) {
  PendingFile file(path);
  write_trajectory_csv(file, trajectory);
  file.commit();
}

void write_rod_forces_csv(const std::filesystem::path& path, const Trajectory& trajectory,
                          const Diagnostics& diagnostics) {
  PendingFile file(path);
  write_rod_forces_csv(file, trajectory, diagnostics);
  file.commit();
}

// --- tables that grow ---

namespace csv_tables {

class GrowingFile {
 public:
  explicit GrowingFile(const std::filesystem::path& path)
      : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666)),
        rows_(path, file_ < 0 ? throw FileError(path, errno) : file_) {
    ::lseek(file_, 0, SEEK_END);
  }
  ~GrowingFile() { ::close(file_); }
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  CsvRows& rows() { return rows_; }
  std::uint64_t size() {
    rows_.flush();
    return static_cast<std::uint64_t>(::lseek(file_, 0, SEEK_CUR));
  }
  void cut(std::uint64_t size) {
    rows_.flush();
    if (::ftruncate(file_, static_cast<off_t>(size)) != 0) throw FileError(rows_.path(), errno);
    ::lseek(file_, 0, SEEK_END);
  }
  void flush_to_disk() {
    rows_.flush();
    if (::fsync(file_) != 0 && errno != EINVAL && errno != EROFS) throw FileError(rows_.path(), errno);
  }

 private:
  int file_;
  CsvRows rows_;  // shares its place in the file
};

}  // namespace csv_tables

using csv_tables::GrowingFile;

struct RunTables::Files {
  explicit Files(const std::filesystem::path& folder)
      : series(folder / "series.csv"),
        trajectory(folder / "trajectory.csv"),
        rod_forces(folder / "rod_forces.csv") {}
  GrowingFile series, trajectory, rod_forces;
};

RunTables::RunTables(const std::filesystem::path& folder) : files_(std::make_unique<Files>(folder)) {}
RunTables::~RunTables() = default;

void RunTables::add(const Trajectory& trajectory, const Diagnostics& diagnostics, std::size_t first,
                    std::size_t last) {
  Files& f = *files_;
  const Structure& structure = trajectory.structure();
  if (f.series.size() == 0) {
    series_header(f.series.rows(), diagnostics);
    trajectory_header(f.trajectory.rows(), structure);
    rod_forces_header(f.rod_forces.rows(), structure);
  }
  for (std::size_t i = first; i < last; ++i) {
    series_row(f.series.rows(), diagnostics, i);
    trajectory_row(f.trajectory.rows(), trajectory, i);
    rod_forces_row(f.rod_forces.rows(), structure, diagnostics, i);
  }
}

RunTables::Sizes RunTables::sizes() {
  return {files_->series.size(), files_->trajectory.size(), files_->rod_forces.size()};
}

void RunTables::cut(Sizes sizes) {
  files_->series.cut(sizes.series);
  files_->trajectory.cut(sizes.trajectory);
  files_->rod_forces.cut(sizes.rod_forces);
}

void RunTables::flush_to_disk() {
  for (GrowingFile* file : {&files_->series, &files_->trajectory, &files_->rod_forces}) file->flush_to_disk();
}

namespace {

void write_long_nodes(const std::filesystem::path& path, const ExportJob& job) {
  const Trajectory& trajectory = job.run.trajectory;
  CsvFile whole(path);
  CsvRows& file = whole.rows();
  for (const char* name : {"t_s", "node", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"}) file.cell(name);
  file.end_row();
  const auto& nodes = trajectory.structure().node_copies;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    job.next();
    const VectorXd x = trajectory.positions(i), v = trajectory.velocities(i);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      file.cell(trajectory.time(i));
      file.cell(nodes[n].name);
      for (std::size_t k = 0; k < 3; ++k) file.cell(x[static_cast<Index>(3 * n + k)]);
      for (std::size_t k = 0; k < 3; ++k) file.cell(v[static_cast<Index>(3 * n + k)]);
      file.end_row();
    }
  }
  whole.commit();
}

void write_long_rods(const std::filesystem::path& path, const ExportJob& job) {
  const Trajectory& trajectory = job.run.trajectory;
  const Diagnostics& diagnostics = job.diagnostics;
  CsvFile whole(path);
  CsvRows& file = whole.rows();
  for (const char* name :
       {"t_s", "rod", "node_a", "node_b", "group", "length_m", "axial_force_N", "axial_force_unique"})
    file.cell(name);
  file.end_row();
  const Structure& structure = trajectory.structure();
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    job.next();
    const VectorXd x = trajectory.positions(i);
    for (const RodCopy& rod : structure.rod_copies) {
      file.cell(trajectory.time(i));
      file.cell(rod.name);
      file.cell(structure.node_copies[static_cast<std::size_t>(rod.a)].name);
      file.cell(structure.node_copies[static_cast<std::size_t>(rod.b)].name);
      file.cell(structure.rods[static_cast<std::size_t>(rod.source)].group);
      file.cell((x.segment<3>(3 * rod.b) - x.segment<3>(3 * rod.a)).norm());
      file.cell(diagnostics.axial_force(static_cast<Index>(i), rod.source));
      file.flag(diagnostics.force_unique(static_cast<Index>(i), rod.source));
      file.end_row();
    }
  }
  whole.commit();
}

}  // namespace

void export_csv(const ExportJob& job) {
  const auto folder = export_folder(job, "csv");
  write_long_nodes(folder / "nodes.csv", job);
  write_long_rods(folder / "rods.csv", job);
}

}  // namespace unfurl
