// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/settings.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"

namespace unfurl {

namespace {

using nlohmann::json;

template <class T>
T number(const json& file, const char* key, T fallback, T low, T high) {
  const auto it = file.find(key);
  if (it == file.end() || !it->is_number()) return fallback;
  return static_cast<T>(std::clamp(it->get<double>(), static_cast<double>(low), static_cast<double>(high)));
}

bool flag(const json& file, const char* key, bool fallback) {
  const auto it = file.find(key);
  return it != file.end() && it->is_boolean() ? it->get<bool>() : fallback;
}

void words(const json& file, const char* key, std::vector<std::string>& list) {
  const auto it = file.find(key);
  if (it == file.end() || !it->is_array()) return;
  list.clear();
  for (const json& word : *it)
    if (word.is_string()) list.push_back(word.get<std::string>());
}

}  // namespace

std::filesystem::path settings_file() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && config[0] == '/') return std::filesystem::path(config) / "unfurl/window.json";
  const char* home = std::getenv("HOME");
  if (home == nullptr || home[0] != '/') return {};
  return std::filesystem::path(home) / ".config/unfurl/window.json";
}

PanelSettings settings_of(const std::string& text) {
  PanelSettings s;
  const json found = json::parse(text, nullptr, false);
  if (!found.is_object()) return s;
  s.width = number(found, "width", s.width, 640, 16384);
  s.height = number(found, "height", s.height, 400, 16384);
  s.left_width = number(found, "left_width", s.left_width, 200.0f, 800.0f);
  s.right_width = number(found, "right_width", s.right_width, 200.0f, 1200.0f);
  s.left_open = flag(found, "left_open", s.left_open);
  s.right_open = flag(found, "right_open", s.right_open);
  s.dark = flag(found, "dark", s.dark);
  s.tour_seen = flag(found, "tour_seen", s.tour_seen);
  words(found, "open_figures", s.open_figures);
  words(found, "recent", s.recent);
  return s;
}

std::string settings_text(const PanelSettings& s) {
  const json text = {{"width", s.width},
                     {"height", s.height},
                     {"left_width", s.left_width},
                     {"right_width", s.right_width},
                     {"left_open", s.left_open},
                     {"right_open", s.right_open},
                     {"dark", s.dark},
                     {"tour_seen", s.tour_seen},
                     {"open_figures", s.open_figures},
                     {"recent", s.recent}};
  return text.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

PanelSettings load_settings(const std::filesystem::path& file) {
  return file.empty() ? PanelSettings() : settings_of(read_text_file(file.string()).text);
}

bool save_settings(const std::filesystem::path& file, const PanelSettings& s) {
  if (file.empty()) return false;
  try {
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    write_file_atomically(file, settings_text(s));
    return true;
  } catch (const std::exception&) {  // a read-only home is no reason to complain
    return false;
  }
}

}  // namespace unfurl
