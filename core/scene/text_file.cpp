// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace unfurl {

namespace {

namespace fs = std::filesystem;

std::string outside_error(const std::string& folder, const std::string& name) {
  const fs::path path(name);
  if (name.find('\0') != std::string::npos) return "holds the character \\u0000, which no file name can";
  if (folder.empty()) return "a scene that is not a file cannot name other files";
  if (path.is_absolute()) return "must be relative to the scene's folder";
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder, error);
  const fs::path target = fs::weakly_canonical(root / path, error);
  const fs::path inside = target.lexically_relative(root);
  if (error || inside.empty() || *inside.begin() == "..") return "must lie inside the scene's folder";
  return "";
}

}  // namespace

TextFile read_text_file(const std::string& path, TextSource source, std::size_t most) {
  TextFile result{path, "", ""};
  // Opening a pipe that nobody writes to waits, unless it is told not to.
  const int descriptor =
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | (source == TextSource::regular_file ? O_NONBLOCK : 0));
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0)
    result.error = std::strerror(errno);
  else if (S_ISDIR(status.st_mode))
    result.error = "is a directory";
  else if (source == TextSource::regular_file && !S_ISREG(status.st_mode))
    result.error = "is not a regular file";
  if (!result.error.empty()) {
    if (descriptor >= 0) ::close(descriptor);
    return result;
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(::fdopen(descriptor, "rb"), &std::fclose);
  if (!file) {
    ::close(descriptor);
    result.error = std::strerror(ENOMEM);
    return result;
  }
  std::vector<char> block(std::size_t{1} << 16U);
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
    result.text.append(block.data(), n);
    if (result.text.size() > most) {
      result.error = "is larger than " + std::to_string(most >> 20U) + " MB";
      result.text.clear();
      return result;
    }
  }
  if (std::ferror(file.get())) result.error = "cannot be read";
  return result;
}

TextFile read_result_file(const std::string& path) {
  return read_text_file(path, TextSource::regular_file, std::string().max_size());
}

namespace {

thread_local FilesBeside* files_in_use = nullptr;

}  // namespace

FilesBeside::InUse::InUse(FilesBeside* files) : before_(files_in_use) {
  files_in_use = files;
}
FilesBeside::InUse::~InUse() {
  files_in_use = before_;
}

void FilesBeside::each(const std::function<void(const std::string&, const TextFile&)>& told) {
  const std::lock_guard lock(mutex_);
  for (const auto& [path, file] : read_) told(path, file);
}

TextFile read_file_beside(const std::string& folder, const std::string& name) {
  const std::string path = (fs::path(folder) / name).string();
  std::unique_lock<std::mutex> lock;
  if (files_in_use) {
    lock = std::unique_lock(files_in_use->mutex_);
    if (const auto known = files_in_use->read_.find(path); known != files_in_use->read_.end())
      return known->second;
  }
  if (std::string error = outside_error(folder, name); !error.empty()) return {name, "", std::move(error)};
  TextFile file = read_text_file(path);
  if (!file.error.empty()) file.error = "cannot read " + file.path + ": " + file.error;
  if (files_in_use) files_in_use->read_[path] = file;
  return file;
}

}  // namespace unfurl
