// SPDX-License-Identifier: BSD-3-Clause
// What the window remembers from one time to the next, in the user's configuration directory.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace unfurl {

struct PanelSettings {
  int width = 1280, height = 720;             // of the window [units of the desktop]
  float left_width = 300, right_width = 360;  // of the panes [points]
  bool left_open = true, right_open = true, dark = false;
  std::vector<std::string> open_figures = {"rod_forces", "drives", "deployment", "trade"};
  std::vector<std::string> recent = {};  // scene files, the latest first
  bool tour_seen = false;                // the guided tour of the first start

  bool operator==(const PanelSettings&) const = default;
};

// $XDG_CONFIG_HOME/unfurl/window.json, or that in ~/.config; empty where there is no such place.
std::filesystem::path settings_file();

std::string settings_text(const PanelSettings& settings);  // as JSON
PanelSettings settings_of(const std::string& text);        // within reason; the defaults where it is broken
// What the file says, within reason; the defaults where it is missing or broken.
PanelSettings load_settings(const std::filesystem::path& file);
// Returns whether it could be written; a window works without.
bool save_settings(const std::filesystem::path& file, const PanelSettings& settings);

}  // namespace unfurl
