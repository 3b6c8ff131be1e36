// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/font_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "core/scene/library.hpp"

namespace unfurl {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

// Folders that may hold fonts, each with its own below it.
std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders{environment("UNFURL_FONTS"), asset_folder("fonts")};
  const std::string home = environment("HOME"), data = environment("XDG_DATA_HOME");
  if (!data.empty()) folders.push_back(fs::path(data) / "fonts");
  if (!home.empty())
    folders.insert(folders.end(), {fs::path(home) / ".local/share/fonts", fs::path(home) / ".fonts"});
  folders.insert(folders.end(), {"/usr/local/share/fonts", "/usr/share/fonts", "/opt/homebrew/share/fonts"});
  return folders;
}

std::string font_below(const fs::path& file) {
  std::error_code error;
  if (fs::is_regular_file(file, error)) return file.string();
  for (const fs::path& folder : font_folders()) {
    if (folder.empty()) continue;
    auto entry =
        fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
      if (entry->path().filename() == file.filename() && entry->is_regular_file(error))
        return entry->path().string();
  }
  return "";
}

}  // namespace

// What was found stays: figures ask for each of theirs.
std::string found_font(const std::string& file) {
  static std::mutex mutex;
  static std::map<std::string, std::string> found;
  const std::lock_guard lock(mutex);
  std::string& place = found[file];
  if (place.empty()) place = font_below(file);
  return place;
}

std::string font_file(bool bold) {
  return found_font(bold ? "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
                         : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf");
}

}  // namespace unfurl
