#include "app/output_directory.hpp"

#include <nlohmann/json.hpp>

#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

// An earlier run ends with a summary that names the program.
bool holds_our_results(const fs::path& directory) {
  const TextFile summary = read_text_file((directory / "summary.json").string());
  const auto json = nlohmann::json::parse(summary.text, nullptr, false);
  return json.is_object() && json.contains("unfurl");
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
  if (!empty && !force && !holds_our_results(directory))
    throw FileError(directory, "is not empty and holds no earlier results; use --force to write into it");
  const PendingFile probe(directory / "probe");
  write_file_atomically(probe.name(), std::string_view("can this directory be written to?\n"));
  return directory;
}

void clear_old_results(const fs::path& directory) {
  std::error_code error;
  for (const char* name : {"summary.json", "series.csv", "trajectory.csv", "rod_forces.csv", "scene.toml",
                           "animation.webp", "animation.mp4", "animation.gif"})
    fs::remove(directory / name, error);
  remove_matching(directory / "frames", "frame_", ".png");
  for (const char* suffix : {".png", ".svg"}) remove_matching(directory / "figures", "", suffix);
  fs::remove(directory / "frames", error);  // only where it is empty now
  fs::remove(directory / "figures", error);
}

}  // namespace unfurl
