// SPDX-License-Identifier: BSD-3-Clause
// Files to choose from while a path is typed.
#pragma once

#include <string>
#include <vector>

namespace unfurl {

struct FileEntry {
  std::string name;  // with "/" behind it where it is a folder
  std::string path;  // as it would be typed on

  bool operator==(const FileEntry&) const = default;
};

// "~/x" means a folder of one's own: "/home/me/x".
std::string at_home(const std::string& typed);
// Folders and .toml files that begin as what is typed, by name; first "../" where nothing of a name is typed.
// Empty where the folder cannot be read.
std::vector<FileEntry> matching_files(const std::string& typed);
// The longest beginning that all of those have in common; what is typed where there are none.
std::string completed_path(const std::string& typed);

}  // namespace unfurl
