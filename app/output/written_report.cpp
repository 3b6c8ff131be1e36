// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/written_report.hpp"

#include <cstdio>
#include <map>
#include <string_view>
#include <utility>

namespace unfurl {

namespace {

namespace fs = std::filesystem;

struct Sum {
  int files = 0;
  std::uintmax_t bytes = 0;
  void add(const Sum& other) {
    files += other.files;
    bytes += other.bytes;
  }
  std::string text() const {
    return std::to_string(files) + (files == 1 ? " file, " : " files, ") + bytes_text(bytes);
  }
};

// In lines that begin with two spaces; none is broken within a name.
std::string in_lines(const std::map<std::string, Sum>& items) {
  constexpr std::size_t width = 80;
  std::string text, line;
  std::size_t left = items.size();
  for (const auto& [name, sum] : items) {
    const bool folder = name.ends_with('/');
    const std::string item =
        name + " " + (folder ? "(" + sum.text() + ")" : bytes_text(sum.bytes)) + (--left ? "," : "");
    if (!line.empty() && line.size() + 1 + item.size() > width) {
      text += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "  " : " ") + item;
  }
  return text + line + "\n";
}

}  // namespace

std::string bytes_text(std::uintmax_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " B";
  auto size = static_cast<double>(bytes);
  std::string_view prefixes = "kMGT";
  for (size /= 1000; size >= 999.95 && prefixes.size() > 1; size /= 1000) prefixes.remove_prefix(1);
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %cB", size, prefixes.front());
  return text;
}

WrittenReport::WrittenReport(fs::path output) : output_(std::move(output)), before_(watch_files(this)) {}

WrittenReport::~WrittenReport() {
  watch_files(before_);
}

void WrittenReport::before_file(const fs::path& target, const std::string& checksum) {
  if (before_) before_->before_file(target, checksum);
  const std::lock_guard lock(mutex_);
  files_.insert(target);
}

std::string WrittenReport::text() const {
  if (output_.empty()) return "";
  std::error_code error;
  const fs::path folder = fs::is_directory(output_, error) ? output_ : output_.parent_path();
  const fs::path from = folder.empty() ? "." : folder;
  std::map<std::string, Sum> items;
  Sum all;
  const std::lock_guard lock(mutex_);
  for (const fs::path& file : files_) {
    const fs::path name = file.lexically_normal().lexically_relative(from.lexically_normal());
    if (name.empty() || *name.begin() == ".." || is_unfinished_name(name.filename().string())) continue;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (error) continue;  // it was for the time of the work
    items[name.has_parent_path() ? name.begin()->string() + "/" : name.string()].add({1, bytes});
    all.add({1, bytes});
  }
  if (items.empty()) return "";
  return "written into " + from.string() + ": " + all.text() + "\n" + in_lines(items);
}

}  // namespace unfurl
