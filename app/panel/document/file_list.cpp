// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/file_list.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace unfurl {

namespace fs = std::filesystem;

std::string at_home(const std::string& typed) {
  const char* home = std::getenv("HOME");
  return typed.starts_with("~/") && home != nullptr ? home + typed.substr(1) : typed;
}

std::vector<FileEntry> matching_files(const std::string& typed) {
  const std::string whole = at_home(typed);
  const std::size_t slash = whole.rfind('/') + 1;  // 0: there is none
  const std::string folder = whole.substr(0, slash), begin = whole.substr(slash);
  std::vector<FileEntry> found;
  std::error_code unknown;
  for (fs::directory_iterator it(folder.empty() ? "." : folder, unknown);
       !unknown && it != fs::directory_iterator(); it.increment(unknown)) {
    std::string name = it->path().filename().string();
    const bool hidden = name.starts_with(".") && !begin.starts_with(".");
    std::error_code gone;
    const bool is_folder = it->is_directory(gone);
    if (hidden || !name.starts_with(begin) || (!is_folder && !name.ends_with(".toml"))) continue;
    if (is_folder) name += "/";
    found.push_back({name, folder + name});
  }
  std::sort(found.begin(), found.end(),
            [](const FileEntry& a, const FileEntry& b) { return a.name < b.name; });
  if (begin.empty()) found.insert(found.begin(), {"../", folder + "../"});
  return found;
}

std::string completed_path(const std::string& typed) {
  std::vector<FileEntry> all = matching_files(typed);
  std::erase_if(all, [](const FileEntry& entry) { return entry.name == "../"; });
  if (all.empty()) return typed;
  std::string common = all.front().path;
  for (const FileEntry& entry : all) {
    const auto end = std::mismatch(common.begin(), common.end(), entry.path.begin(), entry.path.end()).first;
    common.erase(end, common.end());
  }
  return common.size() < at_home(typed).size() ? typed : common;
}

}  // namespace unfurl
