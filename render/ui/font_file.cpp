// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/font_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <vector>

#include "render/plot/true_type.hpp"
#include "render/ui/embedded_fonts.hpp"

namespace unfurl {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

// Folders that may hold fonts, each with its own below it.
std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders{environment("UNFURL_FONTS")};
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

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

// What was found stays: figures ask for each of theirs.
std::string_view font_bytes(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  for (const EmbeddedFont& font : embedded_fonts())
    if (font.name == name) return font.bytes;
  static std::mutex mutex;
  static std::map<std::string, std::string> found;
  const std::lock_guard lock(mutex);
  std::string& bytes = found[file];
  if (bytes.empty())
    if (const std::string place = font_below(file); !place.empty()) bytes = content(place);
  return bytes;
}

bool own_font_has(char32_t c) {
  static const std::optional<plot::TrueType> font = []() -> std::optional<plot::TrueType> {
    try {
      return plot::TrueType{std::string(own_font())};
    } catch (const std::runtime_error&) {  // none, or no such font
      return std::nullopt;
    }
  }();
  return !font || font->glyph(c) != 0;
}

std::string_view own_font(bool bold) {
  return font_bytes(bold ? "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
                         : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf");
}

}  // namespace unfurl
