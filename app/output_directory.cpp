#include "app/output_directory.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "app/exit_code.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/model/nearest_name.hpp"
#include "core/scene/text_file.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

// Put into directories that were empty before, so that a run that was killed can be repeated without --force.
constexpr const char* marker = ".unfurl";

bool holds_our_results(const fs::path& directory) {
  std::error_code error;
  if (fs::exists(directory / marker, error)) return true;
  const TextFile summary = read_text_file((directory / "summary.json").string());
  const auto json = nlohmann::json::parse(summary.text, nullptr, false);
  return json.is_object() && json.contains("unfurl");
}

// The system's words of an error about another file.
std::string cause_of(const FileError& error) {
  const std::string text = error.what();
  return text.substr(text.rfind(": ") + 2);
}

// A directory that cannot be written to, or a full disk, is found now rather than after the work.
void probe(const fs::path& directory, bool leave_marker) {
  try {
    write_file_atomically(directory / marker, "Made by unfurl " UNFURL_VERSION "\n");
  } catch (const FileError& error) {
    throw FileError(directory, cause_of(error));
  }
  std::error_code ignored;
  if (!leave_marker) fs::remove(directory / marker, ignored);
}

void remove_matching(const fs::path& folder, std::string_view prefix, std::string_view suffix) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix)) fs::remove(entry.path(), error);
  }
}

}  // namespace

fs::path open_output_directory(const std::string& path, bool force) {
  const fs::path directory(path);
  std::error_code error;
  if (fs::exists(directory, error) && !fs::is_directory(directory, error))
    throw FileError(directory, "is a file; -o names a directory");
  fs::create_directories(directory, error);
  if (error) throw FileError(directory, error.value());
  const bool empty = fs::is_empty(directory, error);
  if (error) throw FileError(directory, error.value());
  const bool ours = empty || holds_our_results(directory);
  if (!ours && !force)
    throw FileError(directory, "is not empty and holds no earlier results; use --force to write into it");
  probe(directory, ours);
  return directory;
}

OwnDirectory::OwnDirectory(const std::string& path, bool force) {
  if (path.empty()) return;
  path_ = open_output_directory(path, force);
  lock_.emplace(path_, DirectoryLock::Use::alone);
  remove_unfinished(path_);
}

void remove_unfinished(const fs::path& directory) {
  const auto old = fs::file_time_type::clock::now() - std::chrono::minutes(1);
  std::error_code error;
  for (const char* folder : {"", "frames", "figures"})
    for (const auto& entry : fs::directory_iterator(directory / folder, error)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with(".") || !name.ends_with(unfinished_suffix)) continue;
      if (entry.last_write_time(error) < old && !error) fs::remove(entry.path(), error);
    }
}

void require_writable(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) throw FileError(file, "is a directory");
  try {
    const PendingFile pending(file);
    write_file_atomically(pending.name(), std::string_view("can this directory be written to?\n"));
  } catch (const FileError& error) {
    throw FileError(file, cause_of(error));
  }
}

void require_writable_png(const fs::path& file, const std::string& what) {
  if (file.extension() != ".png")
    throw UsageError(what + " is written as .png, not " + in_quotes(file.extension().string()));
  require_writable(file);
}

void clear_old_results(const fs::path& directory) {
  std::error_code error;
  for (const char* name : {"summary.json", "series.csv", "trajectory.csv", "rod_forces.csv", "scene.toml",
                           "animation.webp", "animation.mp4", "animation.gif", "film.json"})
    fs::remove(directory / name, error);
  for (const ExportFormat& format : export_formats()) {
    for (const char* suffix : {".pvd", ".vtu", ".csv", ".npy"})
      remove_matching(directory / format.result, "", suffix);
    fs::remove(directory / format.result, error);
  }
  remove_matching(directory / "frames", "frame_", ".png");
  for (const char* suffix : {".png", ".svg"}) remove_matching(directory / "figures", "", suffix);
  fs::remove(directory / "frames", error);  // only where it is empty now
  fs::remove(directory / "figures", error);
}

}  // namespace unfurl
